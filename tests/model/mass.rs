use crate::yaml::experiment;
use gotai::exact::free_rotation::FreeRotation;
use gotai::model::Geometry;
use gotai::scene::build;
use gotai::shape::cuboid::moments as box_moments;
use gotai::shape::mesh::{TetMesh, box_counts, box_mesh, sphere_mesh};
use gotai::shape::moments::{exact, lumped};
use gotai::shape::sphere::moments as sphere_moments;
use nalgebra::{Matrix3, Vector3};

fn cube(n: u32) -> TetMesh {
    box_mesh([1.0; 3], [n; 3])
}

/// Lecture map: relative error of the diagonal −½/(n−1)², off-diagonals ⅛/(n−1)² of the diagonal's ⅙.
#[test]
fn a_lumped_cube_is_wrong_by_the_law() {
    for n in 2..9 {
        let I = lumped(&cube(n)).with_mass(1.0).I_B;
        let cells = f64::from(n - 1) * f64::from(n - 1);
        for i in 0..3 {
            // measured: 2.2e-15 at most
            assert!((I[(i, i)] * 6.0 - 1.0 + 0.5 / cells).abs() < 1e-10, "n = {n}");
            let off = I[(i, (i + 1) % 3)].abs() * 6.0;
            assert!((off - 0.125 / cells).abs() < 1e-10, "n = {n}: {off}");
        }
    }
}

/// A single tet has no lumped inertia at all; a fan of tets misses 1/16 of a sphere's however fine it is.
#[test]
fn a_lumped_sphere_does_not_converge_and_an_exact_one_does() {
    let error = |I: Matrix3<f64>| I.trace() / 3.0 / (0.4 * 0.25) - 1.0;
    let mesh = sphere_mesh(0.5, 5);
    let (wrong, right) = (error(lumped(&mesh).with_mass(1.0).I_B), error(exact(&mesh).with_mass(1.0).I_B));
    // measured: -0.0631 and -7.2e-4
    assert!((wrong + 1.0 / 16.0).abs() < 2e-3 && right.abs() < 2e-3, "{wrong} {right}");
}

#[test]
fn the_integral_over_the_tets_of_a_bar_is_its_closed_form() {
    let size = [0.4, 0.5, 1.6];
    let closed = box_moments(size).with_mass(3.0);
    for n in 2..5 {
        let mesh = exact(&box_mesh(size, box_counts(size, n))).with_mass(3.0);
        // measured: 4.4e-16
        assert!((mesh.I_B - closed.I_B).abs().max() < 1e-14);
        assert!(mesh.p_BoBcm.norm() < 1e-15);
    }
}

#[test]
fn closed_forms_are_those_of_the_textbook() {
    let bar = box_moments([1.0, 2.0, 3.0]).with_mass(12.0).I_B;
    assert!((bar - Matrix3::from_diagonal(&Vector3::new(13.0, 10.0, 5.0))).abs().max() < 1e-14);
    let ball = sphere_moments(0.5).with_mass(10.0).I_B;
    assert!((ball - Matrix3::identity()).abs().max() < 1e-15);
}

/// Centre of mass and inertia of a part of a mesh, moved far away: the parallel-axis theorem is in the moments.
#[test]
fn moving_the_mesh_moves_the_centre_and_nothing_else() {
    let mut mesh = sphere_mesh(0.5, 1);
    mesh.tets.truncate(7);
    let before = exact(&mesh).with_mass(1.0);
    let moved = Vector3::new(3.0, -2.0, 5.0);
    mesh.nodes.iter_mut().for_each(|u| *u += moved);
    let after = exact(&mesh).with_mass(1.0);
    // measured: 1.8e-14 (cancellation of 38 m² against 0.1)
    assert!((after.p_BoBcm - before.p_BoBcm - moved).norm() < 1e-13);
    assert!((after.I_B - before.I_B).abs().max() < 1e-12);
}

/// I = R ᴼI Rᵀ and not Rᵀ ᴼI R: against the sum over the turned tets of a bar.
#[test]
fn the_inertia_of_a_turned_bar_is_that_of_its_turned_mesh() {
    let text = "
scene:
  bodies:
    - name: bar
      shape: { box: { size_m: [0.4, 0.5, 1.6] } }
      mesh: { nodes_per_edge: 2 }
      mass_kg: 2
      inertia_from: lumped
      orientation: { axis: [1, 2, 3], angle_deg: 50 }
method: free
time: { step_s: 0.1, end_s: 1 }
";
    let (model, state) = build(&crate::yaml::experiment(text, &[])).unwrap();
    let Geometry::Mesh { mesh, .. } = &model.bodies[0].geometry else { panic!("a mesh was asked for") };
    let mut turned = mesh.clone();
    turned.nodes.iter_mut().for_each(|u| *u = state.bodies[0].q_WB * *u);
    let direct = lumped(&turned).with_mass(2.0).I_B;
    let by_matrix = model.bodies[0].I_W(&state.bodies[0]);
    // measured: 1.1e-16; the slide's Rᵀ I R is off by 0.4
    assert!((direct - by_matrix).abs().max() < 1e-14);
}

/// The largest angular velocity of a free turn is one that it comes to: of bodies that tumble about any axis.
#[test]
fn the_fastest_of_a_free_turn_is_come_to_and_not_passed() {
    for size in [[0.3, 0.002, 0.3], [0.65, 0.03, 0.03], [0.2, 0.004, 0.3], [0.1, 0.3, 0.2]] {
        for w in [[400.0, 900.0, 1700.0], [1.0, 2000.0, 1.0], [30.0, -5.0, 0.0], [0.01, 1.0, 0.02]] {
            let text = format!(
                "{{ scene: {{ bodies: [{{ name: a, shape: {{ box: {{ size_m: {size:?} }} }}, mass_kg: 2, \
                 angular_velocity_rad_s: {w:?} }}] }}, time: {{ end_s: 1 }}, method: event-driven }}"
            );
            let (model, start) = build(&experiment(&text, &[])).unwrap();
            let (body, at) = (&model.bodies[0], &start.bodies[0]);
            let fastest = body.fastest_turn_rad_s(at, &at.w_WB);
            let turn = FreeRotation::new(&body.I_B, &at.q_WB, &at.w_WB);
            // A few periods: about the middle axis they are long.
            let span_s = 200.0 / at.w_WB.norm();
            let come_to = (0..40_000).map(|i| turn.at(span_s * f64::from(i) / 4e4).1.norm()).fold(0.0, f64::max);
            // Measured: 1 to 1 + 2e-6.
            assert!((1.0 - 1e-12..1.0 + 1e-4).contains(&(fastest / come_to)), "{size:?}, {w:?}: {fastest} {come_to}");
        }
    }
}

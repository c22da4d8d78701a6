//! `place: at-contact`: a start in the first step of a contact.

use crate::yaml::{CUBE_IN_BOX, experiment, file};
use gotai::collide::faces::nearest;
use gotai::experiment::types::Experiment;
use gotai::scene::build;
use gotai::state::BodyState;
use gotai::sweep::plan::single_case;
use nalgebra::Vector3;

const AT_CONTACT: &str = "scene.random={ speed_m_s: 4, spin_rad_s: 6, attitude: true, place: at-contact }";

/// The start, how fast its lowest point approaches the floor (face 0), and how deep it is inside.
fn landed(experiment: &Experiment) -> (BodyState, f64, f64) {
    let (model, state) = build(experiment).unwrap();
    let floor = &model.container.as_ref().unwrap().faces[0];
    let at = state.bodies[0];
    let (r, gap) = nearest(&model.bodies[0], &at, floor).unwrap();
    (at, -floor.normal.dot(&(at.v_WB + at.w_WB.cross(&r))), -gap)
}

fn with_seed(base: &Experiment, seed: u64) -> Experiment {
    Experiment { seed, ..base.clone() }
}

/// Depths as a part of what the lowest point moves in a step, sorted.
fn parts(sets: &[&str], seeds: u64) -> Vec<f64> {
    let base = experiment(CUBE_IN_BOX, sets);
    let part = |seed| {
        let (_, approach, depth) = landed(&with_seed(&base, seed));
        assert!(approach > 0.0, "seed {seed} recedes by {approach} m/s");
        depth / (approach * base.clock().step_s)
    };
    let mut parts: Vec<f64> = (0..seeds).map(part).collect();
    parts.sort_by(f64::total_cmp);
    parts
}

/// Quantiles against those of U(0, 1), with every shape; 2.0 s are 67 steps of 0.02985 s, not of 0.03 s.
#[test]
fn the_depth_is_uniform_over_what_the_lowest_point_moves_in_a_step() {
    let shapes = [
        ("box: { size_m: [1, 1, 1] }", "{ nodes_per_edge: 3 }"),
        ("box: { size_m: [0.4, 0.4, 1.6] }", "null"),
        ("sphere: { radius_m: 0.5 }", "null"),
        ("sphere: { radius_m: 0.5 }", "{ subdivisions: 1 }"),
    ];
    for (shape, mesh) in shapes {
        let shape = format!("scene.bodies.cube.shape={{ {shape} }}");
        let mesh = format!("scene.bodies.cube.mesh={mesh}");
        let exact = "scene.bodies.cube.inertia_from=exact";
        for direction in ["null", "downward"] {
            let direction = format!("scene.random.direction={direction}");
            let parts = parts(&[AT_CONTACT, &shape, &mesh, exact, &direction, "time.step_s=0.03"], 2000);
            let n = parts.len() as f64;
            let distance = |(i, part): (usize, &f64)| (part - (i as f64 + 0.5) / n).abs();
            let farthest = parts.iter().enumerate().map(distance).fold(0.0, f64::max);
            // Kolmogorov's 1 % point is 1.63/√n = 0.036. measured: 0.013 … 0.028
            assert!(farthest < 0.036, "{shape} {mesh} {direction}: {farthest}");
            assert!(parts[0] > 0.0 && parts[parts.len() - 1] < 1.0, "{shape} {mesh} {direction}");
        }
    }
}

#[test]
fn a_draw_that_approaches_is_kept_and_any_other_is_drawn_again() {
    let (plain, base) = (experiment(CUBE_IN_BOX, &[]), experiment(CUBE_IN_BOX, &[AT_CONTACT]));
    let mut kept = 0;
    for seed in 0..200 {
        let (first, approach, _) = landed(&with_seed(&plain, seed));
        let (at, ..) = landed(&with_seed(&base, seed));
        let same = (first.v_WB, first.w_WB, first.q_WB) == (at.v_WB, at.w_WB, at.q_WB);
        assert_eq!(same, approach > 0.0, "seed {seed}");
        // Only the height changes. measured: 0
        assert!(!same || (at.p_WB.x, at.p_WB.z) == (first.p_WB.x, first.p_WB.z), "seed {seed}");
        assert_eq!(at, landed(&with_seed(&base, seed)).0, "the same every time");
        kept += u32::from(same);
    }
    // measured: 103
    assert!((80..120).contains(&kept), "{kept}");
}

#[test]
fn the_step_scales_the_depth_and_changes_nothing_else() {
    for seed in 0..50 {
        let start = |step: &str| landed(&with_seed(&experiment(CUBE_IN_BOX, &[AT_CONTACT, step]), seed));
        let (coarse, fine) = (start("time.step_s=0.02"), start("time.step_s=0.005"));
        assert_eq!((coarse.0.v_WB, coarse.0.w_WB, coarse.0.q_WB), (fine.0.v_WB, fine.0.w_WB, fine.0.q_WB));
        // measured: 1.3e-12 at most, a rounding of the height in a small depth
        assert!((coarse.2 / fine.2 / 4.0 - 1.0).abs() < 1e-10, "{} {}", coarse.2, fine.2);
    }
}

/// Given velocities serve as well; the floor is the face most against gravity, and without gravity y is up.
#[test]
fn the_body_is_shifted_along_the_normal_of_the_floor_that_gravity_chooses() {
    let given = [
        "scene.random={ place: at-contact }",
        "scene.bodies.cube.velocity_m_s=[-1, -1, 0]",
        "scene.bodies.cube.position_m=[0.2, 1, 0.3]",
    ];
    let start = |set: &str| build(&experiment(CUBE_IN_BOX, &[&given[..], &[set]].concat())).unwrap().1.bodies[0].p_WB;
    // A box 4 m wide: half an edge from a face, less at most 1 m/s × 0.01 s.
    let inside = |x: f64| x < 0.0 && x > -0.01;
    for set in ["seed=1", "scene.gravity_m_s2=[0, 0, 0]"] {
        let p = start(set);
        assert!((p.x, p.z) == (0.2, 0.3) && inside(p.y - 0.5), "{set}: {p}");
    }
    let p = start("scene.gravity_m_s2=[-9.8, 1, 0]");
    assert!((p.y, p.z) == (1.0, 0.3) && inside(p.x + 1.5), "{p}");
}

#[test]
fn a_body_that_never_approaches_is_one_clear_error() {
    let sets = ["scene.random={ place: at-contact }", "scene.bodies.cube.velocity_m_s=[0, 1, 0]"];
    let message = single_case(&file(CUBE_IN_BOX, &sets)).unwrap_err().to_string();
    assert!(
        message.contains("scene.random.place: expected a body that approaches the floor in some draw"),
        "{message}"
    );
    assert!(message.contains("cube receding in all of 1000"), "{message}");
}

#[test]
fn an_overlap_deeper_than_its_own_is_refused_unless_it_is_allowed() {
    let near_a_wall = [AT_CONTACT, "scene.bodies.cube.position_m=[1.8, 2, 0]"];
    let message = single_case(&file(CUBE_IN_BOX, &near_a_wall)).unwrap_err().to_string();
    assert!(message.contains("expected no overlap") && message.contains("cube inside a face by"), "{message}");
    let allowed = [&near_a_wall[..], &["scene.allow_overlap=true"]].concat();
    assert!(single_case(&file(CUBE_IN_BOX, &allowed)).is_ok());
}

#[test]
fn an_overlap_that_is_allowed_is_simulated_and_the_default_changes_no_case_id() {
    let sunk = ["scene.random=null", "scene.bodies.cube.position_m=[0, 0.3, 0]"];
    let case = |last: &str| single_case(&file(CUBE_IN_BOX, &[&sunk[..], &[last]].concat()));
    assert!(case("scene.allow_overlap=false").is_err());
    let (model, start) = build(&case("scene.allow_overlap=true").unwrap().experiment).unwrap();
    assert!((gotai::collide::deepest(&model, &start).unwrap().gap_m + 0.2).abs() < 1e-15);
    let id = |sets: &[&str]| single_case(&file(CUBE_IN_BOX, sets)).unwrap().id;
    assert_eq!(id(&[]), id(&["scene.allow_overlap=false", "scene.random.place=null"]));
    assert_ne!(id(&[]), id(&["scene.allow_overlap=true"]));
}

/// A point has nothing to touch with.
#[test]
fn a_body_without_shape_stays_where_it_is() {
    let point = "{ name: point, shape: none, mass_kg: 1, position_m: [0, 1, 0] }";
    let text = CUBE_IN_BOX.replace("  random:", &format!("    - {point}\n  random:")).replace(", spin_rad_s: 6", "");
    let (_, state) = build(&experiment(&text, &["scene.random.place=at-contact"])).unwrap();
    assert_eq!(state.bodies[1].p_WB, Vector3::new(0.0, 1.0, 0.0));
}

//! Closed forms of round shapes and integrals over polyhedra, against sums over slices and each other.

use gotai::model::{Body, Geometry};
use gotai::scene::build;
use gotai::shape::capsule::moments as capsule_moments;
use gotai::shape::cuboid::moments as box_moments;
use gotai::shape::cylinder::moments as cylinder_moments;
use gotai::shape::ellipsoid::moments as ellipsoid_moments;
use gotai::shape::moments::MassProperties;
use nalgebra::{Matrix3, Vector3};

/// Body of this shape alone.
fn body(shape: &str, more: &str) -> Body {
    let text = format!(
        "
scene:
  container: {{ box: {{ size_m: [9, 9, 9] }} }}
  air: {{ density_kg_m3: 2, drag_coefficient: 1 }}
  bodies:
    - name: one
      shape: {{ {shape} }}
      density_kg_m3: 3
      position_m: [0, 4, 0]
      {more}
method: free
time: {{ step_s: 0.1, end_s: 1 }}
"
    );
    let (mut model, _) = build(&crate::yaml::experiment(&text, &[])).unwrap();
    model.bodies.remove(0)
}

/// Mass properties of a body that is `radii(y)` wide, slice by slice: elliptic disks of area π a b, ∫x² = area a²/4.
fn sliced(low: f64, high: f64, radii: impl Fn(f64) -> (f64, f64)) -> MassProperties {
    const SLICES: usize = 20_000;
    let thick = (high - low) / SLICES as f64;
    let (mut mass_kg, mut second) = (0.0, Vector3::zeros());
    for i in 0..SLICES {
        let y = low + thick * (i as f64 + 0.5);
        let (a, b) = radii(y);
        let slice = std::f64::consts::PI * a * b * thick;
        mass_kg += slice;
        second += Vector3::new(a * a / 4.0, y * y, b * b / 4.0) * slice;
    }
    let I_B = Matrix3::from_diagonal(&(Vector3::repeat(second.sum()) - second));
    MassProperties { mass_kg, p_BoBcm: Vector3::zeros(), I_B }
}

#[test]
fn closed_forms_are_the_sum_of_slices() {
    let (r, h) = (0.4_f64, 1.1_f64);
    let cap = |y: f64| (r * r - (y.abs() - h / 2.0).max(0.0).powi(2)).sqrt();
    let ellipse = |y: f64| (1.0 - y * y / 0.25).sqrt();
    let rows = [
        (cylinder_moments(r, h), sliced(-h / 2.0, h / 2.0, |_| (r, r))),
        (capsule_moments(r, h), sliced(-h / 2.0 - r, h / 2.0 + r, |y| (cap(y), cap(y)))),
        (ellipsoid_moments([0.3, 0.5, 0.7]), sliced(-0.5, 0.5, |y| (0.3 * ellipse(y), 0.7 * ellipse(y)))),
    ];
    for (closed, sum) in rows {
        let closed = closed.with_mass(closed.volume_m3);
        // measured: 2.3e-9 and 3.4e-9, the slices' error
        assert!((closed.mass_kg / sum.mass_kg - 1.0).abs() < 1e-8);
        assert!((closed.I_B - sum.I_B).abs().max() < 1e-8 * sum.I_B.trace());
    }
}

/// A box written as its corners, away from its frame's origin, and a tetrahedron of known volume.
#[test]
fn a_convex_box_is_the_box_and_its_centre_of_mass_is_found() {
    let corners = "[0, 0, 0], [1, 0, 0], [0, 2, 0], [1, 2, 0], [0, 0, 3], [1, 0, 3], [0, 2, 3], [1, 2, 3]";
    let convex = body(&format!("convex: {{ vertices_m: [{corners}] }}"), "");
    let closed = box_moments([1.0, 2.0, 3.0]).with_mass(18.0);
    assert!((convex.I_B - closed.I_B).abs().max() < 1e-13 && (convex.mass_kg - 18.0).abs() < 1e-13);
    assert!((convex.p_BoBcm - Vector3::new(0.5, 1.0, 1.5)).norm() < 1e-14);
    let tet = body("convex: { vertices_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }", "");
    assert!((tet.mass_kg - 0.5).abs() < 1e-15 && (tet.p_BoBcm - Vector3::repeat(0.25)).norm() < 1e-15);
}

/// Drag's mean shadow is a quarter of the surface: ½ ρ c_d S/4 is S/4 here.
#[test]
fn surfaces_are_those_of_the_textbook() {
    use std::f64::consts::PI;
    let surface = |shape: &str| 4.0 * body(shape, "").drag.quadratic_n_s2_m2;
    // Prolate spheroid, c = 2a: 2π a² (1 + c/(a e) asin e), e² = 1 − a²/c².
    let e = 0.75_f64.sqrt();
    let prolate = 2.0 * PI * (1.0 + 2.0 / e * libm::asin(e));
    for (shape, area) in [
        ("cylinder: { radius_m: 1, height_m: 3 }", 8.0 * PI),
        ("capsule: { radius_m: 1, height_m: 3 }", 10.0 * PI),
        ("ellipsoid: { semi_axes_m: [1, 2, 1] }", prolate),
        ("ellipsoid: { semi_axes_m: [2, 2, 2] }", 16.0 * PI),
        ("convex: { vertices_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }", 1.5 + 0.75_f64.sqrt()),
    ] {
        assert!((surface(shape) / area - 1.0).abs() < 1e-13, "{shape}: {} {area}", surface(shape));
    }
}

/// Pictures: closed, outward, near the solid's volume.
#[test]
fn every_solid_has_a_closed_surface_around_its_volume() {
    for shape in [
        "cylinder: { radius_m: 0.5, height_m: 1 }",
        "capsule: { radius_m: 0.5, height_m: 1 }",
        "ellipsoid: { semi_axes_m: [0.5, 0.6, 0.7] }",
        "convex: { vertices_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] }",
    ] {
        let body = body(shape, "center_of_mass_m: [0.1, 0.1, 0.2]");
        assert!(matches!(body.geometry, Geometry::Solid { .. }));
        let (points, triangles) = body.surface();
        let corners = |t: &[u32; 3]| t.map(|i| points[i as usize]);
        let volume: f64 = triangles.iter().map(corners).map(|[a, b, c]| a.cross(&b).dot(&c) / 6.0).sum();
        // Chords are inside.
        assert!((0.94..1.0 + 1e-12).contains(&(volume * 3.0 / body.mass_kg)), "{shape}: {volume} {}", body.mass_kg);
        assert!(points.iter().all(|p| p.norm() <= body.bounding_radius_m * (1.0 + 1e-12)));
        let mut edges: Vec<(u32, u32)> =
            triangles.iter().flat_map(|[a, b, c]| [(*a, *b), (*b, *c), (*c, *a)]).collect();
        edges.sort_unstable();
        assert!(edges.iter().all(|(a, b)| a != b));
    }
}

//! Rims and ellipsoids against edges, corners, balls, round sides and each other: smooth motion with one contact.

use super::apart_m;
use crate::yaml::{experiment, run};

const BALL: &str = "shape: { sphere: { radius_m: 0.5 } }, position_m: [0, -0.5, 0]";
const BAR: &str = "shape: { capsule: { radius_m: 0.1, height_m: 2 } }, position_m: [0, -0.1, 0], orientation: { axis: [1, 0, 0], angle_deg: 90 }";
const EDGE: &str = "shape: { box: { size_m: [0.3, 0.3, 3] } }, position_m: [0, -0.2121320343559643, 0], orientation: { axis: [0, 0, 1], angle_deg: 45 }";
const CORNER: &str = "shape: { convex: { vertices_m: [[0, 0, 0], [0.3, -0.5, 0], [-0.3, -0.5, 0.3], [-0.3, -0.5, -0.3]] } }, position_m: [0, 0, 0]";
const LENTIL: &str = "shape: { ellipsoid: { semi_axes_m: [0.5, 0.4, 0.6] } }, position_m: [0, -0.4, 0]";

const ELLIPSOID: &str = "shape: { ellipsoid: { semi_axes_m: [0.3, 0.15, 0.2] } }, position_m: [0.01, 0.2, 0.01], orientation: { axis: [1, 0, 0.3], angle_deg: 8 }";
const CAN: &str = "shape: { cylinder: { radius_m: 0.2, height_m: 0.3 } }, position_m: [0.01, 0.3, 0.01], orientation: { axis: [1, 0, 0.3], angle_deg: 40 }";

#[test]
fn what_is_round_rolls_and_slides_on_what_is_not() {
    let pairs = [BALL, BAR, EDGE, CORNER, LENTIL].map(|base| (base, ELLIPSOID));
    for (base, body) in pairs.into_iter().chain([BALL, BAR, EDGE].map(|base| (base, CAN))) {
        let text = format!(
            "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.4
  bodies:
    - {{ name: base, {base}, mass_kg: 1, fixed: true }}
    - {{ name: body, {body}, mass_kg: 1, angular_velocity_rad_s: [0, 1, 0.5] }}
method: event-driven
time: {{ end_s: 0.2 }}
"
        );
        let at = |tolerance: &str| run(&experiment(&text, &[&format!("method.event-driven.tolerance={tolerance}")]));
        let (rough, fine) = (at("1e-9"), at("1e-12"));
        let apart = apart_m(&rough.state, &fine.state);
        let (drift, residual) = (fine.measured.energy_drift_rel.unwrap(), fine.measured.residual_max.unwrap());
        // measured: 3.8e-13 m, 0, 2.9e-13
        assert!(
            apart < 1e-11 && drift.abs() < 1e-11 && residual < 1e-11,
            "{base} {body}: {apart:e} {drift:e} {residual:e}"
        );
        assert_eq!(fine.measured.work.fallbacks, 0, "{base} {body}");
    }
}

//! Rims and ellipsoids against edges, corners, balls, round sides and each other: smooth motion with one contact.

use super::{apart_m, followed_alike};
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

/// Along z, to rounding.
const LIES: &str = "orientation: { quaternion_xyzw: [0.7071067811865475, 0, 0, 0.7071067811865476] }";

/// Something straight that stays, what is round and comes down along it, friction and restitution.
const ALONG: [(&str, &str, f64, f64); 4] = [
    (
        "shape: { capsule: { radius_m: 0.124, height_m: 0.244 } }, LIES",
        "shape: { cylinder: { radius_m: 0.124, height_m: 0.268 } }, position_m: [0.15175124737963647, 0.2057768515696969, 0],
        orientation: { quaternion_xyzw: [0.707106781003099, 1.6106998393682e-05, -1.6106998393682e-05, 0.707106781003099] },
        velocity_m_s: [-0.281548857837, -0.5, 0], angular_velocity_rad_s: [0, 0, 2.4545216014828]",
        0.0,
        0.5,
    ),
    (
        "shape: { cylinder: { radius_m: 0.089, height_m: 0.343 } }, LIES",
        "shape: { cylinder: { radius_m: 0.089, height_m: 0.434 } }, position_m: [0.0887406139172, 0.154307554998579, 0.0264591],
        orientation: { quaternion_xyzw: [0.7071067811865216, 1.91022931940731e-07, -1.91022931940731e-07, 0.7071067811865217] },
        velocity_m_s: [-0.26953938495973, -0.5, 0], angular_velocity_rad_s: [0, 0, 0]",
        0.0,
        0.9,
    ),
    (
        "shape: { box: { size_m: [0.4, 0.4, 0.3] } }, orientation: { quaternion_xyzw: [0, 0, 0.398010118885, 0.917381025128] }",
        "shape: { capsule: { radius_m: 0.199, height_m: 0.312 } }, position_m: [-0.00941559424365, 0.48172215352603, 0], LIES,
        velocity_m_s: [-0.181199607874, -1, 0.28341754722], angular_velocity_rad_s: [0, 0.995106774610, -4.5652687077635]",
        0.3,
        0.5,
    ),
    (
        "shape: { box: { size_m: [0.4, 0.4, 0.3] } }, orientation: { axis: [0, 0, 1], angle_deg: 45 }",
        "shape: { cylinder: { radius_m: 0.063, height_m: 0.262 } }, position_m: [0.0012731674797843, 0.3481573659772783, 0], LIES,
        velocity_m_s: [0, 0, 0.28844052653734], angular_velocity_rad_s: [0, 0, 4.870620310478]",
        1.0,
        0.0,
    ),
];

/// The other end of what has just struck with one strikes when it is there, an end that slides along an edge stays that
/// end, and a corner beside a round side is not taken for its end.
#[test]
fn what_is_round_rocks_along_what_is_straight() {
    for (base, body, friction, restitution) in ALONG {
        let [base, body] = [base, body].map(|body| body.replace("LIES", LIES));
        let text = format!(
            "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: {friction}
  restitution: {restitution}
  bodies:
    - {{ name: base, {base}, mass_kg: 1, fixed: true }}
    - {{ name: body, {body}, mass_kg: 1 }}
method: {{ event-driven: {{ tolerance: 1e-6 }} }}
time: {{ end_s: 0.3 }}
"
        );
        let apart_m = followed_alike(&text, |measured| {
            // measured: 4.7e-10 m; 2.6e-5 to 8.9e-5 m before, without a word
            assert!(measured.penetration_max_m.unwrap() < 1e-9, "{text}");
            // measured: 1.1e-11; 0.2 to 0.8 before, of the last one
            assert!(measured.residual_max.unwrap() < 1e-8, "{text}");
        });
        // measured: 1e-7 m
        assert!(apart_m < 1e-6, "{text} {apart_m}");
    }
}

/// A lying cylinder's radius, what comes over its end with a corner, friction and restitution.
const OVER_THE_END: [(&str, &str, f64, f64); 3] = [
    (
        "0.161",
        "shape: { convex: { vertices_m: [[-0.067, -0.067, -0.067], [-0.067, -0.067, 0.067], [-0.067, 0.067, -0.067], [-0.067, 0.067, 0.067], [0.067, -0.067, -0.067], [0.067, -0.067, 0.067], [0.067, 0.067, -0.067], [0.067, 0.067, 0.067]] } }, position_m: [-0.076402345825193563, 0.24829375687374994, 0.2932524235777938], orientation: { quaternion_xyzw: [-0.12488576595638498, 0.44752151069378376, 0.3812498718954147, 0.79923499554734856] }, velocity_m_s: [0, -0.5, 0], angular_velocity_rad_s: [0, 0, -2.9016327357203275]",
        0.0,
        0.0,
    ),
    (
        "0.158",
        "shape: { box: { size_m: [0.295, 0.295, 0.295] } }, position_m: [-0.059470780723908538, 0.4018579102931944, 0.29989999999999994], orientation: { quaternion_xyzw: [0.38343606223223903, 0.87017698620771133, 0.25357770324896767, -0.17738981726490785] }, velocity_m_s: [0, 0, 0.71356067412003532], angular_velocity_rad_s: [0, 0, 0]",
        0.3,
        0.0,
    ),
    (
        "0.19",
        "shape: { convex: { vertices_m: [[-0.08, -0.08, -0.08], [-0.08, -0.08, 0.08], [-0.08, 0.08, -0.08], [-0.08, 0.08, 0.08], [0.08, -0.08, -0.08], [0.08, -0.08, 0.08], [0.08, 0.08, -0.08], [0.08, 0.08, 0.08]] } }, position_m: [-0.078857286744200866, 0.31142680879101386, 0.29999999999999993], orientation: { quaternion_xyzw: [0.22559085966999581, 0.85531294171985184, 0.40054167004013363, 0.23898725137828233] }, velocity_m_s: [0, 0, 0], angular_velocity_rad_s: [-2.7001505051409298, -3.6910529788796165, 0]",
        0.3,
        0.9,
    ),
];

/// Beyond the end of a round side nothing holds a corner: what is behind it comes to the rim.
#[test]
fn a_corner_that_slides_over_the_end_of_a_round_side_is_not_held_there() {
    for (radius_m, body, friction, restitution) in OVER_THE_END {
        let text = format!(
            "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: {friction}
  restitution: {restitution}
  bodies:
    - {{ name: base, shape: {{ cylinder: {{ radius_m: {radius_m}, height_m: 0.6 }} }}, {LIES}, mass_kg: 1, fixed: true }}
    - {{ name: body, {body}, mass_kg: 1 }}
method: {{ event-driven: {{ tolerance: 1e-6 }} }}
time: {{ end_s: 0.3 }}
"
        );
        // Ghosts measured: 0; 0.02 to 0.4 before, and up to 6 cm away at the end.
        let apart_m = followed_alike(&text, |_| ());
        // measured: 3e-9 m
        assert!(apart_m < 1e-6, "{text} {apart_m}");
    }
}

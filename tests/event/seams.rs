//! Which contact: bodies that go over the seams of flush blocks, and into slots, move as on one block, and as if free.

use crate::yaml::{experiment, measured, run};
use gotai::outcome::Outcome;
use gotai::rows::Measured;
use nalgebra::Vector3;

const ONE: &str = "
    - { name: floor, shape: { box: { size_m: [8, 1, 8] } }, mass_kg: 1, position_m: [0, -0.5, 0], fixed: true }";

/// Four blocks that meet at the origin.
const FOUR: &str = "
    - { name: a, shape: { box: { size_m: [4, 1, 4] } }, mass_kg: 1, position_m: [-2, -0.5, -2], fixed: true }
    - { name: b, shape: { box: { size_m: [4, 1, 4] } }, mass_kg: 1, position_m: [2, -0.5, -2], fixed: true }
    - { name: c, shape: { box: { size_m: [4, 1, 4] } }, mass_kg: 1, position_m: [-2, -0.5, 2], fixed: true }
    - { name: d, shape: { box: { size_m: [4, 1, 4] } }, mass_kg: 1, position_m: [2, -0.5, 2], fixed: true }";

/// `first`: the body stands before the blocks in the file.
fn scene(blocks: &str, body: &str, friction: f64, end_s: f64, first: bool) -> String {
    let body = format!("\n    - {{ name: body, mass_kg: 2, {body} }}");
    let bodies = if first { format!("{body}{blocks}") } else { format!("{blocks}{body}") };
    format!(
        "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: {friction}
  bodies:{bodies}
method: event-driven
time: {{ end_s: {end_s} }}
"
    )
}

/// Where the body is, and how fast, with what the judges say.
fn end(text: &str, first: bool) -> (Vector3<f64>, Vector3<f64>, Measured) {
    let ended = run(&experiment(text, &[]));
    let bodies = &ended.state.bodies;
    let at = if first { bodies[0] } else { bodies[bodies.len() - 1] };
    (at.p_WB, at.v_WB, ended.measured)
}

fn is_clean(measured: &Measured) {
    assert_eq!((measured.outcome, measured.work.fallbacks, measured.passed_through), (Outcome::Finished, 0, Some(0)));
    assert!(measured.ghost_impulse_max_rel.unwrap() < 1e-9, "{measured:?}");
    assert!(measured.residual_max.unwrap_or(0.0) < 1e-9, "{measured:?}");
}

#[test]
fn four_flush_blocks_are_one() {
    let crate_at = |yaw: f64, v: [f64; 3]| {
        format!(
            "shape: {{ box: {{ size_m: [0.3, 0.2, 0.3] }} }}, position_m: [-0.4993, 0.1, -0.3], \
             orientation: {{ axis: [0, 1, 0], angle_deg: {yaw} }}, velocity_m_s: {v:?}"
        )
    };
    let ball = |v: [f64; 3]| {
        format!(
            "shape: {{ sphere: {{ radius_m: 0.1 }} }}, position_m: [-0.4993, 0.1, -0.3], velocity_m_s: {v:?}, \
             angular_velocity_rad_s: [{}, 0, {}]",
            v[2] / 0.1,
            -v[0] / 0.1
        )
    };
    // The axis is z, and rolls along x.
    let lying = |shape: &str, v: f64| {
        format!(
            "shape: {{ {shape}: {{ radius_m: 0.1, height_m: 0.3 }} }}, position_m: [-0.4993, 0.1, -0.07], \
             orientation: {{ axis: [1, 0, 0], angle_deg: 90 }}, velocity_m_s: [{v}, 0, 0], \
             angular_velocity_rad_s: [0, 0, {}]",
            -v / 0.1
        )
    };
    let disc = |v: [f64; 3]| {
        format!(
            "shape: {{ cylinder: {{ radius_m: 0.2, height_m: 0.2 }} }}, position_m: [-0.4993, 0.1, -0.3], \
             velocity_m_s: {v:?}"
        )
    };
    let mut bodies = vec![lying("capsule", 2.0), lying("cylinder", 2.0), lying("capsule", 0.7)];
    bodies.extend([disc([2.0, 0.0, 0.0]), disc([1.3, 0.0, 0.9])]);
    for v in [[2.0, 0.0, 0.0], [1.3, 0.0, 0.9], [20.0, 0.0, 12.0]] {
        bodies.extend([0.0, 27.0, 45.0, 90.0].map(|yaw| crate_at(yaw, v)));
        bodies.push(ball(v));
    }
    let mut worst = [0.0_f64; 2];
    for body in &bodies {
        for (friction, first) in [(0.0, false), (0.3, true), (0.3, false)] {
            let end_s = if body.contains("20.0") { 0.12 } else { 0.5 };
            let (p, v, _) = end(&scene(ONE, body, friction, end_s, first), first);
            let (q, w, measured) = end(&scene(FOUR, body, friction, end_s, first), first);
            is_clean(&measured);
            worst = [worst[0].max((p - q).norm()), worst[1].max((v - w).norm())];
        }
    }
    // measured: 7.9e-15 m, 8.4e-14 m/s
    assert!(worst[0] < 1e-12 && worst[1] < 1e-11, "{worst:?}");
}

#[test]
fn a_crate_with_friction_stops_beyond_the_seam_where_it_would_without_one() {
    let body = "shape: { box: { size_m: [0.3, 0.2, 0.3] } }, position_m: [-0.4993, 0.1, 0.4], velocity_m_s: [1, 0, 0]";
    let (p, v, measured) = end(&scene(FOUR, body, 0.1, 2.0, false), false);
    is_clean(&measured);
    let stops_m = -0.4993 + 1.0 / (2.0 * 0.1 * 9.81);
    // measured: 1e-16
    assert!((p.x - stops_m).abs() < 1e-12 && v.norm() < 1e-15, "{p:?} {v:?}");
}

/// It slides from edge on edge, over all of the side, until it has left it below: nothing presses it there.
#[test]
fn a_cube_that_falls_along_another_ones_side_falls_freely() {
    for (size_m, friction, aside_m) in [(1.0, 0.5, 0.0), (1.0, 0.0, 0.3), (0.6, 0.5, 0.0)] {
        let text = format!(
            "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: {friction}
  bodies:
    - {{ name: a, shape: {{ box: {{ size_m: [1, 1, 1] }} }}, mass_kg: 1, position_m: [0, 0.5, 0], fixed: true }}
    - name: body
      shape: {{ box: {{ size_m: [{size_m}, {size_m}, {size_m}] }} }}
      mass_kg: 1
      position_m: [{}, {}, {aside_m}]
      velocity_m_s: [0, -1, 0]
method: event-driven
time: {{ end_s: 0.6 }}
",
            0.5 + size_m / 2.0,
            1.0 + size_m / 2.0
        );
        let (p, v, measured) = end(&text, false);
        is_clean(&measured);
        let y_m = 1.0 + size_m / 2.0 - 0.6 - 0.5 * 9.81 * 0.6 * 0.6;
        // measured: 4.7e-15
        assert!((p - Vector3::new(0.5 + size_m / 2.0, y_m, aside_m)).norm() < 1e-12, "{size_m}: {p:?}");
        assert!((v + Vector3::y() * (1.0 + 9.81 * 0.6)).norm() < 1e-12, "{size_m}: {v:?}");
    }
}

/// Two blocks with a slot between them, symmetric about the body's fall.
fn slot(width_m: f64) -> String {
    let x_m = 2.0 + width_m / 2.0;
    format!(
        "
    - {{ name: left, shape: {{ box: {{ size_m: [4, 1, 4] }} }}, mass_kg: 1, position_m: [{}, -0.5, 0], fixed: true }}
    - {{ name: right, shape: {{ box: {{ size_m: [4, 1, 4] }} }}, mass_kg: 1, position_m: [{x_m}, -0.5, 0], fixed: true }}",
        -x_m
    )
}

#[test]
fn what_falls_into_a_slot_that_is_wider_falls_freely() {
    for wider_m in [1e-4, 1e-3, 1e-2] {
        for shape in ["box: { size_m: [0.3, 0.2, 0.3] }", "sphere: { radius_m: 0.15 }"] {
            let body = format!("shape: {{ {shape} }}, position_m: [0, 0.3, 0]");
            let (p, v, measured) = end(&scene(&slot(0.3 + wider_m), &body, 0.3, 0.35, false), false);
            is_clean(&measured);
            // measured: 0
            let fallen_m = 0.3 - 0.5 * 9.81 * 0.35 * 0.35;
            assert!((p - Vector3::y() * fallen_m).norm() < 1e-12, "{shape} {wider_m}: {p:?}");
            assert!((v + Vector3::y() * (9.81 * 0.35)).norm() < 1e-12, "{shape} {wider_m}: {v:?}");
        }
    }
}

/// Far block, higher by so much.
fn step(higher_m: f64) -> String {
    format!(
        "
    - {{ name: near, shape: {{ box: {{ size_m: [4, 1, 4] }} }}, mass_kg: 1, position_m: [-2, -0.5, 0], fixed: true }}
    - {{ name: far, shape: {{ box: {{ size_m: [4, 1, 4] }} }}, mass_kg: 1, position_m: [2, {}, 0], fixed: true }}",
        -0.5 + higher_m
    )
}

#[test]
fn a_rounding_of_height_is_none_and_a_step_is_one() {
    let body = "shape: { box: { size_m: [0.3, 0.2, 0.3] } }, position_m: [-0.4993, 0.1, 0], velocity_m_s: [2, 0, 0]";
    let reaches_m = |higher_m: f64| end(&scene(&step(higher_m), body, 0.0, 0.4, false), false).0.x;
    assert!((reaches_m(1e-12) - 0.3007).abs() < 1e-9);
    assert!((reaches_m(-1e-12) - 0.3007).abs() < 1e-9);
    assert!((reaches_m(-1e-6) - 0.3007).abs() < 1e-5);
    // The front face stands at the step, plastic.
    assert!(reaches_m(1e-6) < 0.0 && reaches_m(1e-3) < 0.0);
}

#[test]
fn auto_finds_the_motion_over_a_seam_and_says_so() {
    let body = "shape: { box: { size_m: [0.3, 0.2, 0.3] } }, position_m: [-0.4993, 0.1, 0.4], velocity_m_s: [2, 0, 0]";
    let text = scene(FOUR, body, 0.0, 0.4, false).replace("method: event-driven", "method: auto");
    let measured = measured(&text, &[]);
    assert_eq!(
        (measured.tolerance_met.as_deref(), measured.method_used.as_deref()),
        (Some("yes"), Some("event-driven"))
    );
    is_clean(&measured);
}

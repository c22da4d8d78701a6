//! Bodies between others that come nearer to each other: infinitely many impacts in a finite time, and what is left
//! after them.

use crate::yaml::{experiment, run};
use gotai::outcome::Outcome;

/// A light ball between a wall and a heavy ball that comes toward it.
const AT_A_WALL: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  container: { planes: [{ normal: [1, 0, 0], offset_m: -1 }, { normal: [-1, 0, 0], offset_m: -1 }] }
  bodies:
    - { name: a, shape: { sphere: { radius_m: 0.45 } }, mass_kg: 1, position_m: [-0.5, 0, 0], velocity_m_s: [1, 0, 0] }
    - { name: b, shape: { sphere: { radius_m: 0.45 } }, mass_kg: 20, position_m: [0.5, 0, 0], velocity_m_s: [-0.3, 0, 0] }
method: event-driven
time: { end_s: 4 }
";

/// Gaps (m) below which all impacts that are left take no time.
const CLOSED_M: f64 = 1e-60;

/// Where the two balls are at the end, and how fast, from impact to impact; the wall on the left is at −1, that on the
/// right at 1. Impacts at the left wall and between the two change (v_a, v_b) by a linear map of determinant e²; if its
/// eigenvalues are real, the ratio of the two speeds has a limit, the gap falls by e²/λ a round and the speeds by the
/// larger λ < 1: it closes in a finite time, and nothing moves then. If they are complex, the balls part.
fn after_all_impacts(masses: [f64; 2], restitution: f64, end_s: f64) -> [[f64; 2]; 2] {
    let [m, M] = masses;
    let (mut left_m, mut between_m, mut right_m) = (0.05, 0.1, 0.05);
    let ([mut u, mut v], mut t_s) = ([1.0_f64, -0.3_f64], 0.0);
    loop {
        let closes_s = |gap_m: f64, speed: f64| if speed > 0.0 { gap_m / speed } else { f64::INFINITY };
        let all_s = [closes_s(left_m, -u), closes_s(between_m, u - v), closes_s(right_m, v)];
        let next = (0..3).min_by(|i, j| all_s[*i].total_cmp(&all_s[*j])).unwrap();
        let step_s = all_s[next].min(end_s - t_s);
        t_s += step_s;
        left_m += u * step_s;
        between_m += (v - u) * step_s;
        right_m -= v * step_s;
        if t_s >= end_s {
            return [[left_m - 0.55, 0.55 - right_m], [u, v]];
        }
        match next {
            0 => (left_m, u) = (0.0, -restitution * u),
            1 => {
                between_m = 0.0;
                let (mean, off) = ((m * u + M * v) / (m + M), restitution * (u - v) / (m + M));
                (u, v) = (mean - off * M, mean + off * m);
            }
            _ => (right_m, v) = (0.0, -restitution * v),
        }
        if left_m + between_m < CLOSED_M || right_m + between_m < CLOSED_M {
            return [[left_m - 0.55, 0.55 - right_m], [0.0, 0.0]];
        }
    }
}

#[test]
fn what_is_squeezed_at_a_wall_comes_to_rest_with_what_squeezes_it() {
    for law in ["newton", "poisson", "sequential"] {
        for mass_kg in [0.05, 2.0, 5.0, 20.0, 100.0, 1000.0] {
            for restitution in [0.1, 0.3, 0.5, 0.7, 0.9] {
                let wanted = after_all_impacts([1.0, mass_kg], restitution, 4.0);
                let text = AT_A_WALL.replace("mass_kg: 20", &format!("mass_kg: {mass_kg}"));
                let sets =
                    [format!("scene.restitution={restitution}"), format!("method={{event-driven: {{impact: {law}}}}}")];
                let ended = run(&experiment(&text, &sets.each_ref().map(String::as_str)));
                let what = format!("{law}, {mass_kg} kg, e = {restitution}");
                assert_eq!(ended.measured.outcome, Outcome::Finished, "{what}");
                for i in 0..2 {
                    let at = ended.state.bodies[i];
                    let error = (at.p_WB.x - wanted[0][i]).abs().max((at.v_WB.x - wanted[1][i]).abs());
                    // measured: 2.3e-13; up to 0.2 where the last impacts were one
                    assert!(error < 1e-10, "{what}, {i}: {error:e}, {wanted:?}");
                }
                assert!(ended.measured.residual_max.unwrap() < 1e-6, "{what}: {:?}", ended.measured.residual_max);
            }
        }
    }
}

/// A light ball between two heavy ones, far from everything.
const BETWEEN_TWO: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  restitution: 0.5
  bodies:
    - { name: a, shape: { sphere: { radius_m: 0.3 } }, mass_kg: 40, position_m: [-1, 0, 0], velocity_m_s: [0.5, 0, 0] }
    - { name: b, shape: { sphere: { radius_m: 0.3 } }, mass_kg: 1, position_m: [0, 0, 0], velocity_m_s: [1, 0, 0] }
    - { name: c, shape: { sphere: { radius_m: 0.3 } }, mass_kg: 60, position_m: [1, 0, 0], velocity_m_s: [-0.4, 0, 0] }
method: event-driven
time: { end_s: 4 }
";

/// Along x, of every body.
fn speeds_m_s(text: &str, sets: &[&str]) -> Vec<f64> {
    let ended = run(&experiment(text, sets));
    assert_eq!(ended.measured.outcome, Outcome::Finished);
    ended.state.bodies.iter().map(|at| at.v_WB.x).collect()
}

#[test]
fn what_squeezes_goes_on_with_what_is_squeezed() {
    // All impacts are plastic together in the end, as a pair of real eigenvalues says for these masses.
    let wanted = (40.0 * 0.5 + 1.0 - 60.0 * 0.4) / 101.0;
    for law in ["newton", "poisson", "sequential"] {
        for speed in speeds_m_s(BETWEEN_TWO, &[&format!("method={{event-driven: {{impact: {law}}}}}")]) {
            // measured: 3.8e-17
            assert!((speed - wanted).abs() < 1e-12, "{law}: {speed} {wanted}");
        }
    }
}

#[test]
fn boxes_are_squeezed_as_balls_are_and_across_gravity() {
    let boxes = AT_A_WALL.replace("sphere: { radius_m: 0.45 }", "box: { size_m: [0.9, 0.9, 0.9] }");
    let on_floor = |text: &str| {
        let text = text.replace("planes: [", "planes: [{ normal: [0, 1, 0], offset_m: -0.45 }, ");
        text.replace("[0, 0, 0]\n", "[0, -9.81, 0]\n")
    };
    for text in [&boxes, &on_floor(&boxes), &on_floor(AT_A_WALL)] {
        for restitution in [0.1, 0.5] {
            for speed in speeds_m_s(text, &[&format!("scene.restitution={restitution}")]) {
                // measured: 1.6e-64
                assert!(speed.abs() < 1e-10, "{restitution}: {speed:e} of {text}");
            }
        }
    }
}

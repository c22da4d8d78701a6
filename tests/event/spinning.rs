//! What spins and slides on a face comes to rest: all slips end at once, wherever the tolerance ends them.

use super::apart_m;
use crate::yaml::{experiment, run};
use gotai::outcome::Outcome;
use gotai::run::Ended;
use rayon::prelude::*;

const TOLERANCES: [f64; 7] = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

fn scene(friction: f64, body: &str, tolerance: f64) -> String {
    format!(
        "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: {friction}
  container: {{ plane: {{ normal: [0, 1, 0] }} }}
  bodies: [{{ name: body, mass_kg: 2, {body} }}]
method: {{ event-driven: {{ tolerance: {tolerance:e} }} }}
time: {{ end_s: 1.5 }}
limits: {{ events: 2000 }}
"
    )
}

fn rests(ended: &Ended, what: &str) {
    let m = &ended.measured;
    assert_eq!((m.outcome, m.work.fallbacks, m.work.unsolved), (Outcome::Finished, 0, 0), "{what}");
    // measured: 3.4e-14; it was 1.3e-2 where a slip that was stepped over had turned back
    assert!(m.residual_max.unwrap() < 1e-11, "{what}: {:?}", m.residual_max);
    assert_eq!(ended.state.bodies[0].w_WB.norm(), 0.0, "{what}");
}

/// On its rim: μ m g R brakes m R²/2, and it turns by ω²R/4μg.
#[test]
fn a_can_that_spins_turns_as_far_as_its_rim_lets_it() {
    let mut scenes = Vec::new();
    for (radius_m, height_m) in [(0.13, 0.174), (0.25, 0.1), (0.08, 0.3)] {
        for (friction, spin) in [(0.1_f64, 3.3784_f64), (0.1, -2.5), (0.4, 6.0), (1.0, 7.3)] {
            for tolerance in TOLERANCES {
                scenes.push((radius_m, height_m, friction, spin, tolerance));
            }
        }
    }
    scenes.par_iter().for_each(|&(radius_m, height_m, friction, spin, tolerance)| {
        let body = format!(
            "shape: {{ cylinder: {{ radius_m: {radius_m}, height_m: {height_m} }} }}, position_m: [0, {}, 0], \
             angular_velocity_rad_s: [0, {spin}, 0]",
            height_m / 2.0
        );
        let what = format!("{radius_m} {height_m} {friction} {spin} {tolerance:e}");
        let ended = run(&experiment(&scene(friction, &body, tolerance), &[]));
        rests(&ended, &what);
        let turned: f64 = spin * f64::abs(spin) * radius_m / (4.0 * friction * 9.81);
        let y = (turned / 2.0).sin();
        let error_m = radius_m * 2.0 * (ended.state.bodies[0].q_WB.j.abs() - y.abs()).abs();
        assert!(error_m <= 10.0 * tolerance, "{what}: {error_m:e}");
    });
}

/// A prism that slides and turns: its corners slip at different speeds, down to the end.
#[test]
fn a_prism_that_slides_and_spins_comes_to_rest_at_every_tolerance() {
    let corner = |sides: usize, k: usize, y: f64| {
        let angle = std::f64::consts::TAU * k as f64 / sides as f64;
        format!("[{:.12}, {y}, {:.12}]", 0.21 * angle.cos(), 0.21 * angle.sin())
    };
    let mut scenes = Vec::new();
    for sides in [3, 5, 6] {
        for (friction, velocity, spin) in
            [(1.0, [2.0, -1.0173], 3.0522), (0.4, [0.8, 0.3], -4.0), (0.2, [0.3, 0.0], 1.5)]
        {
            scenes.push((sides, friction, velocity, spin));
        }
    }
    scenes.par_iter().for_each(|&(sides, friction, velocity, spin)| {
        let vertices: Vec<String> =
            [-0.1, 0.1].iter().flat_map(|y| (0..sides).map(move |k| corner(sides, k, *y))).collect();
        let body = format!(
            "shape: {{ convex: {{ vertices_m: [{}] }} }}, position_m: [0, 0.1, 0], velocity_m_s: [{}, 0, {}], \
             angular_velocity_rad_s: [0, {spin}, 0]",
            vertices.join(", "),
            velocity[0],
            velocity[1]
        );
        let at = |tolerance: f64| run(&experiment(&scene(friction, &body, tolerance), &[]));
        let best = at(1e-11);
        for tolerance in TOLERANCES {
            let what = format!("{sides} {friction} {spin} {tolerance:e}");
            let ended = at(tolerance);
            rests(&ended, &what);
            let error_m = apart_m(&ended.state, &best.state);
            assert!(error_m <= 10.0 * tolerance, "{what}: {error_m:e}");
        }
    });
}

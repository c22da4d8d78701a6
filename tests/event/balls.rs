//! Balls and boxes that lose nothing, and who leaves a row of balls.

use super::apart_m;
use crate::yaml::{experiment, run};
use gotai::experiment::types::{Experiment, Limits, Measure};
use gotai::run::advance::only_step;
use gotai::scene::build;
use gotai::state::State;

/// Two balls that touch, struck by a third.
const ROW: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  restitution: 1
  bodies:
    - { name: a, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [-0.5, 0, 0], velocity_m_s: [1, 0, 0] }
    - { name: b, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [1, 0, 0] }
    - { name: c, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [2, 0, 0] }
time: { end_s: 1 }
";

#[test]
fn the_law_of_impact_says_which_ball_leaves() {
    let laws = [
        ("newton", [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]),
        ("poisson", [-1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]),
        ("sequential", [0.0, 0.0, 1.0]),
    ];
    for (law, wanted) in laws {
        let state = run(&experiment(ROW, &[&format!("method={{event-driven: {{impact: {law}}}}}")])).state;
        for (i, speed) in wanted.into_iter().enumerate() {
            let at = state.bodies[i];
            // They meet after half a second.
            let place = [-0.5, 1.0, 2.0][i] + if i == 0 { 0.5 } else { 0.0 } + 0.5 * speed;
            let error = (at.v_WB.x - speed).abs().max((at.p_WB.x - place).abs());
            // measured: 5.6e-17
            assert!(error < 1e-15, "{law}, {i}: {error:e}");
        }
    }
}

const BALLS: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  restitution: 1
  container: { box: { size_m: [1, 1, 1] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [-0.3, 0.2, -0.3], copies: { grid: [2, 2, 2], step_m: [0.41, 0.43, 0.39] } }]
  random: { speed_m_s: 2, spin_rad_s: 3 }
method: event-driven
time: { end_s: 0.5 }
";

const CUBE: &str = "
scene:
  restitution: 1
  container: { box: { size_m: [3, 3, 3] } }
  bodies: [{ name: box, shape: { box: { size_m: [0.8, 0.5, 0.6] } }, mass_kg: 1, position_m: [0, 1.2, 0] }]
  random: { speed_m_s: 4, spin_rad_s: 6, attitude: true }
method: event-driven
time: { end_s: 1 }
";

#[test]
fn elastic_bodies_keep_their_energy() {
    for (what, text) in [("balls", BALLS), ("box", CUBE)] {
        for seed in 0..4 {
            let m = run(&experiment(text, &[&format!("seed={seed}"), "time.end_s=20"])).measured;
            let (start_j, end_j) = (m.energy_start_j.unwrap(), m.energy_end_j.unwrap());
            // measured: 9.5e-15, after some 900 impacts of the balls and 85 … 121 of the box
            assert!((end_j / start_j - 1.0).abs() < 1e-13, "{what}, {seed}: {start_j} {end_j}");
            assert!(m.work.events > 60, "{what}, {seed}: {}", m.work.events);
        }
    }
}

fn reversed(state: &State) -> State {
    let mut state = state.clone();
    for at in &mut state.bodies {
        (at.v_WB, at.w_WB) = (-at.v_WB, -at.w_WB);
    }
    State { time_s: 0.0, step: 0, ..state }
}

#[test]
fn elastic_impacts_run_backward() {
    for (what, text, seeds) in [("balls", BALLS, 0..4), ("box", CUBE, 0..12)] {
        for seed in seeds {
            let experiment = experiment(text, &[&format!("seed={seed}")]);
            let (model, start) = build(&experiment).unwrap();
            let go = |from: State| {
                only_step(&experiment.method.stepping().unwrap(), &model, from, &experiment.clock(), &Limits::default())
            };
            let there = go(start.clone());
            let asked = Experiment { measure: vec![Measure::Sensitivity], ..experiment.clone() };
            let grown = run(&asked).measured.sensitivity.unwrap();
            let error = apart_m(&go(reversed(&there.state)).state, &start) / grown;
            // measured: 1.4e-14
            assert!(error < 2e-13, "{what}, {seed}: {error:e}");
        }
    }
}

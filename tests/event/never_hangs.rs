//! Events may come ever faster: a run ends, at its end or at a limit, and says what it did.

use crate::yaml::{experiment, measured};
use gotai::clock::Clock;
use gotai::experiment::types::{Experiment, Limits};
use gotai::outcome::{Criterion, Outcome};
use gotai::run::advance::{Stepped, only_step};
use gotai::scene::build;
use gotai::state::{BodyState, State};
use std::time::{Duration, Instant};

const RATTLING: &str = "
scene:
  friction: 0.3
  container: { box: { size_m: [1.2, 1.2, 1.2] } }
  bodies: [{ name: cube, shape: { box: { size_m: [0.6, 0.6, 0.6] } }, mass_kg: 1, position_m: [0, 0.6, 0] }]
  random: { speed_m_s: 3, spin_rad_s: 10, attitude: true }
method: event-driven
time: { end_s: 3 }
";

const BALLS: &str = "
scene:
  friction: 0.3
  container: { box: { size_m: [1, 1, 1] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [-0.3, 0.2, -0.3], copies: { grid: [2, 2, 2], step_m: [0.41, 0.43, 0.39] } }]
  random: { speed_m_s: 2, spin_rad_s: 3 }
method: event-driven
time: { end_s: 1 }
";

const BOXES: &str = "
scene:
  friction: 0.4
  container: { box: { size_m: [2, 3, 2] } }
  bodies: [{ name: box, shape: { box: { size_m: [0.4, 0.4, 0.4] } }, mass_kg: 1, position_m: [-0.2, 0.4, -0.2], copies: { grid: [2, 2, 1], step_m: [0.55, 0.57, 0.53] } }]
  random: { speed_m_s: 1, spin_rad_s: 2 }
method: event-driven
time: { end_s: 0.25 }
";

#[test]
fn what_rattles_comes_to_its_end() {
    for (what, text) in [("cube", RATTLING), ("balls", BALLS), ("boxes", BOXES)] {
        for e in [0.0, 0.5, 0.9, 0.99, 1.0] {
            let experiment = experiment(text, &[&format!("scene.restitution={e}")]);
            let (model, start) = build(&experiment).unwrap();
            let limits = Limits { steps: Some(800), ..Limits::default() };
            let Stepped { state, work, stopped } =
                only_step(&experiment.method.stepping().unwrap(), &model, start, &experiment.clock(), &limits);
            assert!(state.step <= 800 && work.fallbacks <= state.step);
            assert!(state.bodies.iter().all(BodyState::is_finite), "{what}, {e}");
            // measured: 13 … 681 steps; balls that come to lie against each other take all that they are given
            assert!(stopped.is_none() || (what, e) == ("balls", 0.0), "{what}, {e}: {stopped:?}");
        }
    }
}

#[test]
fn a_limit_of_events_is_kept() {
    let m = measured(RATTLING, &["scene.restitution=1", "limits.events=30"]);
    assert_eq!((m.outcome, m.criterion.as_deref(), m.work.events), (Outcome::Stalled, Some("limit"), 31));
    assert!(m.end_time_s.unwrap() < 3.0);
}

/// Bricks in running bond, side by side: hundreds of redundant contacts.
const WALL: &str = "
scene:
  friction: 0.6
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: a, shape: { box: { size_m: [0.2, 0.1, 0.1] } }, mass_kg: 1, position_m: [0, 0.05, 0], copies: { grid: [8, 4, 1], step_m: [0.2, 0.2, 0.1] } }
    - { name: b, shape: { box: { size_m: [0.2, 0.1, 0.1] } }, mass_kg: 1, position_m: [0.1, 0.15, 0], copies: { grid: [8, 4, 1], step_m: [0.2, 0.2, 0.1] } }
method: event-driven
time: { step_s: 0.01, end_s: 100 }
";

/// A top spins half a million times.
const TOP: &str = "
scene:
  container: null
  bodies: [{ name: top, shape: { box: { size_m: [0.1, 0.2, 0.3] } }, mass_kg: 1, angular_velocity_rad_s: [1e3, 3, 2] }]
method: { free: { integrator: taylor, tolerance: 1e-13 } }
time: { step_s: 4000, end_s: 4000 }
";

/// Until the limit, the state that was reached, and the whole time.
fn limited(experiment: &Experiment, wall_s: f64) -> (Stepped, State, Duration) {
    let (model, start) = build(experiment).unwrap();
    let limits = Limits { wall_s: Some(wall_s), ..Limits::default() };
    let clock: Clock = experiment.clock();
    let started = Instant::now();
    let stepped = only_step(&experiment.method.stepping().unwrap(), &model, start.clone(), &clock, &limits);
    (stepped, start, started.elapsed())
}

#[test]
fn a_limit_of_time_ends_a_run_in_the_middle_of_a_step() {
    // It slides and falls apart: one step takes longer.
    let falling = "scene.gravity_m_s2=[8, -9.81, 0]";
    let newton = "method={time-stepping: {solver: newton}}";
    for (text, sets) in [(WALL, &[falling][..]), (WALL, &[falling, newton]), (TOP, &[])] {
        let experiment = experiment(text, sets);
        let (Stepped { state, stopped, .. }, start, took) = limited(&experiment, 0.5);
        assert_eq!(stopped, Some(Criterion::Limit), "{sets:?}");
        // measured: 0.51 s
        assert!(took < Duration::from_secs(2), "{sets:?}: {took:?}");
        assert!(state.bodies.iter().all(BodyState::is_finite) && state.time_s < experiment.time.end_s);
        // Never a half-made step: where none was made, all is as it was.
        assert!(state.step > 0 || state.bodies == start.bodies, "{sets:?}");
    }
}

#[test]
fn many_contacts_at_rest_are_one_stretch() {
    let (Stepped { state, stopped, .. }, start, took) = limited(&experiment(WALL, &[]), 10.0);
    assert_eq!((stopped, state.step, state.time_s), (None, 1, 100.0));
    assert_eq!(state.bodies, start.bodies);
    // measured: 0.2 s
    assert!(took < Duration::from_secs(5), "{took:?}");
}

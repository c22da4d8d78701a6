//! Taylor's series against closed forms, and against another method where there is none.

use crate::yaml::{experiment, run};
use gotai::rows::Measured;
use gotai::state::BodyState;
use nalgebra::Vector3;

/// A tennis racket turning over: the time of a flip depends on energy and momentum to their eleventh digits and beyond.
const RACKET: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies:
    - name: racket
      shape: none
      mass_kg: 1
      inertia_kg_m2: [1, 2, 3]
      angular_velocity_body_rad_s: [0.01, 5, 0.01]
time: { step_s: 7.5, end_s: 7.5 }
exact: free-motion
method: { free: { integrator: taylor } }
";

const HEAVY_TOP: &str = "
scene:
  bodies:
    - name: top
      shape: none
      mass_kg: 2
      inertia_kg_m2: [[0.05, 0.005, 0], [0.005, 0.06, 0], [0, 0, 0.02]]
      position_m: [0, 0.3, 0.2]
      angular_velocity_rad_s: [1, 12, 9]
  pins: [{ body: top, point_m: [0, -0.3, -0.2] }]
";

/// Two rods, and something to hang them on that moves.
const DOUBLE_PENDULUM: &str = "
scene:
  bodies:
    - { name: hand, shape: none, kinematic: { velocity_m_s: [0.3, 0, 0], angular_velocity_rad_s: [0, 0, 3] } }
    - { name: upper, shape: none, mass_kg: 1, inertia_kg_m2: [0.02, 0.01, 0.03], position_m: [0.5, 0, 0] }
    - { name: lower, shape: none, mass_kg: 2, inertia_kg_m2: [0.3, 0.2, 0.1], position_m: [1, 0, 0.5], angular_velocity_rad_s: [1, 0, 2] }
  pins:
    - { body: upper, with: hand, point_m: [-0.4, 0, 0] }
    - { body: lower, with: upper, point_m: [0, 0, -0.5] }
";

/// Two pins on one body: what they say along the line between them they say twice.
const GATE: &str = "
scene:
  bodies:
    - name: gate
      shape: none
      mass_kg: 2
      inertia_kg_m2: [[0.5, 0.05, 0.02], [0.05, 0.4, 0.03], [0.02, 0.03, 0.3]]
      angular_velocity_rad_s: [0, 0, 3]
  pins: [{ body: gate, point_m: [-0.4, 0, 0.5] }, { body: gate, point_m: [-0.4, 0, -0.5] }]
";

/// Every kind of force, on a body with three moments.
const ROCKET: &str = "
scene:
  air: { linear_drag_n_s_m: 0.4 }
  forces:
    - { body: rocket, force_n: [1, 20, 3], at_m: [0.1, -0.5, 0.02], frame: body }
    - { body: rocket, force_n: [0.5, 0, 2], at_m: [0, 0.4, 0.1] }
    - { body: rocket, force_n: [3, 1, 0], at_m: [0.2, 0, 0], as: { cosine: { frequency_rad_s: 7, phase_rad: 0.3 } } }
    - { body: rocket, force_n: [0, 4, 1], at_m: [0.2, 0, 0], frame: body, as: { cosine: { frequency_rad_s: 3 } } }
    - { body: rocket, torque_n_m: [0.1, 0.2, 0.3], as: { cosine: { frequency_rad_s: 5 } } }
    - { body: rocket, torque_n_m: [0.2, 0, 0.1], frame: body }
  bodies:
    - name: rocket
      shape: none
      mass_kg: 2
      inertia_kg_m2: [[0.53, 0.05, -0.03], [0.05, 0.42, 0.07], [-0.03, 0.07, 0.17]]
      velocity_m_s: [3, 4, 0]
      angular_velocity_rad_s: [0.3, 4, 0.5]
";

/// A ball that a torque and a swinging force move: no gyroscopic term.
const BALL: &str = "
scene:
  forces:
    - { body: ball, torque_n_m: [0.1, 0.2, 0.3] }
    - { body: ball, force_n: [2, 0, 1], as: { cosine: { frequency_rad_s: 9 } } }
  bodies:
    - { name: ball, shape: { sphere: { radius_m: 0.2 } }, mass_kg: 2, angular_velocity_rad_s: [0.3, 4, 0.5] }
";

fn end(text: &str, integrator: &str, tolerance: f64, steps: u32) -> (Vec<BodyState>, Measured) {
    let sets = [
        format!("method.free={{ integrator: {integrator}, tolerance: {tolerance:e} }}"),
        format!("time={{ step_s: {}, end_s: 2 }}", 2.0 / f64::from(steps)),
    ];
    let ended = run(&experiment(text, &[&sets[0], &sets[1]]));
    (ended.state.bodies, ended.measured)
}

/// In m, rad, m/s and rad/s, which are of one size here.
fn apart(a: &[BodyState], b: &[BodyState]) -> f64 {
    let of_one = |(a, b): (&BodyState, &BodyState)| {
        let parts = [(a.p_WB - b.p_WB).norm(), (a.v_WB - b.v_WB).norm(), (a.w_WB - b.w_WB).norm()];
        parts.into_iter().fold(a.q_WB.angle_to(&b.q_WB), f64::max)
    };
    a.iter().zip(b).map(of_one).fold(0.0, f64::max)
}

#[test]
fn the_error_on_an_unstable_motion_follows_the_tolerance_down_to_rounding() {
    for (tolerance, inner) in [(1e-6, 23), (1e-9, 25), (1e-12, 29), (1e-15, 30)] {
        let ended = run(&experiment(RACKET, &[&format!("method.free.tolerance={tolerance:e}")])).measured;
        let error = ended.error_orientation_rad.unwrap() / tolerance;
        // measured: 1.70, 1.40, 1.39, 1.71
        assert!((0.1..10.0).contains(&error), "{tolerance:e}: {error}");
        assert_eq!(ended.work.inner_steps, inner, "{tolerance:e}");
        // measured: 1.2e-15 and less
        assert!(ended.energy_drift_rel.unwrap().abs() < 1e-14, "{ended:?}");
        assert!(ended.angular_momentum_drift_rel.unwrap() < 1e-14, "{ended:?}");
    }
}

#[test]
fn it_agrees_with_dop853_on_every_kind_of_motion() {
    let scenes =
        [("top", HEAVY_TOP), ("pendulum", DOUBLE_PENDULUM), ("gate", GATE), ("rocket", ROCKET), ("ball", BALL)];
    for (name, scene) in scenes {
        let (reference, _) = end(scene, "dop853", 1e-14, 20);
        let (series, _) = end(scene, "taylor", 1e-14, 20);
        let difference = apart(&series, &reference);
        // measured: 2.5e-14, 2.2e-13, 4.4e-15, 9.7e-13, 1.3e-12
        assert!(difference < 1e-11, "{name}: {difference:e}");
    }
}

#[test]
fn an_error_follows_the_tolerance_on_every_kind_of_motion() {
    let scenes = [("top", HEAVY_TOP), ("pendulum", DOUBLE_PENDULUM), ("gate", GATE), ("rocket", ROCKET)];
    for (name, scene) in scenes {
        let (reference, _) = end(scene, "taylor", 1e-15, 1);
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let error = apart(&end(scene, "taylor", tolerance, 1).0, &reference) / tolerance;
            // measured: 0.013 … 2.4
            assert!((0.005..10.0).contains(&error), "{name}, {tolerance:e}: {error}");
        }
    }
}

#[test]
fn the_clock_does_not_change_the_series() {
    for (name, scene) in
        [("top", HEAVY_TOP), ("pendulum", DOUBLE_PENDULUM), ("gate", GATE), ("rocket", ROCKET), ("ball", BALL)]
    {
        let ((once, one), (often, many)) = (end(scene, "taylor", 1e-9, 1), end(scene, "taylor", 1e-9, 2000));
        let difference = apart(&once, &often);
        // measured: 5.6e-17 and less
        assert!(difference < 1e-15, "{name}: {difference:e}");
        assert_eq!(one.work.inner_steps, many.work.inner_steps, "{name}");
        // measured: 2.1e-15
        assert!(many.pin_gap_max_m.is_none_or(|gap| gap < 1e-12), "{name}: {:?}", many.pin_gap_max_m);
    }
}

#[test]
fn a_body_that_nothing_turns_needs_one_series_for_all_times() {
    let sets = ["scene.bodies.racket.inertia_kg_m2=[1, 1, 1]", "time.step_s=0.1"];
    let ended = run(&experiment(RACKET, &sets));
    // measured: 1.6e-15
    assert!(ended.measured.error_orientation_rad.unwrap() < 1e-13);
    assert_eq!((ended.measured.work.inner_steps, ended.measured.work.gyroscopic), (1, 0));
}

#[test]
fn a_ball_in_linear_drag_meets_its_closed_form() {
    let sets = ["scene.air={ linear_drag_n_s_m: 3 }", "scene.bodies.racket.velocity_m_s=[2, 0, 0]", "exact=null"];
    let ended = run(&experiment(RACKET, &sets)).state.bodies[0];
    let error = (ended.p_WB - Vector3::x() * (2.0 / 3.0) * (1.0 - libm::exp(-22.5))).norm();
    // measured: 1.1e-16
    assert!(error < 1e-14, "{error:e}");
}

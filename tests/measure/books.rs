//! Books of energy and momentum: nothing where nothing happens, the work of loads and driven bodies, and of an
//! integrator's own gain as much as it makes.

use crate::yaml::measured;
use gotai::rows::Measured;

/// Largest of all relative amounts.
fn largest(m: &Measured) -> f64 {
    let amounts = [m.energy_drift_rel, m.energy_rise_max_rel, m.energy_balance_rel];
    let momenta = [m.linear_momentum_drift_rel, m.angular_momentum_drift_rel];
    amounts.map(Option::unwrap).into_iter().chain(momenta.into_iter().flatten()).map(f64::abs).fold(0.0, f64::max)
}

const PUSHED_CRATE: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  forces: [{ body: crate, force_n: [2.4, 0, 0] }]
  bodies: [{ name: crate, shape: { box: { size_m: [0.4, 0.3, 0.5] } }, mass_kg: 1, position_m: [0, 0.15, 0] }]
method: { time-stepping: { solver: newton } }
time: { step_s: 0.01, end_s: 10 }
";

const JAW: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.7
  container: { plane: { normal: [1, 0, 0] } }
  forces: [{ body: jaw, force_n: [-40, 0, 0] }]
  pins: [{ body: jaw, point_m: [0, 0.05, 0] }]
  bodies: [{ name: jaw, shape: { box: { size_m: [0.01, 0.1, 0.06] } }, mass_kg: 0.2, position_m: [0.005, 0.03, 0] }]
method: { time-stepping: { solver: newton } }
time: { step_s: 0.01, end_s: 10 }
";

const STACK: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: cube, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0], copies: { count: 5, step_m: [0, 1, 0] } }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.01, end_s: 10 }
";

/// Two that turn, two that do not, far away from the origin.
const FLIGHT: &str = "
scene:
  gravity_m_s2: [0, -9.8, 0]
  bodies:
    - { name: heavy, shape: { sphere: { radius_m: 0.2 } }, mass_kg: 431.521, position_m: [100, 0, 0] }
    - { name: light, shape: { sphere: { radius_m: 0.2 } }, mass_kg: 1, position_m: [100, 0, 0.5] }
    - { name: bar, shape: { box: { size_m: [0.4, 0.8, 1.6] } }, mass_kg: 2, position_m: [100, 5, 9], angular_velocity_rad_s: [0.3, 4, 0.5] }
method: event-driven
time: { end_s: 10 }
";

#[test]
fn where_nothing_moves_nothing_is_lost_or_made() {
    for (text, what) in [(PUSHED_CRATE, "crate"), (JAW, "jaw"), (STACK, "stack")] {
        let newton = largest(&measured(text, &[]));
        let event = largest(&measured(text, &["method=event-driven"]));
        let moreau = largest(&measured(text, &["method.time-stepping.scheme=moreau"]));
        // measured: 0, but 1.0e-10 (newton) of the jaw, whose pin gives way by some 1e-15 m under 40 N
        assert!(newton <= 1e-9 && moreau <= 1e-9 && event == 0.0, "{what}: {newton} {moreau} {event}");
    }
}

#[test]
fn free_flight_keeps_its_books() {
    // measured: 1.3e-14
    let amount = largest(&measured(FLIGHT, &[]));
    assert!(amount <= 1e-12, "{amount}");
    let free = largest(&measured(FLIGHT, &["method={ free: { integrator: exact } }", "time.step_s=0.1"]));
    assert!(free <= 1e-12, "{free}");
}

#[test]
fn the_gain_of_explicit_euler_is_what_it_is() {
    let text = "
scene:
  gravity_m_s2: [0, -10, 0]
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 2, velocity_m_s: [3, 0, 0] }]
method: { free: { integrator: explicit-euler } }
time: { step_s: 0.01, end_s: 1 }
";
    // ½ m g² h a step of ½ g h² more than the fall, of T(0) + m g d with d = ½ g t (t − h).
    let (m, g, h, t) = (2.0, 10.0, 0.01, 1.0);
    let expected = 0.5 * m * g * g * h * t / (0.5 * m * 9.0 + m * g * 0.5 * g * t * (t - h));
    let said = measured(text, &[]);
    // measured: 1.4e-13 of it
    assert!((said.energy_drift_rel.unwrap() / expected - 1.0).abs() < 0.01, "{said:?} {expected}");
    assert!(said.linear_momentum_drift_rel.unwrap() < 1e-12);
}

const BELT: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  bodies:
    - { name: belt, shape: { box: { size_m: [10, 1, 10] } }, mass_kg: 1, position_m: [0, -0.5, 0], kinematic: { velocity_m_s: [1, 0, 0] } }
    - { name: crate, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0], velocity_m_s: [0.001, 0, 0] }
method: event-driven
time: { step_s: 0.01, end_s: 1 }
";

const TURNTABLE: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  bodies:
    - { name: table, shape: { cylinder: { radius_m: 2, height_m: 0.2 } }, mass_kg: 1, position_m: [0, -0.1, 0], kinematic: { angular_velocity_rad_s: [0, 2, 0] } }
    - { name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [0.5, 0.1, 0] }
method: event-driven
time: { step_s: 0.01, end_s: 1 }
";

/// A rod on a crank that is turned.
const MOTOR: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  bodies:
    - { name: crank, shape: none, inertia_kg_m2: [1, 1, 1], mass_kg: 1, kinematic: { angular_velocity_rad_s: [0, 0, 2] } }
    - { name: rod, shape: none, inertia_kg_m2: [0.1, 0.02, 0.1], mass_kg: 1, position_m: [0.3, -0.5, 0] }
  pins: [{ body: rod, point_m: [0, 0.5, 0], with: crank }]
method: event-driven
time: { step_s: 0.05, end_s: 5 }
";

/// A force that swings, and the air.
const SWINGING: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.3 } }, mass_kg: 1 }]
  forces: [{ body: ball, force_n: [2, 0, 1], as: { cosine: { frequency_rad_s: 7, phase_rad: 0.3 } } }]
  air: { density_kg_m3: 1.2, drag_coefficient: 1 }
method: event-driven
time: { step_s: 0.1, end_s: 10 }
";

#[test]
fn work_of_driven_bodies_and_of_loads_is_no_drift() {
    let dop853 = "method={ free: { integrator: dop853, tolerance: 1e-9 } }";
    for (text, what) in [(BELT, "belt"), (TURNTABLE, "turntable"), (MOTOR, "motor"), (SWINGING, "swinging")] {
        let event = largest(&measured(text, &[]));
        // measured: 0, 2.2e-10, 1.1e-12, 4e-10
        assert!(event <= 1e-8, "{what}: {event}");
    }
    for (text, what) in [(MOTOR, "motor"), (SWINGING, "swinging")] {
        let free = largest(&measured(text, &[dop853]));
        // measured: 0, 6.6e-12
        assert!(free <= 1e-8, "{what}: {free}");
    }
    // An order-1 method does what it does: work and energy differ by its error.
    let newton = |text: &str| measured(text, &["method={ time-stepping: { solver: newton } }", "time.step_s=0.001"]);
    // measured: 0, and 8.9e-4
    assert!(newton(BELT).energy_drift_rel.unwrap().abs() <= 1e-9);
    assert!(newton(MOTOR).energy_drift_rel.unwrap().abs() <= 2e-3);
}

#[test]
fn energy_from_nothing_is_all_there_is() {
    // No gravity, nothing moves, no work: whatever there is at the end is made.
    let still = "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 2 }]
method: { free: { integrator: rk4 } }
time: { step_s: 0.01, end_s: 1 }
";
    let said = measured(still, &[]);
    assert_eq!((said.energy_drift_rel, said.energy_growth_max), (Some(0.0), None));
}

#[test]
fn springs_hold_energy() {
    let text = "
scene:
  gravity_m_s2: [0, -9.8, 0]
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: cube, shape: { box: { size_m: [1, 1, 1] } }, mesh: { nodes_per_edge: 2 }, mass_kg: 1, position_m: [0, 0.6, 0] }
method: { penalty: { stiffness_n_m: 1e4 } }
time: { step_s: 1e-4, end_s: 2 }
";
    let said = measured(text, &[]);
    // measured: 5.3e-4, and a rise by 0.019 where steps of 0.02 rad swing; without what springs hold both are of order
    // 1
    assert!(said.energy_drift_rel.unwrap().abs() < 1e-3 && largest(&said) < 0.05, "{said:?}");
}

/// Without gravity nothing but the force itself says how much a joule is.
#[test]
fn what_is_pressed_without_gravity_is_at_rest() {
    let text = "
scene:
  gravity_m_s2: [0, 0, 0]
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  forces: [{ body: upper, force_n: [0, -1, 0] }]
  bodies:
    - { name: lower, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0] }
    - { name: upper, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 1.5, 0] }
time: { step_s: 0.01, end_s: 10 }
";
    let newton = ["{time-stepping: {solver: newton}}", "{time-stepping: {solver: newton, scheme: moreau}}"];
    for method in newton.into_iter().chain(["event-driven"]) {
        let said = measured(text, &[&format!("method={method}")]);
        // measured: 0, and 2.0e-10
        assert!(largest(&said) <= 1e-9 && said.residual_max.unwrap() <= 1e-6, "{method}: {said:?}");
    }
}

/// The moment of gravity about the pin is what there is to be wrong by.
#[test]
fn a_pendulum_from_rest_has_a_scale() {
    let text = "
scene:
  bodies:
    - { name: rod, shape: none, inertia_kg_m2: [0.1, 0.02, 0.1], mass_kg: 1, position_m: [0.5, 0, 0] }
  pins: [{ body: rod, point_m: [-0.5, 0, 0] }]
method: { free: { integrator: rk4 } }
time: { step_s: 0.01, end_s: 2 }
";
    for method in ["{ free: { integrator: rk4 } }", "event-driven"] {
        let said = measured(text, &[&format!("method={method}")]);
        // measured: 5.5e-13
        assert!(said.angular_momentum_drift_rel.unwrap() < 1e-9, "{method}: {said:?}");
    }
}

/// The forces that are shown are those that make the motion, also where walls press as they please.
#[test]
fn friction_of_a_corridor_is_in_the_books() {
    let text = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  container: { box: { size_m: [1, 4, 40] } }
  bodies: [{ name: box, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0], velocity_m_s: [0, 0, 3] }]
method: event-driven
time: { end_s: 1 }
";
    let said = measured(text, &[]);
    // measured: 0
    assert!(largest(&said) <= 1e-9, "{said:?}");
}

//! How an error of the start has grown at the end.

use crate::yaml::measured;

/// A ball in free flight.
const FLYING: &str = "
scene:
  bodies:
    - { name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 3, 0], velocity_m_s: [1, 0, 0] }
method: event-driven
time: { step_s: 0.01, end_s: 0.5 }
";

/// A table of billiards whose cushions are round.
const BILLIARDS: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  restitution: 1
  bodies:
    - { name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 0, 0], velocity_m_s: [5, 0, 0] }
    - { name: right, shape: { sphere: { radius_m: 1 } }, fixed: true, mass_kg: 1, position_m: [3, 0.2, 0] }
    - { name: left, shape: { sphere: { radius_m: 1 } }, fixed: true, mass_kg: 1, position_m: [-3, 0.2, 0] }
method: { time-stepping: { scheme: moreau, solver: newton } }
time: { step_s: 1e-3, end_s: 1.5 }
measure: [sensitivity]
";

fn sensitivity(text: &str, sets: &[&str]) -> Option<f64> {
    measured(text, sets).sensitivity
}

#[test]
fn a_free_flight_adds_the_errors_of_place_and_velocity() {
    // measured: 2.3e-10 from 2: coordinates of some metres in units of ε
    let kappa = sensitivity(FLYING, &["measure=[sensitivity]"]).unwrap();
    assert!((kappa - 2.0).abs() < 2e-9, "{kappa}");
    let asked = sensitivity(FLYING, &["method=time-stepping", "measure=[sensitivity]"]).unwrap();
    assert!((asked - 2.0).abs() < 2e-9, "{asked}");
}

#[test]
fn nobody_pays_for_it_unasked_but_who_compares_ends() {
    for method in ["event-driven", "time-stepping", "free"] {
        assert_eq!(sensitivity(FLYING, &[&format!("method={method}")]), None);
    }
    assert!(sensitivity(FLYING, &["method=auto"]).is_some());
    assert!(sensitivity(FLYING, &["method=event-driven", "reference={}"]).is_some());
}

#[test]
fn every_round_cushion_multiplies_an_error() {
    let after = |end: &str| sensitivity(BILLIARDS, &[end]).unwrap();
    let [none, one, two] = ["time.end_s=0.25", "time.end_s=0.6", "time.end_s=1.2"].map(after);
    // measured: 2.0, 4.8, 10.9
    assert!((none - 2.0).abs() < 1e-6 && one > 2.0 * none && two > 2.0 * one, "{none} {one} {two}");
}

#[test]
fn a_body_at_rest_is_displaced_along_its_floor() {
    let resting = "
scene:
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: cube, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0] }]
time: { step_s: 0.01, end_s: 1 }
measure: [sensitivity]
";
    let [resting, measured] = [measured(resting, &[]), measured(resting, &["scene.friction=0"])];
    // It stays where it was put; without friction it also slides. measured: 6e-10 from 1, 8e-15 from 2
    assert!((resting.sensitivity.unwrap() - 1.0).abs() < 1e-3, "{:?}", resting.sensitivity);
    assert!((measured.sensitivity.unwrap() - 2.0).abs() < 1e-3, "{:?}", measured.sensitivity);
}

#[test]
fn what_cannot_be_displaced_has_no_sensitivity() {
    let text = BILLIARDS.replace("velocity_m_s: [5, 0, 0]", "fixed: true");
    assert_eq!(sensitivity(&text, &[]), None);
}

#[test]
fn a_body_on_a_pin_is_left_alone() {
    let pinned = "
scene:
  bodies:
    - { name: rod, shape: { box: { size_m: [0.1, 1, 0.1] } }, mass_kg: 1, orientation: { axis: [0, 0, 1], angle_deg: 30 } }
    - { name: mote, shape: none, mass_kg: 1 }
  pins: [{ body: rod, point_m: [0, 0.5, 0] }]
method: { free: { integrator: rk4 } }
time: { step_s: 0.01, end_s: 0.5 }
measure: [sensitivity]
";
    // The mote flies, and nothing of it comes to the rod. measured: 1e-10 from 2
    assert!((sensitivity(pinned, &[]).unwrap() - 2.0).abs() < 1e-8);
    assert_eq!(sensitivity(pinned, &["scene.bodies.mote.fixed=true"]), None);
}

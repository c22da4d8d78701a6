//! Scenes whose motion is known.

use super::worst_error;
use crate::yaml::measured;
use gotai::outcome::Outcome;

/// Seven scenes, from free flight to slipping and rolling; z is up where something is touched.
const SCENES: [(&str, &str); 7] = [
    (
        "projectile",
        "
scene:
  gravity_m_s2: [0, -9.8, 0]
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 0.1, position_m: [0, 100, 0], velocity_m_s: [10, 10, 0] }]
time: { end_s: 4 }
exact: free-motion
",
    ),
    (
        "a top in the middle of its flip",
        "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies: [{ name: top, shape: none, mass_kg: 1, inertia_kg_m2: [1, 2, 3], angular_velocity_rad_s: [0.01, 5, 0.01] }]
time: { end_s: 7.5 }
exact: free-motion
",
    ),
    (
        "bounces",
        "
scene:
  gravity_m_s2: [0, 0, -9.81]
  restitution: 0.8
  container: { plane: { normal: [0, 0, 1] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [0, 0, 1.1] }]
time: { end_s: 2 }
exact: ball
",
    ),
    (
        "sliding to rest",
        "
scene:
  gravity_m_s2: [0, 0, -9.81]
  friction: 0.3
  container: { plane: { normal: [0, 0, 1] } }
  bodies: [{ name: slab, shape: { box: { size_m: [1, 1, 0.2] } }, mass_kg: 1, position_m: [0, 0, 0.1], velocity_m_s: [5, 0, 0] }]
time: { end_s: 3 }
exact: sliding
",
    ),
    ("sliding down a slope", SLOPE),
    ("sticking on a slope", SLOPE),
    (
        "slipping to rolling",
        "
scene:
  gravity_m_s2: [0, 0, -9.81]
  friction: 0.3
  container: { plane: { normal: [0, 0, 1] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 0, 0.5], velocity_m_s: [5, 0, 0] }]
time: { end_s: 3 }
exact: ball
",
    ),
];

/// Of 30° towards x, in the plane's own coordinates.
const SLOPE: &str = "
scene:
  gravity_m_s2: [0, 0, -9.81]
  friction: 0.3
  container: { plane: { normal: [0.49999999999999994, 0, 0.8660254037844387] } }
  bodies:
    - name: slab
      shape: { box: { size_m: [1, 1, 0.2] } }
      mass_kg: 1
      position_m: [0.049999999999999996, 0, 0.08660254037844387]
      orientation: { axis: [0, 1, 0], angle_deg: 30 }
time: { end_s: 2 }
exact: sliding
";

#[test]
fn seven_scenes_are_followed_to_rounding() {
    for (what, text) in SCENES {
        let sets = if what.starts_with("sticking") { ["scene.friction=0.7", "time.end_s=5"].as_slice() } else { &[] };
        let error = worst_error(&measured(&format!("{text}method: event-driven\n"), sets));
        // measured: 6.1e-15
        assert!(error < 1e-13, "{what}: {error:e}");
    }
}

/// It bounces ever faster until √(2h/g)(1 + e)/(1 − e), and rests.
#[test]
fn a_ball_is_followed_through_all_its_bounces() {
    let zeno_s = (2.0_f64 / 9.81).sqrt() * 9.0;
    let before = (1..=50).map(|i| zeno_s * (1.0 - 0.85_f64.powi(i)));
    let mut worst = [0.0_f64; 2];
    for (k, end_s) in before.chain([1.0, 1.000_001, 1.1, 2.0].map(|part| zeno_s * part)).enumerate() {
        let m = measured(&format!("{}method: event-driven\n", SCENES[2].1), &[&format!("time.end_s={end_s:?}")]);
        assert_eq!((m.outcome, m.work.fallbacks), (Outcome::Finished, 0));
        worst[0] = worst[0].max(m.error_position_m.unwrap());
        worst[1] = worst[1].max(if k > 50 { m.error_velocity_m_s.unwrap() } else { 0.0 });
    }
    // measured: 2.3e-15 m, and 0 m/s at rest
    assert!(worst[0] < 3e-14 && worst[1] < 1e-14, "{worst:?}");
}

const ROCKING: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 1
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - name: block
      shape: { box: { size_m: [0.4, 1.6, 0.4] } }
      mass_kg: 1
      position_m: [0, 0.8214375654841565, 0]
      orientation: { axis: [0, 0, 1], angle_deg: 9 }
method: event-driven
time: { end_s: 3 }
exact: rocking-block
";

const FALLING: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - name: rod
      shape: { capsule: { radius_m: 0.01, height_m: 1 } }
      mass_kg: 1
      inertia_kg_m2: [0.08333333333333333, 1e-4, 0.08333333333333333]
      position_m: [0, 0.5099238475781956, 0]
      orientation: { axis: [0, 0, 1], angle_deg: 1 }
method: event-driven
time: { end_s: 0.81 }
exact: falling-rod
";

const TURNTABLE: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  bodies:
    - { name: table, shape: { cylinder: { radius_m: 2, height_m: 0.2 } }, mass_kg: 1, position_m: [0, -0.1, 0], kinematic: { angular_velocity_rad_s: [0, 2, 0] } }
    - { name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [0.7, 0.1, 0], velocity_m_s: [0, 0, -0.4], angular_velocity_rad_s: [10, 0, 0] }
method: event-driven
time: { end_s: 3 }
exact: turntable
";

#[test]
fn motions_in_contact_follow_the_tolerance() {
    for (what, text) in [("rocking", ROCKING), ("falling", FALLING), ("turntable", TURNTABLE)] {
        for tolerance in [1e-6, 1e-9, 1e-12] {
            let m = measured(text, &[&format!("method.event-driven.tolerance={tolerance:e}")]);
            let (position_m, worst) = (m.error_position_m.unwrap(), worst_error(&m));
            // measured: at most 0.33 of the tolerance (the block at 1e-12); of all quantities 5.4
            assert!(
                position_m < tolerance && worst < 20.0 * tolerance,
                "{what}, {tolerance}: {position_m:e} {worst:e}"
            );
        }
    }
}

#[test]
fn a_rod_that_has_fallen_lies_flat() {
    let m = measured(FALLING, &["time.end_s=1"]);
    // measured: 2.2e-16
    assert!(worst_error(&m) < 1e-14);
}

//! Rims of caps that cross.

use crate::yaml::measured;
use gotai::outcome::Outcome;

/// A can on a can, off its axis, that topples and rolls on their rims.
const TOPPLES: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  restitution: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: a, shape: { cylinder: { radius_m: 0.1, height_m: 0.2 } }, mass_kg: 5, position_m: [0, 0.1, 0], velocity_m_s: [0, 0, 0], angular_velocity_rad_s: [0, 0, 0] }
    - { name: b, shape: { cylinder: { radius_m: 0.1, height_m: 0.2 } }, mass_kg: 1, position_m: [0.03, 0.3, 0.02], velocity_m_s: [0.0, 0, 0.0], angular_velocity_rad_s: [0.5, 0, -6] }
method: { event-driven: { tolerance: 1e-06 } }
time: { end_s: 0.5 }
";

/// Two rims that nearly lie on each other have more than one normal across which their distance is stationary: where
/// the normal was followed, and not the points, it came to another one, 0.17 m inside.
#[test]
fn rims_of_two_cans_touch_where_they_cross() {
    let measured = measured(TOPPLES, &[]);
    assert_eq!(measured.outcome, Outcome::Finished);
    // measured: 0; 0.3 by its normal
    assert_eq!(measured.ghost_impulse_max_rel, Some(0.0));
    // measured: 6.1e-6 m, in steps of equal length
    assert!(measured.penetration_max_m.unwrap() < 1e-4, "{measured:?}");
}

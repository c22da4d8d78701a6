//! Rims of caps that cross.

use super::followed_to;
use crate::yaml::measured;
use gotai::outcome::Outcome;
use gotai::run::Ended;

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

/// A can on a fixed one of its size, its centre just beyond that one's rim, in a direction.
fn hangs_over(azimuth_rad: f64, off_m: f64) -> String {
    let at = [off_m * azimuth_rad.cos(), 0.3, off_m * azimuth_rad.sin()];
    format!(
        "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.3
  restitution: 0
  container: {{ plane: {{ normal: [0, 1, 0] }} }}
  bodies:
    - {{ name: low, shape: {{ cylinder: {{ radius_m: 0.1, height_m: 0.2 }} }}, mass_kg: 1, fixed: true, position_m: [0, 0.1, 0] }}
    - {{ name: top, shape: {{ cylinder: {{ radius_m: 0.1, height_m: 0.2 }} }}, mass_kg: 1, position_m: {at:?} }}
method: {{ event-driven: {{ tolerance: 1e-6 }} }}
time: {{ end_s: 0.3 }}
"
    )
}

/// The lowest point of a rim that rolls and the middle of its arc are one point: held as two, each was put to rest
/// against the other.
#[test]
fn a_can_tips_over_the_rim_of_a_can_alike_in_every_direction() {
    for off_m in [0.101, 0.11] {
        let heights = [0.0, 0.3, 0.6, 2.0].map(|azimuth_rad| {
            let Ended { measured, state, .. } = followed_to(&hangs_over(azimuth_rad, off_m), &[]);
            // measured: 3 to 12; 5,800 to 6,012 before, and 10 stretches of steps of equal length
            assert!(measured.work.events <= 30, "{measured:?}");
            state.bodies[1].p_WB.y
        });
        // measured: 2e-7 m
        assert!(heights.iter().all(|height_m| (height_m - heights[0]).abs() < 2e-6), "{heights:?}");
    }
}

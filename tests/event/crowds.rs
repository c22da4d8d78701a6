//! Several bodies of all shapes (from `.ci/crowds.py`): parts of them that came into each other unseen, or whose motion
//! along each other was not known.

use super::followed;
use crate::yaml::measured;
use gotai::outcome::Outcome;
use gotai::rows::Measured;

/// A can comes down on two flush blocks: its side on the edge of the one, and its rim a moment before on the other one.
const CAN_OVER_A_SEAM: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.3
  restitution: 0.5
  bodies:
    - { name: floor, shape: { box: { size_m: [3, 1, 3] } }, mass_kg: 1, fixed: true, position_m: [-1.5, -0.5, -1.5], copies: { grid: [2, 1, 2], step_m: [3, 0, 3] } }
    - { name: b0, shape: { cylinder: { radius_m: 0.15, height_m: 0.472 } }, mass_kg: 1.52, orientation: { axis: [-0.5439, 0.8037, 0.2414], angle_deg: 173.9 }, velocity_m_s: [-1.3072, -2.8486, -1.5815], angular_velocity_rad_s: [3.512, -5.9937, 4.2647], position_m: [-0.046844815689, 0.444190710592, 0.070445129393] }
    - { name: b1, shape: { box: { size_m: [0.296, 0.44, 0.458] } }, mass_kg: 2.84, orientation: { axis: [0.2029, 0.7995, 0.5653], angle_deg: 67.0 }, velocity_m_s: [0.4089, -2.5336, -1.8066], angular_velocity_rad_s: [1.5732, 6.6116, 5.0305], position_m: [-0.262757163489, 1.299224251476, 0.152853863685] }
    - { name: b2, shape: { convex: { vertices_m: [[0.215, -0.193, 0.0], [-0.1075, -0.193, 0.186195461814], [-0.1075, -0.193, -0.186195461814], [0.215, 0.193, 0.0], [-0.1075, 0.193, 0.186195461814], [-0.1075, 0.193, -0.186195461814]] } }, mass_kg: 2.53, orientation: { axis: [0.9757, 0.2046, -0.0782], angle_deg: 63.4 }, velocity_m_s: [-1.7194, -1.9743, -1.6591], angular_velocity_rad_s: [-4.8135, -3.5991, -0.171], position_m: [0.282715817836, 1.998755695482, -0.234594568671] }
method: event-driven
time: { end_s: 0.6 }
";

#[test]
fn what_lies_nearly_along_a_face_comes_down_with_its_other_end_too() {
    let Measured { penetration_max_m, .. } = followed(CAN_OVER_A_SEAM, &["time.end_s=0.36"]);
    // measured: 4.0e-12; 5.6e-6 before the first moment was looked for
    assert!(penetration_max_m.unwrap() < 1e-10, "{penetration_max_m:?}");
}

/// A box falls on a can that lies: edge and corner of the one on the round side of the other one.
const EDGE_ON_A_ROUND_SIDE: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.1
  restitution: 0
  bodies:
    - { name: floor, shape: { box: { size_m: [3, 1, 3] } }, mass_kg: 1, fixed: true, position_m: [-1.5, -0.5, -1.5], copies: { grid: [2, 1, 2], step_m: [3, 0, 3] } }
    - { name: b0, shape: { ellipsoid: { semi_axes_m: [0.117, 0.141, 0.098] } }, mass_kg: 1.63, orientation: { axis: [-0.7752, 0.6183, -0.1294], angle_deg: 65.6 }, velocity_m_s: [1.9561, -2.8908, -1.9093], angular_velocity_rad_s: [4.3161, -0.847, 5.6093], position_m: [0.253811719771, 0.176827314532, -0.023220419309] }
    - { name: b1, shape: { cylinder: { radius_m: 0.123, height_m: 0.384 } }, mass_kg: 2.69, orientation: { axis: [0.4779, -0.8011, -0.3603], angle_deg: 84.5 }, velocity_m_s: [0.1837, 0.9004, -1.7714], angular_velocity_rad_s: [0.924, 2.4884, 0.9235], position_m: [-0.227642005779, 0.576406082006, 0.201869313036] }
    - { name: b2, shape: { sphere: { radius_m: 0.154 } }, mass_kg: 1.06, orientation: { axis: [-0.3148, 0.0685, -0.9467], angle_deg: 3.9 }, velocity_m_s: [0.3592, -0.2768, -1.7193], angular_velocity_rad_s: [-4.5119, 4.4368, 3.7101], position_m: [-0.058577426379, 1.018795411513, -0.178842273956] }
    - { name: b3, shape: { box: { size_m: [0.418, 0.192, 0.246] } }, mass_kg: 1.45, orientation: { axis: [-0.36, -0.0118, 0.9329], angle_deg: 167.0 }, velocity_m_s: [0.4717, -2.9388, -0.9471], angular_velocity_rad_s: [1.6612, -7.5272, 5.115], position_m: [-0.225283302733, 1.6921610831, -0.259465554647] }
method: event-driven
time: { end_s: 0.6 }
";

#[test]
fn an_edge_that_ends_on_a_round_side_is_known_there() {
    let Measured { outcome, penetration_max_m, residual_max, work, .. } =
        measured(EDGE_ON_A_ROUND_SIDE, &["time.end_s=0.3"]);
    assert_eq!(outcome, Outcome::Finished);
    // measured: 1, of a point that is known to the root of rounding only; 0 to 2 at other tolerances
    assert!(work.fallbacks <= 1, "{}", work.fallbacks);
    // measured: 1.4e-13 and 8.2e-8; 1e-6 and 4e-4 with steps of equal length in between
    assert!(penetration_max_m.unwrap() < 1e-10 && residual_max.unwrap() < 1e-6);
}

/// A hull's corner on a rim, which is not known in closed form.
const CORNER_ON_A_RIM: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 1
  restitution: 0.3
  bodies:
    - { name: floor, shape: { box: { size_m: [3, 1, 3] } }, mass_kg: 1, fixed: true, position_m: [-1.5, -0.5, -1.5], copies: { grid: [2, 1, 2], step_m: [3, 0, 3] } }
    - { name: b0, shape: { ellipsoid: { semi_axes_m: [0.185, 0.165, 0.121] } }, mass_kg: 2.94, orientation: { axis: [0.9516, -0.2815, 0.1234], angle_deg: 56.0 }, velocity_m_s: [0.0734, -1.2421, -0.2073], angular_velocity_rad_s: [-3.5633, 2.4717, 6.7795], position_m: [-0.101123980692, 0.48169458648, -0.284927753925] }
    - { name: b1, shape: { box: { size_m: [0.416, 0.318, 0.462] } }, mass_kg: 2.24, orientation: { axis: [0.1506, 0.1387, -0.9788], angle_deg: 169.8 }, velocity_m_s: [1.1332, -2.1636, -1.4593], angular_velocity_rad_s: [0.9883, -2.6892, 5.4131], position_m: [0.291010575443, 1.105822309059, 0.220878488107] }
    - { name: b2, shape: { cylinder: { radius_m: 0.242, height_m: 0.438 } }, mass_kg: 2.3, orientation: { axis: [0.8466, -0.4596, 0.2683], angle_deg: 126.1 }, velocity_m_s: [0.6048, -2.7421, -1.4567], angular_velocity_rad_s: [-4.4015, 6.085, -1.8445], position_m: [-0.2061682227, 1.852976490963, 0.171070258964] }
    - { name: b3, shape: { convex: { vertices_m: [[0.121, -0.212, 0.0], [0.037391056319, -0.212, 0.115077838472], [-0.097891056319, -0.212, 0.071122015527], [-0.097891056319, -0.212, -0.071122015527], [0.037391056319, -0.212, -0.115077838472], [0.121, 0.212, 0.0], [0.037391056319, 0.212, 0.115077838472], [-0.097891056319, 0.212, 0.071122015527], [-0.097891056319, 0.212, -0.071122015527], [0.037391056319, 0.212, -0.115077838472]] } }, mass_kg: 1.02, orientation: { axis: [-0.2434, -0.8291, -0.5034], angle_deg: 176.7 }, velocity_m_s: [-1.5812, 0.0714, -1.1117], angular_velocity_rad_s: [-3.9274, 5.9389, 2.5905], position_m: [0.006257456039, 2.639433877859, -0.218273156122] }
    - { name: b4, shape: { cylinder: { radius_m: 0.182, height_m: 0.384 } }, mass_kg: 0.94, orientation: { axis: [0.8977, 0.1112, 0.4264], angle_deg: 30.4 }, velocity_m_s: [1.6232, -0.2395, -0.698], angular_velocity_rad_s: [-6.9628, -2.1997, -2.1034], position_m: [0.202089755765, 3.427991908319, -0.077065101742] }
method: event-driven
time: { end_s: 0.6 }
";

#[test]
fn steps_between_events_are_judged_where_their_impulses_act() {
    let Measured { outcome, penetration_max_m, residual_max, work, tolerance_met, .. } =
        measured(CORNER_ON_A_RIM, &["time.end_s=0.5"]);
    assert_eq!((outcome, work.fallbacks), (Outcome::Finished, 1));
    // The tolerance says nothing of them.
    assert_eq!(tolerance_met.as_deref(), Some("no"));
    // measured: 1.2e-13 and 1.5e-7; 4e-8 and 0.12 where the last of them was judged at its beginning
    assert!(penetration_max_m.unwrap() < 1e-10 && residual_max.unwrap() < 1e-6);
}

/// A capsule slides over the rim of a can on which it lies, without friction.
const CAPSULE_OVER_A_RIM: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0
  restitution: 0
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: b0, shape: { cylinder: { radius_m: 0.092, height_m: 0.266 } }, mass_kg: 2.29, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.5349, 0, 0.4452], position_m: [0.023649589754, 0.133, -0.021288279424] }
    - { name: b1, shape: { box: { size_m: [0.364, 0.356, 0.178] } }, mass_kg: 2.73, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.5349, 0, 0.4452], position_m: [0, 0.444, -0.011255784411] }
    - { name: b2, shape: { cylinder: { radius_m: 0.197, height_m: 0.274 } }, mass_kg: 0.8, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0, 0, 0], position_m: [-0.034187073249, 0.759, -0.00689476868] }
    - { name: b3, shape: { capsule: { radius_m: 0.085, height_m: 0.46 } }, mass_kg: 0.96, orientation: { axis: [0, 1, 0], angle_deg: 35.7 }, velocity_m_s: [0.5349, 0, 0.4452], position_m: [0, 1.211, 0] }
method: event-driven
time: { end_s: 0.6 }
";

#[test]
fn what_slides_over_a_rim_stays_outside() {
    let Measured { outcome, penetration_max_m, .. } = measured(CAPSULE_OVER_A_RIM, &["time.end_s=0.26"]);
    assert_eq!(outcome, Outcome::Finished);
    // measured: 9.7e-11; 4e-4 before the end of a motion was looked at
    assert!(penetration_max_m.unwrap() < 1e-9, "{penetration_max_m:?}");
}

#[test]
fn what_tips_about_an_edge_along_a_cap_is_followed_in_few_looks() {
    let Measured { outcome, penetration_max_m, residual_max, work, tolerance_met, .. } =
        measured(CAPSULE_OVER_A_RIM, &["method.event-driven.tolerance=1e-7"]);
    assert_eq!((outcome, work.fallbacks, tolerance_met), (Outcome::Finished, 0, None));
    // measured: 2.4e-15 and 1.8e-12
    assert!(penetration_max_m.unwrap() < 1e-10 && residual_max.unwrap() < 1e-6);
    // measured: 4,579; 10,000 for 5e-9 s where any point of the rim might have come down as fast as the fastest
    assert!(work.contact_tests < 15_000, "{}", work.contact_tests);
}

/// A stack without friction comes down: boxes rock on each other's edges, each time a little less.
const STACK_THAT_ROCKS: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0
  restitution: 0
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: b5, shape: { cylinder: { radius_m: 0.183, height_m: 0.41 } }, mass_kg: 2.59, orientation: { axis: [0, 1, 0], angle_deg: 88.8 }, velocity_m_s: [0.8327, 0, -0.2059], position_m: [-0.001032920079, 2.231, -0.016295231322] }
    - { name: b4, shape: { convex: { vertices_m: [[0.084, -0.241, 0.0], [0.025957427527, -0.241, 0.079888747369], [-0.067957427527, -0.241, 0.049373961193], [-0.067957427527, -0.241, -0.049373961193], [0.025957427527, -0.241, -0.079888747369], [0.084, 0.241, 0.0], [0.025957427527, 0.241, 0.079888747369], [-0.067957427527, 0.241, 0.049373961193], [-0.067957427527, 0.241, -0.049373961193], [0.025957427527, 0.241, -0.079888747369]] } }, mass_kg: 2.25, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.8327, 0, -0.2059], position_m: [-0.038110279052, 1.785, 0] }
    - { name: b3, shape: { box: { size_m: [0.338, 0.47, 0.236] } }, mass_kg: 0.56, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.8327, 0, -0.2059], position_m: [-0.038543189968, 1.309, 0] }
    - { name: b2, shape: { box: { size_m: [0.43, 0.416, 0.186] } }, mass_kg: 2.88, orientation: { axis: [0, 1, 0], angle_deg: 61.0 }, velocity_m_s: [0.8327, 0, -0.2059], position_m: [0, 0.866, 0] }
    - { name: b1, shape: { box: { size_m: [0.37, 0.446, 0.242] } }, mass_kg: 1.42, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.8327, 0, -0.2059], position_m: [0.049532154293, 0.435, 0] }
    - { name: b0, shape: { box: { size_m: [0.18, 0.212, 0.256] } }, mass_kg: 1.88, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0, 0, 0], position_m: [0, 0.106, -0.029599021825] }
method: { event-driven: { tolerance: 1e-6 } }
time: { end_s: 0.6 }
";

#[test]
fn what_is_put_to_rest_pushes_nothing_that_has_to_strike_for_it() {
    let Measured { penetration_max_m, residual_max, work, .. } = followed(STACK_THAT_ROCKS, &["time.end_s=0.53"]);
    // A corner put to rest at 7e-11 m/s pushed an edge that struck at once, and opened the corner again, 200 times.
    // measured: 144; 233 and a stretch of steps before
    assert!(work.events < 200, "{}", work.events);
    // measured: 5.7e-11 and 5.0e-8
    assert!(penetration_max_m.unwrap() < 1e-9 && residual_max.unwrap() < 1e-6);
}

/// A can with a ball on it, over the corner of four blocks, wobbles on its rim.
const BALL_ON_A_CAN: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 1
  restitution: 0
  bodies:
    - { name: floor, shape: { box: { size_m: [3, 1, 3] } }, mass_kg: 1, fixed: true, position_m: [-1.5, -0.5, -1.5], copies: { grid: [2, 1, 2], step_m: [3, 0, 3] } }
    - { name: can, shape: { cylinder: { radius_m: 0.211, height_m: 0.386 } }, mass_kg: 1.46, velocity_m_s: [-0.0223, 0, -0.0336], position_m: [-0.015908047635, 0.193, 0.025730617687] }
    - { name: ball, shape: { sphere: { radius_m: 0.085 } }, mass_kg: 2.38, velocity_m_s: [-0.0223, 0, -0.0336], position_m: [-0.024035214309, 0.471, 0] }
method: { event-driven: { tolerance: 1e-6 } }
time: { end_s: 0.3 }
";

/// Was: half of the can's weight by a contact that is not there, and 6 s.
#[test]
fn a_ball_on_a_can_that_wobbles_over_seams_has_no_contact_that_is_not_there() {
    let measured = followed(BALL_ON_A_CAN, &[]);
    assert_eq!(measured.ghost_impulse_max_rel, Some(0.0));
    // measured: 2.8e-12, and 162; 3,418
    assert!(measured.residual_max.unwrap() < 1e-8 && measured.work.events < 400, "{measured:?}");
}

/// A can with two boxes on it spins and slides, on thirteen contacts.
const BOXES_ON_A_CAN: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 1
  restitution: 0
  bodies:
    - { name: b2, shape: { box: { size_m: [0.248, 0.466, 0.432] } }, mass_kg: 1.72, velocity_m_s: [0.6139, 0, -0.2288], position_m: [0, 1.007, 0.001173778866] }
    - { name: b1, shape: { box: { size_m: [0.304, 0.344, 0.334] } }, mass_kg: 2.28, orientation: { axis: [0, 1, 0], angle_deg: 84.3 }, position_m: [0, 0.602, 0] }
    - { name: b0, shape: { cylinder: { radius_m: 0.128, height_m: 0.43 } }, mass_kg: 2.71, orientation: { axis: [0, 1, 0], angle_deg: 0.5 }, velocity_m_s: [0.6139, 0, -0.2288], position_m: [0.023687996656, 0.215, 0.03266711946] }
    - { name: floor, shape: { box: { size_m: [3, 1, 3] } }, mass_kg: 1, fixed: true, position_m: [-1.5, -0.5, -1.5], copies: { grid: [2, 1, 2], step_m: [3, 0, 3] } }
method: { event-driven: { tolerance: 1e-6 } }
time: { end_s: 0.0055 }
";

/// Was: the law of all contacts was solved at every look for a change of forces, fifty of them a change.
#[test]
fn when_forces_change_costs_few_solutions_of_the_law() {
    let measured = followed(BOXES_ON_A_CAN, &[]);
    // measured: 1,166; 45,753
    // measured: 5,047, of which the law of one change takes 1,100; 45,753
    assert!(measured.work.newton_steps < 8_000, "{}", measured.work.newton_steps);
    // measured: 4e-11
    assert!(measured.residual_max.unwrap() < 1e-8, "{measured:?}");
}

const PRISMS_AND_BOXES: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 1
  restitution: 0
  container: { box: { size_m: [4, 8, 4] } }
  bodies:
    - { name: b0, shape: { box: { size_m: [0.272, 0.224, 0.312] } }, mass_kg: 1.31, orientation: { axis: [0, 1, 0], angle_deg: 45 }, velocity_m_s: [2, 0, 0], position_m: [-0.815607535055, 0.112, -0.4] }
    - { name: b1, shape: { box: { size_m: [0.172, 0.328, 0.298] } }, mass_kg: 2.45, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0, 0, 0], position_m: [-0.054262715963, 0.164, -0.4] }
    - { name: b2, shape: { convex: { vertices_m: [[0.086, -0.161, 0.0], [0.043, -0.161, 0.074478184725], [-0.043, -0.161, 0.074478184725], [-0.086, -0.161, 0.0], [-0.043, -0.161, -0.074478184725], [0.043, -0.161, -0.074478184725], [0.086, 0.161, 0.0], [0.043, 0.161, 0.074478184725], [-0.043, 0.161, 0.074478184725], [-0.086, 0.161, 0.0], [-0.043, 0.161, -0.074478184725], [0.043, 0.161, -0.074478184725]] } }, mass_kg: 0.71, orientation: { axis: [0, 1, 0], angle_deg: 45 }, velocity_m_s: [0, 0, 0.0], position_m: [0.69767672944, 0.161, -0.4] }
    - { name: b3, shape: { convex: { vertices_m: [[0.106, -0.166, 0.0], [0.053, -0.166, 0.091798692801], [-0.053, -0.166, 0.091798692801], [-0.106, -0.166, 0.0], [-0.053, -0.166, -0.091798692801], [0.053, -0.166, -0.091798692801], [0.106, 0.166, 0.0], [0.053, 0.166, 0.091798692801], [-0.053, 0.166, 0.091798692801], [-0.106, 0.166, 0.0], [-0.053, 0.166, -0.091798692801], [0.053, 0.166, -0.091798692801]] } }, mass_kg: 1.92, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.5, 0, 0.0822], angular_velocity_rad_s: [0, -4.3926, 0], position_m: [-0.809860015273, 0.166, 0.35] }
    - { name: b4, shape: { box: { size_m: [0.296, 0.43, 0.364] } }, mass_kg: 1.57, orientation: { axis: [0, 1, 0], angle_deg: 45 }, velocity_m_s: [2, 0, 0], angular_velocity_rad_s: [0, 2.7181, 0], position_m: [-0.069414375183, 0.215, 0.35] }
    - { name: b5, shape: { convex: { vertices_m: [[0.226, -0.227, 0.0], [-0.113, -0.227, 0.195721741255], [-0.113, -0.227, -0.195721741255], [0.226, 0.227, 0.0], [-0.113, 0.227, 0.195721741255], [-0.113, 0.227, -0.195721741255]] } }, mass_kg: 2.34, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [2, 0, 0], position_m: [0.681387028529, 0.227, 0.35] }
method: { event-driven: { tolerance: 1e-8 } }
time: { end_s: 0.5 }
";

/// A prism of three corners comes to rest beside a box whose contacts say the same thing twice.
#[test]
fn what_is_put_to_rest_is_so_whatever_rests_beside_it() {
    let measured = followed(PRISMS_AND_BOXES, &[]);
    // measured: 1.1e-11; 9.3e-5 where no island was put to rest if one was not; and 2.3e-11 m
    assert!(measured.residual_max.unwrap() < 1e-8 && measured.penetration_max_m.unwrap() < 1e-10, "{measured:?}");
}

/// A can stands on the floor beside a box, its lower rim on the box's lower edge.
const CAN_BESIDE_A_BOX: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.3
  restitution: 0
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: b3, shape: { cylinder: { radius_m: 0.101, height_m: 0.458 } }, mass_kg: 0.87, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [2, 0, 0], angular_velocity_rad_s: [0, -0.5123, 0], position_m: [-0.81257821462, 0.229, 0.35] }
    - { name: b4, shape: { box: { size_m: [0.366, 0.486, 0.236] } }, mass_kg: 1.04, orientation: { axis: [0, 1, 0], angle_deg: 45 }, velocity_m_s: [0, 0, 0], position_m: [-0.065186167496, 0.243, 0.35] }
method: { event-driven: { tolerance: 1e-8 } }
time: { end_s: 0.45 }
";

#[test]
fn closing_a_gap_carries_nothing_away() {
    let measured = measured(CAN_BESIDE_A_BOX, &[]);
    assert_eq!(measured.outcome, Outcome::Finished);
    // measured: 5.8e-10; 0.13 in no time where a displacement after which gaps are larger is kept
    assert!(measured.penetration_max_m.unwrap() < 1e-8, "{:?}", measured.penetration_max_m);
}

/// A can on a leaning prism, an edge of which lies across its cap for a moment and then turns up over the rim.
#[test]
fn an_edge_that_turns_up_over_a_rim_is_held_along_both() {
    let measured = followed(STACK_THAT_ROCKS, &["time.end_s=0.56"]);
    // measured: 0; 0.018 where it went on along the cap's normal, and off it by a micrometre in a step
    assert_eq!(measured.ghost_impulse_max_rel, Some(0.0));
    // measured: 5.0e-8 and 3.4e-10 m
    assert!(measured.residual_max.unwrap() < 1e-6 && measured.penetration_max_m.unwrap() < 1e-9, "{measured:?}");
}

/// A stack whose contacts slip so that no forces go on with it, and no impulse is found that ends it.
const JAMMED_STACK: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 1
  restitution: 0.3
  container: { box: { size_m: [4, 8, 4] } }
  bodies:
    - { name: b3, shape: { ellipsoid: { semi_axes_m: [0.233, 0.232, 0.089] } }, mass_kg: 1.68, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0, 0, 0], position_m: [-0.003790875853, 1.606, 0] }
    - { name: b2, shape: { cylinder: { radius_m: 0.246, height_m: 0.462 } }, mass_kg: 1.05, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [-0.0, 0, -0.0112], position_m: [0, 1.143, 0] }
    - { name: b1, shape: { box: { size_m: [0.274, 0.438, 0.252] } }, mass_kg: 2.76, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [-0.0, 0, -0.0112], position_m: [0, 0.693, 0] }
    - { name: b0, shape: { box: { size_m: [0.284, 0.474, 0.23] } }, mass_kg: 0.6, orientation: { axis: [0, 1, 0], angle_deg: 57.1 }, velocity_m_s: [-0.0, 0, -0.0112], position_m: [0.025102621844, 0.237, -0.049167073109] }
method: { event-driven: { tolerance: 1e-8 } }
time: { end_s: 0.05 }
";

#[test]
fn what_jams_together_goes_on_in_steps() {
    let measured = measured(JAMMED_STACK, &[]);
    // Was: stalled at 0.0047 s.
    assert_eq!(measured.outcome, Outcome::Finished, "{measured:?}");
    // measured: 10, and they are told
    assert!(measured.work.fallbacks > 0, "{measured:?}");
}

//! Contacts that share a load: by the law, in the direction of their slips, and on blocks side by side as on one.

use crate::yaml::{experiment, run};
use gotai::outcome::Outcome;

/// Was: friction askew to the slip by a thousandth of what accelerates it, 4e-4 of the load, at every tolerance.
#[test]
fn a_tall_box_that_presses_with_three_corners_of_four_slips_against_its_friction() {
    let mut worst = 0.0_f64;
    for (friction, v, w) in [
        (0.8, [0.193, 0.0, -1.472], 2.539),
        (0.8, [0.469, 0.0, 1.561], -0.522),
        (0.8, [-0.4, 0.0, 1.2], 1.7),
        (0.5, [0.9, 0.0, 1.1], -3.0),
    ] {
        for tolerance in ["1e-6", "1e-8"] {
            let text = format!(
                "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: {friction}
  container: {{ plane: {{ normal: [0, 1, 0] }} }}
  bodies:
    - {{ name: box, shape: {{ box: {{ size_m: [0.11, 0.31, 0.25] }} }}, mass_kg: 1, position_m: [0, 0.155, 0],
        velocity_m_s: {v:?}, angular_velocity_rad_s: [0, {w}, 0] }}
method: {{ event-driven: {{ tolerance: {tolerance} }} }}
time: {{ end_s: 0.3 }}
"
            );
            let measured = run(&experiment(&text, &[])).measured;
            assert_eq!(measured.outcome, Outcome::Finished);
            worst = worst.max(measured.residual_max.unwrap());
        }
    }
    // measured: 4.1e-9
    assert!(worst < 1e-7, "{worst:e}");
}

/// Redundant contacts of a stack whose lowest body tips while it slides: forces by the law of all at once.
#[test]
fn a_stack_that_slides_and_tips_keeps_the_law() {
    let text = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  restitution: 0
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: b0, shape: { convex: { vertices_m: [[0.242, -0.202, 0.0], [0.121, -0.202, 0.209578147716], [-0.121, -0.202, 0.209578147716], [-0.242, -0.202, 0.0], [-0.121, -0.202, -0.209578147716], [0.121, -0.202, -0.209578147716], [0.242, 0.202, 0.0], [0.121, 0.202, 0.209578147716], [-0.121, 0.202, 0.209578147716], [-0.242, 0.202, 0.0], [-0.121, 0.202, -0.209578147716], [0.121, 0.202, -0.209578147716]] } }, mass_kg: 1.24, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.0, 0, 0.3549], position_m: [0, 0.202, 0] }
    - { name: b1, shape: { convex: { vertices_m: [[0.239, -0.143, 0.0], [0.1195, -0.143, 0.206980071504], [-0.1195, -0.143, 0.206980071504], [-0.239, -0.143, 0.0], [-0.1195, -0.143, -0.206980071504], [0.1195, -0.143, -0.206980071504], [0.239, 0.143, 0.0], [0.1195, 0.143, 0.206980071504], [-0.1195, 0.143, 0.206980071504], [-0.239, 0.143, 0.0], [-0.1195, 0.143, -0.206980071504], [0.1195, 0.143, -0.206980071504]] } }, mass_kg: 2.05, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.0, 0, 0.3549], position_m: [-0.004391704766, 0.547, -0.001999098296] }
    - { name: b2, shape: { sphere: { radius_m: 0.232 } }, mass_kg: 2.68, orientation: { axis: [0, 1, 0], angle_deg: 0 }, velocity_m_s: [0.0, 0, 0.3549], position_m: [-0.037831511751, 0.922, 0] }
method: { event-driven: { tolerance: 1e-8 } }
time: { end_s: 0.001 }
";
    let measured = run(&experiment(text, &[])).measured;
    assert_eq!((measured.outcome, measured.work.fallbacks), (Outcome::Finished, 0));
    // measured: 1.3e-13; it was 5.0e-4
    assert!(measured.residual_max.unwrap() < 1e-8, "{measured:?}");
}

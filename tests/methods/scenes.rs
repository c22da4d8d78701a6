//! Whole scenes of contact: stacks, orders, extremes, copies.

use super::order;
use crate::yaml::{experiment, file, measured, run};
use gotai::outcome::Outcome;
use gotai::scene::build;

const NEWTON: &str = "method.time-stepping.solver=newton";
const SCHEMES: [&str; 2] = ["semi-implicit", "moreau"];

const STACK: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: cube, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0], copies: { count: 10, step_m: [0, 1, 0] } }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.01, end_s: 5 }
";

/// Masses from below; every contact carries the weight above, and nothing moves.
fn stands(masses: [f64; 10], scheme: &str) {
    let mut experiment = experiment(STACK, &[&format!("method.time-stepping.scheme={scheme}")]);
    for (body, mass) in experiment.scene.bodies.iter_mut().zip(masses) {
        body.mass_kg = Some(mass);
    }
    let ended = run(&experiment);
    let m = &ended.measured;
    assert_eq!((m.outcome, m.work.unsolved), (Outcome::Finished, 0));
    // measured: 1.0e-14 of equal masses, RESMAX of 1 : 1000
    assert!(m.residual_max.unwrap() < 1e-8, "{masses:?} {scheme}: {:?}", m.residual_max);
    for (i, at) in ended.state.bodies.iter().enumerate() {
        let place = nalgebra::Vector3::new(0.0, i as f64 + 0.5, 0.0);
        // measured: 1.1e-15 m; 2.2e-12 with masses of 1000
        assert!((at.p_WB - place).norm() < 1e-9, "{masses:?} {scheme}, {i}: {}", at.p_WB);
        let weight: f64 = masses[i..].iter().sum::<f64>() * 9.81;
        let lower = ended.forces.iter().filter(|c| {
            let below = i.checked_sub(1);
            (c.contact.body, c.contact.other) == below.map_or((i, None), |below| (below, Some(i)))
        });
        let borne = lower.map(|c| c.force_W.y.abs()).sum::<f64>();
        // measured: 2.3e-14 relative; 9.5e-10 with a top 1000 ×
        assert!((borne / weight - 1.0).abs() < 1e-9, "{masses:?} {scheme}, {i}: {borne} of {weight}");
    }
}

#[test]
fn a_stack_of_ten_stands_whatever_its_masses() {
    let top = std::array::from_fn(|i| if i == 9 { 1000.0 } else { 1.0 });
    let alternating = std::array::from_fn(|i| if i % 2 == 0 { 1.0 } else { 1000.0 });
    for scheme in SCHEMES {
        for masses in [[1.0; 10], top, alternating] {
            stands(masses, scheme);
        }
    }
}

/// The largest error of sixteen starts within a step's loss of speed, at each step length.
fn fitted_order(scheme: &str, text: &str, body: &str, speed: f64, x: impl Fn(f64) -> f64) -> (f64, Vec<f64>) {
    let steps = [8e-3, 4e-3, 2e-3, 1e-3];
    let errors = steps.map(|h| {
        let error = |shift: i32| {
            let v = speed + f64::from(shift) / 16.0 * 0.3 * 9.81 * h;
            let sets = [
                NEWTON.to_string(),
                format!("method.time-stepping.scheme={scheme}"),
                format!("time.step_s={h}"),
                format!("scene.bodies.{body}.velocity_m_s=[{v}, 0, 0]"),
            ];
            let ended = run(&experiment(text, &sets.each_ref().map(String::as_str)));
            (ended.state.bodies[0].p_WB.x - x(v)).abs()
        };
        (0..16).map(error).fold(0.0, f64::max)
    });
    (order(&steps, &errors), errors.to_vec())
}

#[test]
fn sliding_to_rest_has_order_1_and_with_moreau_2() {
    let text = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.3
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: slab, shape: { box: { size_m: [1, 0.2, 1] } }, mass_kg: 2, position_m: [0, 0.1, 0] }]
method: { time-stepping: {} }
time: { step_s: 0.001, end_s: 1 }
";
    for (scheme, claim) in [("semi-implicit", 1.0), ("moreau", 2.0)] {
        let (order, errors) = fitted_order(scheme, text, "slab", 2.0, |v| v * v / (2.0 * 0.3 * 9.81));
        // measured: 1.00 and 2.02
        assert!((order - claim).abs() < 0.1, "{scheme}: {order} {errors:?}");
    }
}

#[test]
fn slipping_to_rolling_has_order_1_and_with_moreau_2() {
    let text = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.3
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 2, position_m: [0, 0.1, 0] }]
method: { time-stepping: {} }
time: { step_s: 0.001, end_s: 0.6 }
";
    for (scheme, claim) in [("semi-implicit", 1.0), ("moreau", 2.0)] {
        let x = |v: f64| {
            let (rolls, mu_g) = (2.0 * v / (7.0 * 0.3 * 9.81), 0.3 * 9.81);
            12.0 * v * v / (49.0 * mu_g) + 5.0 / 7.0 * v * (0.6 - rolls)
        };
        let (order, errors) = fitted_order(scheme, text, "ball", 2.0, x);
        // measured: 1.00 and 2.00
        assert!((order - claim).abs() < 0.1, "{scheme}: {order} {errors:?}");
    }
}

/// No contact adds energy: e = 0 with any friction, no friction with any e.
#[test]
fn energy_never_rises() {
    let text = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  container: { box: { size_m: [3, 3, 3] } }
  bodies:
    - { name: box, shape: { box: { size_m: [0.8, 0.5, 0.6] } }, mass_kg: 1, position_m: [-0.7, 0.8, 0] }
    - { name: ball, shape: { sphere: { radius_m: 0.3 } }, mass_kg: 2, position_m: [0.5, 0.8, 0] }
  random: { speed_m_s: 3, spin_rad_s: 6 }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.005, end_s: 2 }
";
    for seed in 0..6 {
        for (friction, restitution) in [(0.0, 0.0), (0.4, 0.0), (1.5, 0.0), (0.0, 0.5), (0.0, 1.0)] {
            let sets = [
                format!("seed={seed}"),
                format!("scene.friction={friction}"),
                format!("scene.restitution={restitution}"),
            ];
            let m = measured(text, &sets.each_ref().map(String::as_str));
            // measured: 0, beyond rounding
            assert!(m.energy_rise_max_rel.unwrap() < 1e-12, "{sets:?}: {:?}", m.energy_rise_max_rel);
        }
    }
}

#[test]
fn extremes_are_no_surprise() {
    // A billionth of a second, and a spin of 10⁴ rad/s.
    let tiny = measured(STACK, &["time.step_s=1e-9", "time.end_s=1e-7"]);
    // measured: 9.9e-15
    assert!(tiny.residual_max.unwrap() < 1e-10, "{:?}", tiny.residual_max);
    let spun = "
scene:
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: box, shape: { box: { size_m: [0.8, 0.5, 0.6] } }, mass_kg: 1, position_m: [0, 1, 0], angular_velocity_rad_s: [1e4, 1, 1] }]
method: { time-stepping: { solver: newton } }
time: { step_s: 0.001, end_s: 1 }
";
    let m = measured(spun, &[]);
    // measured: no rise, 0.32 of the energy left by the worst contact solve
    assert_eq!(m.outcome, Outcome::Finished);
    assert!(m.energy_rise_max_rel.unwrap() < 1e-12 && m.contact_gain_max.unwrap() < 1.0 + 1e-12, "{m:?}");
}

#[test]
fn copies_are_the_bodies_that_they_stand_for() {
    let grid = STACK.replace("count: 10, step_m: [0, 1, 0]", "grid: [2, 1, 2], step_m: [2, 1, 3]");
    let written = &experiment(&grid, &["scene.bodies.cube.mass_kg=3"]).scene.bodies;
    let shown: Vec<_> = written.iter().map(|body| (body.name.as_str(), body.position_m, body.mass_kg)).collect();
    let mass = Some(3.0);
    let expected = [
        ("cube[0,0,0]", [0.0, 0.5, 0.0], mass),
        ("cube[0,0,1]", [0.0, 0.5, 3.0], mass),
        ("cube[1,0,0]", [2.0, 0.5, 0.0], mass),
        ("cube[1,0,1]", [2.0, 0.5, 3.0], mass),
    ];
    assert_eq!(shown, expected);
    let pair = "scene.pairs=[{ between: ['cube[1,0,1]', container], friction: 0 }]";
    let (model, _) = build(&experiment(&grid, &[pair])).unwrap();
    assert_eq!([0, 3].map(|i| model.pair(i, None).friction), [0.5, 0.0]);
}

#[test]
fn bodies_that_overlap_at_the_start_are_named() {
    let text = STACK.replace("count: 10, step_m: [0, 1, 0]", "count: 2, step_m: [0, 0.9, 0]");
    let error = gotai::sweep::plan::single_case(&file(&text, &[])).unwrap_err().to_string();
    let wanted = "scene.bodies.cube.position_m: expected no overlap with `cube[1]` at the start, \
                  found cube[0] and cube[1] inside each other by 1.000e-1 m";
    assert!(error.contains(wanted), "{error}");
    assert!(error.starts_with("test.yaml:7:"), "{error}");
}

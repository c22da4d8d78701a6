//! Applied forces, air, pins, and bodies that move as they are told: with every integrator of free motion.

use crate::yaml::{CUBE_IN_BOX, experiment, measured, run};
use gotai::experiment::types::Integrator;
use gotai::integrate::claims::claim;
use gotai::math::order::fit;
use gotai::rows::Measured;
use gotai::run::Ended;
use gotai::state::State;
use nalgebra::{UnitQuaternion, Vector3};

/// Forces of every kind on a body with three different moments of inertia.
const PUSHED: &str = "
scene:
  bodies:
    - { name: bar, shape: none, mass_kg: 2, inertia_kg_m2: [0.2, 0.5, 0.6], velocity_m_s: [1, 0, 2], angular_velocity_rad_s: [0.3, 1, 0.5] }
  air: { linear_drag_n_s_m: 0.4 }
  forces:
    - { body: bar, force_n: [1, 0, 2], at_m: [0.1, 0.2, 0] }
    - { body: bar, force_n: [0, 3, 0], at_m: [0, 0, 0.2], frame: body }
    - { body: bar, torque_n_m: [0.1, 0, 0.2], frame: body, as: { cosine: { frequency_rad_s: 3, phase_rad: 1 } } }
    - { body: bar, force_n: [0, 0, 4], as: { cosine: { frequency_rad_s: 2 } } }
time: { step_s: 0.01, end_s: 1 }
";

const TOP: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  bodies:
    - name: top
      shape: none
      mass_kg: 1
      inertia_kg_m2: [0.1, 0.02, 0.1]
      position_m: [0.5, 0.866, 0]
      orientation: { axis: [0, 0, 1], angle_deg: -30 }
      angular_velocity_body_rad_s: [0, 40, 0]
  pins: [{ body: top, point_m: [0, -1, 0] }]
time: { step_s: 0.01, end_s: 1 }
";

/// Two rods, out of one plane.
const DOUBLE_PENDULUM: &str = "
scene:
  bodies:
    - { name: upper, shape: { box: { size_m: [0.1, 1, 0.1] } }, mass_kg: 1, orientation: { axis: [0, 0, 1], angle_deg: 60 } }
    - name: lower
      shape: { box: { size_m: [0.1, 1, 0.1] } }
      mass_kg: 2
      position_m: [0.9, 0, 0]
      orientation: { axis: [0, 0, 1], angle_deg: 20 }
      angular_velocity_rad_s: [0.5, 1, 0]
  pins:
    - { body: upper, point_m: [0, 0.5, 0] }
    - { body: lower, point_m: [0, 0.5, 0], with: upper }
time: { step_s: 0.01, end_s: 1 }
";

const AIR: &str = "
scene:
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 0.5, velocity_m_s: [20, 10, 0] }]
  air: { density_kg_m3: 1.2, drag_coefficient: 0.47 }
time: { step_s: 0.01, end_s: 1 }
";

const SCENES: [(&str, &str); 4] =
    [("pushed", PUSHED), ("top", TOP), ("double pendulum", DOUBLE_PENDULUM), ("air", AIR)];

const ACCURATE: [&str; 3] = ["method.free.integrator=dop853", "method.free.tolerance=1e-14", "time.step_s=0.005"];

fn accurate(text: &str) -> Ended {
    run(&experiment(text, &ACCURATE))
}

fn stepped(text: &str, integrator: Integrator, step_s: f64) -> State {
    let sets = [format!("method.free.integrator={}", integrator.word()), format!("time.step_s={step_s:e}")];
    run(&experiment(text, &[&sets[0], &sets[1]])).state
}

/// The largest of position, attitude and velocity of all bodies; m, rad and rad/s are of one size here.
fn error(a: &State, b: &State) -> f64 {
    let each = a.bodies.iter().zip(&b.bodies);
    let error = each.map(|(a, b)| (a.p_WB - b.p_WB).norm().max(a.q_WB.angle_to(&b.q_WB)).max((a.w_WB - b.w_WB).norm()));
    error.fold(0.0, f64::max)
}

#[test]
fn every_integrator_keeps_its_order_under_forces_air_and_pins() {
    for (scene, text) in SCENES {
        let reference = accurate(text).state;
        for &integrator in Integrator::ALL {
            let Some(order) = claim(integrator).order.filter(|order| *order < 8) else { continue };
            let coarsest = [1e-3, 2.5e-3, 1e-2, 1e-2][order as usize - 1];
            let points: Vec<(f64, f64)> = (0..4)
                .map(|k| coarsest * 0.5_f64.powi(k))
                .map(|h| (h, error(&stepped(text, integrator, h), &reference)))
                .collect();
            let fitted = fit(&points).unwrap();
            // measured: 1.000 … 1.013, 1.981 … 2.029, 3.921 … 4.113
            let off = fitted.slope - f64::from(order);
            assert!(off.abs() < 0.15, "{scene}, {}: {fitted:?}, {points:?}", integrator.word());
        }
    }
}

#[test]
fn two_methods_agree_on_the_references() {
    for (scene, text) in SCENES {
        let error = error(&stepped(text, Integrator::Rk4, 1e-4), &accurate(text).state);
        // measured: 9.2e-11 (top), 7.2e-13 and less (the others)
        assert!(error < 1e-9, "{scene}: {error:e}");
    }
}

#[test]
fn the_ledgers_know_the_work_and_the_impulse_of_every_force() {
    for (scene, text) in SCENES {
        let m = accurate(text).measured;
        let drifts = [m.energy_drift_rel, m.linear_momentum_drift_rel, m.angular_momentum_drift_rel];
        for drift in drifts.into_iter().flatten() {
            // measured: 5.7e-12 and less (Simpson's rule in steps of 5 ms)
            assert!(drift.abs() < 1e-10, "{scene}: {drifts:?}");
        }
        assert!(m.energy_rise_max_rel.unwrap() < 1e-10, "{scene}: {m:?}");
        assert_eq!(
            m.linear_momentum_drift_rel.is_none(),
            m.pin_gap_max_m.is_some(),
            "a pin to the world takes momentum"
        );
    }
    let euler = measured(PUSHED, &["method.free.integrator=explicit-euler"]);
    // The ledger does not hide what a method gains: measured 2.4e-3.
    assert!(euler.energy_drift_rel.unwrap() > 1e-4, "{euler:?}");
}

#[test]
fn a_heavy_top_keeps_energy_and_momentum_and_its_pin() {
    let m = measured(TOP, &["method.free={integrator: dop853, tolerance: 1e-13}", "time.end_s=10"]);
    let (energy, momentum) = (m.energy_drift_rel.unwrap().abs(), m.angular_momentum_drift_rel.unwrap());
    // measured: 1.0e-15, 2.3e-15
    assert!(energy < 1e-12 && momentum < 1e-12, "{energy:e}, {momentum:e}");
    // measured: 2.6e-15
    assert!(m.pin_gap_max_m.unwrap() < 1e-12, "{m:?}");
}

#[test]
fn pins_hold_with_every_integrator_at_any_step() {
    for (scene, text) in [("top", TOP), ("double pendulum", DOUBLE_PENDULUM)] {
        for integrator in Integrator::ALL.iter().copied().filter(|i| *i != Integrator::Exact) {
            for step in ["0.05", "0.001"] {
                let sets = [format!("method.free.integrator={}", integrator.word()), format!("time.step_s={step}")];
                let gap = measured(text, &[&sets[0], &sets[1]]).pin_gap_max_m.unwrap();
                // measured: 2.2e-15
                assert!(gap < 1e-12, "{scene}, {}: {gap:e}", integrator.word());
            }
        }
    }
}

#[test]
fn bodies_pinned_to_each_other_alone_keep_their_momentum() {
    let text = DOUBLE_PENDULUM.replace("    - { body: upper, point_m: [0, 0.5, 0] }\n", "");
    let m = accurate(&text).measured;
    let drifts = [m.energy_drift_rel, m.linear_momentum_drift_rel, m.angular_momentum_drift_rel];
    // measured: 2.9e-16, 4.2e-15, 2.2e-14
    assert!(drifts.iter().all(|drift| drift.unwrap().abs() < 1e-12), "{drifts:?}");
}

/// Two pins on one body say the same along the line between them.
#[test]
fn two_pins_are_an_axis() {
    let rod =
        "shape: none, mass_kg: 2, inertia_kg_m2: [0.3, 0.2, 0.4], orientation: { axis: [0, 0, 1], angle_deg: 70 }";
    let text = |pins: &str| {
        format!("scene: {{ bodies: [{{ name: rod, {rod} }}], pins: [{pins}] }}\ntime: {{ step_s: 0.01, end_s: 2 }}\n")
    };
    let pin = |z: &str| format!("{{ body: rod, point_m: [0, 0.5, {z}] }}");
    let one = accurate(&text(&pin("0")));
    let two = accurate(&text(&format!("{}, {}", pin("-0.3"), pin("0.4"))));
    // It swings in a plane either way; measured: 5.1e-15
    assert!(error(&one.state, &two.state) < 1e-12, "{:?}, {:?}", one.state, two.state);
    assert!(two.measured.pin_gap_max_m.unwrap() < 1e-12);
    assert_eq!(two.measured.outcome, gotai::outcome::Outcome::Finished);
}

#[test]
fn velocities_follow_from_the_pins_along_a_chain() {
    let link = |i: usize| {
        let v = if i == 0 { "angular_velocity_rad_s: [0, 0, 2]" } else { "angular_velocity_rad_s: [0, 0, -1]" };
        format!(
            "    - {{ name: link{i}, shape: {{ box: {{ size_m: [0.02, 0.2, 0.02] }} }}, mass_kg: 1, position_m: [0, {}, 0], {v} }}\n",
            -0.2 * i as f64 - 0.1
        )
    };
    // Written from the last to the first, so that each waits for the next.
    let pin = |i: usize| match i {
        0 => "    - { body: link0, point_m: [0, 0.1, 0] }\n".to_string(),
        i => format!("    - {{ body: link{i}, point_m: [0, 0.1, 0], with: link{} }}\n", i - 1),
    };
    let (links, pins): (String, String) = ((0..6).map(link).collect(), (0..6).rev().map(pin).collect());
    let text = format!("scene:\n  bodies:\n{links}  pins:\n{pins}time: {{ step_s: 0.01, end_s: 1 }}\n");
    let (_, start) = gotai::scene::build(&experiment(&text, &["method=free"])).unwrap();
    // 0.1 m of each link before the middle of the fourth, 0.2 m of the first at 2 rad/s, of the others at −1 rad/s.
    let expected = Vector3::new(2.0 * 0.2 - 0.2 - 0.2 - 0.1, 0.0, 0.0);
    assert!((start.bodies[3].v_WB - expected).norm() < 1e-15, "{:?}", start.bodies[3]);
    let m = accurate(&text).measured;
    // measured: 7.2e-15, 1.0e-15
    assert!(m.energy_drift_rel.unwrap().abs() < 1e-12 && m.pin_gap_max_m.unwrap() < 1e-12, "{m:?}");
}

#[test]
fn a_kinematic_body_moves_as_it_is_told_and_carries_what_is_pinned_to_it() {
    let text = "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies:
    - { name: arm, shape: none, mass_kg: 1, inertia_kg_m2: [1, 1, 1], position_m: [1, 0, 0],
        kinematic: { velocity_m_s: [0.5, 0, 0], angular_velocity_rad_s: [0, 2, 0] } }
    - { name: ball, shape: none, mass_kg: 3, inertia_kg_m2: [1, 2, 2.5], position_m: [1, 0, 2] }
  pins: [{ body: arm, point_m: [0, 0, 2], with: ball }]
time: { step_s: 0.01, end_s: 1 }
";
    for integrator in [Integrator::Rk4, Integrator::Dop853, Integrator::ImplicitMidpoint, Integrator::SemiImplicitEuler]
    {
        let end = stepped(text, integrator, 0.01);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), 2.0);
        let [arm, ball] = [&end.bodies[0], &end.bodies[1]];
        // measured: 0
        assert!((arm.p_WB - Vector3::new(1.5, 0.0, 0.0)).norm() < 1e-14 && arm.q_WB.angle_to(&turn) < 1e-14);
        let pinned = arm.p_WB + turn * Vector3::new(0.0, 0.0, 2.0);
        // The ball is held at its centre of mass; measured: 1.8e-15
        assert!((ball.p_WB - pinned).norm() < 1e-13, "{}: {ball:?}", integrator.word());
        assert!(
            (ball.v_WB - Vector3::new(0.5, 0.0, 0.0) - Vector3::new(0.0, 2.0, 0.0).cross(&(pinned - arm.p_WB))).norm()
                < 1e-13
        );
    }
}

#[test]
fn a_fixed_body_stays_with_every_method() {
    for method in ["free", "time-stepping"] {
        let sets = [
            format!("method={method}"),
            "scene.bodies.cube.fixed=true".into(),
            "scene.bodies.cube.orientation={axis: [1, 2, 3], angle_deg: 40}".into(),
        ];
        let experiment = experiment(CUBE_IN_BOX, &[&sets[0], &sets[1], &sets[2]]);
        let (_, start) = gotai::scene::build(&experiment).unwrap();
        let ended = run(&experiment);
        assert_eq!(ended.state.bodies, start.bodies, "{method}");
        assert_eq!(ended.measured.energy_drift_rel, Some(0.0));
    }
}

/// φ' = −φ (L2): the trapezoidal rule multiplies by (1 − h/2)/(1 + h/2) at any step, Euler by 1 − h.
#[test]
fn the_decay_is_each_methods_own_recurrence() {
    let text = "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies: [{ name: phi, shape: none, mass_kg: 1, velocity_m_s: [1, 0, 0] }]
  air: { linear_drag_n_s_m: 1 }
time: { step_s: 0.5, end_s: 5 }
";
    for h in [0.1, 0.5, 2.5_f64] {
        let n = (5.0 / h).round() as i32;
        let factors = [
            (Integrator::ExplicitEuler, 1.0 - h),
            (Integrator::SemiImplicitEuler, 1.0 - h),
            (Integrator::CrankNicolson, (1.0 - h / 2.0) / (1.0 + h / 2.0)),
            (Integrator::ImplicitMidpoint, (1.0 - h / 2.0) / (1.0 + h / 2.0)),
            (Integrator::Rk4, 1.0 - h + h * h / 2.0 - h * h * h / 6.0 + h * h * h * h / 24.0),
        ];
        for (integrator, factor) in factors {
            let phi = stepped(text, integrator, h).bodies[0].v_WB.x;
            let expected = factor.powi(n);
            // measured: 5.0e-15
            assert!((phi / expected - 1.0).abs() < 1e-12, "{}, {h}: {phi}, {expected}", integrator.word());
        }
    }
}

#[test]
fn methods_with_contact_feel_applied_forces() {
    // Half of the weight is carried by the force: the floor carries the other half, and without it the cube rises.
    let at_rest = CUBE_IN_BOX
        .replace("  random: { speed_m_s: 4, spin_rad_s: 6, attitude: true }\n", "")
        .replace("[0, 2, 0]", "[0, 0.5, 0]");
    for method in ["time-stepping", "lecture", "{penalty: {stiffness_n_m: 1e5, damping_n_s_m: 100}}"] {
        let end = |force_n: f64| {
            let force = format!("scene.forces=[{{body: cube, force_n: [0, {force_n}, 0]}}]");
            run(&experiment(&at_rest, &[&format!("method={method}"), &force, "time.step_s=0.001"]))
        };
        let (held, lifted) = (end(4.9), end(9.8 + 1.0));
        // measured: 6e-5 (`lecture`)
        assert!((held.state.bodies[0].p_WB.y - 0.5).abs() < 1e-3, "{method}: {:?}", held.state.bodies[0]);
        // ½ · 1 m/s² · 4 s², and half a step of it; measured: 1.0e-3
        assert!((lifted.state.bodies[0].p_WB.y - 2.5).abs() < 2e-3, "{method}: {:?}", lifted.state.bodies[0]);
        assert!(lifted.measured.energy_drift_rel.unwrap().abs() < 1e-3, "{method}: {:?}", lifted.measured);
        if method == "time-stepping" {
            let floor_n: f64 = held.forces.iter().map(|c| c.force_W.y).sum();
            // measured: 4.9 to 2e-12
            assert!((floor_n - 4.9).abs() < 1e-9, "{floor_n}");
            assert!(held.measured.residual_max.unwrap() < 1e-9, "{:?}", held.measured);
        }
    }
}

#[test]
fn a_run_with_forces_that_are_zero_is_the_run_without_them() {
    let nothing = PUSHED.split("  air:").next().unwrap().to_string() + "time: { step_s: 0.01, end_s: 1 }\n";
    let zero = "scene.forces=[{body: bar, force_n: [0, 0, 0], torque_n_m: [0, 0, 0]}]";
    let without_work = |m: Measured| Measured { wall_s: None, ..m };
    for integrator in [Integrator::ExplicitEuler, Integrator::Rk4, Integrator::Dop853, Integrator::CrankNicolson] {
        let set = format!("method.free.integrator={}", integrator.word());
        let [free, loaded] = [run(&experiment(&nothing, &[&set])), run(&experiment(&nothing, &[&set, zero]))];
        assert_eq!(free.state, loaded.state, "{}", integrator.word());
        assert_eq!(without_work(free.measured).energy_end_j, without_work(loaded.measured).energy_end_j);
    }
}

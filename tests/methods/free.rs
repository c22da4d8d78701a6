//! Motion without contact: the slide's projectile (L5), and a body that turns.

use super::order;
use crate::yaml::{FREE_BAR, experiment, measured, run};
use nalgebra::Vector3;

const PROJECTILE: &str = "
scene:
  bodies:
    - { name: ball, shape: none, mass_kg: 0.1, position_m: [0, 100, 0], velocity_m_s: [10, 10, 0] }
time: { step_s: 0.01, end_s: 2 }
";

const METHODS: [(&str, bool); 2] = [("explicit-euler", true), ("semi-implicit-euler", false)];

#[test]
fn the_projectile_is_its_own_recurrence_to_the_last_bits() {
    for (name, explicit) in METHODS {
        let ended = run(&experiment(PROJECTILE, &[&format!("method.free.integrator={name}")]));
        // The slide's C program, by hand.
        let (dt, mut u, mut v) = (0.01, Vector3::new(0.0, 100.0, 0.0), Vector3::new(10.0, 10.0, 0.0));
        for _ in 0..200 {
            let old = v;
            v += Vector3::new(0.0, -9.8, 0.0) * dt;
            u += if explicit { old } else { v } * dt;
        }
        // measured: 0
        assert!((ended.state.bodies[0].p_WB - u).norm() < 1e-12, "{name}");
        assert!((ended.state.bodies[0].v_WB - v).norm() < 1e-12, "{name}");
        assert_eq!((ended.state.step, ended.state.time_s), (200, 2.0));
    }
}

#[test]
fn the_projectile_meets_the_parabola_at_first_order() {
    let exact = Vector3::new(20.0, 100.0 + 20.0 - 0.5 * 9.8 * 4.0, 0.0);
    for (name, _) in METHODS {
        let steps = [0.04, 0.02, 0.01, 0.005, 0.0025];
        let errors = steps.map(|h| {
            let sets = [format!("method.free.integrator={name}"), format!("time.step_s={h}")];
            (run(&experiment(PROJECTILE, &[&sets[0], &sets[1]])).state.bodies[0].p_WB - exact).norm()
        });
        // measured: 1.000000 for both
        assert!((order(&steps, &errors) - 1.0).abs() < 0.02, "{name}: {errors:?}");
    }
}

#[test]
fn a_tumbling_bar_meets_a_finer_run_at_first_order() {
    for (name, _) in METHODS {
        let end = |h: f64| {
            let sets = [format!("method.free.integrator={name}"), format!("time.step_s={h}"), "time.end_s=1".into()];
            run(&experiment(FREE_BAR, &[&sets[0], &sets[1], &sets[2]])).state.bodies[0]
        };
        let reference = end(1e-6);
        let steps = [4e-3, 2e-3, 1e-3, 5e-4];
        let errors = steps.map(|h| end(h).q_WB.angle_to(&reference.q_WB));
        // measured: 1.01 and 0.99
        assert!((order(&steps, &errors) - 1.0).abs() < 0.1, "{name}: {errors:?}");
    }
}

#[test]
fn steps_divide_the_end_time() {
    let m = measured(PROJECTILE, &["method=free", "time.step_s=0.3"]);
    assert_eq!((m.steps, m.step_used_s, m.end_time_s), (7, Some(2.0 / 7.0), Some(2.0)));
    let m = measured(PROJECTILE, &["method=free", "time.step_s=50"]);
    assert_eq!((m.steps, m.step_used_s), (1, Some(2.0)));
}

//! The penalty method's critical step against the eigenvalues of its recurrence.

use super::{close, measured};
use crate::yaml::{CUBE_IN_BOX, experiment};
use gotai::collide::approach::Approach;
use gotai::experiment::types::{Penalty, Rotation, Update};
use gotai::measure::critical_step::critical_step_s;
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::solve::problem::ContactProblem;
use gotai::solve::twist::Twist;
use gotai::step::Stepper;
use nalgebra::SymmetricEigen;
use serde_json::Value;

const PENALTY: &str = "method={ penalty: { stiffness_n_m: 1e4, damping_n_s_m: 20 } }";

fn settings(update: Update, stiffness_n_m: f64, damping_n_s_m: f64) -> Penalty {
    Penalty { stiffness_n_m, damping_n_s_m, slip_speed_m_s: 0.01, update, rotation: Rotation::Momentum }
}

/// Largest |z| of the companion matrix of one mode: [1 − γΔt, −λΔt] for v', then the row of x'.
fn growth(update: Update, lambda: f64, gamma: f64, step: f64) -> f64 {
    let (a, b) = (1.0 - gamma * step, -lambda * step);
    let (c, d) = match update {
        Update::Explicit => (step, 1.0),
        Update::SemiImplicit => (step * a, 1.0 + step * b),
    };
    let (trace, determinant) = (a + d, a * d - b * c);
    let discriminant = trace * trace / 4.0 - determinant;
    if discriminant < 0.0 { determinant.sqrt() } else { trace.abs() / 2.0 + discriminant.sqrt() }
}

/// From no damping to far above the critical one (c √ν = 2 √k), in both updates.
#[test]
fn below_the_critical_step_the_recurrence_decays_and_above_it_grows() {
    for update in [Update::SemiImplicit, Update::Explicit] {
        for normal_lambda in [0.3, 16.0, 400.0] {
            for part in [0.0, 1e-3, 0.1, 0.5, 0.99, 1.01, 2.0, 10.0] {
                let k = 1e4;
                let lambda = k * normal_lambda;
                let c = part * 2.0 * k / f64::sqrt(lambda);
                let step = critical_step_s(&settings(update, k, c), normal_lambda);
                let growth = |factor: f64| growth(update, lambda, c / k * lambda, factor * step);
                let what = format!("{update:?} {normal_lambda} {part}: {step}");
                if step > 0.0 {
                    assert!(growth(0.999) <= 1.0 + 1e-12 && growth(1.001) > 1.0 + 1e-9, "{what}");
                    // measured: 9.7e-14 at most
                    assert!((growth(1.0) - 1.0).abs() < 1e-12, "{what}: {}", growth(1.0));
                } else {
                    // Explicit and undamped: every step grows.
                    assert!(update == Update::Explicit && part == 0.0, "{what}");
                }
            }
        }
    }
    let undamped = critical_step_s(&settings(Update::SemiImplicit, 1e4, 0.0), 16.0);
    // measured: 0
    assert!(close(undamped, 2.0 / 400.0, 1e-15), "{undamped}");
}

/// A lying cube of 4 × 4 nodes a face: the stiffest mode is up and down, 16/m.
#[test]
fn a_lying_cube_has_the_step_of_its_up_and_down_mode() {
    let lying = ["scene.random=null", "scene.bodies.cube.position_m=[0, 0.5, 0]", "measure=[critical-step]"];
    let cube = ["scene.bodies.cube.mesh.nodes_per_edge=4", "time.step_s=1e-3", "time.end_s=0.1"];
    let values = |method: &str| -> Vec<f64> {
        let values = measured(CUBE_IN_BOX, &[&lying[..], &cube, &[method]].concat());
        values.iter().map(|value| value.as_f64().unwrap()).collect()
    };
    let [undamped, damped] = [values("method={ penalty: { stiffness_n_m: 1e4 } }"), values(PENALTY)];
    // measured: 0
    assert!(close(undamped[0], 16.0, 1e-12) && close(undamped[1], 5e-3, 1e-12), "{undamped:?}");
    let semi_implicit = -2e-3 + f64::sqrt(4e-6 + 25e-6);
    // measured: 2.2e-16
    assert!(close(damped[0], 16.0, 1e-12) && close(damped[1], semi_implicit, 1e-12), "{damped:?}");
}

/// The normal rows of the whole matrix in the first step of a contact.
#[test]
fn the_largest_eigenvalue_is_that_of_the_normal_rows() {
    for seed in 0..10 {
        let seed = format!("seed={seed}");
        let sets = ["measure=[critical-step]", PENALTY, "time.step_s=0.001", &seed];
        let experiment = experiment(CUBE_IN_BOX, &sets);
        let (model, mut state) = build(&experiment).unwrap();
        let (clock, plan) = (experiment.clock(), Plan::new(&model, &experiment.method));
        let mut stepper = Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &state);
        let mut before = state.clone();
        while stepper.contacts().is_empty() {
            before = state.clone();
            stepper.step(&model, &mut state, &clock);
        }
        let contacts: Vec<_> = stepper.contacts().iter().map(|solved| solved.contact).collect();
        let mut problem = ContactProblem::default();
        problem.gather(&model, &before, &[Twist::ZERO], &mut contacts.clone(), (Approach::Inside, 0.01));
        let normal: Vec<usize> = (0..contacts.len()).map(|i| 3 * i).collect();
        let A_n = problem.A().select_rows(&normal).select_columns(&normal);
        let exact = SymmetricEigen::new(A_n).eigenvalues.max();
        let values = measured(CUBE_IN_BOX, &sets);
        // measured: 3.3e-16 at most
        assert!(close(values[0].as_f64().unwrap(), exact, 1e-12), "{seed}: {values:?} {exact}");
    }
}

#[test]
fn without_a_contact_no_step_is_critical() {
    let values = measured(CUBE_IN_BOX, &["measure=[critical-step]", PENALTY, "time.end_s=0.01"]);
    assert_eq!(values, [Value::Null, Value::Null]);
}

//! Rank and Jacobi's radius against the whole matrix, 3L × 3L.

use super::{close, columns, measured};
use crate::yaml::{CUBE_IN_BOX, experiment, run};
use gotai::collide::Contact;
use gotai::collide::approach::Approach;
use gotai::experiment::types::Experiment;
use gotai::model::Model;
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::solve::problem::ContactProblem;
use gotai::solve::twist::Twist;
use gotai::state::State;
use gotai::step::Stepper;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// A of the first of these steps with the most contacts.
fn whole_matrix(experiment: &Experiment, steps: u64) -> DMatrix<f64> {
    let (model, mut state) = build(experiment).unwrap();
    let (clock, plan) = (experiment.clock(), Plan::new(&model, &experiment.method));
    let mut stepper = Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &state);
    let mut most: (Vec<Contact>, State) = (Vec::new(), state.clone());
    while state.step < steps {
        let before = state.clone();
        stepper.step(&model, &mut state, &clock);
        if stepper.contacts().len() > most.0.len() {
            most = (stepper.contacts().iter().map(|solved| solved.contact).collect(), before);
        }
    }
    gathered(&model, &most.1, &most.0)
}

fn gathered(model: &Model, before: &State, contacts: &[Contact]) -> DMatrix<f64> {
    let mut problem = ContactProblem::default();
    problem.gather(model, before, &[Twist::ZERO], &mut contacts.to_vec(), (Approach::Inside, 0.01));
    problem.A()
}

fn rank(A: &DMatrix<f64>) -> usize {
    let values = SymmetricEigen::new(A.clone()).eigenvalues;
    values.iter().filter(|value| **value > 1e-9 * values.max()).count()
}

/// Largest |1 − λ| over all eigenvalues of D^(−1/2) A D^(−1/2).
fn jacobi_radius(A: &DMatrix<f64>) -> f64 {
    let root: DVector<f64> = A.diagonal().map(|d| 1.0 / d.sqrt());
    let scaled = DMatrix::from_fn(A.nrows(), A.ncols(), |i, j| A[(i, j)] * root[i] * root[j]);
    SymmetricEigen::new(scaled).eigenvalues.iter().map(|value| (1.0 - value).abs()).fold(0.0, f64::max)
}

#[test]
fn the_columns_are_those_of_the_whole_matrix() {
    let shapes = [
        ("box: { size_m: [1, 1, 1] }", "nodes_per_edge: 2"),
        ("box: { size_m: [0.4, 0.4, 1.6] }", "nodes_per_edge: 4"),
        ("sphere: { radius_m: 0.5 }", "subdivisions: 2"),
    ];
    for (shape, mesh) in shapes {
        for method in ["lecture", "time-stepping"] {
            for seed in 0..5 {
                let sets = [
                    "measure=[contact-matrix]".to_string(),
                    format!("method={method}"),
                    format!("scene.bodies.cube.shape={{ {shape} }}"),
                    format!("scene.bodies.cube.mesh={{ {mesh} }}"),
                    format!("seed={seed}"),
                    "time.step_s=0.002".into(),
                ];
                let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
                let experiment = experiment(CUBE_IN_BOX, &sets);
                let measured = run(&experiment).measured;
                let (values, A) = (columns(&experiment, &measured), whole_matrix(&experiment, measured.steps));
                assert_eq!(values[0].as_u64(), Some(A.nrows() as u64 / 3), "{sets:?}");
                assert_eq!(values[1].as_u64(), Some(rank(&A) as u64), "{sets:?}");
                let (radius, exact) = (values[2].as_f64().unwrap(), jacobi_radius(&A));
                // measured: 3.2e-15
                assert!(close(radius, exact, 1e-11), "{radius} {exact} {sets:?}");
            }
        }
    }
}

/// A cube that lies on n² nodes: rank 6 of 3n² rows, and ρ ≥ L/2 − 1, as the eigenvalues of D⁻¹A sum to 3L.
#[test]
fn jacobis_iteration_grows_with_the_number_of_contacts() {
    for nodes in [2, 3, 5] {
        let mesh = format!("scene.bodies.cube.mesh.nodes_per_edge={nodes}");
        let lying = ["scene.random=null", "scene.bodies.cube.position_m=[0, 0.5, 0]", "time.end_s=0.01"];
        let values = measured(CUBE_IN_BOX, &[&lying[..], &["measure=[contact-matrix]", &mesh]].concat());
        let L = nodes * nodes;
        // measured: 3.24, 7.90, 23.67
        assert_eq!((values[0].as_u64(), values[1].as_u64()), (Some(L), Some(6)));
        assert!(values[2].as_f64().unwrap() >= L as f64 / 2.0 - 1.0);
    }
}

/// A ball touches with one point at a time, whose three rows do not feel each other: A is its own diagonal.
#[test]
fn a_ball_on_one_point_has_rank_3_and_jacobi_solves_it_in_one_sweep() {
    let ball = [
        "scene.random=null",
        "scene.bodies.cube.shape={ sphere: { radius_m: 0.5 } }",
        "scene.bodies.cube.mesh=null",
        "scene.bodies.cube.inertia_from=exact",
        "measure=[contact-matrix]",
    ];
    let values = measured(CUBE_IN_BOX, &ball);
    assert_eq!((values[0].as_u64(), values[1].as_u64()), (Some(1), Some(3)));
    // measured: 8.9e-16
    assert!(values[2].as_f64().unwrap() < 1e-14);
}

#[test]
fn without_a_contact_there_is_no_matrix() {
    let values = measured(CUBE_IN_BOX, &["measure=[contact-matrix]", "method=free"]);
    assert!(values.len() == 3 && values.iter().all(serde_json::Value::is_null), "{values:?}");
}

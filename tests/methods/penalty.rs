//! Spring and damper (L15): the critical step is known in closed form.

use crate::yaml::{experiment, run};
use gotai::clock::Clock;
use gotai::collide::approach::Approach;
use gotai::collide::{Contact, Detector, Reach};
use gotai::model::Model;
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::solve::problem::ContactProblem;
use gotai::solve::twist::Twist;
use gotai::state::State;
use gotai::step::Stepper;
use gotai::work::Work;
use nalgebra::SymmetricEigen;

const STIFFNESS: f64 = 1e4;
const LYING: &str = "
scene:
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 4 }
      mass_kg: 1
      position_m: [0, 0.5, 0]
method: { penalty: { stiffness_n_m: 1e4 } }
time: { step_s: 1e-3, end_s: 1 }
";

/// A cube of `nodes` nodes an edge in its equilibrium, mg/k n_c deep, so that all n_c nodes of the face stay in
/// contact.
fn at_rest(nodes: u32, sets: &[&str]) -> (Stepper, Model, State) {
    let mesh = format!("scene.bodies.cube.mesh.nodes_per_edge={nodes}");
    let experiment = experiment(LYING, &[&[mesh.as_str()], sets].concat());
    let (model, mut state) = build(&experiment).unwrap();
    state.bodies[0].p_WB.y -= 9.8 / (STIFFNESS * f64::from(nodes * nodes));
    let plan = Plan::new(&model, &experiment.method);
    (Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &state), model, state)
}

fn contacts(model: &Model, state: &State) -> Vec<Contact> {
    let (mut found, mut work) = (Vec::new(), Work::default());
    Detector::default().detect(model, state, &Reach::INSIDE, &mut found, &mut work);
    found
}

/// 2/√λmax of k J_n M⁻¹ J_nᵀ over the nodes of the face.
fn critical_step(nodes: u32) -> f64 {
    let (_, model, state) = at_rest(nodes, &[]);
    let mut found = contacts(&model, &state);
    let mut problem = ContactProblem::default();
    problem.gather(&model, &state, &[Twist::ZERO], &mut found, (Approach::Inside, 0.01));
    let normal: Vec<usize> = (0..found.len()).map(|i| 3 * i).collect();
    let A = problem.A();
    let A_n = A.select_rows(&normal).select_columns(&normal);
    2.0 / (STIFFNESS * SymmetricEigen::new(A_n).eigenvalues.max()).sqrt()
}

/// How much a small disturbance of the equilibrium grows in 2000 steps.
fn growth(nodes: u32, step_s: f64, sets: &[&str]) -> f64 {
    const DISTURBANCE: f64 = 1e-9;
    let (mut stepper, model, mut state) = at_rest(nodes, sets);
    state.bodies[0].v_WB.y = DISTURBANCE;
    let clock = Clock { steps: 2000, end_s: 2000.0 * step_s, step_s };
    let mut largest = 0.0_f64;
    while state.step < clock.steps && largest < 1e6 * DISTURBANCE {
        stepper.step(&model, &mut state, &clock);
        largest = largest.max(state.bodies[0].v_WB.norm());
    }
    largest / DISTURBANCE
}

#[test]
fn the_critical_step_of_the_spring_is_two_over_root_lambda() {
    for nodes in [4, 5] {
        let critical = critical_step(nodes);
        // n_c k/m, n_c nodes of the face: 5.00 and 4.00 ms.
        assert!((critical * f64::from(nodes * nodes * 10_000).sqrt() / 2.0 - 1.0).abs() < 1e-9, "{critical}");
        // measured: 7 … 10 below, 1e6 (where it is cut off) above
        let (below, above) = (growth(nodes, 0.99 * critical, &[]), growth(nodes, 1.01 * critical, &[]));
        assert!(below < 50.0 && above >= 1e6, "{nodes} nodes: {below} {above}");
    }
}

/// Damped: the root of λΔt² + 2(c/k)λΔt = 4 (semi-implicit), and c/k while it is small (explicit).
#[test]
fn a_damper_has_a_critical_step_of_its_own() {
    let (c, k, lambda) = (20.0, STIFFNESS, 16.0 * STIFFNESS);
    let damped = format!("method.penalty.damping_n_s_m={c}");
    let ratio: f64 = c / k;
    let semi_implicit = -ratio + (ratio * ratio + 4.0 / lambda).sqrt();
    let explicit = "method.penalty.update=explicit";
    for (critical, sets) in [(semi_implicit, vec![damped.as_str()]), (ratio, vec![damped.as_str(), explicit])] {
        let (below, above) = (growth(4, 0.98 * critical, &sets), growth(4, 1.02 * critical, &sets));
        assert!(below < 50.0 && above >= 1e4, "{sets:?}: {below} {above}");
    }
}

#[test]
fn mass_matters_unless_the_stiffness_follows_it() {
    let end = |mass: f64, stiffness: f64| {
        let sets = [
            format!("scene.bodies.cube.mass_kg={mass}"),
            format!("method.penalty.stiffness_n_m={stiffness}"),
            "scene.bodies.cube.position_m=[0, 1, 0]".into(),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        run(&experiment(LYING, &sets)).state.bodies[0].p_WB
    };
    let one = end(1.0, 1e4);
    assert!((end(3.0, 1e4) - one).norm() > 1e-3);
    assert!((end(3.0, 3e4) - one).norm() < 1e-9);
}

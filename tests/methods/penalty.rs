//! Spring and damper (L15): the critical step is known in closed form.

use crate::yaml::{experiment, measured};
use gotai::collide::detect;
use gotai::measure::work::Work;
use gotai::row::Outcome;
use gotai::solve::problem::ContactProblem;
use nalgebra::SymmetricEigen;

/// A cube lying so deep in its four walls' floor that all nodes of the face stay in contact: the linear regime.
const PRESSED: &str = "
scene:
  gravity_m_s2: [0, -9.8, 0]
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 4 }
      mass_kg: 1
      position_m: [0, 0.5, 0]
      angular_velocity_rad_s: [1e-5, 0, 2e-5]
method: { penalty: { stiffness_n_m: 1e4 } }
time: { step_s: 1e-3, end_s: 3 }
diverge: { energy_factor: 1.5 }
";

/// 2/√λmax of k J_n M⁻¹ J_nᵀ over the nodes of the face.
fn critical_step(nodes: u32) -> f64 {
    let text = PRESSED.replace("method: { penalty: { stiffness_n_m: 1e4 } }", "method: free");
    let sets = [format!("scene.bodies.cube.mesh.nodes_per_edge={nodes}"), "scene.bodies.cube.position_m=[0, 0.499, 0]".into()];
    let (model, state) = gotai::model::build(&experiment(&text, &[&sets[0], &sets[1]])).unwrap();
    let (mut found, mut work) = (Vec::new(), Work::default());
    detect(&model, &state, 0.0, &mut found, &mut work);
    let free = [gotai::solve::problem::Twist::ZERO];
    let mut problem = ContactProblem::default();
    problem.gather(&model, &state, &free, &found);
    let A = problem.A();
    let normal: Vec<usize> = (0..found.len()).map(|i| 3 * i).collect();
    let A_n = A.select_rows(&normal).select_columns(&normal);
    2.0 / (1e4 * SymmetricEigen::new(A_n).eigenvalues.max()).sqrt()
}

#[test]
fn the_critical_step_of_the_spring_is_two_over_root_lambda() {
    for nodes in [4, 5] {
        let critical = critical_step(nodes);
        // n_c k/m, n_c nodes of the face: 5.00 and 4.00 ms.
        assert!((critical - 2.0 / f64::from(nodes * nodes * 10_000).sqrt()).abs() < 1e-12, "{critical}");
        let outcome = |step: f64| {
            let sets = [format!("scene.bodies.cube.mesh.nodes_per_edge={nodes}"), format!("time.step_s={step}")];
            // Deep enough that no node leaves.
            measured(PRESSED, &[&sets[0], &sets[1], "scene.gravity_m_s2=[0, -980, 0]"]).outcome
        };
        assert_eq!(outcome(0.99 * critical), Outcome::Finished, "{nodes} nodes, below");
        assert_eq!(outcome(1.01 * critical), Outcome::Diverged, "{nodes} nodes, above");
    }
}

#[test]
fn mass_matters_unless_the_stiffness_follows_it() {
    let end = |mass: f64, stiffness: f64| {
        let sets = [
            format!("scene.bodies.cube.mass_kg={mass}"),
            format!("method.penalty.stiffness_n_m={stiffness}"),
            "scene.bodies.cube.position_m=[0, 1, 0]".into(),
            "diverge.energy_factor=1000".into(),
        ];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        crate::yaml::run(&experiment(PRESSED, &sets)).state.bodies[0].p_WB
    };
    let one = end(1.0, 1e4);
    assert!((end(3.0, 1e4) - one).norm() > 1e-3);
    assert!((end(3.0, 3e4) - one).norm() < 1e-9);
}

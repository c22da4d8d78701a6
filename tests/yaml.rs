//! Experiments from a few lines of YAML.

use gotai::experiment::ExperimentFile;
use gotai::experiment::types::Experiment;
use gotai::rows::Measured;
use gotai::run::Ended;
use gotai::study::{self, Place};
use gotai::sweep::plan;
use std::path::Path;

pub fn file(text: &str, sets: &[&str]) -> ExperimentFile {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    ExperimentFile::from_text(Path::new("test.yaml"), text, &sets).unwrap_or_else(|error| panic!("{error}"))
}

pub fn experiment(text: &str, sets: &[&str]) -> Experiment {
    plan::single_case(&file(text, sets)).unwrap_or_else(|error| panic!("{error}")).experiment
}

/// Runs without recorders.
pub fn run(experiment: &Experiment) -> Ended {
    let (model, start) = gotai::scene::build(experiment).unwrap();
    study::measure(experiment, &model, start, &Place::default()).ended
}

pub fn measured(text: &str, sets: &[&str]) -> Measured {
    run(&experiment(text, sets)).measured
}

/// The lecture's scene: a cube thrown into a box.
pub const CUBE_IN_BOX: &str = "
scene:
  friction: 0.3
  container: { box: { size_m: [4, 4, 4] } }
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 3 }
      mass_kg: 1.0
      inertia_from: lumped
      position_m: [0, 2, 0]
  random: { speed_m_s: 4, spin_rad_s: 6, attitude: true }
seed: 3
time: { step_s: 0.01, end_s: 2.0 }
";

/// A bar turning freely, without gravity.
pub const FREE_BAR: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies:
    - name: bar
      shape: { box: { size_m: [0.4, 0.8, 1.6] } }
      mass_kg: 2
      angular_velocity_rad_s: [0.3, 4, 0.5]
time: { step_s: 0.01, end_s: 10 }
";

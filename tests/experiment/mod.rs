//! The experiment file: `good.rs` reads, `bad.rs` refuses, `sets.rs` overrides, `axes.rs` sweeps, `flags.rs` sweeps
//! from the command line, `extends.rs` stands on another file, `written.rs` writes what was read.

mod axes;
mod bad;
mod extends;
mod flags;
mod good;
mod ids;
mod sets;
mod written;

use gotai::experiment::types::Experiment;
use gotai::experiment::{ExperimentError, ExperimentFile, Given};
use std::path::Path;

/// A file without faults whose lines the tests count on: change it at its end only.
pub const BASE: &str = "\
scene:
  friction: 0.3
  container:
    box:
      size_m: [4, 4, 4]
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 3 }
      mass_kg: 1.0
      position_m: [0, 2, 0]
    - name: point
      shape: none
      mass_kg: 0.5
seed: 7
method: lecture
time:
  step_s: 0.01
  end_s: 1.0
";

pub fn file(text: &str, sets: &[&str]) -> Result<ExperimentFile, ExperimentError> {
    let sets: Vec<String> = sets.iter().map(|set| set.to_string()).collect();
    ExperimentFile::from_text(Path::new("a.yaml"), text, &sets)
}

/// `--axis …` is an axis, all else a set.
pub fn flagged(text: &str, flags: &[&str]) -> Result<ExperimentFile, ExperimentError> {
    let given = |flag: &&str| match flag.strip_prefix("--axis ") {
        Some(axis) => Given::Axis(axis.to_string()),
        None => Given::Set(flag.to_string()),
    };
    ExperimentFile::from_text_given(Path::new("a.yaml"), text, &flags.iter().map(given).collect::<Vec<_>>())
}

pub fn experiment(text: &str, sets: &[&str]) -> Result<Experiment, ExperimentError> {
    file(text, sets)?.experiment()
}

/// `BASE` and a sweep of these lines.
pub fn swept(lines: &str) -> String {
    format!("{BASE}sweep:\n  axes:\n{lines}")
}

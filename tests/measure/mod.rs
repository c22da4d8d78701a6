//! Columns that `measure:` adds, each against another way to its number; the judge of geometry, against another library
//! and faults made by hand.

mod books;
mod broken;
mod contact_matrix;
mod critical_step;
mod geometry;
mod inertia;
mod overlap;
mod sensitivity;
mod squeezed;

use crate::yaml::experiment;
use gotai::experiment::types::Experiment;
use gotai::measure::more;
use gotai::rows::Measured;
use serde_json::Value;

/// The columns of a finished run, whose names were known before it.
fn columns(experiment: &Experiment, measured: &Measured) -> Vec<Value> {
    let names: Vec<&str> = measured.more.keys().map(String::as_str).collect();
    assert_eq!(names, more::names(experiment));
    measured.more.values().cloned().collect()
}

fn measured(text: &str, sets: &[&str]) -> Vec<Value> {
    let experiment = experiment(text, sets);
    columns(&experiment, &crate::yaml::run(&experiment).measured)
}

/// Parts of a number, not of zero.
fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * b.abs()
}

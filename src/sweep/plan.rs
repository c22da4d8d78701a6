//! All cases of an experiment file, in plan order, each resolved and checked before the first run.

use crate::case::Case;
use crate::experiment::{ExperimentError, ExperimentFile};
use crate::model;
use rayon::prelude::*;
use serde_json::Map;

/// Resolves every point of the grid, and builds its model once to find what only geometry shows (overlap).
///
/// # Errors
/// The first wrong case in plan order.
pub fn cases(file: &ExperimentFile) -> Result<Vec<Case>, ExperimentError> {
    (0..file.axes().len()).into_par_iter().map(|index| case(file, index)).collect::<Vec<_>>().into_iter().collect()
}

/// The one case of a file without axes.
///
/// # Errors
/// Axes are left, or the experiment is wrong.
pub fn single_case(file: &ExperimentFile) -> Result<Case, ExperimentError> {
    checked(file, &[], Case::new(file.experiment()?, Map::new()))
}

fn case(file: &ExperimentFile, index: usize) -> Result<Case, ExperimentError> {
    let axes = file.axes();
    let point = axes.point(index);
    let columns = axes.axes.iter().zip(&point).map(|(axis, &value)| (axis.path.clone(), axis.values[value].cell()));
    checked(file, &point, Case::new(file.case(&point)?, columns.collect()))
}

fn checked(file: &ExperimentFile, point: &[usize], case: Case) -> Result<Case, ExperimentError> {
    match model::build(&case.experiment) {
        Ok(_) => Ok(case),
        Err(error) => Err(file.error_at(point, &error.path, &error.expected, &error.found)),
    }
}

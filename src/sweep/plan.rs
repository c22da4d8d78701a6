//! All cases of an experiment file, in plan order, each resolved and checked before the first run.

use super::build::{build, columns};
use super::planned::Planned;
use super::search;
use crate::build_info::{BUILD, PROGRAM};
use crate::case::Case;
use crate::digest::sha256;
use crate::experiment::{ExperimentError, ExperimentFile};
use crate::rows::plan_file::{PlanAxis, PlanCase, PlanFile};
use rayon::prelude::*;
use serde_json::{Map, json};

/// Resolves every point of the grid, and builds its model once to find what only geometry shows (overlap).
///
/// # Errors
/// The first wrong case in plan order.
pub fn cases(file: &ExperimentFile) -> Result<Vec<Planned>, ExperimentError> {
    if let Some(search) = file.search() {
        return search::cases(file, search);
    }
    (0..file.axes().len()).into_par_iter().map(|index| case(file, index)).collect::<Vec<_>>().into_iter().collect()
}

/// The one case of a file without axes.
///
/// # Errors
/// Axes are left, or the experiment is wrong.
pub fn single_case(file: &ExperimentFile) -> Result<Case, ExperimentError> {
    checked(file, &[], Case::new(file.experiment()?, Map::new()))
}

fn case(file: &ExperimentFile, index: usize) -> Result<Planned, ExperimentError> {
    let axes = file.axes();
    let point = axes.point(index);
    checked(file, &point, Case::new(file.case(&point)?, columns(axes, &point).collect())).map(Planned::from)
}

fn checked(file: &ExperimentFile, point: &[usize], case: Case) -> Result<Case, ExperimentError> {
    build(file, point, &case.experiment)?;
    Ok(case)
}

/// The plan of these cases, as its file says it.
pub fn plan_file(cases: &[Planned]) -> PlanFile {
    let mut axes: Vec<PlanAxis> = Vec::new();
    for (path, value) in cases.iter().flat_map(|planned| &planned.case.axes) {
        match axes.iter_mut().find(|axis| axis.path == *path) {
            Some(axis) if axis.values.contains(value) => {}
            Some(axis) => axis.values.push(value.clone()),
            None => axes.push(PlanAxis { path: path.clone(), values: vec![value.clone()] }),
        }
    }
    let cases: Vec<_> =
        cases.iter().map(|Planned { case, .. }| PlanCase { case: case.id.clone(), at: case.axes.clone() }).collect();
    let hash = sha256(json!([&axes, &cases]).to_string(), 8);
    PlanFile { program: PROGRAM.to_string(), build: BUILD.to_string(), hash, axes, cases }
}

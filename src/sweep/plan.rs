//! All cases of an experiment file, in plan order, each resolved and checked before the first run.

use super::search;
use crate::build_info::{BUILD, PROGRAM};
use crate::case::{Case, hex};
use crate::exact::{self, Reference};
use crate::experiment::axes::Axes;
use crate::experiment::types::Experiment;
use crate::experiment::{ExperimentError, ExperimentFile};
use crate::model::{self, BuildError, Model};
use crate::state::State;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use sha2::{Digest, Sha256};

/// Resolves every point of the grid, and builds its model once to find what only geometry shows (overlap).
///
/// # Errors
/// The first wrong case in plan order.
pub fn cases(file: &ExperimentFile) -> Result<Vec<Case>, ExperimentError> {
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

fn case(file: &ExperimentFile, index: usize) -> Result<Case, ExperimentError> {
    let axes = file.axes();
    let point = axes.point(index);
    checked(file, &point, Case::new(file.case(&point)?, columns(axes, &point).collect()))
}

/// A point of the axes as the result columns show it.
pub(super) fn columns(axes: &Axes, point: &[usize]) -> impl Iterator<Item = (String, Value)> {
    axes.axes.iter().zip(point).map(|(axis, &value)| (axis.path.clone(), axis.values[value].cell()))
}

fn checked(file: &ExperimentFile, point: &[usize], case: Case) -> Result<Case, ExperimentError> {
    build(file, point, &case.experiment)?;
    Ok(case)
}

/// The model and first state of the experiment at `point` (empty without axes).
///
/// # Errors
/// What only geometry shows, with the place in the file.
pub fn build(
    file: &ExperimentFile,
    point: &[usize],
    experiment: &Experiment,
) -> Result<(Model, State), ExperimentError> {
    let placed = |e: BuildError| file.error_at(point, &e.path, &e.expected, &e.found);
    let (model, start) = model::build(experiment).map_err(placed)?;
    for (path, exact) in exact::named(experiment) {
        let lacking =
            |lacks| file.error_at(point, path, &format!("a scene with {lacks}"), &format!("`{}`", exact.word()));
        let until_s = Reference::new(exact, &model, &start).map_err(lacking)?.holds_until_s();
        if experiment.time.end_s > until_s {
            let expected = format!("at most {until_s}, up to where the closed form `{}` holds", exact.word());
            return Err(file.error_at(point, "time.end_s", &expected, &experiment.time.end_s.to_string()));
        }
    }
    Ok((model, start))
}

/// What `plan.json` says.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PlanFile {
    pub program: String,
    pub build: String,
    /// Of the axes and the case ids.
    pub hash: String,
    pub axes: Vec<PlanAxis>,
    /// Case ids with their values on the axes, in plan order.
    pub cases: Vec<PlanCase>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PlanAxis {
    pub path: String,
    pub values: Vec<Value>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PlanCase {
    pub case: String,
    pub at: Map<String, Value>,
}

impl PlanFile {
    pub fn new(cases: &[Case]) -> Self {
        let mut axes: Vec<PlanAxis> = Vec::new();
        for (path, value) in cases.iter().flat_map(|case| &case.axes) {
            match axes.iter_mut().find(|axis| axis.path == *path) {
                Some(axis) if axis.values.contains(value) => {}
                Some(axis) => axis.values.push(value.clone()),
                None => axes.push(PlanAxis { path: path.clone(), values: vec![value.clone()] }),
            }
        }
        let cases: Vec<_> = cases.iter().map(|c| PlanCase { case: c.id.clone(), at: c.axes.clone() }).collect();
        let digest = Sha256::digest(json!([&axes, &cases]).to_string());
        PlanFile { program: PROGRAM.to_string(), build: BUILD.to_string(), hash: hex(&digest[..8]), axes, cases }
    }
}

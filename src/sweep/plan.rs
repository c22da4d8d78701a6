//! All cases of an experiment file, in plan order, each resolved and checked before the first run.

use super::build::{build, columns};
use super::kept::{EXPERIMENT, read_plan};
use super::planned::Planned;
use super::search;
use crate::build_info::{BUILD, PROGRAM};
use crate::case::Case;
use crate::digest::sha256;
use crate::exact;
use crate::experiment::axes::Axis;
use crate::experiment::types::Experiment;
use crate::experiment::{ExperimentError, ExperimentFile};
use crate::record::name::RecordingName;
use crate::rows::plan_file::{FORMAT, PlanAxis, PlanFile};
use crate::scene;
use rayon::prelude::*;
use serde_json::{Map, json};
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::{Arc, PoisonError, RwLock};

/// A sweep as it is planned.
#[derive(Clone, Debug)]
pub struct SweepPlan {
    pub cases: Vec<Planned>,
    pub file: PlanFile,
    /// Text of the experiment file that it follows from: what is set, and what it extends, written in.
    pub written: String,
}

impl SweepPlan {
    /// Plan of a file. Every point of the grid is resolved, and its model built once to find what only geometry shows
    /// (overlap).
    ///
    /// # Errors
    /// The first wrong case in plan order.
    pub fn new(file: &ExperimentFile) -> Result<Self, ExperimentError> {
        let plan = Self::unbuilt(file, &config_name(file))?;
        // A search has built both ends of its brackets.
        if file.search().is_none() {
            let check = |planned: &Planned| build(file, &planned.point, &planned.case.experiment).map(drop);
            let unlike = unlike(&plan.cases);
            in_parallel(unlike.len(), |i| check(unlike[i])).into_iter().collect::<Result<(), _>>()?;
        }
        Ok(plan)
    }

    /// Plan of a file that was called `config`, without building a model.
    ///
    /// # Errors
    /// The first wrong case in plan order.
    pub fn unbuilt(file: &ExperimentFile, config: &str) -> Result<Self, ExperimentError> {
        let mut cases = match file.search() {
            Some(search) => search::cases(file, search, config)?,
            None => {
                let likes = Likes::of(file);
                let case = |index| case(&likes, file.axes().point(index), config);
                in_parallel(file.axes().len(), case).into_iter().collect::<Result<Vec<_>, _>>()?
            }
        };
        tell_apart(&mut cases, file, config);
        Ok(SweepPlan { file: plan_file(file, &cases, config), written: file.written(), cases })
    }

    /// Plan of the one case of a file without axes, built once.
    ///
    /// # Errors
    /// Axes are left, or the experiment is wrong.
    pub fn single(file: &ExperimentFile) -> Result<Self, ExperimentError> {
        if let Err(left) = file.refuse_any_axis() {
            // What is wrong in any case is said first: no axis that is fixed would mend it.
            if file.search().is_none() {
                file.case(&file.axes().point(0))?;
            }
            return Err(left);
        }
        Self::new(file)
    }
}

/// The cases that building may find something wrong with: those like one before them, in what building looks at, are
/// left out.
fn unlike(cases: &[Planned]) -> Vec<&Planned> {
    let is_like = |before: &Planned, planned: &Planned| {
        let experiment = &planned.case.experiment;
        before.case.experiment.scene.is_one_with(&experiment.scene)
            && scene::is_sound_whatever_the_seed(experiment)
            && exact::named(experiment).is_empty()
    };
    (0..cases.len()).filter(|i| *i == 0 || !is_like(&cases[i - 1], &cases[*i])).map(|i| &cases[i]).collect()
}

/// The cases of a file, each built once.
///
/// # Errors
/// The first wrong case in plan order.
pub fn cases(file: &ExperimentFile) -> Result<Vec<Planned>, ExperimentError> {
    Ok(SweepPlan::new(file)?.cases)
}

/// The one case of a file without axes, built once.
///
/// # Errors
/// Axes are left, or the experiment is wrong.
pub fn single_case(file: &ExperimentFile) -> Result<Case, ExperimentError> {
    let case = Case::new(file.experiment()?, Map::new());
    build(file, &[], &case.experiment)?;
    Ok(case)
}

/// What is made of every index, on all threads; of a single one no thread is woken.
fn in_parallel<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
    if count <= 1 { (0..count).map(make).collect() } else { (0..count).into_par_iter().map(make).collect() }
}

fn case(likes: &Likes, point: Vec<usize>, config: &str) -> Result<Planned, ExperimentError> {
    let file = likes.file;
    let case = Case::new(likes.case(&point)?, columns(file.axes(), &point).collect());
    Ok(Planned::new(file, case, point, config))
}

/// Cases of a file, of which those that differ by seed or step alone are read once and share their scene.
struct Likes<'a> {
    file: &'a ExperimentFile,
    has_light_axes: bool,
    known: RwLock<HashMap<Vec<usize>, Arc<Experiment>>>,
}

impl<'a> Likes<'a> {
    fn of(file: &'a ExperimentFile) -> Self {
        Likes { file, has_light_axes: file.has_light_axes(), known: RwLock::default() }
    }

    fn case(&self, point: &[usize]) -> Result<Experiment, ExperimentError> {
        if !self.has_light_axes {
            return self.file.case(point);
        }
        let likeness = self.file.likeness(point);
        let known = self.known.read().unwrap_or_else(PoisonError::into_inner).get(&likeness).cloned();
        if let Some(case) = known.as_ref().and_then(|known| self.file.case_like(known, point)) {
            return Ok(case);
        }
        let case = self.file.case(point)?;
        if known.is_some() {
            return Ok(case);
        }
        let mut known = self.known.write().unwrap_or_else(PoisonError::into_inner);
        let first = known.entry(likeness).or_insert_with(|| Arc::new(case.clone()));
        // Another thread may have been the first.
        Ok(self.file.case_like(first, point).unwrap_or(case))
    }
}

/// Gives the later of two cases of a plan that would share a name (values that were cut, ids that begin alike) all
/// digits of its id.
fn tell_apart(cases: &mut [Planned], file: &ExperimentFile, config: &str) {
    let mut digits: Vec<u32> = cases.iter().map(|planned| begins(&planned.case.id)).collect();
    digits.sort_unstable();
    let is_seen_twice = |id: &str| {
        let at = digits.partition_point(|known| *known < begins(id));
        digits.get(at + 1) == digits.get(at)
    };
    let mut seen = HashSet::new();
    for planned in cases.iter_mut().filter(|planned| is_seen_twice(&planned.case.id)) {
        if !seen.insert(planned.name.begun()) {
            planned.with_whole_id(file, config);
        }
    }
}

/// The digits of an id that names hold, as a number.
fn begins(id: &str) -> u32 {
    u32::from_str_radix(&id[..RecordingName::DIGITS], 16).unwrap_or_default()
}

/// Name of the file, without folders and ending; of a recording, its values; of what a folder of results keeps, what
/// that was called.
fn config_name(file: &ExperimentFile) -> String {
    if let Some(plan) = plan_beside(file.path()) {
        return plan.name;
    }
    let stem = file.path().file_stem().map_or_else(|| "run".into(), |stem| stem.to_string_lossy());
    RecordingName::values_of(&stem).unwrap_or(&stem).to_string()
}

fn plan_beside(path: &Path) -> Option<PlanFile> {
    let is_kept = path.file_name().is_some_and(|name| name == EXPERIMENT);
    is_kept.then(|| read_plan(path.parent()?).ok())?
}

fn plan_file(file: &ExperimentFile, cases: &[Planned], name: &str) -> PlanFile {
    let over = file.search().and_then(|search| search.over);
    let all = &file.axes().axes;
    let axis = |axis: &Axis| PlanAxis {
        path: axis.path.clone(),
        values: axis.values.iter().map(|value| value.cell()).collect(),
    };
    let axes: Vec<_> = (0..all.len()).filter(|i| Some(*i) != over).map(|i| axis(&all[i])).collect();
    let together = file.axes().groups.iter().filter(|group| group.len() > 1);
    let ids: Vec<&str> = cases.iter().map(|planned| planned.case.id.as_str()).collect();
    PlanFile {
        format: FORMAT,
        program: PROGRAM.to_string(),
        build: BUILD.to_string(),
        name: name.to_string(),
        question: cases.first().and_then(|first| first.case.experiment.question.clone()),
        hash: sha256(json!([&axes, ids]).to_string(), 8),
        rows: cases.len(),
        axes,
        together: together.map(|group| group.iter().map(|axis| all[*axis].path.clone()).collect()).collect(),
        search: file.search().map(|search| search.critical.clone()),
    }
}

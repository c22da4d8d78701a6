//! Critical value of a key in one cell of the axes, by bisection.

use super::build::build;
use crate::experiment::axes::{decimal, float};
use crate::experiment::predicate::Predicate;
use crate::experiment::search::Search;
use crate::experiment::types::Experiment;
use crate::experiment::{ExperimentError, ExperimentFile, Number};
use crate::outcome::Outcome;
use crate::rows::Measured;
use crate::rows::columns::{self, SEARCH};
use crate::study::{self, Place};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

/// Cell of the other axes, in which a critical value is searched.
#[derive(Clone, Debug)]
pub struct Cell {
    pub(super) file: Arc<ExperimentFile>,
    pub(super) search: Search,
    /// Points of the axes that are tried together.
    pub(super) members: Vec<Vec<usize>>,
    /// Whether the key takes whole numbers only.
    pub(super) whole: bool,
}

/// Runs at one value of the key.
struct Trial {
    value: Number,
    reached: bool,
    /// Measurements of the first member.
    measured: Measured,
}

impl Cell {
    /// Text of what a row of this cell depends on beside its experiments.
    pub fn rule(&self) -> String {
        let Search { critical, until, fraction, relative_width, .. } = &self.search;
        format!("{critical} until {until} in {fraction} to {relative_width}")
    }

    /// Number of runs that a bracket of this width takes, about.
    pub fn expected_runs(&self) -> usize {
        let [low, high] = self.search.between.each_ref().map(float);
        let width = if low > 0.0 { libm::log(high / low) } else { 1.0 };
        let halvings = libm::log2(width / self.search.relative_width).max(0.0).ceil();
        self.members.len() * (2 + halvings as usize)
    }

    /// The experiment that a row's columns are of: its first run at `search_low`, or at the bracket's lower end where
    /// the row has none.
    ///
    /// # Errors
    /// The experiment is wrong.
    pub fn shown_by(&self, row: &Measured) -> Result<Experiment, ExperimentError> {
        let low = row.more.get("search_low").and_then(|low| match low.as_i64() {
            Some(whole) => Some(Number::from(whole)),
            None => low.as_f64().map(Number::from),
        });
        self.file.searched_case(&self.members[0], low.as_ref().unwrap_or(&self.search.between[0]))
    }

    /// Row of the cell, by bisection. Its other columns are those of the run at `search_low`, or at the bracket's lower
    /// end where there is none; `wall_s` is that of all runs. References are kept in the folder.
    pub fn bisect(&self, dir: &Path) -> Measured {
        self.try_bisect(dir).unwrap_or_else(|error| Measured::failed(error.to_string()))
    }

    fn try_bisect(&self, dir: &Path) -> Result<Measured, ExperimentError> {
        let [low, high] = &self.search.between;
        let (mut low, mut high) = (self.try_at(low, dir)?, self.try_at(high, dir)?);
        let (mut tried, mut wall_s) = (2, low.wall_s() + high.wall_s());
        if low.reached == high.reached {
            return Ok(match low.reached {
                true => self.row(low.measured, [Value::Null, json!(low.value)], tried, wall_s, "below"),
                false => self.row(high.measured, [json!(high.value), Value::Null], tried, wall_s, "above"),
            });
        }
        while let Some(middle) = self.between(float(&low.value), float(&high.value)) {
            let trial = self.try_at(&middle, dir)?;
            tried += 1;
            wall_s += trial.wall_s();
            let end = if trial.reached == low.reached { &mut low } else { &mut high };
            *end = trial;
        }
        Ok(self.row(low.measured, [json!(low.value), json!(high.value)], tried, wall_s, "found"))
    }

    fn try_at(&self, value: &Number, dir: &Path) -> Result<Trial, ExperimentError> {
        let run = |point: &Vec<usize>| self.file.searched_case(point, value).and_then(|e| self.run(&e, point, dir));
        let runs = self.members.par_iter().map(run).collect::<Vec<_>>();
        let runs = runs.into_iter().collect::<Result<Vec<_>, _>>()?;
        let holds = runs.iter().filter(|measured| is_true(&self.search.until, measured)).count();
        let wall_s = runs.iter().filter_map(|measured| measured.wall_s).sum();
        let reached = holds as f64 >= self.search.fraction * runs.len() as f64;
        let mut measured = runs.into_iter().next().unwrap_or_default();
        measured.wall_s = Some(wall_s);
        Ok(Trial { value: value.clone(), reached, measured })
    }

    fn run(&self, experiment: &Experiment, point: &[usize], dir: &Path) -> Result<Measured, ExperimentError> {
        let (model, start) = build(&self.file, point, experiment)?;
        let place = Place { references: Some(dir), recording: None };
        Ok(study::measure(experiment, &model, start, &place).ended.measured)
    }

    /// Value to try next; None where the bracket is narrow enough.
    fn between(&self, low: f64, high: f64) -> Option<Number> {
        if self.whole {
            let middle = ((low + high) / 2.0).floor();
            return (middle > low && middle < high).then(|| Number::from(middle as i64));
        }
        let is_wide = high - low > self.search.relative_width * low.abs().max(high.abs());
        let middle = decimal(if low > 0.0 { (low * high).sqrt() } else { (low + high) / 2.0 });
        (is_wide && middle > low && middle < high).then(|| Number::from(middle))
    }

    fn row(&self, mut row: Measured, ends: [Value; 2], tried: usize, wall_s: f64, verdict: &str) -> Measured {
        let [low, high] = ends;
        let found = [low, high, json!(tried * self.members.len()), json!(verdict)];
        row.more.extend(columns::names(&SEARCH).into_iter().zip(found));
        row.wall_s = Some(wall_s);
        row
    }
}

impl Trial {
    fn wall_s(&self) -> f64 {
        self.measured.wall_s.unwrap_or_default()
    }
}

/// A number that is no longer there (a diverged run's energy) is beyond every bound.
fn is_true(until: &Predicate, measured: &Measured) -> bool {
    let row = serde_json::to_value(measured).unwrap_or_default();
    until.holds(|name| row.get(name)).unwrap_or(measured.outcome != Outcome::Finished)
}

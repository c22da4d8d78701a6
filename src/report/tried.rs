//! What a method did at one step or tolerance: rows of a bench as they are, of a sweep the medians over its other axes.

use super::frame::RowFrame;
use super::stats::median;
use super::subject::{Ground, Levels};
use crate::rows::trials::Trial;

/// A trial, and where it is from.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    pub trial: Trial,
    /// The row, where it is one.
    pub row: Option<usize>,
    /// Number of rows that it is the median of.
    pub rows: usize,
    /// What it was tried on, where that differs: only trials of one problem compete.
    pub problem: String,
}

/// Errors that a sweep's rows are compared by, the first of which there is one.
const ERRORS: [&str; 4] =
    ["error_position_m", "error_orientation_rad", "error_velocity_m_s", "error_angular_velocity_rad_s"];

/// Of the largest error of any kind: one that nowhere exceeds it is rounding.
const ROUNDING: f64 = 1e-6;

/// Most series of a figure.
const MOST_SERIES: usize = 10;

/// Axes that tell the series of a figure apart, and those of problems of which only the first value has room: a median
/// over problems would be an error that no run has.
struct Series<'a> {
    by: Vec<&'a Levels>,
    alone: Vec<&'a Levels>,
}

impl<'a> Series<'a> {
    fn of(ground: &'a Ground) -> Self {
        let mut by: Vec<&Levels> = ground.chosen().filter(|axis| !axis.is_step() && !axis.is_tolerance()).collect();
        let mut alone = Vec::new();
        while by.iter().map(|axis| axis.len()).product::<usize>() > MOST_SERIES {
            let Some(last) = by.iter().rposition(|axis| !axis.is_of_methods()) else { break };
            alone.push(by.remove(last));
        }
        Series { by, alone }
    }

    /// Number of series.
    fn len(&self) -> usize {
        self.by.iter().map(|axis| axis.len()).product()
    }
}

fn accuracy<'a>(ground: &'a Ground) -> Vec<&'a Levels> {
    ground.axes.iter().filter(|axis| axis.is_step() || axis.is_tolerance()).collect()
}

/// What the trials of rows are alone of, in sentences; empty where they are of all.
pub fn alone(ground: &Ground) -> String {
    if !ground.subject.trials.is_empty() || accuracy(ground).is_empty() {
        return String::new();
    }
    let series = Series::of(ground);
    let of = |axis: &&Levels| format!(" Of {} alone, of {} values.", axis.says(0), axis.len());
    let mut said: String = series.alone.iter().map(of).collect();
    if series.len() > MOST_SERIES {
        said += &format!(" The first {MOST_SERIES} of {} series.", series.len());
    }
    said
}

/// Trials of a subject: those that it has, else those that its rows make.
pub fn trials(ground: &Ground) -> Vec<Tried> {
    let known = &ground.subject.trials;
    if !known.is_empty() {
        let tried = |(row, trial): (usize, &Trial)| {
            let row = (ground.subject.is_bench && row < ground.frame().rows()).then_some(row);
            Tried { trial: labelled(trial.clone()), row, rows: 1, problem: String::new() }
        };
        return known.iter().enumerate().map(tried).collect();
    }
    of_rows(ground).unwrap_or_default()
}

/// A trial whose method says which program it is of, if it is not ours.
fn labelled(mut trial: Trial) -> Trial {
    if trial.engine != "gotai" {
        trial.method = format!("{} {}", trial.engine, trial.method).trim().to_string();
    }
    trial
}

fn of_rows(ground: &Ground) -> Option<Vec<Tried>> {
    let frame = ground.frame();
    let accuracy = accuracy(ground);
    if accuracy.is_empty() {
        return None;
    }
    // The first error that is not rounding beside the others.
    let largest = |name: &&str| {
        let sizes = frame.numbers(name).into_iter().flatten().map(|x| x.abs()).filter(|x| x.is_finite());
        sizes.fold(0.0, f64::max)
    };
    let of_all = ERRORS.iter().map(largest).fold(0.0, f64::max);
    let error = *ERRORS.iter().find(|name| largest(name) > ROUNDING * of_all)?;
    let errors = frame.numbers(error)?;
    // One series for what the other axes are.
    let Series { by, alone } = Series::of(ground);
    let (wall, steps) = (frame.numbers("wall_s"), frame.numbers("steps"));
    let used = frame.numbers("step_used_s");
    let finished = ground.ended("finished");
    let mut groups: std::collections::BTreeMap<Vec<u32>, Vec<usize>> = std::collections::BTreeMap::new();
    let is_there = |row: &usize| alone.iter().all(|axis| axis.of_row[*row] == Some(0));
    for row in (0..frame.rows()).filter(is_there) {
        let key: Option<Vec<u32>> = by.iter().chain(&accuracy).map(|axis| axis.of_row[row]).collect();
        if let Some(key) = key {
            groups.entry(key).or_default().push(row);
        }
    }
    let tried = |(key, rows): (Vec<u32>, Vec<usize>)| {
        let of = |numbers: Option<&[f64]>| {
            let finite = |row: &usize| Some(numbers?[*row].abs()).filter(|x| x.is_finite() && finished[*row]);
            median(&rows.iter().filter_map(finite).collect::<Vec<_>>())
        };
        let names: Vec<String> =
            by.iter().zip(&key).map(|(axis, level)| axis.labels[*level as usize].clone()).collect();
        let value = |of: fn(&Levels) -> bool| {
            let at = accuracy.iter().position(|axis| of(axis))?;
            accuracy[at].numbers.as_ref().map(|numbers| numbers[key[by.len() + at] as usize])
        };
        let of_problem = by.iter().zip(&names).filter(|(axis, _)| !axis.is_of_methods());
        let problem = of_problem.map(|(_, name)| name.as_str()).collect::<Vec<_>>().join(", ");
        let method = if names.is_empty() { ground.subject.methods.join(", ") } else { names.join(", ") };
        let step_s = value(Levels::is_step).map(|step_s| of(used).unwrap_or(step_s));
        Tried {
            trial: Trial {
                scene: String::new(),
                engine: "gotai".to_string(),
                method,
                step_s: step_s.filter(|_| value(Levels::is_tolerance).is_none()),
                tolerance: value(Levels::is_tolerance),
                steps: of(steps).unwrap_or_default() as u64,
                error: of(Some(errors)),
                error_kind: error.to_string(),
                wall_s: of(wall),
                wall_median_s: None,
                outcome: (if rows.iter().any(|row| finished[*row]) { "finished" } else { "diverged" }).to_string(),
                criterion: None,
            },
            row: (rows.len() == 1).then(|| rows[0]),
            rows: rows.len(),
            problem,
        }
    };
    let mut series: Vec<Vec<u32>> = groups.keys().map(|key| key[..by.len()].to_vec()).collect();
    series.dedup();
    series.truncate(MOST_SERIES);
    let has_room = |(key, _): &(Vec<u32>, Vec<usize>)| series.iter().any(|series| key.starts_with(series));
    Some(groups.into_iter().filter(has_room).map(tried).collect())
}

/// Trials of a table of a bench, ours or another program's: `step_s` may be called `dt`, and an error may be a word.
/// None where it has no columns of methods, errors and times.
pub fn trials_of(frame: &RowFrame) -> Option<Vec<Trial>> {
    if !["method", "error", "wall_s"].iter().all(|name| frame.has(name)) {
        return None;
    }
    let number = |name: &str, row: usize| {
        let written = || frame.word(name, row).and_then(|word| word.parse::<f64>().ok());
        frame.number(name, row).or_else(written).filter(|x| x.is_finite())
    };
    let trial = |row: usize| {
        let error = number("error", row);
        let outcome = frame.word("outcome", row).unwrap_or(if error.is_some() { "finished" } else { "diverged" });
        Trial {
            scene: frame.text("scene", row),
            engine: frame.text("engine", row),
            method: frame.text("method", row),
            step_s: number("step_s", row).or_else(|| number("dt", row)),
            tolerance: number("tolerance", row),
            steps: number("steps", row).unwrap_or_default() as u64,
            error: error.map(f64::abs),
            error_kind: frame.text("error_kind", row),
            wall_s: number("wall_s", row),
            wall_median_s: number("wall_median_s", row),
            outcome: outcome.to_string(),
            criterion: frame.word("criterion", row).map(str::to_string),
        }
    };
    Some((0..frame.rows()).map(trial).collect())
}

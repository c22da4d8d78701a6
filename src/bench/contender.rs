//! Contenders of a bench: a method at one step or tolerance, and the row that its run makes.

use crate::check::{Schema, refuse_no_numbers};
use crate::experiment::bench::{Bench, Listed, bench_path};
use crate::experiment::file::Change;
use crate::experiment::key_path::{self, KeyPath, Segment};
use crate::experiment::predicate::Column;
use crate::experiment::types::{Accuracy, Experiment};
use crate::experiment::{ExperimentError, ExperimentFile, Value};
use crate::measure::more;
use crate::model::Model;
use crate::outcome::Outcome;
use crate::panics;
use crate::rows::trials::Trial;
use crate::rows::{Measured, cells, finite};
use crate::state::State;
use crate::study::{self, Place, Studied};
use crate::sweep::build::build;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

type Result<T> = std::result::Result<T, ExperimentError>;

/// A method at one step or tolerance.
pub struct Contender {
    pub method: String,
    /// Length of the steps; made by the method itself where it controls its error, and of no meaning to a closed form.
    pub step_s: Option<f64>,
    pub tolerance: Option<f64>,
    pub experiment: Experiment,
    pub model: Model,
    pub start: State,
}

/// Row of a contender, and what its judged run measured.
pub struct Ran {
    pub row: Trial,
    pub measured: Measured,
}

/// Failure of the program: the timed and the judged run of a contender end in different states.
#[derive(Debug, thiserror::Error)]
#[error("{0}: the timed run ends in another state than the judged one; please report this")]
pub struct NotDeterministic(String);

/// All contenders of a file, in the order written.
///
/// # Errors
/// Axes are left that are neither the method's nor the step; a contender is wrong; the error is no number of a row, or
/// there is nothing to measure it against.
pub fn plan(file: &ExperimentFile, bench: &Bench) -> Result<Vec<Contender>> {
    let mut contenders = Vec::new();
    for listed in &bench.methods {
        let (key, values) = match listed.method.accuracy() {
            Accuracy::Step => ("steps_s", &bench.steps_s),
            Accuracy::Tolerance(_) => ("tolerances", &bench.tolerances),
            Accuracy::Closed => ("", &Vec::new()),
        };
        if values.is_empty() {
            contenders.push(contender(file, listed, None)?);
        }
        for (i, value) in values.iter().enumerate() {
            let mut written = bench_path(key);
            written.push(Segment::Item { index: i, name: None });
            contenders.push(contender(file, listed, Some((*value, written)))?);
        }
    }
    for contender in &contenders {
        check_error(&contender.experiment, bench).map_err(|error| file.placed(error))?;
    }
    Ok(contenders)
}

fn contender(file: &ExperimentFile, listed: &Listed, value: Option<(f64, KeyPath)>) -> Result<Contender> {
    let accuracy = listed.method.accuracy();
    let change = |path: &[&str], value: Value, written: Option<KeyPath>| Change {
        path: path.iter().map(|key| key.to_string()).collect(),
        value,
        written,
    };
    let own = listed.written.iter().map(|(method, at)| change(&["method"], method.clone(), Some(at.clone())));
    let mut changes: Vec<Change> = own.collect();
    if accuracy != Accuracy::Step {
        // One step of the clock, to the end.
        changes.push(change(&["time", "step_s"], Value::Null, None));
    }
    if let Some((x, written)) = value {
        let path = match accuracy {
            Accuracy::Tolerance(path) => path,
            _ => &["time", "step_s"],
        };
        changes.push(change(path, x.into(), Some(written)));
    }
    let experiment = file.changed(&changes, is_set_by_bench)?;
    let (model, start) = build(file, &[], &experiment)?;
    let by_step = (accuracy == Accuracy::Step).then(|| experiment.clock().step_s);
    let tolerance = experiment.method.tolerance();
    Ok(Contender { method: listed.label.clone(), step_s: by_step, tolerance, experiment, model, start })
}

/// Whether a path is a step or the method, whose axes mean nothing here.
fn is_set_by_bench(path: &[String]) -> bool {
    path[0] == "method" || path == ["time", "step_s"]
}

fn check_error(experiment: &Experiment, bench: &Bench) -> Result<()> {
    let base = bench_path("error");
    let schema = Schema::new(&Default::default(), None, &more::names(experiment));
    refuse_no_numbers(&schema, &Column { name: bench.error.clone(), divided_by: None }, key_path::Path::Base(&base))?;
    let measured = experiment.exact.is_some() || experiment.reference.is_some();
    if bench.error.starts_with("error_") && bench.error != "error_estimate_m" && !measured {
        let expected = "`exact:` or `reference:` in the experiment, which errors are measured against";
        return Err(ExperimentError::unexpected(base, expected, &format!("`{}` without it", bench.error)));
    }
    Ok(())
}

/// The row of a contender, run once judged, then as often as its time needs. References are kept in a folder, if there
/// is one.
///
/// # Errors
/// The two end in different states.
pub fn run(
    contender: &Contender,
    bench: &Bench,
    scene: &str,
    references: Option<&Path>,
) -> std::result::Result<Ran, NotDeterministic> {
    let Contender { model, start, .. } = contender;
    let place = Place { references, recording: None };
    let judged = catch_unwind(AssertUnwindSafe(|| {
        let Studied { ended, chosen, .. } = study::measure(&contender.experiment, model, start.clone(), &place);
        (ended.measured, Some((ended.state, chosen)))
    }));
    let (measured, run) =
        judged.unwrap_or_else(|panic| (Measured::failed(panics::message(panic.as_ref()).to_string()), None));
    let experiment = run.as_ref().map_or(&contender.experiment, |(_, chosen)| &chosen.experiment);
    let steps = match experiment.method.accuracy() {
        Accuracy::Tolerance(_) if !experiment.method.follows_events() => measured.work.inner_steps,
        _ => measured.steps,
    };
    let mut row = Trial {
        scene: scene.to_string(),
        engine: "gotai".to_string(),
        method: contender.method.clone(),
        step_s: contender.step_s,
        tolerance: contender.tolerance,
        steps,
        error: None,
        error_kind: bench.error.clone(),
        wall_s: None,
        wall_median_s: None,
        outcome: measured.outcome.name().to_string(),
        criterion: measured.criterion.clone(),
    };
    // Neither the error nor the time of half a motion can be compared.
    if let (Outcome::Finished, Some((end, chosen))) = (measured.outcome, &run) {
        // The search for a method is not what is timed.
        let timed = super::timing::time(chosen, model, start, bench.repeats);
        if *end != timed.end {
            return Err(NotDeterministic(format!("{scene}, {}", contender.method)));
        }
        row.error = cells(&measured).get(&bench.error).and_then(|x| x.as_f64()).map(f64::abs);
        (row.wall_s, row.wall_median_s) = (finite(timed.best_s), finite(timed.median_s));
    }
    Ok(Ran { row, measured })
}

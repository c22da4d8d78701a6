//! Runs the missing cases of a plan on all cores, each row kept as soon as its case ends.

use super::recordings::{known_after, known_before};
use super::store::{Store, StoreError};
use crate::case::Case;
use crate::experiment::types::{Record, RecordTo};
use crate::model::{self, Model};
use crate::record::RecordError;
use crate::record::head::header;
use crate::record::sampler::Sampler;
use crate::record::writer::{Target, open};
use crate::row::Measured;
use crate::run::{self, Ended};
use crate::state::State;
use rayon::prelude::*;
use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Mutex, MutexGuard};

/// The machine failed during a sweep; rows of cases that had ended are kept.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(transparent)]
    Record(#[from] RecordError),
    /// The program failed: a case that was run again for its recording measured something else.
    #[error("case {0}: the recorded run differs from the first one; please report this")]
    NotDeterministic(String),
}

/// How far a sweep is, for a progress bar.
pub trait Progress: Sync {
    fn begin(&self, what: &str, total: usize);
    fn one_done(&self);
    fn end(&self);
}

/// Runs what is missing, then records the chosen cases and writes the tables. How many cases were run.
pub fn sweep(
    cases: &[Case],
    store: &Mutex<Store>,
    dir: &Path,
    targets: &[Target],
    progress: &dyn Progress,
) -> Result<usize, SweepError> {
    let rule = cases.first().map_or(Record::default().cases, |case| case.experiment.record.cases);
    let missing = missing(cases, &lock(store));
    let at_once: HashSet<usize> = match known_before(rule, cases.len()) {
        Some(known) if !targets.is_empty() => known.into_iter().collect(),
        _ => HashSet::new(),
    };
    progress.begin("cases", missing.len());
    let results: Result<(), SweepError> = missing.par_iter().try_for_each(|&i| {
        let targets = if at_once.contains(&i) { targets } else { &[] };
        let measured = run_caught(&cases[i], dir, targets)?;
        lock(store).add(&cases[i].id, measured)?;
        progress.one_done();
        Ok(())
    });
    progress.end();
    lock(store).write_tables()?;
    results?;
    if !targets.is_empty() {
        let fresh = missing.iter().copied().filter(|i| !at_once.contains(i)).collect();
        record_chosen(cases, store, dir, targets, &fresh, progress)?;
    }
    Ok(missing.len())
}

/// The first of equal cases stands for all of them.
fn missing(cases: &[Case], store: &Store) -> Vec<usize> {
    let mut seen = HashSet::new();
    let is_missing = |case: &Case| store.measured(&case.id).is_none();
    (0..cases.len()).filter(|&i| seen.insert(&cases[i].id) && is_missing(&cases[i])).collect()
}

/// Records the chosen cases that have no complete recording yet, or whose row was made just now (`fresh`).
fn record_chosen(
    cases: &[Case],
    store: &Mutex<Store>,
    dir: &Path,
    targets: &[Target],
    fresh: &HashSet<usize>,
    progress: &dyn Progress,
) -> Result<(), SweepError> {
    let chosen = {
        let store = lock(store);
        let measured: Vec<_> = cases.iter().map(|case| store.measured(&case.id)).collect();
        known_after(cases[0].experiment.record.cases, &measured)
    };
    let is_there = |case: &Case| targets.iter().all(|t| dir.join(format!("{}.{}", case.id, t.extension())).exists());
    let chosen: Vec<_> = chosen.into_iter().filter(|i| fresh.contains(i) || !is_there(&cases[*i])).collect();
    if chosen.is_empty() {
        return Ok(());
    }
    progress.begin("recordings", chosen.len());
    let result = chosen.par_iter().try_for_each(|&i| {
        let again = run_caught(&cases[i], dir, targets)?;
        let first = lock(store).measured(&cases[i].id).map(Measured::without_wall_time);
        progress.one_done();
        let same = first.is_none_or(|first| first == again.without_wall_time());
        if same { Ok(()) } else { Err(SweepError::NotDeterministic(cases[i].id.clone())) }
    });
    progress.end();
    result
}

/// A case that panics is a row too, and the sweep goes on.
fn run_caught(case: &Case, dir: &Path, targets: &[Target]) -> Result<Measured, RecordError> {
    let ran = catch_unwind(AssertUnwindSafe(|| match model::build(&case.experiment) {
        Ok((model, start)) => run_case(case, &model, start, dir, targets).map(|ended| ended.measured),
        Err(error) => Ok(Measured::failed(error.to_string())),
    }));
    ran.unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        Ok(Measured::failed(text.unwrap_or("panic").to_string()))
    })
}

/// Runs one case and writes its recordings.
pub fn run_case(
    case: &Case,
    model: &Model,
    start: State,
    dir: &Path,
    targets: &[Target],
) -> Result<Ended, RecordError> {
    if targets.is_empty() {
        return Ok(run::run(&case.experiment, model, start, None));
    }
    let clock = run::clock(&case.experiment);
    let writer = open(targets, dir, &header(case, model, &clock))?;
    let mut sampler = Sampler::new(writer, &case.experiment.record, &clock);
    let ended = run::run(&case.experiment, model, start, Some(&mut sampler));
    sampler.finish()?;
    Ok(ended)
}

/// What `record.to` means in this build; nothing said: everything it can write.
pub fn targets(to: Option<RecordTo>) -> Vec<Target> {
    match to {
        None => Target::AVAILABLE.to_vec(),
        Some(RecordTo::None) => Vec::new(),
        Some(RecordTo::Rerun) => vec![Target::Rerun],
        Some(RecordTo::Mcap) => vec![Target::Mcap],
        Some(RecordTo::Both) => vec![Target::Rerun, Target::Mcap],
    }
}

/// A thread that panics while it holds the store has already been caught; the store itself is whole.
pub fn lock(store: &Mutex<Store>) -> MutexGuard<'_, Store> {
    store.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

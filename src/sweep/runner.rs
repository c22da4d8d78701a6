//! Runs the missing cases of a plan on all cores, each row kept as soon as its case ends.

use super::planned::Planned;
use super::recordings::{known_after, known_before};
use super::store::Store;
use crate::case::Case;
use crate::experiment::types::{Record, RecordCases, RecordTo};
use crate::files::FileError;
use crate::model::Model;
use crate::record::RecordError;
use crate::record::head::header;
use crate::record::sampler::Sampler;
use crate::record::writer::{Target, open};
use crate::rows::Measured;
use crate::run::Ended;
use crate::run::ticks::ticks;
use crate::state::State;
use crate::study::{self, choose, reference};
use crate::{panics, scene};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Mutex, MutexGuard};

/// The machine failed during a sweep; rows of cases that had ended are kept.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    #[error(transparent)]
    Store(#[from] FileError),
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

/// What a sweep does with every case, and where.
pub struct Job<'a> {
    pub dir: &'a Path,
    /// What the chosen cases are recorded into; empty: nothing is.
    pub targets: &'a [Target],
    /// Runs a case and records it into the targets.
    pub work: &'a Make<'a>,
    pub progress: &'a dyn Progress,
}

pub type Make<'a> = dyn Fn(&Planned, &[Target]) -> (Measured, Written) + Sync + 'a;

/// Whether the recordings of a run were written. A run that cannot be recorded still has its result.
pub type Written = Result<(), RecordError>;

impl Job<'_> {
    /// Runs what is missing, then records the chosen cases and writes the tables. How many cases were run.
    pub fn sweep(&self, cases: &[Planned], store: &Mutex<Store>) -> Result<usize, SweepError> {
        let rule = match cases.first() {
            // The row of a search is of many runs: none of them is the one to look at.
            Some(Planned { search: Some(_), .. }) => RecordCases::None,
            first => first.map_or(Record::default().cases, |first| first.case.experiment.record.cases),
        };
        let missing = missing(cases, &lock(store));
        let at_once: HashSet<usize> = match known_before(rule, cases.len()) {
            Some(known) if !self.targets.is_empty() => known.into_iter().collect(),
            _ => HashSet::new(),
        };
        self.make_references(&missing, cases)?;
        self.progress.begin("cases", missing.len());
        let ran = missing.par_iter().try_for_each(|&i| {
            let targets = if at_once.contains(&i) { self.targets } else { &[] };
            let (measured, written) = self.caught(&cases[i], targets);
            lock(store).add(&cases[i].case.id, measured)?;
            self.progress.one_done();
            Ok::<_, SweepError>(written?)
        });
        self.progress.end();
        lock(store).write_tables()?;
        ran?;
        if !self.targets.is_empty() {
            let stale = missing.iter().copied().filter(|i| !at_once.contains(i)).collect();
            self.record_chosen(rule, cases, store, &stale)?;
        }
        Ok(missing.len())
    }

    /// Those that no earlier sweep has left here, each once. A search makes its own.
    fn make_references(&self, missing: &[usize], cases: &[Planned]) -> Result<(), SweepError> {
        let single =
            missing.iter().map(|&i| &cases[i]).filter(|planned| planned.search.is_none()).map(|planned| &planned.case);
        let needed: BTreeMap<_, _> =
            single.filter_map(|case| Some((reference::path(self.dir, &case.experiment)?, case))).collect();
        let missing: Vec<&Case> = needed.into_iter().filter(|(path, _)| !path.exists()).map(|(_, case)| case).collect();
        if missing.is_empty() {
            return Ok(());
        }
        self.progress.begin("references", missing.len());
        let made = missing.par_iter().try_for_each(|case| {
            let make = || match scene::build(&case.experiment) {
                Ok((model, start)) => reference::of(self.dir, &case.experiment, &model, &start).map(drop),
                Err(_) => Ok(()),
            };
            // A reference that panics does so again in its case, which has a row to say so.
            let made = catch_unwind(AssertUnwindSafe(make)).unwrap_or(Ok(()));
            self.progress.one_done();
            made
        });
        self.progress.end();
        Ok(made?)
    }

    /// Records the chosen cases that have no complete recording yet, or only one of an earlier row (`stale`).
    fn record_chosen(
        &self,
        rule: RecordCases,
        cases: &[Planned],
        store: &Mutex<Store>,
        stale: &HashSet<usize>,
    ) -> Result<(), SweepError> {
        let chosen = {
            let store = lock(store);
            let measured: Vec<_> = cases.iter().map(|planned| store.measured(&planned.case.id)).collect();
            known_after(rule, &measured)
        };
        let chosen: Vec<_> =
            chosen.into_iter().filter(|i| stale.contains(i) || !self.is_recorded(&cases[*i].case)).collect();
        if chosen.is_empty() {
            return Ok(());
        }
        self.progress.begin("recordings", chosen.len());
        let result = chosen.par_iter().try_for_each(|&i| {
            let (again, written) = self.caught(&cases[i], self.targets);
            written?;
            let first = lock(store).measured_by_this_build(&cases[i].case.id).map(Measured::without_wall_time);
            self.progress.one_done();
            let same = first.is_none_or(|first| first == again.without_wall_time());
            // How far a run comes in a given time is another thing every time.
            let same = same || cases[i].case.experiment.limits.wall_s.is_some();
            if same { Ok(()) } else { Err(SweepError::NotDeterministic(cases[i].case.id.clone())) }
        });
        self.progress.end();
        result
    }

    fn is_recorded(&self, case: &Case) -> bool {
        let file = |target: &Target| self.dir.join(format!("{}.{}", case.id, target.extension()));
        self.targets.iter().all(|target| file(target).exists())
    }

    /// A case that panics is a row too, and the sweep goes on.
    fn caught(&self, planned: &Planned, targets: &[Target]) -> (Measured, Written) {
        let ran = catch_unwind(AssertUnwindSafe(|| (self.work)(planned, targets)));
        ran.unwrap_or_else(|panic| (Measured::failed(panics::message(panic.as_ref()).to_string()), Ok(())))
    }
}

/// The first of equal cases stands for all of them.
fn missing(cases: &[Planned], store: &Store) -> Vec<usize> {
    let mut seen = HashSet::new();
    let is_missing = |planned: &Planned| store.measured(&planned.case.id).is_none();
    (0..cases.len()).filter(|&i| seen.insert(&cases[i].case.id) && is_missing(&cases[i])).collect()
}

/// Builds a case's model and runs it, recording it into `dir`: the usual `Make`.
pub fn build_and_run(Planned { case, search }: &Planned, dir: &Path, targets: &[Target]) -> (Measured, Written) {
    if let Some(cell) = search {
        return (cell.bisect(dir), Ok(()));
    }
    match scene::build(&case.experiment) {
        Ok((model, start)) => {
            let (ended, written) = run_case(case, &model, start, dir, targets);
            (ended.measured, written)
        }
        // Every case is built once before the first one runs.
        Err(error) => (Measured::failed(error.to_string()), Ok(())),
    }
}

/// Runs one case and writes its recordings.
pub fn run_case(case: &Case, model: &Model, start: State, dir: &Path, targets: &[Target]) -> (Ended, Written) {
    let reference = reference::of_or_made(dir, &case.experiment, model, &start);
    let choice = choose::choose(&case.experiment, model, &start);
    let experiment = choice.as_ref().map_or(&case.experiment, |choice| &choice.experiment);
    let run = |sampler: Option<&mut Sampler>| {
        study::run_as(choice.as_ref(), &case.experiment, model, start, sampler, reference.as_ref())
    };
    if targets.is_empty() {
        return (run(None), Ok(()));
    }
    let clock = ticks(experiment);
    match open(targets, dir, &header(case, model, &clock)) {
        Ok(writer) => {
            let mut sampler = Sampler::new(writer, &experiment.record, &clock);
            let ended = run(Some(&mut sampler));
            (ended, sampler.finish())
        }
        Err(error) => (run(None), Err(error)),
    }
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

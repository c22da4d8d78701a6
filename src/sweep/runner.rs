//! Runner of the missing cases of a plan on all cores, each row kept as soon as its case ends.

use super::leftovers;
use super::planned::Planned;
use super::recorded::{self, Recorded};
use super::recordings::{known_after, known_before};
use super::store::Store;
use crate::case::Case;
use crate::experiment::types::{Record, RecordCases, RecordTo};
use crate::files::{self, FileError};
use crate::model::Model;
use crate::outcome::Outcome;
use crate::record::RecordError;
use crate::record::writer::Target;
use crate::rows::Measured;
use crate::run::Ended;
use crate::state::State;
use crate::study::{self, Place, Studied, reference};
use crate::{interrupt, panics, scene};
use rayon::prelude::*;
use std::collections::{BTreeMap, HashSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Failure of the machine during a sweep; rows of cases that had ended are kept.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    #[error(transparent)]
    Store(#[from] FileError),
    #[error(transparent)]
    Record(#[from] RecordError),
    /// Failure of the program: a case that was run again for its recording measured something else.
    #[error("case {0}: the recorded run differs from the first one; please report this")]
    NotDeterministic(String),
}

/// Progress of a sweep, for a bar.
pub trait Progress: Sync {
    fn begin(&self, what: &str, total: usize);
    fn one_done(&self);
    /// One case of those that were begun has ended.
    fn case_ended(&self, _id: &str, _outcome: Outcome) {
        self.one_done();
    }
    /// Whether no further case is begun, though some are missing.
    fn is_stopped(&self) -> bool {
        false
    }
    fn end(&self);
}

/// Work of a sweep on every case, and where it is done.
pub struct Job<'a> {
    pub dir: &'a Path,
    /// Kinds of file that the chosen cases are recorded into; empty where nothing is.
    pub targets: &'a [Target],
    /// Whether a table of text is written, however long.
    pub csv: bool,
    /// Function that runs a case and records it into the targets.
    pub work: &'a Make<'a>,
    pub progress: &'a dyn Progress,
}

pub type Make<'a> = dyn Fn(&Planned, &[Target]) -> (Measured, Written) + Sync + 'a;

/// Recording of a run, None where there is none, or its failure. A run that cannot be recorded still has its result.
pub type Written = Result<Option<Recorded>, SweepError>;

impl Job<'_> {
    /// Runs what is missing, then records the chosen cases and writes the tables. Returns the number of cases that were
    /// run.
    ///
    /// # Errors
    /// The machine failed; rows of cases that had ended are kept.
    pub fn sweep(&self, cases: &[Planned], store: &Mutex<Store>) -> Result<usize, SweepError> {
        remove(leftovers::partial(self.dir)?)?;
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
        let done = AtomicUsize::new(0);
        let ran = in_turn(&longest_first(&missing, cases), |&i| {
            if self.progress.is_stopped() {
                return Ok(());
            }
            let targets = if at_once.contains(&i) { self.targets } else { &[] };
            let (measured, written) = self.caught(&cases[i], targets);
            let (id, outcome) = (&cases[i].case.id, measured.outcome);
            lock(store).add(id, measured)?;
            done.fetch_add(1, Ordering::Relaxed);
            self.progress.case_ended(id, outcome);
            keep(written, &mut lock(store))
        });
        self.progress.end();
        // What tells most is chosen of all rows.
        let record = || if self.progress.is_stopped() { Ok(()) } else { self.record_chosen(rule, cases, store) };
        let recorded = ran.and_then(|()| record());
        lock(store).write_tables(self.csv)?;
        recorded?;
        // Of cases that have panicked.
        remove(leftovers::partial(self.dir)?)?;
        Ok(done.into_inner())
    }

    /// Records cases that somebody has chosen by what all rows say, and writes the tables anew.
    ///
    /// # Errors
    /// The machine failed.
    pub fn record(&self, ids: &[String], cases: &[Planned], store: &Mutex<Store>) -> Result<(), SweepError> {
        let of = |id: &String| cases.iter().find(|planned| planned.case.id == *id && planned.search.is_none());
        let ended = |planned: &Planned| lock(store).measured(&planned.case.id).map(|measured| measured.outcome);
        let with_outcome = ids.iter().filter_map(of).filter_map(|planned| Some((planned, ended(planned)?)));
        // A case that panics leaves no recording.
        let chosen = with_outcome.filter(|(_, outcome)| *outcome != Outcome::Failed);
        let recorded = |planned: &Planned| lock(store).recorded(&planned.case.id).cloned();
        let recorded = self.record_all(chosen.map(|(p, outcome)| (p, recorded(p), outcome)).collect(), store);
        lock(store).write_tables(self.csv)?;
        recorded
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

    /// Records the chosen cases that have no recording yet, or another one than theirs would be now.
    fn record_chosen(&self, rule: RecordCases, cases: &[Planned], store: &Mutex<Store>) -> Result<(), SweepError> {
        let chosen = chosen(rule, cases, &lock(store));
        self.record_all(chosen, store)
    }

    fn record_all(&self, chosen: Vec<Chosen>, store: &Mutex<Store>) -> Result<(), SweepError> {
        if self.targets.is_empty() {
            return Ok(());
        }
        let missing: Vec<_> = chosen
            .into_par_iter()
            .filter_map(|(planned, recorded, outcome)| {
                let lacking = self.lacking(planned, recorded.as_ref(), outcome);
                (!lacking.is_empty()).then_some((planned, lacking))
            })
            .collect();
        if !missing.is_empty() {
            self.progress.begin("recordings", missing.len());
            let made = missing.par_iter().try_for_each(|(planned, lacking)| self.record_again(planned, lacking, store));
            self.progress.end();
            made?;
        }
        remove(lock(store).older_recordings())
    }

    /// The kinds of file that are not there, cut, changed, or show something else than what is asked for now.
    fn lacking(&self, planned: &Planned, recorded: Option<&Recorded>, outcome: Outcome) -> Vec<Target> {
        let name = planned.name.ended(outcome);
        let is_it = |recorded: &&Recorded| recorded.name == name && recorded.shows == recorded::shows(&planned.case);
        let recorded = recorded.filter(is_it);
        let is_whole = |target: &Target| recorded.is_some_and(|recorded| recorded.is_whole(self.dir, *target, true));
        self.targets.iter().copied().filter(|target| !is_whole(target)).collect()
    }

    fn record_again(&self, planned: &Planned, targets: &[Target], store: &Mutex<Store>) -> Result<(), SweepError> {
        let case = &planned.case;
        let (again, written) = self.caught(planned, targets);
        keep(written, &mut lock(store))?;
        let first = lock(store).measured_by_this_build(&case.id).map(Measured::without_wall_time);
        self.progress.one_done();
        let same = first.is_none_or(|first| first == again.without_wall_time());
        // How far a run comes in a given time is another thing every time.
        let same = same || case.experiment.limits.wall_s.is_some();
        if same { Ok(()) } else { Err(SweepError::NotDeterministic(case.id.clone())) }
    }

    /// A case that panics is a row too, and the sweep goes on.
    fn caught(&self, planned: &Planned, targets: &[Target]) -> (Measured, Written) {
        let ran = catch_unwind(AssertUnwindSafe(|| (self.work)(planned, targets)));
        ran.unwrap_or_else(|panic| (Measured::failed(panics::message(panic.as_ref()).to_string()), Ok(None)))
    }
}

/// A case that is recorded, its recording, if there is one, and how it ended.
type Chosen<'a> = (&'a Planned, Option<Recorded>, Outcome);

/// The cases that a rule chooses. A case that panics leaves no recording.
fn chosen<'a>(rule: RecordCases, cases: &'a [Planned], store: &Store) -> Vec<Chosen<'a>> {
    let measured: Vec<_> = cases.iter().map(|planned| store.measured(&planned.case.id)).collect();
    let chosen = known_after(rule, &measured).into_iter().filter_map(|i| Some((&cases[i], measured[i]?.outcome)));
    // The first of equal cases stands for all of them.
    let mut seen = HashSet::new();
    let first = chosen.filter(|(planned, outcome)| *outcome != Outcome::Failed && seen.insert(&planned.case.id));
    first.map(|(planned, outcome)| (planned, store.recorded(&planned.case.id).cloned(), outcome)).collect()
}

/// The same, those that are likely to take longest first, so that none is left alone at the end; of equals in plan
/// order.
fn longest_first(missing: &[usize], cases: &[Planned]) -> Vec<usize> {
    let mut ordered: Vec<(f64, usize)> = missing.iter().map(|&i| (cases[i].likely_cost(), i)).collect();
    ordered.sort_by(|(a, i), (b, j)| b.total_cmp(a).then(i.cmp(j)));
    ordered.into_iter().map(|(_, i)| i).collect()
}

/// Does the work on all items on all threads, each thread taking the next one in their order; after a failure no new
/// ones.
fn in_turn<T: Sync>(items: &[T], work: impl Fn(&T) -> Result<(), SweepError> + Sync) -> Result<(), SweepError> {
    let (next, failed) = (AtomicUsize::new(0), Mutex::new(None));
    rayon::broadcast(|_| {
        while let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Err(error) = work(item) {
                next.store(items.len(), Ordering::Relaxed);
                failed.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
        }
    });
    failed.into_inner().unwrap_or_else(PoisonError::into_inner).map_or(Ok(()), Err)
}

/// The first of equal cases stands for all of them.
fn missing(cases: &[Planned], store: &Store) -> Vec<usize> {
    let mut seen = HashSet::new();
    let is_missing = |planned: &Planned| store.measured(&planned.case.id).is_none();
    (0..cases.len()).filter(|&i| seen.insert(&cases[i].case.id) && is_missing(&cases[i])).collect()
}

fn remove(paths: Vec<PathBuf>) -> Result<(), SweepError> {
    Ok(paths.iter().try_for_each(|path| files::remove(path))?)
}

fn keep(written: Written, store: &mut Store) -> Result<(), SweepError> {
    match written? {
        Some(recorded) => Ok(store.add_recording(recorded)?),
        None => Ok(()),
    }
}

/// Builds a case's model and runs it, recording it into `dir`: the usual `Make`.
pub fn build_and_run(planned: &Planned, dir: &Path, targets: &[Target]) -> (Measured, Written) {
    if let Some(cell) = &planned.search {
        return (cell.bisect(dir), Ok(None));
    }
    match scene::build(&planned.case.experiment) {
        Ok((model, start)) => {
            let place = Place { references: Some(dir), recording: planned.recording(dir, targets) };
            let (ended, written) = run_case(&planned.case, &model, start, &place);
            (ended.measured, written)
        }
        // Every case is built once before the first one runs.
        Err(error) => (Measured::failed(error.to_string()), Ok(None)),
    }
}

/// Result of one case, whose recordings are written, and what was recorded.
pub fn run_case(case: &Case, model: &Model, start: State, place: &Place) -> (Ended, Written) {
    let Studied { ended, recorded, .. } = study::measure(&case.experiment, model, start, place);
    let in_files = place.recording.filter(|recording| !recording.targets.is_empty());
    let of_files = |sums| in_files.map(|recording| Recorded::of(recording, ended.measured.outcome, sums));
    let written = recorded.map_err(SweepError::from).map(of_files);
    (ended, written)
}

/// Runs the one case of a folder, its row there or not, and keeps row, recordings and tables.
pub fn run_one(
    case: &Case,
    model: &Model,
    start: State,
    place: &Place,
    store: &mut Store,
) -> (Ended, Result<(), SweepError>) {
    let (ended, written) = run_case(case, model, start, place);
    if interrupt::asked().is_some() {
        // What it has measured is no row, but what it has recorded is there until the next run's takes its place.
        return (ended, keep(written, store));
    }
    let measured = ended.measured.clone();
    let keep_all = || {
        store.add(&case.id, measured)?;
        let recorded = keep(written, store);
        store.write_tables(false)?;
        recorded?;
        remove(leftovers::partial(store.dir())?)?;
        remove(store.older_recordings())
    };
    let kept = keep_all();
    (ended, kept)
}

/// Kinds of file that `record.to` means in this build; where nothing is said, all that it can write.
pub fn targets(to: Option<RecordTo>) -> Vec<Target> {
    match to {
        None => Target::AVAILABLE.to_vec(),
        Some(RecordTo::None) => Vec::new(),
        Some(RecordTo::Rerun) => vec![Target::Rerun],
        Some(RecordTo::Mcap) => vec![Target::Mcap],
        Some(RecordTo::Both) => vec![Target::Rerun, Target::Mcap],
    }
}

/// Lock on a store. A thread that panics while it holds the store has already been caught; the store itself is whole.
pub fn lock(store: &Mutex<Store>) -> MutexGuard<'_, Store> {
    store.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

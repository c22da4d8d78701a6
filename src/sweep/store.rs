//! Folder of results: experiment.yaml, plan.json, journal.jsonl, rows.csv, rows.parquet, recordings.
//!
//! Rows go to the journal as their cases end; the tables are written from it in plan order. The journal holds what was
//! measured by case id, the plan holds the axes: a sweep whose axes have grown finds its old rows again.

use super::journal::{self, Entry, Journal, JournalFile};
use super::kept::{self, EXPERIMENT, PLAN, read_plan};
use super::leftovers;
use super::plan::SweepPlan;
use super::planned::Planned;
use super::recorded::Recorded;
use crate::build_info::BUILD;
use crate::files::{self, FileError, write_if_new, write_whole};
use crate::outcome::Outcome;
use crate::record::writer::Target;
use crate::rows::plan_file::PlanFile;
use crate::rows::{Measured, Row, table};
use crate::shared::Shared;
use serde_json::{Map, Value};
use std::collections::HashSet;
use std::fmt;
use std::path::{Path, PathBuf};

/// Most rows of which a table of text is written without being asked for.
const CSV_ROWS: usize = 100_000;

/// A folder of results, open for adding rows.
pub struct Store {
    dir: PathBuf,
    plan: PlanFile,
    /// Ids of the plan's cases with their values on the axes.
    order: Vec<(String, Shared<Map<String, Value>>)>,
    /// The plan that was here before.
    before: Option<PlanFile>,
    journal: JournalFile,
    done: Journal,
}

/// Change of a plan, and what it has left of the rows that are there.
#[derive(Clone, Debug, PartialEq)]
pub struct Edited {
    /// Phrases about the axes that have changed, one an axis.
    pub changes: Vec<String>,
    /// Number of rows of the plan that are there already.
    pub held: usize,
    /// Number of all rows of the plan.
    pub planned: usize,
    /// Number of rows that are there and no longer planned.
    pub unplanned: usize,
}

/// Reason why a folder cannot be opened for adding rows.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    #[error(transparent)]
    File(#[from] FileError),
    #[error("{0}: expected a folder of results or a new one, found a file of this name that no gotai has written")]
    Foreign(PathBuf),
}

impl Store {
    /// Opens or makes the folder and writes the plan. Rows of another build count as missing, unless `keep`.
    ///
    /// # Errors
    /// The machine failed, another program has the folder open, or it holds files of the same names that are not ours.
    pub fn open(dir: &Path, plan: &SweepPlan, keep: bool) -> Result<Self, StoreError> {
        files::make_folder(dir)?;
        refuse_foreign(dir)?;
        let (journal, mut done) = JournalFile::open(dir)?;
        if !keep {
            done.retain_build();
        }
        let before = read_plan(dir).ok();
        write_if_new(&dir.join(EXPERIMENT), plan.written.as_bytes())?;
        write_if_new(&dir.join(PLAN), &serde_json::to_vec_pretty(&plan.file).unwrap_or_default())?;
        Ok(Store { dir: dir.to_path_buf(), plan: plan.file.clone(), order: order(&plan.cases), before, journal, done })
    }

    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// Change of an edited plan that goes on in its folder; None where it is the same, or the first.
    pub fn edited(&self) -> Option<Edited> {
        let before = self.before.as_ref().filter(|before| before.hash != self.plan.hash)?;
        let planned: HashSet<&String> = self.order.iter().map(|(case, _)| case).collect();
        Some(Edited {
            changes: self.plan.changes_from(before),
            held: self.order.iter().filter(|(case, _)| self.done.rows.contains_key(case)).count(),
            planned: self.order.len(),
            unplanned: self.done.rows.keys().filter(|case| !planned.contains(case)).count(),
        })
    }

    /// Drops the rows of cases that have failed, so that they count as missing.
    pub fn forget_failed(&mut self) {
        self.done.rows.retain(|_, entry| entry.measured.outcome != Outcome::Failed);
    }

    pub fn measured(&self, case: &str) -> Option<&Measured> {
        self.done.rows.get(case).map(|entry| &*entry.measured)
    }

    /// Measurements of a case, if this very program made them: another one may give other bits.
    pub fn measured_by_this_build(&self, case: &str) -> Option<&Measured> {
        self.done.rows.get(case).filter(|entry| entry.build == BUILD).map(|entry| &*entry.measured)
    }

    /// Recording of a case whose row is there, whichever build they are of.
    pub fn recorded(&self, case: &str) -> Option<&Recorded> {
        self.done.recorded(case)
    }

    /// Files that the cases' recordings have had before.
    pub fn older_recordings(&self) -> Vec<PathBuf> {
        leftovers::older(&self.dir, &self.done)
    }

    /// Appends a row to the journal at once.
    ///
    /// # Errors
    /// The machine failed.
    pub fn add(&mut self, case: &str, measured: Measured) -> Result<(), FileError> {
        let entry = Entry { case: case.to_string(), build: BUILD.to_string(), measured: measured.into() };
        self.journal.add_row(&entry)?;
        self.done.rows.insert(entry.case.clone(), entry);
        Ok(())
    }

    /// Appends a recording to the journal at once.
    ///
    /// # Errors
    /// The machine failed.
    pub fn add_recording(&mut self, recorded: Recorded) -> Result<(), FileError> {
        let recorded = match self.done.recordings.get(&recorded.recorded) {
            Some(before) => recorded.with_files_of(before),
            None => recorded,
        };
        self.journal.add(&recorded)?;
        let before = self.done.recordings.insert(recorded.recorded.clone(), recorded);
        self.done.superseded.extend(before);
        Ok(())
    }

    /// Rows that there are, in plan order.
    pub fn rows(&self) -> Vec<Row> {
        rows(&self.dir, &self.order, &self.done)
    }

    /// Writes the tables; with `csv` also one of text where it is long.
    ///
    /// # Errors
    /// The machine failed.
    pub fn write_tables(&self, csv: bool) -> Result<(), FileError> {
        write_tables(&self.dir, &self.plan, &self.rows(), csv)
    }
}

impl fmt::Display for Edited {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Edited { changes, held, planned, unplanned } = self;
        write!(f, "the plan has changed")?;
        if !changes.is_empty() {
            write!(f, " ({})", changes.join("; "))?;
        }
        write!(f, "; {held} of {planned} rows still hold")?;
        if *unplanned > 0 {
            write!(f, ", {unplanned} that are no longer planned stay in the store")?;
        }
        Ok(())
    }
}

/// Refuses a folder in which somebody else has written under our names, which would be lost.
fn refuse_foreign(dir: &Path) -> Result<(), StoreError> {
    let (plan, experiment) = (dir.join(PLAN), dir.join(EXPERIMENT));
    if plan.exists() && !kept::is_ours(&plan) {
        return Err(StoreError::Foreign(plan));
    }
    // A killed program has made a journal, and perhaps no plan.
    let is_ours = plan.exists() || journal::path(dir).exists();
    if experiment.exists() && !is_ours { Err(StoreError::Foreign(experiment)) } else { Ok(()) }
}

/// Ids of cases with their values on the axes, in plan order.
pub(super) fn order(cases: &[Planned]) -> Vec<(String, Shared<Map<String, Value>>)> {
    cases.iter().map(|Planned { case, .. }| (case.id.clone(), case.axes.clone())).collect()
}

/// Rows of a plan that there are, in its order.
pub(super) fn rows(dir: &Path, order: &[(String, Shared<Map<String, Value>>)], done: &Journal) -> Vec<Row> {
    let row = |(case, axes): &(String, Shared<Map<String, Value>>)| {
        let Entry { case, build, measured } = done.rows.get(case)?.clone();
        let is_there = |recorded: &&Recorded| Target::ALL.iter().any(|target| recorded.is_whole(dir, *target, false));
        let recording = done.recorded(&case).filter(is_there).map(|recorded| recorded.name.clone());
        Some(Row { case, axes: axes.clone(), measured, recording, build })
    };
    order.iter().filter_map(row).collect()
}

pub(super) fn write_tables(dir: &Path, plan: &PlanFile, rows: &[Row], csv: bool) -> Result<(), FileError> {
    let table = table::Table::new(&plan.axes, rows);
    let written = table.written();
    let path = dir.join("rows.csv");
    if csv || rows.len() <= CSV_ROWS {
        write_whole(&path, &written.csv)?;
    } else {
        // Of fewer rows, and no longer true.
        files::remove(&path)?;
    }
    let path = dir.join("rows.parquet");
    write_whole(&path, &table.to_parquet(plan, &written.hash).map_err(|error| FileError::new(&path, error))?)
}

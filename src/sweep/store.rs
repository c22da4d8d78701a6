//! A folder of results: plan.json, journal.jsonl, rows.csv, rows.parquet.
//!
//! A row goes to the journal as soon as its case ends, so that nothing computed is lost; the tables are written from it
//! in plan order. The journal holds what was measured by case id, the plan holds the axes: a sweep whose axes have
//! grown finds its old rows again.
//!
//! Every line of the journal carries a checksum of the rest of it, so that a line that is torn or changed counts for
//! nothing and its case is run again. The journal is locked while a sweep adds to it: two at once would write over each
//! other's files.

use crate::build_info::BUILD;
use crate::digest::sha256;
use crate::files::{self, FileError, write_whole};
use crate::outcome::Outcome;
use crate::rows::plan_file::{PlanCase, PlanFile};
use crate::rows::{Measured, Row, table};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// One line of the journal.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Entry {
    pub case: String,
    pub build: String,
    #[serde(flatten)]
    pub measured: Measured,
}

/// The last entry of every case, by its id.
pub type Entries = HashMap<String, Entry>;

/// A folder of results, open for adding rows.
pub struct Store {
    dir: PathBuf,
    plan: PlanFile,
    /// Another one was here before.
    is_changed: bool,
    journal: File,
    done: Entries,
}

impl Store {
    /// Opens or makes the folder and writes the plan. Rows of another build count as missing, unless `keep`.
    ///
    /// # Errors
    /// The machine failed, or another program has the folder open.
    pub fn open(dir: &Path, plan: PlanFile, keep: bool) -> Result<Self, FileError> {
        files::make_folder(dir)?;
        let mut journal = open_alone(dir)?;
        let text = read_journal(dir)?;
        // A killed run may have left half a line: end it, so that the next one starts at its beginning.
        if text.last().is_some_and(|last| *last != b'\n') {
            journal.write_all(b"\n").map_err(|error| FileError::new(&journal_path(dir), error))?;
        }
        let mut done = entries(&text);
        if !keep {
            done.retain(|_, entry| entry.build == BUILD);
        }
        let before = read_plan(dir).ok().map(|before| before.hash);
        let is_changed = before.is_some_and(|hash| hash != plan.hash);
        write_whole(&plan_path(dir), serde_json::to_string(&plan).unwrap_or_default().as_bytes())?;
        Ok(Store { dir: dir.to_path_buf(), plan, is_changed, journal, done })
    }

    /// Opens a folder for reading its rows, of whatever build.
    pub fn read(dir: &Path) -> Result<(PlanFile, Entries), FileError> {
        Ok((read_plan(dir)?, entries(&read_journal(dir)?)))
    }

    /// Of an edited plan that goes on in its folder: how many of its rows are there already, and how many it has.
    pub fn still_hold(&self) -> Option<[usize; 2]> {
        let held = self.plan.cases.iter().filter(|planned| self.done.contains_key(&planned.case)).count();
        self.is_changed.then_some([held, self.plan.cases.len()])
    }

    /// Cases that have failed count as missing.
    pub fn forget_failed(&mut self) {
        self.done.retain(|_, entry| entry.measured.outcome != Outcome::Failed);
    }

    pub fn measured(&self, case: &str) -> Option<&Measured> {
        self.done.get(case).map(|entry| &entry.measured)
    }

    /// The same, if this very program measured it: another one may give other bits.
    pub fn measured_by_this_build(&self, case: &str) -> Option<&Measured> {
        self.done.get(case).filter(|entry| entry.build == BUILD).map(|entry| &entry.measured)
    }

    /// Appends to the journal at once.
    pub fn add(&mut self, case: &str, measured: Measured) -> Result<(), FileError> {
        let entry = Entry { case: case.to_string(), build: BUILD.to_string(), measured };
        let line = line(&entry);
        self.journal.write_all(line.as_bytes()).map_err(|error| FileError::new(&journal_path(&self.dir), error))?;
        self.done.insert(entry.case.clone(), entry);
        Ok(())
    }

    /// Rows that there are, in plan order.
    pub fn rows(&self) -> Vec<Row> {
        rows(&self.plan, &self.done)
    }

    pub fn write_tables(&self) -> Result<(), FileError> {
        let table = table::Table::new(&self.plan.axes, &self.rows());
        let csv = self.dir.join("rows.csv");
        write_whole(&csv, &table.to_csv().map_err(|error| FileError::new(&csv, error))?)?;
        let parquet = self.dir.join("rows.parquet");
        write_whole(&parquet, &table.to_parquet().map_err(|error| FileError::new(&parquet, error))?)
    }
}

/// Rows of a plan that there are, in its order.
pub fn rows(plan: &PlanFile, done: &Entries) -> Vec<Row> {
    let row = |planned: &PlanCase| {
        let Entry { case, build, measured } = done.get(&planned.case)?.clone();
        Some(Row { case, axes: planned.at.clone(), measured, build })
    };
    plan.cases.iter().filter_map(row).collect()
}

/// The journal for appending, locked until it is closed, by a kill too.
fn open_alone(dir: &Path) -> Result<File, FileError> {
    let path = journal_path(dir);
    let opened = OpenOptions::new().create(true).append(true).open(&path);
    let journal = opened.map_err(|error| FileError::new(&path, error))?;
    match journal.try_lock() {
        Ok(()) => Ok(journal),
        Err(TryLockError::WouldBlock) => Err(FileError::new(dir, "another gotai is at work here")),
        // A file system without locks, over a network for instance, has to be trusted.
        Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => Ok(journal),
        Err(TryLockError::Error(error)) => Err(FileError::new(&path, error)),
    }
}

/// Between what a line of the journal says and its checksum.
const SEAL: &str = ",\"sum\":\"";

/// What the journal says of a row: JSON, whose last member is 64 bits of the SHA-256 of all before it.
pub fn line(entry: &Entry) -> String {
    let text = serde_json::to_string(entry).unwrap_or_default();
    let said = text.strip_suffix('}').unwrap_or_default();
    format!("{said}{SEAL}{}\"}}\n", sha256(said, 8))
}

/// None: the line is not what was written.
fn entry(line: &[u8]) -> Option<Entry> {
    let (said, sum) = std::str::from_utf8(line).ok()?.rsplit_once(SEAL)?;
    let is_whole = sum.strip_suffix("\"}")? == sha256(said, 8);
    is_whole.then(|| serde_json::from_str(&format!("{said}}}")).ok())?
}

fn plan_path(dir: &Path) -> PathBuf {
    dir.join("plan.json")
}

fn read_plan(dir: &Path) -> Result<PlanFile, FileError> {
    let path = plan_path(dir);
    serde_json::from_slice(&files::read(&path)?).map_err(|error| FileError::new(&path, error))
}

fn journal_path(dir: &Path) -> PathBuf {
    dir.join("journal.jsonl")
}

/// Nothing: there is none yet.
fn read_journal(dir: &Path) -> Result<Vec<u8>, FileError> {
    let path = journal_path(dir);
    match std::fs::read(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Vec::new()),
        read => read.map_err(|error| FileError::new(&path, error)),
    }
}

/// Later lines win; a line that does not fit its checksum counts for nothing.
fn entries(journal: &[u8]) -> Entries {
    journal.split(|byte| *byte == b'\n').filter_map(entry).map(|entry| (entry.case.clone(), entry)).collect()
}

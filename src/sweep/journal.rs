//! journal.jsonl: what was measured and what was recorded, by the ids of cases, a line each.
//!
//! A line goes there as soon as its case ends, so that nothing computed is lost. Every line carries a checksum of the
//! rest of it, so that a line that is torn or changed counts for nothing and its case is run again. The journal is
//! locked while someone adds to it: two at once would write over each other's files.

use super::recorded::Recorded;
use crate::build_info::BUILD;
use crate::digest::sha256;
use crate::files::{FileError, write_whole};
use crate::rows::Measured;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// What was measured of a case.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Entry {
    pub case: String,
    pub build: String,
    #[serde(flatten)]
    pub measured: Measured,
}

/// One line.
#[derive(Deserialize)]
#[serde(untagged)]
enum Line {
    Recorded(Recorded),
    Row(Box<Entry>),
}

/// What a journal says: of every case the last line.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    pub rows: HashMap<String, Entry>,
    pub recordings: HashMap<String, Recorded>,
}

/// The journal of a folder, open for adding lines, by nobody else at the same time.
pub struct JournalFile {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Of a folder, which need not have one yet.
    ///
    /// # Errors
    /// The machine failed.
    pub fn read(dir: &Path) -> Result<Self, FileError> {
        Ok(Self::of(&read(dir)?))
    }

    fn of(text: &[u8]) -> Self {
        let mut journal = Journal::default();
        for said in text.split(|byte| *byte == b'\n').filter_map(said) {
            match serde_json::from_str::<Line>(&said) {
                Ok(Line::Recorded(recorded)) => drop(journal.recordings.insert(recorded.recorded.clone(), recorded)),
                Ok(Line::Row(entry)) => drop(journal.rows.insert(entry.case.clone(), *entry)),
                // Of another version.
                Err(_) => {}
            }
        }
        journal
    }

    /// Of a row that is there: the recording of the run that made it, or of this program's own.
    pub fn recorded(&self, case: &str) -> Option<&Recorded> {
        let build = &self.rows.get(case)?.build;
        self.recordings.get(case).filter(|recorded| [build.as_str(), BUILD].contains(&recorded.build.as_str()))
    }

    /// Leaves what this very program has made.
    pub fn retain_build(&mut self) {
        self.rows.retain(|_, entry| entry.build == BUILD);
        self.recordings.retain(|_, recorded| recorded.build == BUILD);
    }
}

impl JournalFile {
    /// Opens or makes a folder's journal, and reads it.
    ///
    /// # Errors
    /// The machine failed, or another program has it open.
    pub fn open(dir: &Path) -> Result<(Self, Journal), FileError> {
        let path = path(dir);
        let mut journal = JournalFile { file: open_alone(dir, &path)?, path };
        let text = read(dir)?;
        // A killed run may have left half a line: end it, so that the next one starts at its beginning.
        if text.last().is_some_and(|last| *last != b'\n') {
            journal.write("\n")?;
        }
        Ok((journal, Journal::of(&text)))
    }

    /// Appends a line at once.
    ///
    /// # Errors
    /// The machine failed.
    pub fn add(&mut self, entry: &impl Serialize) -> Result<(), FileError> {
        self.write(&line(entry))
    }

    /// Leaves these lines alone, in the order of the ids.
    ///
    /// # Errors
    /// The machine failed.
    pub fn rewrite(dir: &Path, kept: &Journal) -> Result<(), FileError> {
        let mut rows: Vec<&Entry> = kept.rows.values().collect();
        rows.sort_by_key(|entry| &entry.case);
        let mut recordings: Vec<&Recorded> = kept.recordings.values().collect();
        recordings.sort_by_key(|recorded| &recorded.recorded);
        let lines: String = rows.iter().map(line).chain(recordings.iter().map(line)).collect();
        write_whole(&path(dir), lines.as_bytes())
    }

    fn write(&mut self, text: &str) -> Result<(), FileError> {
        self.file.write_all(text.as_bytes()).map_err(|error| FileError::new(&self.path, error))
    }
}

/// Locked until it is closed, by a kill too.
fn open_alone(dir: &Path, path: &Path) -> Result<File, FileError> {
    let opened = OpenOptions::new().create(true).append(true).open(path);
    let journal = opened.map_err(|error| FileError::new(path, error))?;
    match journal.try_lock() {
        Ok(()) => Ok(journal),
        Err(TryLockError::WouldBlock) => Err(FileError::new(dir, "another gotai is at work here")),
        // A file system without locks, over a network for instance, has to be trusted.
        Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => Ok(journal),
        Err(TryLockError::Error(error)) => Err(FileError::new(path, error)),
    }
}

/// Between what a line of the journal says and its checksum.
const SEAL: &str = ",\"sum\":\"";

/// JSON, whose last member is 64 bits of the SHA-256 of all before it.
pub fn line(entry: &impl Serialize) -> String {
    let text = serde_json::to_string(entry).unwrap_or_default();
    let said = text.strip_suffix('}').unwrap_or_default();
    format!("{said}{SEAL}{}\"}}\n", sha256(said, 8))
}

/// What a line says; none: it is not what was written.
fn said(line: &[u8]) -> Option<String> {
    let (said, sum) = std::str::from_utf8(line).ok()?.rsplit_once(SEAL)?;
    let is_whole = sum.strip_suffix("\"}")? == sha256(said, 8);
    is_whole.then(|| format!("{said}}}"))
}

fn path(dir: &Path) -> PathBuf {
    dir.join("journal.jsonl")
}

/// Nothing: there is none yet.
fn read(dir: &Path) -> Result<Vec<u8>, FileError> {
    let path = path(dir);
    match std::fs::read(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Vec::new()),
        read => read.map_err(|error| FileError::new(&path, error)),
    }
}

//! The journal, journal.jsonl: what was measured and what was recorded, by the ids of cases, a line each.
//!
//! A line goes there as soon as its case ends, so that nothing computed is lost. Every line carries a checksum of the
//! rest of it, so that a line that is torn or changed counts for nothing and its case is run again. The journal is
//! locked while someone adds to it: two at once would write over each other's files.

use super::recorded::Recorded;
use crate::build_info::BUILD;
use crate::digest::{seal, sealed, unsealed};
use crate::files::{self, FileError, write_whole};
use crate::heading::{Datum, Headings};
use crate::rows::Measured;
use crate::shared::Shared;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Measurements of a case.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Entry {
    pub case: String,
    pub build: String,
    #[serde(flatten)]
    pub measured: Shared<Measured>,
}

/// One line.
#[derive(Deserialize)]
#[serde(untagged)]
enum Line {
    Recorded(Recorded),
    Row(Box<Entry>),
}

/// Content of a journal: of every case the last line.
#[derive(Clone, Debug, Default)]
pub struct Journal {
    pub rows: HashMap<String, Entry>,
    pub recordings: HashMap<String, Recorded>,
    /// Recordings that were replaced by those of later lines.
    pub superseded: Vec<Recorded>,
    /// Number of lines that are torn, changed, or of another version.
    pub unreadable: usize,
}

/// The journal of a folder, open for adding lines, by nobody else at the same time.
pub struct JournalFile {
    path: PathBuf,
    file: File,
    /// Whether a killed run has left half a line, which is ended before the next one.
    is_torn: bool,
}

impl Journal {
    /// Journal of a folder, which need not have one yet.
    ///
    /// # Errors
    /// The machine failed.
    pub fn read(dir: &Path) -> Result<Self, FileError> {
        Ok(Self::of(&read(dir)?))
    }

    fn of(text: &[u8]) -> Self {
        let mut journal = Journal::default();
        let lines = text.split(|byte| *byte == b'\n').filter(|line| !line.trim_ascii().is_empty());
        for line in lines {
            match unsealed(line).and_then(|said| serde_json::from_str::<Line>(&said).ok()) {
                Some(Line::Recorded(recorded)) => {
                    let before = journal.recordings.insert(recorded.recorded.clone(), recorded);
                    journal.superseded.extend(before);
                }
                Some(Line::Row(entry)) => drop(journal.rows.insert(entry.case.clone(), *entry)),
                None => journal.unreadable += 1,
            }
        }
        journal
    }

    /// Recording of a row that is there: of the run that made it, or of this program's own.
    pub fn recorded(&self, case: &str) -> Option<&Recorded> {
        let build = &self.rows.get(case)?.build;
        self.recordings.get(case).filter(|recorded| [build.as_str(), BUILD].contains(&recorded.build.as_str()))
    }

    /// Drops what another program has made.
    pub fn retain_build(&mut self) {
        self.rows.retain(|_, entry| entry.build == BUILD);
        self.recordings.retain(|_, recorded| recorded.build == BUILD);
    }
}

impl JournalFile {
    /// Journal of a folder, opened or made, and what it says.
    ///
    /// # Errors
    /// The machine failed, or another program has it open.
    pub fn open(dir: &Path) -> Result<(Self, Journal), FileError> {
        let path = path(dir);
        let file = open_alone(dir, &path)?;
        let text = read(dir)?;
        let is_torn = text.last().is_some_and(|last| *last != b'\n');
        Ok((JournalFile { path, file, is_torn }, Journal::of(&text)))
    }

    /// Appends a recording's line at once.
    ///
    /// # Errors
    /// The machine failed.
    pub fn add(&mut self, recorded: &Recorded) -> Result<(), FileError> {
        self.write(line(recorded).into_bytes())
    }

    /// Appends a row's line at once.
    ///
    /// # Errors
    /// The machine failed.
    pub fn add_row(&mut self, entry: &Entry) -> Result<(), FileError> {
        self.write(row_line(entry))
    }

    /// Makes these lines the whole journal, in the order of the ids.
    ///
    /// # Errors
    /// The machine failed.
    pub fn rewrite(dir: &Path, kept: &Journal) -> Result<(), FileError> {
        let mut rows: Vec<&Entry> = kept.rows.values().collect();
        rows.sort_by_key(|entry| &entry.case);
        let mut recordings: Vec<&Recorded> = kept.recordings.values().collect();
        recordings.sort_by_key(|recorded| &recorded.recorded);
        let recordings = recordings.iter().map(|recorded| line(recorded).into_bytes());
        let lines: Vec<u8> = rows.into_iter().map(row_line).chain(recordings).flatten().collect();
        write_whole(&path(dir), &lines)
    }

    fn write(&mut self, mut line: Vec<u8>) -> Result<(), FileError> {
        if std::mem::take(&mut self.is_torn) {
            line.insert(0, b'\n');
        }
        self.file.write_all(&line).map_err(|error| FileError::new(&self.path, error))
    }
}

/// A file for appending, made if it is not there, and locked until it is closed, by a kill too. `dir` is what messages
/// call it.
///
/// # Errors
/// Another program holds the lock, or the machine failed.
pub fn open_alone(dir: &Path, path: &Path) -> Result<File, FileError> {
    loop {
        let opened = OpenOptions::new().create(true).append(true).open(path);
        let file = opened.map_err(|error| FileError::new(path, error))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(FileError::new(dir, "another gotai is at work here")),
            // A file system without locks, over a network for instance, has to be trusted.
            Err(TryLockError::Error(error)) if error.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(FileError::new(path, error)),
        }
        // Someone who cleaned up may have put another one in its place, between opening it and locking it.
        if files::is_at(&file, path) {
            return Ok(file);
        }
    }
}

/// Row on a line of its own, sealed, without the columns of every row that are null.
fn row_line(Entry { case, build, measured }: &Entry) -> Vec<u8> {
    let mut said = Vec::with_capacity(1 << 11);
    let mut say = |name: &str, cell: Datum| {
        if cell != Datum::Null {
            said.push(if said.is_empty() { b'{' } else { b',' });
            Datum::Text(name).write_json(&mut said);
            said.push(b':');
            cell.write_json(&mut said);
        }
    };
    say("case", Datum::Text(case));
    say("build", Datum::Text(build));
    measured.each_cell(&mut say);
    let mut line = seal(said);
    line.push(b'\n');
    line
}

/// Sealed object on a line of its own.
pub fn line(entry: &impl Serialize) -> String {
    sealed(entry) + "\n"
}

/// Path of the journal in a folder.
pub(super) fn path(dir: &Path) -> PathBuf {
    dir.join("journal.jsonl")
}

/// Content of the journal; empty where there is none yet.
fn read(dir: &Path) -> Result<Vec<u8>, FileError> {
    let path = path(dir);
    match std::fs::read(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Vec::new()),
        read => read.map_err(|error| FileError::new(&path, error)),
    }
}

//! Recordings as a folder knows them: which case, by which program, how long and with which checksum.

use crate::build_info::BUILD;
use crate::case::Case;
use crate::digest::{sha256, sha256_of};
use crate::experiment::types::{Record, RecordCases};
use crate::files::FileError;
use crate::outcome::Outcome;
use crate::record::writer::{FileSum, Target};
use crate::study::Recording;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The recording of a case: one file a target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recorded {
    /// Id of the case.
    pub recorded: String,
    pub build: String,
    /// Name of the files, without their endings.
    pub name: String,
    /// Hash of what decides about its content beside the case.
    pub shows: String,
    /// Sums of the files by their endings.
    pub files: BTreeMap<String, Sum>,
}

/// Length and checksum that tell a file from one that was cut or changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sum {
    pub bytes: u64,
    pub sha256: String,
}

impl Recorded {
    /// Recording of files that have just been written, with these sums, of a run that ended so.
    pub fn of(Recording { case, name, .. }: Recording, outcome: Outcome, sums: Vec<FileSum>) -> Self {
        let sum = |FileSum { target, bytes, sha256 }| (target.extension().to_string(), Sum { bytes, sha256 });
        let (name, files) = (name.ended(outcome), sums.into_iter().map(sum).collect());
        Recorded { recorded: case.id.clone(), build: BUILD.to_string(), shows: shows(case), name, files }
    }

    /// The recording with the files of another one that is of the same run and shows the same.
    pub fn with_files_of(mut self, before: &Recorded) -> Self {
        let of = |recorded: &Recorded| [&recorded.build, &recorded.name, &recorded.shows].map(String::clone);
        if of(&self) == of(before) {
            for (ending, sum) in &before.files {
                self.files.entry(ending.clone()).or_insert_with(|| sum.clone());
            }
        }
        self
    }

    /// Whether the file is there, has its length, and, looked at in full, its checksum.
    pub fn is_whole(&self, dir: &Path, target: Target, in_full: bool) -> bool {
        let path = target.path(dir, &self.name);
        let Some(sum) = self.files.get(target.extension()) else { return false };
        let has_length = std::fs::metadata(&path).is_ok_and(|file| file.len() == sum.bytes);
        has_length && (!in_full || Sum::of(&path).is_ok_and(|found| found == *sum))
    }
}

impl Sum {
    fn of(path: &Path) -> Result<Self, FileError> {
        const BUFFER: usize = 1 << 20;
        let read = File::open(path).and_then(|file| sha256_of(BufReader::with_capacity(BUFFER, file)));
        let (bytes, sha256) = read.map_err(|error| FileError::new(path, error))?;
        Ok(Sum { bytes, sha256 })
    }
}

/// Hash of the question and of `record:`, without the kinds of file and the choice of cases.
pub fn shows(case: &Case) -> String {
    let record = Record { to: None, cases: RecordCases::All, ..case.experiment.record.clone() };
    sha256(json!([case.experiment.question, record]).to_string(), 8)
}

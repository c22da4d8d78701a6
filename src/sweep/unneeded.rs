//! Files and rows of a folder of results that nobody needs, and the size of its files.

use super::folder::Folder;
use super::leftovers;
use crate::build_info::BUILD;
use crate::files::FileError;
use crate::record::name::RecordingName;
use crate::record::writer::{PARTIAL, Target};
use crate::study::reference;
use serde::Serialize;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Folder below a folder of results for what runs of single rows leave; and how their locks end.
pub const REPLAYS: &str = "replays";
pub const LOCK: &str = "lock";

/// Names of what a kill may leave of files that are written whole or not at all.
const HALF_WRITTEN: [&str; 4] = ["experiment.partial", "plan.partial", "rows.partial", "journal.partial"];

/// Sizes of a folder's files, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Bytes {
    pub total: u64,
    pub recordings: u64,
    pub replays: u64,
    /// Size of what `gotai clean` drops beside replays.
    pub unneeded: u64,
}

/// Files and rows that nobody needs any more.
#[derive(Clone, Debug, Default)]
pub struct Unneeded {
    /// Files that runs of single rows have left.
    pub replays: Vec<PathBuf>,
    /// Recordings that were being written when their program was killed, or that newer ones stand for.
    pub leftovers: Vec<PathBuf>,
    /// Recordings of other builds.
    pub recordings: Vec<PathBuf>,
    /// References of other builds.
    pub references: Vec<PathBuf>,
    /// Number of rows of other builds.
    pub rows: usize,
    /// Number of lines of the journal that nobody can read.
    pub lines: usize,
}

impl Unneeded {
    /// Files and rows in a folder of results that nobody needs.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn of(folder: &Folder) -> Result<Self, FileError> {
        let Folder { dir, journal, .. } = folder;
        let mut leftovers = leftovers::partial(dir)?;
        leftovers.extend(leftovers::older(dir, journal));
        leftovers.extend(HALF_WRITTEN.map(|name| dir.join(name)).into_iter().filter(|path| path.exists()));
        let (ours, others): (Vec<_>, Vec<_>) =
            journal.recordings.values().partition(|recorded| recorded.build == BUILD);
        let ours: HashSet<&str> = ours.iter().map(|recorded| recorded.name.as_str()).collect();
        let others = others.iter().filter(|recorded| !ours.contains(recorded.name.as_str()));
        let files = others.flat_map(|recorded| Target::ALL.map(|target| target.path(dir, &recorded.name)));
        let mut recordings: Vec<_> = files.filter(|path| path.exists()).collect();
        recordings.sort();
        let replays = files_of(&dir.join(REPLAYS))?.into_iter().filter(|path| is_replay(path)).collect();
        Ok(Unneeded {
            replays,
            leftovers,
            recordings,
            references: files_of(dir)?.into_iter().filter(|path| is_reference_of_another_build(path)).collect(),
            rows: journal.rows.values().filter(|entry| entry.build != BUILD).count(),
            lines: journal.unreadable,
        })
    }

    /// Files of all kinds but the replays.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.leftovers.iter().chain(&self.recordings).chain(&self.references)
    }
}

impl Bytes {
    /// Sizes of the files in a folder of results.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn of(folder: &Folder) -> Result<Self, FileError> {
        let unneeded = Unneeded::of(folder)?;
        let all = files_of(&folder.dir)?;
        let is_recording = |path: &&PathBuf| Target::ALL.iter().any(|target| ends(path, target.extension()));
        let replays = size(&unneeded.replays);
        Ok(Bytes {
            total: size(&all) + replays,
            recordings: size(all.iter().filter(is_recording)),
            replays,
            unneeded: size(unneeded.files()),
        })
    }
}

/// Size of files, in bytes; those that have just gone count for nothing.
pub fn size<'a>(files: impl IntoIterator<Item = &'a PathBuf>) -> u64 {
    files.into_iter().filter_map(|path| Some(std::fs::metadata(path).ok()?.len())).sum()
}

fn ends(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|own| own == ending)
}

/// A name that this program gives, of a recording or of the lock of a replay.
fn is_replay(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    let Some((stem, ending)) = name.rsplit_once('.') else { return false };
    let is_made = ["ghosts_", "view_"].iter().any(|word| stem.starts_with(word));
    let is_whole = is_made || RecordingName::values_of(stem).is_some() || stem.ends_with(PARTIAL.trim_end_matches('.'));
    ending == LOCK || (is_whole && Target::ALL.iter().any(|target| target.extension() == ending))
}

/// Half written, or made by another program.
fn is_reference_of_another_build(path: &Path) -> bool {
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    let id = name.strip_prefix("reference-").and_then(|rest| rest.split_once('.'));
    match id {
        Some((id, "partial")) => leftovers::is_id(id),
        Some((id, "json")) => leftovers::is_id(id) && !reference::is_current(path),
        _ => false,
    }
}

/// Files in a folder, which need not be there, in the order of their names. A link is followed nowhere.
fn files_of(dir: &Path) -> Result<Vec<PathBuf>, FileError> {
    if !dir.symlink_metadata().is_ok_and(|found| found.is_dir()) && !Folder::is_one(dir) {
        return Ok(Vec::new());
    }
    let entries = std::fs::read_dir(dir).map_err(|error| FileError::new(dir, error))?;
    let is_file = |path: &PathBuf| path.symlink_metadata().is_ok_and(|found| found.is_file());
    let mut files: Vec<_> = entries.flatten().map(|entry| entry.path()).filter(is_file).collect();
    files.sort();
    Ok(files)
}

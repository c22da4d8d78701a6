//! Files of recordings that nobody needs: what a kill has left half written, what a newer one stands for. Only names
//! that this program has written itself: a user's copies are his.

use super::journal::Journal;
use super::recorded::Recorded;
use crate::files::FileError;
use crate::record::writer::{PARTIAL, Target};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// Number of digits of a case's id.
const ID: usize = 16;

/// Recordings that were being written when their program was killed.
///
/// # Errors
/// The folder cannot be read.
pub fn partial(dir: &Path) -> Result<Vec<PathBuf>, FileError> {
    let entries = std::fs::read_dir(dir).map_err(|error| FileError::new(dir, error))?;
    let named = entries.flatten().filter_map(|entry| Some((entry.file_name().into_string().ok()?, entry.path())));
    let mut found: Vec<_> = named.filter(|(name, _)| is_partial(name)).map(|(_, path)| path).collect();
    found.sort();
    Ok(found)
}

fn is_partial(name: &str) -> bool {
    let endings = Target::ALL.map(Target::extension);
    name.split_once(PARTIAL).is_some_and(|(id, ending)| is_id(id) && endings.contains(&ending))
}

/// Whether a text is the whole id of a case.
pub(super) fn is_id(text: &str) -> bool {
    text.len() == ID && text.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f'))
}

/// Files that cases have had before they had those of now; an older program called a file by its case's id alone.
pub fn older(dir: &Path, journal: &Journal) -> Vec<PathBuf> {
    let files = |recorded: &Recorded| {
        let targets = Target::ALL.into_iter().filter(|target| recorded.files.contains_key(target.extension()));
        targets.map(|target| target.path(dir, &recorded.name)).collect::<Vec<_>>()
    };
    let current: HashSet<PathBuf> = journal.recordings.values().flat_map(files).collect();
    let before = journal.superseded.iter().flat_map(files);
    let by_id = journal.recordings.keys().flat_map(|case| Target::ALL.map(|target| target.path(dir, case)));
    let older: HashSet<PathBuf> = before.chain(by_id).filter(|path| !current.contains(path) && path.exists()).collect();
    let mut older: Vec<_> = older.into_iter().collect();
    older.sort();
    older
}

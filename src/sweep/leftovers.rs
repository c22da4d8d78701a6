//! Files of recordings that nobody needs: what a kill has left half written, what a newer one stands for.

use super::recorded::Recorded;
use crate::files::FileError;
use crate::record::name::RecordingName;
use crate::record::writer::{PARTIAL, Target};
use std::path::{Path, PathBuf};

/// Digits of a case's id.
const ID: usize = 16;

/// Recordings that were being written when their program was killed.
///
/// # Errors
/// The folder cannot be read.
pub fn partial(dir: &Path) -> Result<Vec<PathBuf>, FileError> {
    let is_partial = |(name, _): &(String, PathBuf)| name.split_once(PARTIAL).is_some_and(|(id, _)| is_id(id, ID));
    Ok(recordings(dir)?.into_iter().filter(is_partial).map(|(_, path)| path).collect())
}

/// Other files of cases than those that their recordings have.
///
/// # Errors
/// The folder cannot be read.
pub fn older<'a>(dir: &Path, known: impl Iterator<Item = &'a Recorded>) -> Result<Vec<PathBuf>, FileError> {
    let known: Vec<&Recorded> = known.collect();
    let is_older = |(name, _): &(String, PathBuf)| {
        let Some((stem, ending)) = name.rsplit_once('.') else { return false };
        let Some(digits) = digits(stem) else { return false };
        let of_case = known.iter().filter(|recorded| recorded.recorded.starts_with(digits));
        let mut names = of_case.map(|recorded| recorded.name == stem && recorded.files.contains_key(ending)).peekable();
        names.peek().is_some() && !names.any(|is_its_own| is_its_own)
    };
    Ok(recordings(dir)?.into_iter().filter(is_older).map(|(_, path)| path).collect())
}

/// Of the id, at the end of a name; older programs called a file by its id alone.
fn digits(stem: &str) -> Option<&str> {
    let digits = stem.rsplit_once('.').map_or(stem, |(_, digits)| digits);
    (is_id(digits, ID) || (digits.len() < stem.len() && is_id(digits, RecordingName::DIGITS))).then_some(digits)
}

fn is_id(text: &str, len: usize) -> bool {
    text.len() == len && text.bytes().all(|c| matches!(c, b'0'..=b'9' | b'a'..=b'f'))
}

/// Names and paths of a folder's files that end as recordings do, in the order of their names.
fn recordings(dir: &Path) -> Result<Vec<(String, PathBuf)>, FileError> {
    let entries = std::fs::read_dir(dir).map_err(|error| FileError::new(dir, error))?;
    let ends = |name: &str| Target::ALL.iter().any(|target| name.ends_with(&format!(".{}", target.extension())));
    let named = entries.flatten().filter_map(|entry| Some((entry.file_name().into_string().ok()?, entry.path())));
    let mut found: Vec<_> = named.filter(|(name, _)| ends(name)).collect();
    found.sort();
    Ok(found)
}

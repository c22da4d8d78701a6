//! Files that are whole or not there, and errors of the machine.

use std::fs::{File, Metadata};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Failure of the machine: disk full, no permission.
#[derive(Debug, thiserror::Error)]
#[error("{path}: {reason}")]
pub struct FileError {
    pub path: PathBuf,
    pub reason: String,
}

impl FileError {
    pub fn new(path: &Path, reason: impl std::fmt::Display) -> Self {
        FileError { path: path.to_path_buf(), reason: reason.to_string() }
    }
}

/// Writes a file under a temporary name first: a file with the final name is whole. An error names the
/// file that was asked for.
///
/// # Errors
/// The machine failed.
pub fn write_whole(path: &Path, content: &[u8]) -> Result<(), FileError> {
    let partial = path.with_extension("partial");
    std::fs::write(&partial, content).map_err(|error| FileError::new(path, error))?;
    std::fs::rename(&partial, path).map_err(|error| FileError::new(path, error))
}

/// The same, unless it is there already: to put a file in another one's place takes a file system longer.
///
/// # Errors
/// The machine failed.
pub fn write_if_new(path: &Path, content: &[u8]) -> Result<(), FileError> {
    if std::fs::read(path).is_ok_and(|there| there == content) { Ok(()) } else { write_whole(path, content) }
}

/// Makes a folder if it is not there, and those above it.
///
/// # Errors
/// The machine failed.
pub fn make_folder(dir: &Path) -> Result<(), FileError> {
    std::fs::create_dir_all(dir).map_err(|error| FileError::new(dir, error))
}

/// Takes a file away; that it is not there is no error.
///
/// # Errors
/// The machine failed.
pub fn remove(path: &Path) -> Result<(), FileError> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(FileError::new(path, error)),
        _ => Ok(()),
    }
}

/// Takes a folder away in which nothing is left; one that holds something, or is not there, is left alone.
///
/// # Errors
/// The machine failed.
pub fn remove_empty_folder(path: &Path) -> Result<(), FileError> {
    match std::fs::remove_dir(path) {
        Err(error) if ![ErrorKind::NotFound, ErrorKind::DirectoryNotEmpty].contains(&error.kind()) => {
            Err(FileError::new(path, error))
        }
        _ => Ok(()),
    }
}

/// Whether an open file is the one that is now at this path; where a system cannot tell, it is.
pub fn is_at(file: &File, path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let same = |(a, b): (Metadata, Metadata)| (a.dev(), a.ino()) == (b.dev(), b.ino());
        file.metadata().ok().zip(std::fs::metadata(path).ok()).is_some_and(same)
    }
    #[cfg(not(unix))]
    true
}

/// Content of a file.
///
/// # Errors
/// It is not there, or the machine failed.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    std::fs::read(path).map_err(|error| FileError::new(path, error))
}

/// A word, mostly a path, as a shell takes it for one.
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=~,:@%".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_string(),
        false => format!("'{}'", word.replace('\'', r"'\''")),
    }
}

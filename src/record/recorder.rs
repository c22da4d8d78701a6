//! A file format, and what is said when the machine fails.

use super::sample::{Batch, Ending, Event};
use std::error::Error;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// A file format. Made by its own constructor from a path and a `Header`.
pub trait Recorder: Send {
    /// Writes a batch; what is written survives a kill of the program.
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError>;
    /// Writes an event; it comes after every sample written before.
    fn event(&mut self, event: &Event) -> Result<(), RecordError>;
    /// Says how the run ended and closes the file; without it a file is incomplete.
    fn finish(self: Box<Self>, ending: &Ending) -> Result<(), RecordError>;
}

/// The machine failed: disk full, no permission.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {path}: {reason}")]
pub struct RecordError {
    pub path: PathBuf,
    pub reason: String,
}

impl RecordError {
    pub fn new(path: &Path, reason: impl Display) -> Self {
        RecordError { path: path.to_path_buf(), reason: reason.to_string() }
    }

    /// With every cause: libraries say "cannot write" and keep "no space left" for the next in the chain.
    pub fn caused(path: &Path, error: &dyn Error) -> Self {
        let mut reason = error.to_string();
        let mut cause = error.source();
        while let Some(error) = cause {
            let text = error.to_string();
            // Some errors repeat their cause.
            if !reason.contains(&text) {
                reason = format!("{reason}: {text}");
            }
            cause = error.source();
        }
        RecordError::new(path, reason)
    }
}

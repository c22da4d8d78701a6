//! Interface of the file formats, and the error of a failing machine.

use super::sample::{Batch, Ending, Event};
use std::error::Error;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Writer of a file format. Its own constructor makes it from a path and a `Header`.
pub trait Recorder: Send {
    /// Writes a batch; what is written survives a kill of the program.
    ///
    /// # Errors
    /// The machine failed.
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError>;
    /// Writes an event; it comes after every sample written before.
    ///
    /// # Errors
    /// The machine failed.
    fn event(&mut self, event: &Event) -> Result<(), RecordError>;
    /// Writes samples and events that a later `write` brings again, so that a kill of the program does not lose them;
    /// that one puts them where they belong. What is shown in a row follows what was shown before.
    ///
    /// # Errors
    /// The machine failed.
    fn ahead(&mut self, _: &Batch) -> Result<(), RecordError> {
        Ok(())
    }
    /// Bytes of the file that are written, without what stands ahead; 0 of what is no file.
    fn bytes(&self) -> u64 {
        0
    }
    /// Says how the run ended and closes the file; without it a file is incomplete.
    ///
    /// # Errors
    /// The machine failed.
    fn finish(self: Box<Self>, ending: &Ending) -> Result<(), RecordError>;
}

/// Failure of the machine: disk full, no permission.
#[derive(Debug, thiserror::Error)]
#[error("cannot {verb} {path}: {reason}")]
pub struct RecordError {
    verb: &'static str,
    pub path: PathBuf,
    pub reason: String,
}

impl RecordError {
    pub fn new(path: &Path, reason: impl Display) -> Self {
        RecordError { verb: "write", path: path.to_path_buf(), reason: reason.to_string() }
    }

    /// Of a file that cannot be read.
    pub fn unread(path: &Path, reason: impl Display) -> Self {
        RecordError { verb: "read", path: path.to_path_buf(), reason: reason.to_string() }
    }

    /// Error with every cause: libraries say "cannot write" and keep "no space left" for the next in the chain.
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

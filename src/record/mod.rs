//! Recorders: what a run shows, to files.

pub mod sample;
pub mod sampler;

use sample::{Batch, Event};
use std::path::PathBuf;

/// A file format. Made by its own constructor from a path and a `Header`.
pub trait Recorder: Send {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError>;
    fn event(&mut self, event: &Event) -> Result<(), RecordError>;
    /// Closes the file; without it a file is incomplete.
    fn finish(self: Box<Self>) -> Result<(), RecordError>;
}

/// The machine failed: disk full, no permission.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {path}: {reason}")]
pub struct RecordError {
    pub path: PathBuf,
    pub reason: String,
}

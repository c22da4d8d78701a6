//! Errors of the commands, with their exit codes.

use super::output::{has_document, print_json, say};
use crate::experiment::ExperimentError;
use crate::files::FileError;
use crate::record::RecordError;
use crate::sweep::folder::FolderError;
use crate::sweep::runner::SweepError;
use crate::sweep::store::StoreError;
use serde_json::{Value, json};
use std::process::ExitCode;

/// Reason why a command failed; it says the exit code.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    #[error("{0}")]
    Input(String),
    #[error(transparent)]
    Record(#[from] RecordError),
    #[error(transparent)]
    File(#[from] FileError),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(transparent)]
    Folder(#[from] FolderError),
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error("{0}")]
    Machine(String),
}

impl CliError {
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.code())
    }

    /// Says it on stderr; on stdout too, as a document, where one was asked for.
    pub fn say(&self) {
        say(format!("gotai: {self}"));
        document(&self.to_string(), self.code());
    }

    /// Adds it to the document of what has been done all the same.
    pub(super) fn put_into(&self, document: &mut Value) {
        document["error"] = json!(self.to_string());
        document["exit_code"] = json!(self.code());
    }

    /// The exit code as a number: 2 of wrong input, 3 of a machine that failed.
    pub(super) fn code(&self) -> u8 {
        let input_is_wrong = match self {
            CliError::Experiment(error) => !error.is_machine(),
            CliError::Input(_) | CliError::Store(StoreError::Foreign(_)) => true,
            CliError::Folder(error) => !matches!(error, FolderError::Experiment(error) if error.is_machine()),
            _ => false,
        };
        if input_is_wrong { 2 } else { 3 }
    }
}

/// Prints what went wrong as the one document of `--json`, if it was given and none is printed: whoever reads documents
/// gets one.
pub(super) fn document(said: &str, exit_code: u8) {
    if !has_document() && std::env::args_os().any(|arg| arg == "--json") {
        print_json(&json!({ "error": said, "exit_code": exit_code }));
    }
}

//! `gotai schema`: the JSON Schema of the experiment file, for editors.

use super::error::CliError;
use super::output::print;
use crate::experiment::schema::schema;
use clap::Args;
use std::process::ExitCode;

/// For an editor that knows YAML: `gotai schema > gotai.json`, and `# yaml-language-server: $schema=gotai.json` on top
/// of a file
#[derive(Args)]
pub struct Command {}

impl Command {
    /// Prints the schema.
    ///
    /// # Errors
    /// None.
    pub fn run(self) -> Result<ExitCode, CliError> {
        print(serde_json::to_string_pretty(&schema()).unwrap_or_default());
        Ok(ExitCode::SUCCESS)
    }
}

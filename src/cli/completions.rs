//! `gotai completions`: what a shell completes, made from the declarations of the commands.

use super::error::CliError;
use super::output::print;
use clap::Args;
use clap_complete::{Shell, generate};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// The shell, e.g. bash: `gotai completions bash > ~/.local/share/bash-completion/completions/gotai`
    #[arg(value_enum)]
    shell: Shell,
}

impl Command {
    /// Prints the completions of a program.
    ///
    /// # Errors
    /// None.
    pub fn run(self, mut program: clap::Command) -> Result<ExitCode, CliError> {
        let mut text = Vec::new();
        generate(self.shell, &mut program, "gotai", &mut text);
        print(String::from_utf8_lossy(&text).trim_end());
        Ok(ExitCode::SUCCESS)
    }
}

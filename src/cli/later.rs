//! Commands and flags that a later version brings: refused by name, so that nobody searches for a typing error.

use super::error::document;
use super::output::say;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use std::process::ExitCode;

const COMMANDS: [&str; 2] = ["merge", "submit"];
const FLAGS: [&str; 1] = ["--shard"];

/// Prints a parser's message (or help) and gives the exit code.
pub fn explain_usage(error: &clap::Error) -> ExitCode {
    let named = |kind, names: &[&'static str]| match error.get(kind) {
        Some(ContextValue::String(found)) => names.iter().find(|name| found.split('=').next() == Some(name)).copied(),
        _ => None,
    };
    let later = match error.kind() {
        ErrorKind::InvalidSubcommand => named(ContextKind::InvalidSubcommand, &COMMANDS),
        ErrorKind::UnknownArgument => named(ContextKind::InvalidArg, &FLAGS),
        _ => None,
    };
    match later {
        Some(name) => say(format!("gotai: `{name}` is not available in this version")),
        // Nowhere to report a closed terminal to.
        None => drop(error.print()),
    }
    if error.use_stderr() {
        let said = later.map(|name| format!("`{name}` is not available in this version"));
        document(&said.unwrap_or_else(|| error.to_string()), 2);
    }
    if error.use_stderr() { ExitCode::from(2) } else { ExitCode::SUCCESS }
}

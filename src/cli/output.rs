//! What is printed.

use std::io::Write;

/// Prints to stdout; a reader that has gone away is no error.
pub(super) fn print(text: impl std::fmt::Display) {
    let _ = writeln!(std::io::stdout(), "{text}");
}

pub(super) fn print_json(value: &impl serde::Serialize) {
    print(serde_json::to_string(value).unwrap_or_default());
}

/// To a tenth of a megabyte.
pub(super) fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

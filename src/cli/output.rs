//! Output of the commands.

use std::io::{ErrorKind, Write};

/// Prints to stdout. A reader that has gone away is no error; a disk that is full is the machine's.
pub(super) fn print(text: impl std::fmt::Display) {
    let mut out = std::io::stdout();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            eprintln!("gotai: cannot write the output: {error}");
            std::process::exit(3);
        }
        _ => {}
    }
}

pub(super) fn print_json(value: &impl serde::Serialize) {
    print(serde_json::to_string(value).unwrap_or_default());
}

/// A number of bytes in megabytes, to a tenth of one.
pub(super) fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

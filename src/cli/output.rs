//! Output of the commands.

use clap::ValueEnum;
use std::io::{ErrorKind, IsTerminal, Write};

/// When output has colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum ColorFlag {
    /// On a terminal, unless NO_COLOR is set
    #[default]
    Auto,
    /// Into files and pipes too, whatever NO_COLOR says
    Always,
    Never,
}

/// Colour of what is told apart by it; nothing is said by colour alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hue {
    Good,
    Bad,
    Doubtful,
    Faint,
}

/// Width in letters of what goes into a file or a CI's log.
const WIDTH: u16 = 140;

impl ColorFlag {
    /// Whether what goes to this stream has colour: the one place that decides it. (<https://no-color.org>: NO_COLOR
    /// says it if it is not empty, and a flag says more than a variable.)
    pub(super) fn is_on(self, stream: &impl IsTerminal) -> bool {
        let is_set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
        match self {
            ColorFlag::Always => true,
            ColorFlag::Never => false,
            ColorFlag::Auto => {
                let is_dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
                stream.is_terminal() && !is_set("NO_COLOR") && !is_dumb
            }
        }
    }
}

impl Hue {
    /// A text in this colour, if there is colour.
    pub(super) fn paint(self, text: &str, is_colored: bool) -> String {
        let code = match self {
            Hue::Good => "32",
            Hue::Bad => "1;31",
            Hue::Doubtful => "33",
            Hue::Faint => "2",
        };
        if is_colored { format!("\u{1b}[{code}m{text}\u{1b}[0m") } else { text.to_string() }
    }
}

/// Width of what is printed, in letters: COLUMNS, else that of the terminal.
pub(super) fn width() -> u16 {
    let given = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    let of_terminal = || if std::io::stdout().is_terminal() { comfy_table::Table::new().width() } else { None };
    // A table in fewer letters than these has no room for a number.
    const LEAST: u16 = 40;
    given.filter(|width| *width > 0).or_else(of_terminal).unwrap_or(WIDTH).max(LEAST)
}

/// A text in lines of at most this many letters, broken at spaces; the first line begins with `first`, the others with
/// `rest`. What has no space is not broken.
pub(super) fn wrapped(text: &str, width: usize, first: &str, rest: &str) -> String {
    let (mut lines, mut line, mut is_begun) = (Vec::new(), first.to_string(), false);
    for word in text.split_whitespace() {
        if is_begun && line.chars().count() + 1 + word.chars().count() > width {
            lines.push(std::mem::replace(&mut line, rest.to_string()));
            is_begun = false;
        }
        if is_begun {
            line.push(' ');
        }
        line.push_str(word);
        is_begun = true;
    }
    lines.push(line);
    lines.join("\n")
}

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

//! Output of the commands.

use crate::report::is_shown;
use clap::ValueEnum;
use std::io::{ErrorKind, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether anything has been painted: only then does an escape sequence belong to what is printed.
static IS_PAINTED: AtomicBool = AtomicBool::new(false);
/// Whether a document has been printed: `--json` promises one.
static HAS_DOCUMENT: AtomicBool = AtomicBool::new(false);

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

/// How progress is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum ProgressFlag {
    /// A bar on a terminal, nothing elsewhere
    #[default]
    Auto,
    /// Events on stderr, a JSON object a line
    Json,
    None,
}

/// Colour of what is told apart by it; nothing is said by colour alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hue {
    Good,
    Bad,
    Doubtful,
    Faint,
}

/// Sequence that ends a colour.
const END: &str = "\u{1b}[0m";

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
    const ALL: [Hue; 4] = [Hue::Good, Hue::Bad, Hue::Doubtful, Hue::Faint];

    /// Sequence that begins this colour.
    const fn begin(self) -> &'static str {
        match self {
            Hue::Good => "\u{1b}[32m",
            Hue::Bad => "\u{1b}[1;31m",
            Hue::Doubtful => "\u{1b}[33m",
            Hue::Faint => "\u{1b}[2m",
        }
    }

    /// A text in this colour, if there is colour.
    pub(super) fn paint(self, text: &str, is_colored: bool) -> String {
        if !is_colored {
            return text.to_string();
        }
        IS_PAINTED.store(true, Ordering::Relaxed);
        format!("{}{text}{END}", self.begin())
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

/// A text as a terminal may have it: words of files and names of folders are data, and turn no cursor, no colour and no
/// line around. Lines, tabs and the colours of `Hue` stay.
pub(super) fn cleaned(text: &str) -> String {
    let is_painted = IS_PAINTED.load(Ordering::Relaxed);
    let (mut clean, mut rest) = (String::with_capacity(text.len()), text);
    while let Some(c) = rest.chars().next() {
        let hue = Hue::ALL.map(Hue::begin).into_iter().chain([END]).find(|hue| is_painted && rest.starts_with(hue));
        let length = hue.map_or(c.len_utf8(), str::len);
        if hue.is_some() || c == '\n' || c == '\t' || is_shown(c) {
            clean.push_str(&rest[..length]);
        }
        rest = &rest[length..];
    }
    clean
}

/// Prints to stdout, without what is no letter.
pub(super) fn print(text: impl std::fmt::Display) {
    print_as_it_is(cleaned(&text.to_string()));
}

/// Prints what holds no word that has not been cleaned. A reader that has gone away is no error; a disk that is full is
/// the machine's.
pub(super) fn print_as_it_is(text: impl std::fmt::Display) {
    let mut out = std::io::stdout();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            eprintln!("gotai: cannot write the output: {error}");
            std::process::exit(3);
        }
        _ => {}
    }
}

/// Prints a table's text: to a terminal without what is no letter, into a file or a program as it is.
pub(super) fn print_data(text: &str) {
    if std::io::stdout().is_terminal() { print(text) } else { print_as_it_is(text) }
}

/// Prints a line to stderr, without what is no letter. A closed stderr is no error.
pub fn say(text: impl std::fmt::Display) {
    drop(writeln!(std::io::stderr(), "{}", cleaned(&text.to_string())));
}

/// Prints a document in one line; what is no letter is escaped, and so the data are whole.
pub(super) fn print_json(value: &impl serde::Serialize) {
    HAS_DOCUMENT.store(true, Ordering::Relaxed);
    let text = serde_json::to_string(value).unwrap_or_default();
    let escaped = |c: char| if is_shown(c) { c.to_string() } else { format!("\\u{:04x}", u32::from(c)) };
    print_as_it_is(text.chars().map(escaped).collect::<String>());
}

/// Whether `print_json` has printed one.
pub(super) fn has_document() -> bool {
    HAS_DOCUMENT.load(Ordering::Relaxed)
}

/// A number of things, whose plural ends with an s.
pub(super) fn counted(count: usize, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// A number of bytes in megabytes, to a tenth of one.
pub(super) fn megabytes(bytes: u64) -> String {
    format!("{:.1} MB", bytes as f64 / 1e6)
}

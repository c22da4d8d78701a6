//! Story of a run: the instants that decide about it, as the recording opens with them.

use serde::{Deserialize, Serialize};

/// What makes an instant decisive, in the order of a table of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Decisive {
    FirstContact,
    FirstGain,
    LargestGain,
    Onset,
    MostContacts,
    End,
}

impl Decisive {
    /// Words of it in a table.
    pub fn name(self) -> &'static str {
        match self {
            Decisive::FirstContact => "first contact",
            Decisive::FirstGain => "first step that gains energy",
            Decisive::LargestGain => "largest gain in a step",
            Decisive::Onset => "from here on more energy than at the start",
            Decisive::MostContacts => "most contacts",
            Decisive::End => "end",
        }
    }
}

/// An instant that decides about a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TurningPoint {
    pub what: Decisive,
    pub step: u64,
    /// When the contacts of the step act; of the end, its time.
    pub time_s: f64,
    /// What happened then, in words.
    pub text: String,
}

/// A step that gained energy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergyGain {
    pub step: u64,
    /// When its contacts act.
    pub acted_s: f64,
    /// Its end.
    pub time_s: f64,
    /// Energy less the work of loads, before and after.
    pub before_j: f64,
    pub after_j: f64,
}

/// What happened in a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Story {
    /// In the order of time.
    pub turns: Vec<TurningPoint>,
    /// Steps that gained energy, the first `Story::MOST_GAINS` of them.
    pub gains: Vec<EnergyGain>,
    /// Number of steps that gained energy.
    pub gains_count: u64,
    /// Energy at the start.
    pub start_j: f64,
    /// Part of the run to look at first.
    pub stretch_s: [f64; 2],
    /// Up to when a body that has been thrown away by an error is not yet.
    pub calm_until_s: f64,
}

impl Story {
    /// Most marks on a plot.
    pub const MOST_GAINS: usize = 1_000;

    /// The instant of a kind, if there is one.
    pub fn turn(&self, what: Decisive) -> Option<&TurningPoint> {
        self.turns.iter().find(|turn| turn.what == what)
    }
}

/// A number to its last bit, in as few characters as it takes.
pub fn shortest(x: f64) -> String {
    let text = format!("{x:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_string)
}

/// A text as Markdown shows it: what would be a mark or the edge of a cell stands for itself, in one line.
pub fn markdown(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut before = ' ';
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        // Inside a word, as in the name of a column, an underscore is no mark.
        let in_word = before.is_alphanumeric() && rest.peek().is_some_and(|next| next.is_alphanumeric());
        match c {
            '_' if in_word => shown.push(c),
            '\\' | '`' | '*' | '_' | '<' | '[' | ']' | '|' | '~' | '&' | '$' => shown.extend(['\\', c]),
            c if c.is_control() => shown.push(' '),
            c => shown.push(c),
        }
        before = c;
    }
    shown
}

/// The same as code; what code cannot hold is plain text.
pub fn markdown_code(text: &str) -> String {
    if text.contains('`') || text.chars().any(char::is_control) { markdown(text) } else { format!("`{text}`") }
}

/// A number for people: four significant digits, without an exponent where it is of ordinary size.
pub fn brief(x: f64) -> String {
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    let size = x.abs();
    if !(1e-3..1e6).contains(&size) {
        let text = format!("{x:.2e}");
        return text.replace(".00e", "e");
    }
    let decimals = (3 - libm::floor(libm::log10(size)) as i32).clamp(0, 6) as usize;
    let text = format!("{x:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

//! Names of recordings: for people first, and no two cases alike.

use crate::outcome::Outcome;

/// Most bytes of a file's whole name: what every file system takes, with room for what a user puts before it.
const LONGEST: usize = 120;
/// Most bytes behind the values: `_finished`, and the ending `.mcap`.
const BEHIND: usize = "_finished".len() + ".mcap".len();

/// The name of a case's recording, `<values>_<outcome>.<digits of the id>`, until the outcome is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordingName {
    values: String,
    digits: String,
}

impl RecordingName {
    /// Number of digits of the id that a name holds where they tell the cases of a plan apart.
    pub const DIGITS: usize = 8;

    /// Name of these values, which are joined by `_`; what is not a letter, a digit or one of `. + - =` becomes `-`,
    /// what is too long is cut at a `~`.
    pub fn new(values: &[String], digits: &str) -> Self {
        let is_safe = |c: char| c.is_ascii_alphanumeric() || ".+-=".contains(c);
        let safe = |value: &String| value.chars().map(|c| if is_safe(c) { c } else { '-' }).collect::<String>();
        let mut joined = values.iter().map(safe).collect::<Vec<_>>().join("_");
        let longest = LONGEST - BEHIND - digits.len() - 1;
        if joined.len() > longest {
            joined.truncate(longest - 1);
            joined.push('~');
        }
        RecordingName { values: joined, digits: digits.to_string() }
    }

    /// Values in a name that `ended` has made; None for another name.
    pub fn values_of(name: &str) -> Option<&str> {
        let (values, outcome) = name.rsplit_once('.')?.0.rsplit_once('_')?;
        Outcome::ALL.iter().any(|known| known.name() == outcome).then_some(values)
    }

    /// The name that `ended` has made this of; None of another text.
    pub fn parse(name: &str) -> Option<Self> {
        let values = Self::values_of(name)?.to_string();
        let digits = name.rsplit_once('.')?.1.to_string();
        Some(RecordingName { values, digits })
    }

    /// Name while the run goes on.
    pub fn begun(&self) -> String {
        format!("{}.{}", self.values, self.digits)
    }

    /// Name of a run that has ended, without the ending of a file.
    pub fn ended(&self, outcome: Outcome) -> String {
        format!("{}_{}.{}", self.values, outcome.name(), self.digits)
    }
}

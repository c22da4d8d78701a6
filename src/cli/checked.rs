//! A file of `gotai check` with its verdicts, and what it says of the cases that they name.

use super::error::CliError;
use super::output::say;
use super::sweeping::Swept;
use crate::check::{Failing, Judged, MOST};
use crate::files::quoted;
use crate::record::story::shortest;
use crate::record::writer::Target;
use serde_json::{Value, json};
use std::collections::HashSet;
use std::path::PathBuf;

/// A file, its sweep and its verdicts.
pub struct Checked {
    pub swept: Swept,
    named: Names,
}

/// A file that could not be checked, and why.
pub struct Unchecked {
    pub path: PathBuf,
    pub error: CliError,
}

/// All files of the command, as far as it has come.
#[derive(Default)]
pub struct Report {
    pub checked: Vec<Checked>,
    pub unchecked: Vec<Unchecked>,
    /// Files of folders that have no `expect:`.
    pub without_expect: Vec<PathBuf>,
    /// Files that were left out when another one was not met.
    pub skipped: Vec<String>,
}

/// A case that an unmet expectation names, as a person needs it.
pub struct NamedCase<'a> {
    pub id: String,
    /// Values of the axes that have several.
    pub place: String,
    /// What was measured.
    pub measured: String,
    /// Command that runs it again.
    pub command: String,
    /// Files that show it.
    pub recordings: Vec<PathBuf>,
    of: &'a Failing,
}

/// Names of cases and axes in a file's results.
struct Names {
    /// Axes with more than one value.
    telling: Vec<String>,
    /// Whether the ids differ in their first digits.
    are_short: bool,
}

/// Digits of an id that a person reads.
const DIGITS: usize = 8;

impl Checked {
    pub fn new(swept: Swept) -> Self {
        let rows = &swept.rows;
        let first = rows.first().map(|row| &row.axes);
        let tells = |path: &&String| rows.iter().any(|row| row.axes.get(*path) != first.and_then(|f| f.get(*path)));
        let telling = first.into_iter().flat_map(|axes| axes.keys()).filter(tells).cloned().collect();
        let ids: HashSet<&str> = rows.iter().map(|row| row.case.as_str()).collect();
        let short: HashSet<&str> = ids.iter().map(|id| &id[..DIGITS.min(id.len())]).collect();
        let named = Names { telling, are_short: short.len() == ids.len() };
        Checked { named, swept }
    }

    pub fn name(&self) -> String {
        self.swept.config.display().to_string()
    }

    pub fn judged(&self) -> &[Judged] {
        &self.swept.judged
    }

    pub fn is_met(&self) -> bool {
        self.judged().iter().all(|judged| judged.met) && self.swept.failed() == 0 && !self.swept.is_cut()
    }

    /// The worst of these cases, at most as many as an expectation names.
    pub fn cases<'a>(&self, failing: &'a [Failing]) -> Vec<NamedCase<'a>> {
        failing.iter().take(MOST).map(|failing| self.case(failing)).collect()
    }

    fn case<'a>(&self, of: &'a Failing) -> NamedCase<'a> {
        let id: String = of.case.chars().take(if self.named.are_short { DIGITS } else { usize::MAX }).collect();
        let values =
            self.named.telling.iter().filter_map(|path| Some(format!("{path} = {}", shown(of.axes.get(path)?))));
        let row = self.swept.rows.iter().find(|row| row.case == of.case);
        let name = row.and_then(|row| row.recording.as_deref());
        let files = name.into_iter().flat_map(|name| Target::ALL.map(|target| target.path(&self.swept.dir, name)));
        NamedCase {
            place: values.collect::<Vec<_>>().join(", "),
            measured: format!("{} = {}", of.column, shown(&of.value)),
            command: format!("gotai run {} --case {id}", quoted(&self.swept.dir.display().to_string())),
            recordings: files.filter(|file| file.is_file()).collect(),
            id,
            of,
        }
    }
}

impl Report {
    /// Says so, and goes on.
    pub fn cannot_check(&mut self, unchecked: Unchecked) {
        say(format!("gotai: {}", unchecked.error));
        self.unchecked.push(unchecked);
    }

    /// The exit code: that of the file that went worst.
    pub fn code(&self) -> u8 {
        let unmet = u8::from(!self.checked.iter().all(Checked::is_met));
        self.unchecked.iter().map(|unchecked| unchecked.error.code()).fold(unmet, u8::max)
    }
}

impl NamedCase<'_> {
    pub fn document(&self) -> Value {
        let Failing { case, axes, column, value } = self.of;
        json!({
            "case": case, "axes": axes, "column": column, "value": value, "command": self.command,
            "recordings": self.recordings,
        })
    }
}

/// A cell for people: six digits of a number that is not whole.
fn shown(cell: &Value) -> String {
    match cell {
        Value::Number(number) if number.is_f64() => {
            let x = number.as_f64().unwrap_or(f64::NAN);
            shortest(format!("{x:.5e}").parse().unwrap_or(x))
        }
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

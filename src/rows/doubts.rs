//! Doubts about rows: what is not solved, what pushes where nothing touches, what has passed through a body. They are
//! told by the names of columns alone, so that a column that a row does not have raises none.

use super::Measured;
use crate::heading::Headings;
use serde_json::{Map, Value};

/// Sign of a doubt: a column, and the value above which it is one.
struct Sign {
    column: &'static str,
    above: f64,
}

/// Kind of doubt, as it is said of one case and of several.
struct Kind {
    one: &'static str,
    several: &'static str,
    signs: &'static [Sign],
}

/// Residual, or ghost impulse, up to which a run is taken for solved: seven orders above the rounding of f64 for bodies
/// of like mass, and above the 2e-8 of a ratio of 1e8. A smaller one would tell of rounding, a larger one hide errors.
const TOLERATED: f64 = 1e-6;

const KINDS: [Kind; 3] = [
    Kind {
        one: "is not solved",
        several: "are not solved",
        signs: &[Sign { column: "work_unsolved", above: 0.0 }, Sign { column: "residual_max", above: TOLERATED }],
    },
    Kind {
        one: "has impulses where nothing touches",
        several: "have impulses where nothing touches",
        signs: &[Sign { column: "ghost_impulse_max_rel", above: TOLERATED }],
    },
    Kind {
        one: "passes through bodies",
        several: "pass through bodies",
        signs: &[Sign { column: "passed_through", above: 0.0 }],
    },
];

/// Columns that can raise a doubt.
pub fn columns() -> impl Iterator<Item = &'static str> {
    KINDS.iter().flat_map(|kind| kind.signs).map(|sign| sign.column)
}

/// Cells of a row that raise a doubt; none where there is none.
pub fn signs(row: &impl Headings) -> Map<String, Value> {
    let mut shown = Map::new();
    row.each_cell(&mut |name, cell| {
        let mut signs = KINDS.iter().flat_map(|kind| kind.signs).filter(|sign| sign.column == name);
        if let (Some(sign), Some(x)) = (signs.next(), cell.as_f64())
            && x > sign.above
        {
            shown.insert(name.to_string(), Value::from(x));
        }
    });
    shown
}

/// Whether what was measured raises a doubt.
pub fn are_raised(measured: &Measured) -> bool {
    !signs(measured).is_empty()
}

/// What is in doubt, in words, and the columns that say so.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    pub said: String,
    pub columns: Vec<&'static str>,
}

/// Doubt about some rows of `of` in all; None where there is none.
pub fn doubt(rows: &[Map<String, Value>], of: usize) -> Option<Doubt> {
    let mut clauses: Vec<String> = Vec::new();
    let mut columns = Vec::new();
    for Kind { one, several, signs } in &KINDS {
        let count = rows.iter().filter(|row| signs.iter().any(|sign| sign.shown_by(row).is_some())).count();
        if count == 0 {
            continue;
        }
        let largest = |sign: &Sign| rows.iter().filter_map(|row| sign.shown_by(row)).reduce(f64::max);
        let shown: Vec<(&str, f64)> = signs.iter().filter_map(|sign| Some((sign.column, largest(sign)?))).collect();
        columns.extend(shown.iter().map(|(column, _)| *column));
        let up_to = if of > 1 { " up to" } else { "" };
        let shown: Vec<String> = shown.iter().map(|(column, x)| format!("{column}{up_to} {}", short(*x))).collect();
        let subject = match (of, clauses.is_empty()) {
            (1, true) => "the run ".to_string(),
            (1, false) => String::new(),
            (_, true) => format!("{count} of {of} cases "),
            (_, false) => format!("{count} "),
        };
        let verb = if count == 1 { one } else { several };
        clauses.push(format!("{subject}{verb} ({})", shown.join(", ")));
    }
    (!clauses.is_empty()).then(|| Doubt { said: clauses.join(", "), columns })
}

impl Sign {
    /// The value of a row that raises the doubt.
    fn shown_by(&self, row: &Map<String, Value>) -> Option<f64> {
        row.get(self.column).and_then(Value::as_f64).filter(|x| *x > self.above)
    }
}

/// A number to two significant digits; a whole one as it is.
fn short(x: f64) -> String {
    let rounded = if x.fract() == 0.0 { x } else { format!("{x:.1e}").parse().unwrap_or(x) };
    let text = format!("{rounded:?}");
    text.strip_suffix(".0").map(str::to_string).unwrap_or(text)
}

//! Rows as a page holds them: all of a few, of many those that tell most.

use super::frame::RowFrame;
use super::number::{counted, plain, shown, thousands};
use super::subject::Subject;
use crate::heading::unit_of;
use crate::rows::columns::TELLING;
use crate::rows::doubts::{self, Doubt, doubt};
use serde_json::{Map, Value, json};
use std::collections::HashSet;

/// How much of the rows a page holds at most.
#[derive(Clone, Copy)]
pub struct Extent {
    pub rows: usize,
    pub columns: usize,
}

/// Rows and columns of a page.
pub struct Listing<'a> {
    frame: &'a RowFrame,
    names: Vec<String>,
    /// Columns that it could hold.
    all_names: usize,
    rows: Vec<usize>,
    /// Columns that raise a doubt about a row.
    doubts: Vec<Option<String>>,
    doubt: Option<Doubt>,
}

/// Columns of a bench that a table shows at first.
const OF_A_BENCH: [&str; 7] = ["engine", "method", "step_s", "tolerance", "error", "wall_s", "wall_median_s"];

impl<'a> Listing<'a> {
    /// The rows that a page holds; `named` are those that figures show.
    pub fn of(subject: &'a Subject, named: &[usize], chosen: Extent) -> Self {
        let frame = &subject.frame;
        let (doubts, doubt) = doubts_of(frame);
        let mut names: Vec<String> = frame.names().filter(|name| !frame.is_blank(name)).map(str::to_string).collect();
        let all_names = names.len();
        if names.len() > chosen.columns {
            // What every row has comes first.
            names.sort_by_key(|name| !is_telling(subject, name) && name.contains('.'));
            names.truncate(chosen.columns);
        }
        let mut rows: Vec<usize> = (0..frame.rows()).collect();
        if frame.rows() > chosen.rows {
            rows = most_telling(frame, named, &doubts, chosen.rows);
        }
        Listing { frame, names, all_names, rows, doubts, doubt }
    }

    pub fn columns(&self) -> usize {
        if self.frame.rows() == 0 { 0 } else { self.names.len() }
    }

    /// What the rows are in doubt of, as a sentence.
    pub fn doubt(&self) -> Option<String> {
        let Doubt { said, columns } = self.doubt.as_ref()?;
        Some(format!("In doubt: {said}; see {}.", columns.join(", ")))
    }

    /// What the page does not hold.
    pub fn left_out(&self) -> Option<String> {
        let mut said = Vec::new();
        if self.rows.len() < self.frame.rows() {
            said.push(format!(
                "The table holds the {} most telling of {}: those of the figures, what failed, diverged or is in \
                 doubt, and the largest numbers.",
                thousands(self.rows.len()),
                counted(self.frame.rows(), "row")
            ));
        }
        if self.names.len() < self.all_names {
            said.push(format!(
                "{} of {} are left out.",
                counted(self.all_names - self.names.len(), "column"),
                self.all_names
            ));
        }
        (!said.is_empty()).then(|| said.join(" "))
    }

    /// The table as JSON: columns with their values, numbers to six digits.
    pub fn json(&self, subject: &Subject) -> String {
        if self.columns() == 0 {
            return json!({ "columns": [], "rows": [], "of": 0, "replay": null }).to_string();
        }
        let mut columns: Vec<String> = self.names.iter().map(|name| self.column(subject, name)).collect();
        if self.doubts.iter().any(Option::is_some) {
            let values: Vec<&Option<String>> = self.rows.iter().map(|row| &self.doubts[*row]).collect();
            columns.push(words(
                "in doubt",
                (true, false),
                &values.iter().map(|value| value.as_deref()).collect::<Vec<_>>(),
            ));
        }
        format!(
            "{{\"columns\":[{}],\"rows\":{},\"of\":{},\"replay\":{}}}",
            columns.join(","),
            json!(self.rows),
            self.frame.rows(),
            json!(subject.replay)
        )
    }

    fn column(&self, subject: &Subject, name: &str) -> String {
        let is_telling = is_telling(subject, name);
        let is_axis = subject.axes.iter().any(|axis| axis.path == name && axis.values.len() > 1);
        match self.frame.numbers(name) {
            Some(numbers) => {
                // The values of an axis are looked for by figures: all digits.
                let written = if is_axis { exactly } else { rounded };
                let values: Vec<String> = self.rows.iter().map(|row| written(numbers[*row])).collect();
                let head =
                    json!({ "name": plain(name), "unit": unit_of(name), "telling": is_telling, "axis": is_axis })
                        .to_string();
                format!("{},\"values\":[{}]}}", head.trim_end_matches('}'), values.join(","))
            }
            None => {
                let values: Vec<Option<&str>> = self.rows.iter().map(|row| self.frame.word(name, *row)).collect();
                // Enough digits of an id to find the row again.
                let cut = |word: &'a str| if name == "case" { word.get(..12).unwrap_or(word) } else { word };
                words(name, (is_telling, is_axis), &values.into_iter().map(|word| word.map(cut)).collect::<Vec<_>>())
            }
        }
    }
}

fn is_telling(subject: &Subject, name: &str) -> bool {
    let is_axis = subject.axes.iter().any(|axis| axis.path == name && axis.values.len() > 1);
    name == "case" || is_axis || TELLING.contains(&name) || (subject.is_bench && OF_A_BENCH.contains(&name))
}

/// A column of words, each once.
fn words(name: &str, (is_telling, is_axis): (bool, bool), values: &[Option<&str>]) -> String {
    let mut known = std::collections::HashMap::new();
    let mut listed: Vec<String> = Vec::new();
    let code = |word: &Option<&str>| {
        let word = (*word)?;
        Some(*known.entry(word.to_string()).or_insert_with(|| {
            listed.push(plain(word));
            listed.len() - 1
        }))
    };
    let codes: Vec<Option<usize>> = values.iter().map(code).collect();
    json!({
        "name": plain(name), "unit": "", "telling": is_telling, "axis": is_axis, "words": listed, "values": codes,
    })
    .to_string()
}

/// A number of all its digits as JSON.
fn exactly(x: f64) -> String {
    if x.is_finite() { shown(x) } else { rounded(x) }
}

/// A number of six digits as JSON; a count as it is.
fn rounded(x: f64) -> String {
    if x.is_nan() {
        return "null".to_string();
    }
    if !x.is_finite() {
        return format!("\"{}\"", shown(x));
    }
    if x.fract() == 0.0 && x.abs() < 1e15 {
        return shown(x);
    }
    shown(format!("{x:.5e}").parse().unwrap_or(x))
}

/// What raises doubt of each row, and of all.
fn doubts_of(frame: &RowFrame) -> (Vec<Option<String>>, Option<Doubt>) {
    let columns: Vec<&str> = doubts::columns().filter(|name| frame.numbers(name).is_some()).collect();
    let mut found: Vec<Map<String, Value>> = Vec::new();
    let of_row = |row: usize| {
        let is_plain = columns.iter().all(|name| frame.number(name, row).is_none_or(|x| x <= 0.0));
        let signs = if is_plain { Map::new() } else { doubts::signs(&frame.cells(&columns, row)) };
        let said = (!signs.is_empty()).then(|| signs.keys().cloned().collect::<Vec<_>>().join(", "));
        if said.is_some() {
            found.push(signs);
        }
        said
    };
    let each = (0..frame.rows()).map(of_row).collect();
    let all = doubt(&found, frame.rows());
    (each, all)
}

/// The rows that tell most, in their order.
fn most_telling(frame: &RowFrame, named: &[usize], doubts: &[Option<String>], most: usize) -> Vec<usize> {
    let mut chosen: HashSet<usize> = HashSet::new();
    for row in named.iter().copied().filter(|row| *row < frame.rows()) {
        if chosen.len() < most {
            chosen.insert(row);
        }
    }
    let rank = |row: usize| {
        let outcome = match frame.word("outcome", row) {
            Some("failed") => 4,
            Some("diverged") => 3,
            Some("stalled") => 3,
            _ => i32::from(doubts[row].is_some()),
        };
        let size = ["error_position_m", "energy_rise_max_rel", "energy_drift_rel"]
            .iter()
            .find_map(|name| frame.number(name, row))
            .map_or(0.0, f64::abs);
        (outcome, size)
    };
    let mut rest: Vec<((i32, f64), usize)> =
        (0..frame.rows()).filter(|row| !chosen.contains(row)).map(|row| (rank(row), row)).collect();
    rest.sort_by(|a, b| b.0.0.cmp(&a.0.0).then(b.0.1.total_cmp(&a.0.1)).then(a.1.cmp(&b.1)));
    // A third of the room is for what is not bad: every so many rows, so that good cases are seen too.
    let bad = (most - chosen.len()) * 2 / 3;
    chosen.extend(rest.iter().take(bad).map(|(_, row)| *row));
    let left = most - chosen.len();
    let others: Vec<usize> = rest.iter().skip(bad).map(|(_, row)| *row).collect();
    chosen.extend((0..left).map(|i| others[i * others.len() / left]));
    let mut rows: Vec<usize> = chosen.into_iter().collect();
    rows.sort_unstable();
    rows
}

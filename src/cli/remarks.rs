//! Warnings and notes of a command: a line each on stderr, and lists in its JSON document. What a method that claims to
//! solve the law of contact has missed is a warning; of another one it is a note.

use super::output::say;
use crate::check::OneSided;
use crate::experiment::types::Experiment;
use crate::heading::Headings;
use crate::rows::doubts::{Doubt, doubt, signs};
use serde_json::{Map, Value, json};
use std::path::{Path, PathBuf};

/// Most places that a line names.
const MOST_PLACES: usize = 6;

/// Signs of doubt of a case, and whether its method claims to solve the law of contact.
pub(super) struct Seen {
    signs: Map<String, Value>,
    solves: bool,
}

/// Lines of a command.
#[derive(Default)]
pub(super) struct Remarks {
    warnings: Vec<String>,
    notes: Vec<String>,
}

impl Seen {
    /// What is seen of a row, or of what was measured.
    pub(super) fn of(row: &impl Headings, experiment: &Experiment) -> Self {
        Seen { signs: signs(row), solves: experiment.method.facts().solves_contacts }
    }

    pub(super) fn is_doubtful(&self) -> bool {
        !self.signs.is_empty()
    }
}

impl Remarks {
    /// Remarks about the cases of a command; `tables` are the files that have their columns.
    pub(super) fn about<'a>(seen: impl IntoIterator<Item = &'a Seen>, tables: &[PathBuf]) -> Self {
        let (mut of, mut solving, mut others) = (0, Vec::new(), Vec::new());
        for seen in seen {
            of += 1;
            if seen.is_doubtful() {
                if seen.solves { &mut solving } else { &mut others }.push(seen.signs.clone());
            }
        }
        let line = |signs: &[Map<String, Value>]| doubt(signs, of).map(|doubt| with_tables(doubt, tables));
        Remarks { warnings: line(&solving).into_iter().collect(), notes: line(&others).into_iter().collect() }
    }

    /// Adds a warning of bounds on one side of columns with a sign, with the places where they stand.
    pub(super) fn warn_of_one_sided(&mut self, found: &[(OneSided, String)]) {
        let mut columns: Vec<&str> = Vec::new();
        let mut passes: Vec<String> = Vec::new();
        for (OneSided { column, key, .. }, _) in found {
            if !columns.contains(&column.as_str()) {
                columns.push(column);
            }
            let what = if ["max", "below"].contains(key) { "loss" } else { "gain" };
            let passed = format!("`{key}` alone passes any {what}");
            if !passes.contains(&passed) {
                passes.push(passed);
            }
        }
        if !found.is_empty() {
            let are = if columns.len() == 1 { "is" } else { "are" };
            let places: Vec<&str> = found.iter().map(|(_, place)| place.as_str()).collect();
            self.warnings.push(format!(
                "{} {are} signed: {}; `within:` bounds both sides ({})",
                columns.join(" and "),
                passes.join(", "),
                listed(&places)
            ));
        }
    }

    /// Prints the lines. `--quiet` silences notes, and no warning.
    pub(super) fn say(&self, quiet: bool) {
        for warning in &self.warnings {
            say(format!("warning: {warning}"));
        }
        for note in self.notes.iter().filter(|_| !quiet) {
            say(format!("note: {note}"));
        }
    }

    /// Adds the lines to a document, as `warnings` and `notes`.
    pub(super) fn put_into(&self, document: &mut Value) {
        document["warnings"] = json!(self.warnings);
        document["notes"] = json!(self.notes);
    }
}

/// The table of a folder of results that is easiest to read.
pub(super) fn table_of(dir: &Path) -> PathBuf {
    let csv = dir.join("rows.csv");
    if csv.exists() { csv } else { dir.join("rows.parquet") }
}

fn with_tables(Doubt { said, columns }: Doubt, tables: &[PathBuf]) -> String {
    if tables.is_empty() {
        return said;
    }
    let column = if columns.len() == 1 { "column" } else { "columns" };
    let tables: Vec<String> = tables.iter().map(|path| path.display().to_string()).collect();
    let tables: Vec<&str> = tables.iter().map(String::as_str).collect();
    format!("{said}: see the {column} {} in {}", columns.join(", "), listed(&tables))
}

fn listed(places: &[&str]) -> String {
    match places.len() {
        0..=MOST_PLACES => places.join(", "),
        n => format!("{} and {} more", places[..MOST_PLACES].join(", "), n - MOST_PLACES),
    }
}

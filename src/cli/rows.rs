//! `gotai rows`: the rows of a folder of results, without another program.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{print, print_data, print_json, say, width, wrapped};
use super::table::fitted;
use crate::experiment::filter::{Condition, Filter, is_same, shown_cell};
use crate::experiment::nearest::nearest;
use crate::outcome::Outcome;
use crate::record::story::shortest;
use crate::report::plain;
use crate::rows::columns::TELLING;
use crate::rows::plan_file::PlanFile;
use crate::rows::table::{Table, to_csv};
use crate::sweep::folder::Folder;
use clap::Args;
use serde_json::{Map, Value};
use std::cmp::Ordering;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// A folder of results (it has plan.json)
    dir: PathBuf,
    /// Only rows of which this holds: COLUMN=VALUE, or another sign: != < <= > >=; all that are given must hold
    #[arg(long = "where", value_name = "COLUMN=VALUE")]
    filters: Vec<String>,
    /// Columns to show, with commas between them; `all` [default: id, axes, outcome and what tells most]
    #[arg(long, value_delimiter = ',')]
    columns: Vec<String>,
    /// Columns to sort by, with commas between them; with a minus before it, the largest first
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true)]
    sort: Vec<String>,
    /// As CSV
    #[arg(long)]
    csv: bool,
    #[command(flatten)]
    output: OutputArgs,
}

/// Number of digits of an id that a person reads.
const DIGITS: usize = 8;

type Cells = Map<String, Value>;

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let folder = Folder::read(&self.dir)?;
        let there = folder.rows();
        let table = Table::new(&folder.plan.axes, &there);
        let known: Vec<&str> = table.names().collect();
        let rows: Vec<Cells> = table.rows().collect();
        let filter = filter(&self.filters, &known, &folder.plan)?;
        let mut chosen: Vec<&Cells> = rows.iter().filter(|row| takes(&filter, row)).collect();
        self.sort(&mut chosen, &known)?;
        let columns = self.columns(&folder, &known, &chosen)?;
        let cells = |row: &Cells| -> Vec<Value> {
            columns.iter().map(|name| row.get(*name).cloned().unwrap_or_default()).collect()
        };
        if self.output.json {
            let named = |row: &&Cells| columns.iter().map(|name| name.to_string()).zip(cells(row)).collect::<Cells>();
            print_json(&chosen.iter().map(named).collect::<Vec<_>>());
        } else if self.csv {
            let text = to_csv(&columns, chosen.iter().copied());
            let text = text.map_err(|error| CliError::Machine(format!("cannot write CSV: {error}")))?;
            print_data(String::from_utf8_lossy(&text).trim_end());
        } else {
            let texts: Vec<Vec<String>> = chosen
                .iter()
                .map(|row| columns.iter().zip(cells(row)).map(|(name, cell)| plain(&shown(name, &cell))).collect())
                .collect();
            // What is asked for is there, whatever room there is.
            let kept: Vec<bool> = columns.iter().map(|name| self.is_kept(name, &folder, &filter)).collect();
            let most = if self.columns.is_empty() { width().into() } else { usize::MAX };
            let (text, left_out) = fitted(&columns, &texts, &kept, most);
            print(text);
            if !left_out.is_empty() && !self.output.quiet {
                let names: Vec<&str> = left_out.iter().map(|i| columns[*i]).collect();
                let said = format!("no room for {}; --columns chooses", names.join(", "));
                say(wrapped(&said, width().into(), "", "  "));
            }
            if !self.output.quiet {
                say(format!("{} of {} rows, {} planned", chosen.len(), rows.len(), folder.plan.rows));
            }
        }
        Ok(ExitCode::SUCCESS)
    }

    /// Whether a column stands in the table even where it has no room: what a row is, and what was asked for.
    fn is_kept(&self, name: &str, folder: &Folder, filter: &Filter) -> bool {
        let is_axis = folder.plan.axes.iter().any(|axis| axis.path == name);
        let is_sorted = self.sort.iter().any(|written| written.trim_start_matches('-') == name);
        let is_filtered = filter.0.iter().any(|(filtered, _)| filtered == name);
        !self.columns.is_empty() || is_axis || is_sorted || is_filtered || ["case", "outcome"].contains(&name)
    }

    fn sort(&self, rows: &mut [&Cells], known: &[&str]) -> Result<(), CliError> {
        let mut keys = Vec::new();
        for written in &self.sort {
            let (falls, name) = written.strip_prefix('-').map_or((false, written.as_str()), |name| (true, name));
            keys.push((find("--sort", name, known)?, falls));
        }
        let by = |a: &Cells, b: &Cells, name: &str, falls: bool| {
            let (a, b) = (a.get(name).filter(|cell| !cell.is_null()), b.get(name).filter(|cell| !cell.is_null()));
            match (a, b) {
                (Some(a), Some(b)) if falls => order(b, a),
                (Some(a), Some(b)) => order(a, b),
                // What is empty comes last, either way.
                (a, b) => b.is_some().cmp(&a.is_some()),
            }
        };
        rows.sort_by(|a, b| {
            keys.iter()
                .map(|(name, falls)| by(a, b, name, *falls))
                .find(|order| order.is_ne())
                .unwrap_or(Ordering::Equal)
        });
        Ok(())
    }

    fn columns<'a>(&self, folder: &Folder, known: &[&'a str], rows: &[&Cells]) -> Result<Vec<&'a str>, CliError> {
        if self.columns == ["all"] {
            return Ok(known.to_vec());
        }
        if !self.columns.is_empty() {
            return self.columns.iter().map(|name| find("--columns", name, known)).collect();
        }
        let is_axis = |name: &str| folder.plan.axes.iter().any(|axis| axis.path == name && axis.values.len() > 1);
        let says = |name: &str| rows.iter().any(|row| row.get(name).is_some_and(|cell| !cell.is_null()));
        let is_shown = |name: &&&str| {
            **name == "case" || is_axis(name) || (TELLING.contains(*name) && (says(name) || **name == "outcome"))
        };
        Ok(known.iter().filter(is_shown).copied().collect())
    }
}

/// The filter of texts on the command line, over columns that are known.
pub(super) fn filter(texts: &[String], known: &[&str], plan: &PlanFile) -> Result<Filter, CliError> {
    if let Some(text) = texts.iter().find(|text| !text.contains(['=', '<', '>', '≤', '≥', '≠'])) {
        let expected = "expected COLUMN=VALUE, or another sign: != < <= > >=";
        return Err(CliError::Input(format!("--where: {expected}, found `{text}`")));
    }
    let filter = Filter::of_texts(texts)?;
    for (name, condition) in &filter.0 {
        find("--where", name, known)?;
        refuse_unknown_value(name, condition, plan)?;
    }
    Ok(filter)
}

/// Whether a filter takes a row; of an id its first digits are enough.
pub(super) fn takes(filter: &Filter, row: &Cells) -> bool {
    let begins = |id: &str, values: &[Value]| values.iter().any(|value| id.starts_with(&shown_cell(value)));
    let holds = |(name, condition): &(String, Condition)| match (name.as_str(), condition, row.get(name)) {
        ("case", Condition::Is(values), Some(Value::String(id))) => begins(id, values),
        (.., Some(cell)) => condition.holds(cell),
        (.., None) => false,
    };
    filter.0.iter().all(holds)
}

/// A value that is not on its axis, or no outcome, is a slip.
fn refuse_unknown_value(name: &str, condition: &Condition, plan: &PlanFile) -> Result<(), CliError> {
    let on_axis = plan.axes.iter().find(|axis| axis.path == name).map(|axis| axis.values.clone());
    let outcomes = || (name == "outcome").then(|| Outcome::ALL.map(|outcome| Value::from(outcome.name())).to_vec());
    let (Condition::Is(values), Some(known)) = (condition, on_axis.or_else(outcomes)) else { return Ok(()) };
    match values.iter().find(|value| !known.iter().any(|known| is_same(known, value))) {
        None => Ok(()),
        Some(value) => {
            let known: Vec<String> = known.iter().map(shown_cell).collect();
            // As it was written: a number that is whole has no fraction.
            let written = value.as_f64().map_or_else(|| shown_cell(value), shortest);
            Err(CliError::Input(format!("--where {name}={written}: expected one of {}", known.join(", "))))
        }
    }
}

fn find<'a>(flag: &str, name: &str, known: &[&'a str]) -> Result<&'a str, CliError> {
    let found = known.iter().find(|known| **known == name).copied();
    found.ok_or_else(|| {
        let near = nearest(name, known).map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
        CliError::Input(format!("{flag}: expected a column, found `{name}`{near} (known: {})", known.join(", ")))
    })
}

/// Order of two cells: numbers by size, before texts by their letters.
fn order(a: &Value, b: &Value) -> Ordering {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => a.total_cmp(&b),
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => shown_cell(a).cmp(&shown_cell(b)),
    }
}

/// A cell for people: short ids, four digits of what was measured; axes and counts as they are.
fn shown(name: &str, cell: &Value) -> String {
    match cell {
        Value::Null => String::new(),
        Value::String(id) if name == "case" => id.chars().take(DIGITS).collect(),
        Value::Number(number) if number.is_f64() && !name.contains('.') => rounded(number.as_f64().unwrap_or(f64::NAN)),
        other => shown_cell(other),
    }
}

fn rounded(x: f64) -> String {
    let is_plain = x == 0.0 || (1e-3..1e6).contains(&x.abs());
    if is_plain { format!("{}", (x * 1e4).round() / 1e4) } else { format!("{x:.3e}") }
}

//! `gotai compare`: two folders of results, of two versions, methods or machines: what changed, by how much.

use super::args::OutputArgs;
use super::compare_page::page;
use super::compared::{
    FACTOR, at, brief, cell, changed, described, factor, finding, interval, joined, others, outcomes,
};
use super::error::CliError;
use super::output::{Hue, counted, print, print_json, width, wrapped};
use super::reporting::{BENCH, OF_BENCH, read_trials};
use crate::check::{Cells, Change, CompareBy, Compared, Regression, Side, TOLERATED, compare};
use crate::experiment::ExperimentFile;
use crate::files::quoted;
use crate::files::{FileError, read, write_whole};
use crate::report::cut;
use crate::rows::cells;
use crate::rows::columns::OLDEST;
use crate::rows::plan_file::{FORMAT, PlanAxis};
use crate::rows::table::rows_of_parquet;
use crate::rows::trials::Trial;
use crate::sweep::build::build;
use crate::sweep::folder::{Folder, FolderError};
use crate::sweep::kept::{EXPERIMENT, PLAN};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// A folder of results (it has plan.json), or of a bench (bench.json): how it was
    a: PathBuf,
    /// Another one: how it is
    b: PathBuf,
    /// Columns to compare, with commas between them [default: all that say what is better]
    #[arg(long, value_delimiter = ',')]
    columns: Vec<String>,
    /// Exit code 1 if B is worse: by more than 10 % and above rounding, finished in A and not in B
    /// (or planned in B and missing), or a measure that has no number in B any more
    #[arg(long)]
    fail_on_regression: bool,
    /// What costs more is worse too: wall time, steps, counters of work
    #[arg(long)]
    time: bool,
    /// Write the comparison as a page too
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    #[command(flatten)]
    output: OutputArgs,
}

/// Most regressions on the screen; JSON and -v have more.
const SHOWN: usize = 6;

/// What lines of the table begin with, and the fewest letters of a name in it.
const MARGIN: &str = "  ";
const LEAST_NAME: usize = 12;

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// A folder is none, or the two cannot be compared.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let (a, b) = (side(&self.a)?, side(&self.b)?);
        let asked = CompareBy { columns: self.columns, with_cost: self.time };
        let compared = compare(&a, &b, &asked).map_err(|error| CliError::Input(error.to_string()))?;
        if let Some(path) = &self.html {
            write_whole(path, page(&a, &b, &compared).as_bytes())?;
        }
        if self.output.json {
            print_json(&document(&a, &b, &compared));
        } else {
            let most = if self.output.verbose { usize::MAX } else { SHOWN };
            print(shown(&a, &b, &compared, self.output.is_colored(), most));
        }
        Ok(ExitCode::from(u8::from(self.fail_on_regression && compared.regression_count > 0)))
    }
}

/// A folder as it was written, by whatever gotai that it can be known of.
fn side(dir: &Path) -> Result<Side, CliError> {
    let name = dir.display().to_string();
    if !Folder::is_one(dir) && dir.join(BENCH).is_file() {
        return of_bench(dir);
    }
    if !Folder::is_one(dir) {
        return Err(FolderError::NoResults(name).into());
    }
    let path = dir.join(PLAN);
    let wrong = |what: &str| CliError::Input(format!("{}: {what}", path.display()));
    let plan: Value = serde_json::from_slice(&read(&path)?).map_err(|error| wrong(&error.to_string()))?;
    let format = plan["format"].as_u64().and_then(|format| u32::try_from(format).ok());
    let format = format.filter(|format| (OLDEST..=FORMAT).contains(format)).ok_or_else(|| {
        let found = plan.get("format").map_or("none, as of an older gotai".to_string(), Value::to_string);
        wrong(&format!("expected format {OLDEST} to {FORMAT}, found {found}; run its sweep again"))
    })?;
    let axes: Vec<PlanAxis> =
        serde_json::from_value(plan["axes"].clone()).map_err(|error| wrong(&error.to_string()))?;
    let table = dir.join("rows.parquet");
    if !table.is_file() {
        return Err(CliError::Input(format!("{}: found no rows yet; run its sweep to the end", table.display())));
    }
    let rows = rows_of_parquet(read(&table)?);
    let rows = rows.map_err(|error| FileError::new(&table, error))?;
    let text = |key: &str| plan[key].as_str().unwrap_or("?").to_string();
    let planned = plan["rows"].as_u64().map_or(rows.len(), |rows| rows as usize);
    let together = serde_json::from_value(plan["together"].clone()).unwrap_or_default();
    let size_m = size_m(&dir.join(EXPERIMENT));
    Ok(Side { name, program: text("program"), build: text("build"), format, planned, axes, together, rows, size_m })
}

/// The rows of a bench: joined by methods, steps and tolerances; its error under the name of its column.
fn of_bench(dir: &Path) -> Result<Side, CliError> {
    let trials = read_trials(&dir.join(BENCH))?;
    let axes: Vec<PlanAxis> = ["method", "step_s", "tolerance"]
        .into_iter()
        .map(|path| {
            let mut values: Vec<Value> = Vec::new();
            for value in trials.iter().map(|trial| cells(trial)[path].clone()) {
                if !values.contains(&value) {
                    values.push(value);
                }
            }
            PlanAxis { path: path.to_string(), values }
        })
        .collect();
    let row = |trial: &Trial| {
        let all = cells(trial);
        let known = ["method", "step_s", "tolerance", "outcome", "criterion", "steps", "wall_s"].into_iter();
        let mut row: Cells = known.map(|name| (name.to_string(), all[name].clone())).collect();
        row.insert(trial.error_kind.clone(), all["error"].clone());
        row
    };
    let rows: Vec<Cells> = trials.iter().map(row).collect();
    Ok(Side {
        name: dir.display().to_string(),
        program: "a bench".to_string(),
        build: String::new(),
        format: FORMAT,
        planned: rows.len(),
        axes,
        together: Vec::new(),
        rows,
        // The name has no ending that a loader takes: it is read as a text.
        size_m: size_m(&dir.join(OF_BENCH)),
    })
}

/// Size of the bodies of an experiment's first case; None where this program cannot build it.
fn size_m(path: &Path) -> Option<f64> {
    // Not the folder: what it has stored may be long, and of another build.
    let text = String::from_utf8(read(path).ok()?).ok()?;
    let file = ExperimentFile::from_text(path, &text, &[]).ok()?;
    let point = file.axes().point(0);
    let (model, _) = build(&file, &point, &file.case(&point).ok()?).ok()?;
    Some(model.largest_radius_m())
}

fn document(a: &Side, b: &Side, compared: &Compared) -> Value {
    let side = |side: &Side| {
        json!({
            "dir": side.name, "program": side.program, "build": side.build, "format": side.format,
            "planned": side.planned, "rows": side.rows.len(),
        })
    };
    let mut document = json!({ "a": side(a), "b": side(b), "tolerated": TOLERATED });
    if let (Value::Object(document), Ok(Value::Object(compared))) = (&mut document, serde_json::to_value(compared)) {
        document.extend(compared);
    }
    for regression in document["regressions"].as_array_mut().into_iter().flatten() {
        for (case, side, command) in [("case_a", a, "command_a"), ("case_b", b, "command_b")] {
            regression[command] = json!(regression[case].as_str().map(|case| replay(side, case)));
        }
    }
    document
}

fn replay(side: &Side, case: &str) -> String {
    format!("gotai run {} --case {}", quoted(&side.name), case.get(..8).unwrap_or(case))
}

/// The columns that differ, as wide as what they hold; where that is too wide, names are cut.
fn table(compared: &Compared, width: usize) -> Vec<String> {
    let is_in_all = |change: &&Change| change.cells == compared.finished;
    let has_cells = !changed(compared).iter().all(is_in_all);
    let head = ["column", "cases", "better", "worse", "A", "B", "B / A", "(95 %)"].map(String::from);
    let mut rows = vec![head];
    rows.extend(changed(compared).into_iter().map(|change| {
        let [cells, better, worse] = [change.cells, change.better, change.worse].map(|count| count.to_string());
        let [a, b] = [change.median_a, change.median_b].map(brief);
        [change.column.clone(), cells, better, worse, a, b, factor(change), interval(change)]
    }));
    let mut widths: Vec<usize> =
        (0..8).map(|i| rows.iter().map(|row| row[i].chars().count()).max().unwrap_or(0)).collect();
    let shown: Vec<usize> = (0..8).filter(|i| has_cells || *i != 1).collect();
    // A space before each but the first, and the margin.
    let taken = shown.iter().skip(1).map(|i| widths[*i] + 1).sum::<usize>() + MARGIN.len();
    widths[0] = widths[0].min(width.saturating_sub(taken).max(LEAST_NAME));
    let line = |row: &[String; 8]| {
        let cells = shown.iter().map(|i| match i {
            0 => format!("{:1$}", cut(&row[0], widths[0]), widths[0]),
            7 => row[7].clone(),
            i => format!("{:>1$}", row[*i], widths[*i]),
        });
        format!("{MARGIN}{}", cells.collect::<Vec<_>>().join(" ")).trim_end().to_string()
    };
    rows.iter().map(line).collect()
}

fn shown(a: &Side, b: &Side, compared: &Compared, is_colored: bool, most: usize) -> String {
    let width = usize::from(width());
    let mut text = vec![wrapped(&described(a), width, "A  ", "   "), wrapped(&described(b), width, "B  ", "   ")];
    text.extend(joined(compared).iter().map(|line| wrapped(line, width, "", "  ")));
    text.push(String::new());
    for line in outcomes(compared) {
        text.push(line);
    }
    if !changed(compared).is_empty() {
        text.push(format!(
            "\nin {} that finished in both (A, B: medians of sizes):",
            counted(compared.finished, "case")
        ));
        text.extend(table(compared, width));
        text.push(wrapped(FACTOR, width, MARGIN, MARGIN));
        text.push(String::new());
    }
    text.extend(others(compared).iter().map(|line| wrapped(line, width, "", "  ")));
    let hue = if compared.regression_count > 0 { Hue::Bad } else { Hue::Good };
    text.push(format!("\n{}", hue.paint(&finding(compared), is_colored)));
    for Regression { axes, column, a: was, b: is, case_a, case_b, .. } in compared.regressions.iter().take(most) {
        let place = if axes.is_empty() { String::new() } else { format!(" at {}", at(axes)) };
        text.push(wrapped(&format!("{column}: {} → {}{place}", cell(was), cell(is)), width, "  ", "    "));
        for (side, case) in [(a, case_a), (b, case_b)] {
            if let Some(case) = case {
                text.push(format!("    {}", Hue::Faint.paint(&replay(side, case), is_colored)));
            }
        }
    }
    let more = compared.regression_count - compared.regressions.len().min(most);
    if more > 0 {
        text.push(format!("  … and {more} more"));
    }
    text.join("\n")
}

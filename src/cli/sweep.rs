//! `gotai sweep`: the axes' cases on all cores, a row each; run again, it does only what is missing.

use super::error::CliError;
use super::output::{cleaned, counted, print_as_it_is, print_json, say, width, wrapped};
use super::reporting::{Known, Reported, write_beside};
use super::sweeping::{SweepArgs, Swept, configs};
use crate::files::quoted;
use crate::outcome::Outcome;
use crate::record::writer::Target;
use crate::report::choose::map_in_characters;
use crate::rows::{Row, count};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// An experiment file (YAML), or a folder of them
    config: PathBuf,
    /// Write no report.html
    #[arg(long)]
    no_report: bool,
    #[command(flatten)]
    sweep: SweepArgs,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        // Every case of every file is checked before the first run.
        let pool = self.sweep.run.pool()?;
        let mut configs = configs(std::slice::from_ref(&self.config))?;
        self.sweep.tell_apart(&mut configs.iter_mut().collect::<Vec<_>>())?;
        let plan = |config| self.sweep.load(&config).and_then(|file| self.sweep.planned(config, file, None));
        let planned = configs.into_iter().map(|config| pool.install(|| plan(config)));
        let planned = planned.collect::<Result<Vec<_>, _>>()?;
        let mut swept = Vec::with_capacity(planned.len());
        for planned in &planned {
            let done = pool.install(|| self.sweep.sweep(planned))?;
            let ending = self.ending(&done, planned.plan.file.axes.iter().any(|axis| axis.values.len() > 1));
            if !self.sweep.output.json {
                // The map has cleaned its words, and has colours of its own.
                print_as_it_is(cleaned(&summary(&done)) + &ending);
            }
            swept.push(done);
        }
        if self.sweep.output.json {
            print_document(&swept);
        }
        Swept::remarks(&swept.iter().collect::<Vec<_>>()).say(self.sweep.output.quiet);
        Ok(ExitCode::from(u8::from(swept.iter().any(|swept| swept.failed() > 0))))
    }
}

impl Command {
    /// The map of a sweep with axes, and where its report is.
    fn ending(&self, swept: &Swept, has_axes: bool) -> String {
        let output = self.sweep.output;
        let has_map = !output.json && !output.quiet;
        if !has_axes || (self.no_report && !has_map) {
            return String::new();
        }
        let reported = match Reported::of_folder(&swept.dir, Known { rows: Some(&swept.rows) }) {
            Ok(reported) => reported,
            Err(error) => {
                say(format!("warning: no report is written: {error}"));
                return String::new();
            }
        };
        let mut text = String::new();
        if !self.no_report
            && let Some(page) = write_beside(&reported)
        {
            text += &cleaned(&format!("\n  report: {}", page.display()));
        }
        if let Some(map) = map_in_characters(&reported.subject).filter(|_| has_map) {
            text += &format!("\n\n{}\n{}", map.characters(output.is_colored()), cleaned(&where_to_look(swept)));
        }
        text
    }
}

/// Why runs ended early, and the command that shows them.
fn where_to_look(swept: &Swept) -> String {
    let mut text = String::new();
    let is_search = swept.rows.iter().any(|row| verdict_of(row).is_some());
    for outcome in [Outcome::Diverged, Outcome::Stalled, Outcome::Failed] {
        if is_search && outcome != Outcome::Failed {
            continue;
        }
        let of = || swept.rows.iter().filter(|row| row.measured.outcome == outcome);
        let mut criteria: Vec<(&str, usize)> = Vec::new();
        for criterion in of().filter_map(|row| row.measured.criterion.as_deref()) {
            match criteria.iter_mut().find(|(known, _)| *known == criterion) {
                Some((_, n)) => *n += 1,
                None => criteria.push((criterion, 1)),
            }
        }
        criteria.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
        let shown: Vec<String> = criteria.iter().take(4).map(|(criterion, n)| format!("{criterion} {n}")).collect();
        if of().next().is_some() {
            let name = outcome.name();
            let dir = quoted(&swept.dir.display().to_string());
            let said = format!("{name}: {} ({});", of().count(), shown.join(", "));
            text += &format!("{}\n", beside(&said, &format!("gotai rows {dir} --where outcome={name}"), ""));
        }
    }
    text
}

/// The verdict of a search in a row of one.
fn verdict_of(row: &Row) -> Option<&str> {
    row.measured.more.get("search_verdict")?.as_str()
}

fn verdict_count(rows: &[Row], verdict: &str) -> usize {
    rows.iter().filter(|row| verdict_of(row) == Some(verdict)).count()
}

fn summary(swept: &Swept) -> String {
    let mut text = format!("{}: {}, {} run now", swept.config.display(), counted(swept.planned, "case"), swept.ran);
    // Rows of a search are of the runs at one end of their brackets, whose outcomes are its means.
    let verdicts = ["found", "below", "above"].map(|verdict| (verdict, verdict_count(&swept.rows, verdict)));
    let is_search = verdicts.iter().any(|(_, n)| *n > 0);
    let outcomes = Outcome::ALL.map(|outcome| (outcome.name(), count(&swept.rows, outcome)));
    let outcomes = outcomes.into_iter().filter(|(name, _)| !is_search || *name == Outcome::Failed.name());
    for (name, n) in verdicts.into_iter().chain(outcomes).filter(|(_, n)| *n > 0) {
        text += &format!(" · {n} {name}");
    }
    text = wrapped(&text, width().into(), "", "  ");
    // Of very many rows there is no CSV, unless it is asked for.
    let tables = ["rows.csv", "rows.parquet"].map(|name| swept.dir.join(name));
    let table = tables.iter().find(|table| table.is_file()).unwrap_or(&tables[0]);
    text += &format!("\n  rows: {}", table.display());
    if let Some((recordings, telling)) = most_telling(&swept.rows) {
        let files = Target::ALL.map(|target| target.path(&swept.dir, telling));
        if let Some(file) = files.iter().find(|file| file.is_file()) {
            let said = format!("  recordings: {recordings}; the most telling:");
            text +=
                &format!("\n{}", beside(&said, &format!("gotai view {}", quoted(&file.display().to_string())), "  "));
        }
    }
    text
}

/// A remark and the command that shows what it says, which has a line of its own where one has no room for both.
fn beside(said: &str, command: &str, margin: &str) -> String {
    let is_short = said.chars().count() + 1 + command.chars().count() <= usize::from(width());
    if is_short { format!("{said} {command}") } else { format!("{said}\n{margin}  {command}") }
}

/// Number of recordings, and the name of the one that tells most: of a run that diverged or stalled, if there is one,
/// that with the largest rise of energy.
fn most_telling(rows: &[Row]) -> Option<(usize, &str)> {
    let recorded = || rows.iter().filter_map(|row| Some((row, row.recording.as_deref()?)));
    let rank = |row: &Row| {
        let ended_badly = row.measured.outcome != Outcome::Finished;
        (ended_badly, row.measured.energy_rise_max_rel.unwrap_or(f64::INFINITY))
    };
    // The first of equals.
    let better = |a: &Row, b: &Row| {
        let ((a_bad, a_rise), (b_bad, b_rise)) = (rank(a), rank(b));
        a_bad.cmp(&b_bad).then(a_rise.total_cmp(&b_rise)).is_lt()
    };
    let best = recorded().reduce(|best, next| if better(best.0, next.0) { next } else { best })?;
    Some((recorded().count(), best.1))
}

/// Prints one object for a file, a list for a folder, in which each has remarks of its own.
fn print_document(swept: &[Swept]) {
    let document = |s: &Swept| {
        let counted = Outcome::ALL.map(|outcome| (outcome.name().to_string(), count(&s.rows, outcome).into()));
        let outcomes: serde_json::Map<_, _> = counted.into_iter().collect();
        let mut document = json!({
            "config": s.config, "dir": s.dir, "cases": s.planned, "ran": s.ran, "outcomes": outcomes, "rows": s.rows,
        });
        Swept::remarks(&[s]).put_into(&mut document);
        document
    };
    match swept {
        [only] => print_json(&document(only)),
        all => print_json(&all.iter().map(document).collect::<Vec<_>>()),
    }
}

//! `gotai report`: results as one page, and its figures as SVG and PNG.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{print, print_as_it_is, print_json, say, width, wrapped};
use super::reporting::Reported;
use crate::report::choose::{figures, map_in_characters};
use crate::report::figure::Figure;
use crate::report::page::nothing_drawn;
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// Folders of results, or files of rows (rows.csv, rows.parquet, bench.json, or a bench's table of any program)
    #[arg(required = true)]
    paths: Vec<PathBuf>,
    /// What the map is of: finished, diverged or stalled (the share that ends so), or a column (the median of sizes)
    #[arg(long, value_name = "COLUMN")]
    map: Option<String>,
    /// Rows of other programs, drawn into run time against error: a table with engine, method, dt or step_s, error,
    /// error_kind and wall_s; of several scenes FILE:SCENE
    #[arg(long, value_name = "FILE")]
    with: Vec<String>,
    #[command(flatten)]
    output: OutputArgs,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        // All are read before anything is written.
        let mut all = self.paths.iter().map(|path| Reported::of(path)).collect::<Result<Vec<_>, _>>()?;
        let mut documents = Vec::new();
        for reported in &mut all {
            self.refuse_unknown(reported)?;
            for file in &self.with {
                reported.overlay(file)?;
            }
            reported.subject.painted.clone_from(&self.map);
            documents.push(self.one(reported)?);
        }
        if self.output.json {
            match &documents[..] {
                [only] => print_json(only),
                all => print_json(&all),
            }
        }
        Ok(ExitCode::SUCCESS)
    }

    fn refuse_unknown(&self, reported: &Reported) -> Result<(), CliError> {
        let Some(name) = &self.map else { return Ok(()) };
        let frame = &reported.subject.frame;
        let numbers: Vec<&str> = frame.names().filter(|name| frame.numbers(name).is_some()).collect();
        if ["finished", "diverged", "stalled"].contains(&name.as_str()) || numbers.contains(&name.as_str()) {
            return Ok(());
        }
        let expected = format!("expected finished, diverged, stalled, or a column of numbers ({})", numbers.join(", "));
        Err(CliError::Input(format!("--map: {expected}, found `{name}`")))
    }

    fn one(&self, reported: &Reported) -> Result<Value, CliError> {
        let figures = figures(&reported.subject);
        let left_out = reported.write_page(&figures)?;
        let plots = reported.write_plots(&figures)?;
        if !self.output.json {
            for warning in reported.subject.warnings.iter().filter(|_| !self.output.quiet) {
                say(format!("warning: {}: {warning}", reported.page.display()));
            }
            let is_told = !self.output.quiet;
            if figures.is_empty() && is_told {
                print(wrapped(&nothing_drawn(&reported.subject), width().into(), "", ""));
            }
            let is_colored = self.output.is_colored();
            let map = map_in_characters(&reported.subject).filter(|_| !self.output.verbose && is_told);
            let drawn: Vec<&Figure> = if self.output.verbose { figures.iter().collect() } else { map.iter().collect() };
            for figure in drawn {
                // The figure has cleaned its words, and has colours of its own.
                print_as_it_is(format!("{}\n", figure.characters(is_colored)));
            }
            if !self.output.verbose && is_told {
                figures.iter().filter(|figure| map.is_none() || figure.name != "map").for_each(|figure| {
                    print(wrapped(&format!("{}: {}", figure.title, figure.finding), width().into(), "", "  "));
                });
            }
            print(format!("report: {}", reported.page.display()));
            if let Some(first) = plots.first().and_then(|plot| plot.parent()) {
                print(format!("figures: {} as SVG and PNG in {}", plots.len(), first.display()));
            }
            if let Some(left_out) = left_out.as_ref().filter(|_| !self.output.quiet) {
                say(wrapped(&format!("note: {left_out}"), width().into(), "", "  "));
            }
        }
        let figure = |figure: &Figure| json!({ "name": figure.name, "title": figure.title, "finding": figure.finding });
        Ok(json!({
            "report": reported.page, "rows": reported.subject.frame.rows(),
            "figures": figures.iter().map(figure).collect::<Vec<_>>(),
            "plots": plots, "left_out": left_out, "warnings": reported.subject.warnings,
        }))
    }
}

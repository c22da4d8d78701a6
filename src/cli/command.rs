//! The commands, one file each.

use super::error::CliError;
use super::{
    bench, check, clean, compare, completions, doctor, explain, export, list, new, repair, report, rows, run, schema,
    status, sweep, view,
};
use clap::{CommandFactory, Parser, Subcommand};
use std::process::ExitCode;

/// Experiment harness for rigid-body simulation: sweep time step, friction and mesh resolution; record, judge and
/// compare every run.
#[derive(Parser)]
#[command(name = "gotai", version, long_about = None, after_help = EXIT_CODES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 fine · 1 an expectation not met, a case failed or results are incomplete · \
                          2 the input is wrong · 3 the machine failed · 130/143 interrupted (what was finished is \
                          kept)";

#[derive(Subcommand)]
enum Command {
    /// Run one experiment (no axes left: fix them with --set), write its row and recordings, print a summary; or run a
    /// row of a folder of results again (--case)
    Run(run::Command),
    /// Expand the axes into cases and run them on all cores; run again, it does only what is missing
    Sweep(sweep::Command),
    /// Run experiments and judge what they expect (`expect:`); exit code 1 if one expectation is not met
    Check(check::Command),
    /// Run time against error: the methods, steps and tolerances of `bench:`, on one core
    Bench(bench::Command),
    /// Two folders of results (versions, methods, machines): what got better, what worse, by how much
    Compare(compare::Command),
    /// Results as one page (report.html), and its figures as SVG and PNG
    Report(report::Command),
    /// How much of a sweep is done, missing, failed
    Status(status::Command),
    /// The rows of a folder of results, chosen, sorted, as a table
    Rows(rows::Command),
    /// Open recordings in the Rerun Viewer; several cases together, on one timeline, as ghosts
    View(view::Command),
    /// The series of recordings (.mcap) as CSV or Parquet
    Export(export::Command),
    /// Mend a recording that was cut
    Repair(repair::Command),
    /// Drop replays, half-written files, and what other builds have left in a folder of results
    Clean(clean::Command),
    /// What this scene needs, what is skipped and why; number of cases, steps, estimated time and bytes
    Explain(explain::Command),
    /// What can be written in an experiment file
    List(list::Command),
    /// Write a commented experiment to start from
    New(new::Command),
    /// The JSON Schema of the experiment file, for editors
    Schema(schema::Command),
    /// What a shell completes
    Completions(completions::Command),
    /// What is there: the viewer and its version, Slurm, space
    Doctor(doctor::Command),
}

impl Cli {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        match self.command {
            Command::Run(command) => command.run(),
            Command::Sweep(command) => command.run(),
            Command::Check(command) => command.run(),
            Command::Bench(command) => command.run(),
            Command::Compare(command) => command.run(),
            Command::Report(command) => command.run(),
            Command::Status(command) => command.run(),
            Command::Rows(command) => command.run(),
            Command::View(command) => command.run(),
            Command::Export(command) => command.run(),
            Command::Repair(command) => command.run(),
            Command::Clean(command) => command.run(),
            Command::Explain(command) => command.run(),
            Command::List(command) => command.run(),
            Command::New(command) => command.run(),
            Command::Schema(command) => command.run(),
            Command::Completions(command) => command.run(Cli::command()),
            Command::Doctor(command) => command.run(),
        }
    }
}

//! The command line: one file per command. No default of the physics lives here.

mod bench;
mod check;
mod explain;
mod junit;
pub mod later;
mod list;
mod progress;
mod run;
mod status;
mod sweep;
mod sweeping;
mod table;

use crate::experiment::types::RecordTo;
use crate::experiment::{ExperimentError, ExperimentFile};
use crate::record::RecordError;
use crate::record::writer::Target;
use crate::sweep::runner::{SweepError, targets};
use crate::sweep::store::StoreError;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::io::Write;
use std::path::{Component, Path, PathBuf};
use std::process::ExitCode;

/// Experiment harness for rigid-body simulation: sweep time step, friction and mesh resolution; record, judge and
/// compare every run.
#[derive(Parser)]
#[command(name = "gotai", version, long_about = None, after_help = EXIT_CODES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 fine · 1 an expectation not met, a case failed or results are incomplete · 2 the input is wrong · \
                          3 the machine failed · 130/143 interrupted (what was finished is kept)";

#[derive(Subcommand)]
enum Command {
    /// Run one experiment (no axes left: fix them with --set), write its recordings, print a summary
    Run(run::Command),
    /// Expand the axes into cases and run them on all cores; run again, it does only what is missing
    Sweep(sweep::Command),
    /// Run experiments and judge what they expect (`expect:`); exit code 1 if one expectation is not met
    Check(check::Command),
    /// Run time against error: the methods, steps and tolerances of `bench:`, on one core
    Bench(bench::Command),
    /// How much of a sweep is done, missing, failed
    Status(status::Command),
    /// What this scene needs, what is skipped and why; number of cases, steps, estimated time and bytes
    Explain(explain::Command),
    /// What can be written in an experiment file
    List(list::Command),
}

impl Cli {
    pub fn run(self) -> Result<ExitCode, CliError> {
        match self.command {
            Command::Run(command) => command.run(),
            Command::Sweep(command) => command.run(),
            Command::Check(command) => command.run(),
            Command::Bench(command) => command.run(),
            Command::Status(command) => command.run(),
            Command::Explain(command) => command.run(),
            Command::List(command) => command.run(),
        }
    }
}

/// Of every command that reads an experiment.
#[derive(Args, Clone, Debug)]
struct ExperimentArgs {
    /// Change a value: a key path and YAML, e.g. scene.bodies.cube.mass_kg=2; list items by name or 0-based index
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
}

/// Of every command that prints.
#[derive(Args, Clone, Copy, Debug)]
struct OutputArgs {
    /// One JSON document on stdout and nothing else there
    #[arg(long)]
    json: bool,
    /// Nothing on stderr but errors
    #[arg(long)]
    quiet: bool,
    /// More about what is done
    #[arg(short, long)]
    verbose: bool,
}

/// Of every command that runs cases.
#[derive(Args, Clone, Debug)]
struct RunArgs {
    /// Folder for the results [default: recordings/<path of the config below configs/, without .yaml>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// What to record into; overrides record.to
    #[arg(long, value_enum)]
    record: Option<RecordFlag>,
    /// Cases at a time [default: all cores]
    #[arg(long, value_name = "N")]
    jobs: Option<usize>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum RecordFlag {
    None,
    Rerun,
    Mcap,
    Both,
}

impl From<RecordFlag> for RecordTo {
    fn from(flag: RecordFlag) -> Self {
        match flag {
            RecordFlag::None => RecordTo::None,
            RecordFlag::Rerun => RecordTo::Rerun,
            RecordFlag::Mcap => RecordTo::Mcap,
            RecordFlag::Both => RecordTo::Both,
        }
    }
}

/// Why a command failed; says its exit code.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    #[error("{0}")]
    Input(String),
    #[error(transparent)]
    Record(#[from] RecordError),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error("{0}")]
    Machine(String),
}

impl CliError {
    pub fn exit_code(&self) -> ExitCode {
        let input_is_wrong = match self {
            CliError::Experiment(error) => !error.is_machine(),
            CliError::Input(_) => true,
            _ => false,
        };
        ExitCode::from(if input_is_wrong { 2 } else { 3 })
    }
}

impl RunArgs {
    fn out(&self, config: &Path) -> PathBuf {
        self.out.clone().unwrap_or_else(|| default_out(config))
    }

    /// The flag wins over the file.
    fn targets(&self, in_file: Option<RecordTo>) -> Result<Vec<Target>, CliError> {
        let targets = targets(self.record.map(RecordTo::from).or(in_file));
        match targets.iter().find(|target| !Target::AVAILABLE.contains(target)) {
            None => Ok(targets),
            Some(_) => Err(CliError::Input(
                "record: this gotai was built without Rerun (cargo feature `rerun`); use --record mcap".into(),
            )),
        }
    }

    /// A pool of as many threads as asked for.
    fn pool(&self) -> Result<rayon::ThreadPool, CliError> {
        if self.jobs == Some(0) {
            return Err(CliError::Input("--jobs: expected at least 1, found 0".into()));
        }
        let builder = rayon::ThreadPoolBuilder::new().num_threads(self.jobs.unwrap_or(0));
        builder.build().map_err(|error| CliError::Machine(format!("cannot start threads: {error}")))
    }
}

impl ExperimentArgs {
    fn load(&self, config: &Path) -> Result<ExperimentFile, CliError> {
        Ok(ExperimentFile::load(config, &self.sets)?)
    }
}

/// recordings/<path of the config below configs/, without .yaml>.
fn default_out(config: &Path) -> PathBuf {
    Path::new("recordings").join(below_configs(config))
}

/// Path below configs/, without .yaml; a config elsewhere goes by its own name.
fn below_configs(config: &Path) -> PathBuf {
    let parts: Vec<_> = config.components().collect();
    let below = parts.iter().rposition(|part| *part == Component::Normal("configs".as_ref()));
    let name: PathBuf = match below {
        Some(at) if at + 1 < parts.len() => parts[at + 1..].iter().collect(),
        _ => PathBuf::from(config.file_name().unwrap_or("run".as_ref())),
    };
    name.with_extension("")
}

/// Prints to stdout; a reader that has gone away is no error.
fn print(text: impl std::fmt::Display) {
    let _ = writeln!(std::io::stdout(), "{text}");
}

fn print_json(value: &impl serde::Serialize) {
    print(serde_json::to_string(value).unwrap_or_default());
}

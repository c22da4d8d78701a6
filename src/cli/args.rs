//! Flags that commands share.

use super::error::CliError;
use crate::digest::sha256;
use crate::experiment::ExperimentFile;
use crate::experiment::types::RecordTo;
use crate::record::writer::Target;
use crate::sweep::runner::targets;
use clap::{Args, ValueEnum};
use std::path::{Component, Path, PathBuf};

/// Of every command that reads an experiment.
#[derive(Args, Clone, Debug)]
pub(super) struct ExperimentArgs {
    /// Change a value: a key path and YAML, e.g. scene.bodies.cube.mass_kg=2; list items by name or 0-based index
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(super) sets: Vec<String>,
}

/// Of every command that prints.
#[derive(Args, Clone, Copy, Debug)]
pub(super) struct OutputArgs {
    /// One JSON document on stdout and nothing else there
    #[arg(long)]
    pub(super) json: bool,
    /// Nothing on stderr but errors
    #[arg(long)]
    pub(super) quiet: bool,
    /// More about what is done
    #[arg(short, long)]
    pub(super) verbose: bool,
}

/// Of every command that runs cases.
#[derive(Args, Clone, Debug)]
pub(super) struct RunArgs {
    /// Folder for the results [default: recordings/<path of the config below configs/, without .yaml>+<what is set>]
    #[arg(long, value_name = "DIR")]
    pub(super) out: Option<PathBuf>,
    /// What to record into; overrides record.to
    #[arg(long, value_enum)]
    pub(super) record: Option<RecordFlag>,
    /// Cases at a time [default: all cores]
    #[arg(long, value_name = "N")]
    pub(super) jobs: Option<usize>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum RecordFlag {
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

impl RunArgs {
    /// The flag wins over the file.
    pub(super) fn targets(&self, in_file: Option<RecordTo>) -> Result<Vec<Target>, CliError> {
        let targets = targets(self.record.map(RecordTo::from).or(in_file));
        match targets.iter().find(|target| !Target::AVAILABLE.contains(target)) {
            None => Ok(targets),
            Some(_) => Err(CliError::Input(
                "record: this gotai was built without Rerun (cargo feature `rerun`); use --record mcap".into(),
            )),
        }
    }

    /// A pool of as many threads as asked for.
    pub(super) fn pool(&self) -> Result<rayon::ThreadPool, CliError> {
        if self.jobs == Some(0) {
            return Err(CliError::Input("--jobs: expected at least 1, found 0".into()));
        }
        let builder = rayon::ThreadPoolBuilder::new().num_threads(self.jobs.unwrap_or(0));
        builder.build().map_err(|error| CliError::Machine(format!("cannot start threads: {error}")))
    }
}

impl ExperimentArgs {
    pub(super) fn load(&self, config: &Path) -> Result<ExperimentFile, CliError> {
        Ok(ExperimentFile::load(config, &self.sets)?)
    }

    /// The same of a text that stands in a file of another kind.
    pub(super) fn read(&self, path: &Path, text: &str) -> Result<ExperimentFile, CliError> {
        Ok(ExperimentFile::from_text(path, text, &self.sets)?)
    }

    /// Nothing is changed.
    pub(super) fn is_empty(&self) -> bool {
        self.sets.is_empty()
    }

    /// recordings/<path of the config below configs/, without .yaml>, and what was set, so that no run overwrites the
    /// table of another one.
    pub(super) fn default_out(&self, config: &Path) -> PathBuf {
        let mut folder = Path::new("recordings").join(below_configs(config)).into_os_string();
        folder.push(suffix(&self.sets));
        folder.into()
    }
}

/// Keys that change neither the motion nor the columns.
const BESIDE: [&str; 4] = ["record", "question", "expect", "bench"];

/// `+path=value` for every `--set` in the order given, in characters that every shell and file system takes.
fn suffix(sets: &[String]) -> String {
    const LONGEST: usize = 80;
    const KEPT: usize = 60;
    let decides = |set: &&String| !BESIDE.contains(&set.split(['.', '=']).next().unwrap_or_default().trim());
    let given: String = sets.iter().filter(decides).map(|set| format!("+{set}")).collect();
    let is_safe = |c: char| c.is_ascii_alphanumeric() || ".+-=".contains(c);
    let name: String = given.chars().map(|c| if is_safe(c) { c } else { '-' }).collect();
    if name.len() <= LONGEST {
        return name;
    }
    // Of what was given: two that begin alike, or differ in what is replaced, are two.
    format!("{}~{}", &name[..KEPT], sha256(given, 4))
}

/// Path below configs/, without .yaml; a config elsewhere goes by its own name.
pub(super) fn below_configs(config: &Path) -> PathBuf {
    let parts: Vec<_> = config.components().collect();
    let below = parts.iter().rposition(|part| *part == Component::Normal("configs".as_ref()));
    let name: PathBuf = match below {
        Some(at) if at + 1 < parts.len() => parts[at + 1..].iter().collect(),
        _ => PathBuf::from(config.file_name().unwrap_or("run".as_ref())),
    };
    name.with_extension("")
}

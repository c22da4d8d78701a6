//! Flags that commands share.

use super::error::CliError;
use super::output::{ColorFlag, ProgressFlag};
use crate::digest::sha256;
use crate::experiment::types::RecordTo;
use crate::experiment::{ExperimentFile, Given};
use crate::record::writer::Target;
use crate::sweep::folder::Folder;
use crate::sweep::kept::EXPERIMENT;
use crate::sweep::runner::targets;
use clap::{ArgMatches, Args, FromArgMatches, ValueEnum};
use std::path::{Component, Path, PathBuf};

/// Flags of every command that reads an experiment.
#[derive(Clone, Debug)]
pub(super) struct ExperimentArgs {
    /// Flags in the order on the command line, which each of the two kinds alone does not tell.
    given: Vec<Given>,
}

#[derive(Args)]
struct ExperimentFlags {
    /// Change a value: a key path and YAML, e.g. scene.bodies.cube.mass_kg=2; list items by name or 0-based index
    #[arg(long = "set", id = SET, value_name = "PATH=VALUE")]
    _sets: Vec<String>,
    /// The values of an axis, in place of the file's or new: a list, from..to, or a form, e.g. seed=0..39
    #[arg(long = "axis", id = AXIS, value_name = "PATH=VALUES")]
    _axes: Vec<String>,
}

const SET: &str = "set";
const AXIS: &str = "axis";

impl Args for ExperimentArgs {
    fn augment_args(command: clap::Command) -> clap::Command {
        ExperimentFlags::augment_args(command)
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        ExperimentFlags::augment_args_for_update(command)
    }
}

impl FromArgMatches for ExperimentArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let all = |id, flag: fn(String) -> Given| {
            let texts = matches.get_many::<String>(id).into_iter().flatten().cloned().map(flag);
            matches.indices_of(id).into_iter().flatten().zip(texts)
        };
        let mut given: Vec<(usize, Given)> = all(SET, Given::Set).chain(all(AXIS, Given::Axis)).collect();
        given.sort_by_key(|(place, _)| *place);
        Ok(ExperimentArgs { given: given.into_iter().map(|(_, given)| given).collect() })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Flags of every command that prints.
#[derive(Args, Clone, Copy, Debug)]
pub(super) struct OutputArgs {
    /// One JSON document on stdout and nothing else there
    #[arg(long)]
    pub(super) json: bool,
    /// Nothing on stderr but warnings and errors; of `check`, nothing on stdout but what is not met
    #[arg(long)]
    pub(super) quiet: bool,
    /// More about what is done
    #[arg(short, long)]
    pub(super) verbose: bool,
    /// When there is colour [default: on a terminal, unless NO_COLOR is set]
    #[arg(long, value_enum, value_name = "WHEN", default_value_t, hide_default_value = true)]
    pub(super) color: ColorFlag,
}

impl OutputArgs {
    /// Whether what is printed has colour.
    pub(super) fn is_colored(self) -> bool {
        !self.json && self.color.is_on(&std::io::stdout())
    }
}

/// Flags of every command that runs cases.
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
    /// How progress is told, on stderr [default: a bar on a terminal]
    #[arg(long, value_enum, value_name = "HOW", default_value_t, hide_default_value = true)]
    pub(super) progress: ProgressFlag,
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
    /// Kinds of file to record into: those of the flag, else those of the file.
    ///
    /// # Errors
    /// What is asked for is a kind that this build cannot write.
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
    ///
    /// # Errors
    /// No thread is asked for, or the machine has none to give.
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
        Ok(ExperimentFile::load_given(config, &self.given)?)
    }

    /// The first axis that is given on the command line.
    pub(super) fn first_axis(&self) -> Option<&str> {
        self.given.iter().find(|given| matches!(given, Given::Axis(_))).map(Given::text)
    }

    /// The experiment of a text that stands in a file of another kind, with the flags' changes.
    pub(super) fn read(&self, path: &Path, text: &str) -> Result<ExperimentFile, CliError> {
        Ok(ExperimentFile::from_text_given(path, text, &self.given)?)
    }

    /// Whether the flags change nothing.
    pub(super) fn is_empty(&self) -> bool {
        self.given.is_empty()
    }

    /// Default folder of results: recordings/<path of the config below configs/, without .yaml>, and what was set, so
    /// that no run overwrites the table of another one. What a folder of results keeps goes on there.
    pub(super) fn default_out(&self, config: &Path) -> PathBuf {
        match kept_in(config) {
            Some(dir) => self.suffixed(dir.to_path_buf()),
            None => self.default_below(&below_configs(config)),
        }
    }

    /// Default folder of results of this place below recordings/.
    pub(super) fn default_below(&self, place: &Path) -> PathBuf {
        self.suffixed(Path::new("recordings").join(place))
    }

    fn suffixed(&self, folder: PathBuf) -> PathBuf {
        let mut folder = folder.into_os_string();
        folder.push(suffix(&self.given));
        folder.into()
    }

    /// The file without what the flags change.
    pub(super) fn load_as_written(config: &Path) -> Result<ExperimentFile, CliError> {
        Ok(ExperimentFile::load_given(config, &[])?)
    }
}

/// The folder of results that keeps this file as its question.
pub(super) fn kept_in(config: &Path) -> Option<&Path> {
    config.parent().filter(|dir| config.ends_with(EXPERIMENT) && Folder::is_one(dir))
}

/// Keys that change neither the motion nor the columns.
const BESIDE: [&str; 4] = ["record", "question", "expect", "bench"];

/// `+path=value` for every `--set` and `--axis` in the order given, in characters that every shell and file system
/// takes.
fn suffix(given: &[Given]) -> String {
    const LONGEST: usize = 80;
    const KEPT: usize = 60;
    let decides = |set: &&str| !BESIDE.contains(&set.split(['.', '=']).next().unwrap_or_default().trim());
    let given: String = given.iter().map(Given::text).filter(decides).map(|set| format!("+{set}")).collect();
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
    // However it is written, and from wherever.
    let whole = std::fs::canonicalize(config).unwrap_or_else(|_| config.to_path_buf());
    let parts: Vec<_> = whole.components().collect();
    let below = parts.iter().rposition(|part| *part == Component::Normal("configs".as_ref()));
    let name: PathBuf = match below {
        Some(at) if at + 1 < parts.len() => parts[at + 1..].iter().collect(),
        _ => PathBuf::from(config.file_name().unwrap_or("run".as_ref())),
    };
    name.with_extension("")
}

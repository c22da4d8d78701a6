//! Sweeps of files and folders, for `sweep` and `check`: their cases, and running what is missing.

use super::args::{ExperimentArgs, OutputArgs, RunArgs, below_configs, kept_in};
use super::error::CliError;
use super::output::say;
use super::progress::Bar;
use super::remarks::{Remarks, Seen, table_of};
use crate::check::{self, Failing, Judged, Magnitudes, Schema, broken, cells_of, in_turn, judge, refuse_unknown};
use crate::experiment::ExperimentFile;
use crate::experiment::types::{RecordCases, RecordTo};
use crate::files::quoted;
use crate::measure::more;
use crate::outcome::Outcome;
use crate::record::writer::Target;
use crate::rows::columns::{self, SEARCH};
use crate::rows::{Row, count};
use crate::sweep::folder::Folder;
use crate::sweep::plan::SweepPlan;
use crate::sweep::planned::Planned;
use crate::sweep::runner::{Job, build_and_run, lock, targets};
use crate::sweep::store::Store;
use clap::Args;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::collections::HashMap;
use std::io::IsTerminal;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant, SystemTime};

#[derive(Args)]
pub struct SweepArgs {
    /// Take rows of another build as they are
    #[arg(long)]
    keep: bool,
    /// Run the cases again that have failed
    #[arg(long)]
    retry_failed: bool,
    /// Write rows.csv for more than 100,000 rows too
    #[arg(long)]
    csv: bool,
    /// Begin no further case once one has failed, and no further file once an expectation is not met
    #[arg(long)]
    pub fail_fast: bool,
    #[command(flatten)]
    experiment: ExperimentArgs,
    #[command(flatten)]
    pub run: RunArgs,
    #[command(flatten)]
    pub output: OutputArgs,
}

/// An experiment file on the command line, or found in a folder there.
pub struct Config {
    pub path: PathBuf,
    /// Place of the file in its folder, below `--out`; nothing for a file on its own.
    below: PathBuf,
    /// Place of its results below `--out` or recordings/, where another file would have the same folder.
    apart: Option<PathBuf>,
    pub is_of_folder: bool,
}

/// A file whose cases have all been checked.
pub struct PlannedSweep {
    pub config: Config,
    pub file: ExperimentFile,
    pub plan: SweepPlan,
    targets: Vec<Target>,
    /// Columns of its rows, where what it expects is judged.
    judged_by: Option<Schema>,
}

/// Result of one file's sweep.
pub struct Swept {
    pub config: PathBuf,
    pub dir: PathBuf,
    pub ran: usize,
    pub planned: usize,
    pub rows: Vec<Row>,
    /// What is seen of each row.
    seen: Vec<Seen>,
    /// Verdicts on what the file expects, where they were asked for.
    pub judged: Vec<Judged>,
    /// Cases that have failed, where verdicts were asked for.
    pub broken: Vec<Failing>,
    /// When it was begun, and how long it took.
    pub begun: SystemTime,
    pub took: Duration,
}

impl Swept {
    pub fn failed(&self) -> usize {
        count(&self.rows, Outcome::Failed)
    }

    /// Whether rows are missing, because somebody has let no further case begin.
    pub fn is_cut(&self) -> bool {
        self.rows.len() < self.planned
    }

    /// Remarks about the cases of several files.
    pub(super) fn remarks(all: &[&Swept]) -> Remarks {
        let doubtful = all.iter().filter(|swept| swept.seen.iter().any(Seen::is_doubtful));
        let tables: Vec<PathBuf> = doubtful.map(|swept| table_of(&swept.dir)).collect();
        Remarks::about(all.iter().flat_map(|swept| &swept.seen), &tables)
    }
}

impl SweepArgs {
    /// Gives every file a folder of results of its own.
    ///
    /// # Errors
    /// Two files cannot be told apart by their paths.
    pub(super) fn tell_apart(&self, configs: &mut [&mut Config]) -> Result<(), CliError> {
        tell_apart(configs, self.run.out.as_deref(), &self.experiment)
    }

    /// Of a command that runs its few cases as a sweep does.
    pub(super) fn for_run(experiment: ExperimentArgs, run: RunArgs, output: OutputArgs) -> Self {
        SweepArgs { keep: false, retry_failed: false, csv: false, fail_fast: false, experiment, run, output }
    }

    /// A file's sweep, recorded into this kind of file whatever the flags say.
    ///
    /// # Errors
    /// A case is wrong, or this build cannot write what is asked for.
    pub(super) fn planned_into(
        &self,
        path: PathBuf,
        file: ExperimentFile,
        to: RecordTo,
    ) -> Result<PlannedSweep, CliError> {
        let config = Config { path, below: PathBuf::new(), apart: None, is_of_folder: false };
        let plan = SweepPlan::new(&file)?;
        refuse_unknown_names(&config.path, &file, &plan, &self.experiment)?;
        Ok(PlannedSweep { config, file, plan, targets: targets(Some(to)), judged_by: None })
    }

    /// The file with the flags' changes.
    ///
    /// # Errors
    /// The file cannot be read, or its experiment is wrong.
    pub fn load(&self, config: &Config) -> Result<ExperimentFile, CliError> {
        self.experiment.load(&config.path)
    }

    /// A file's sweep: all its cases, and the kinds of file that they are recorded into: `--record`, else `instead`,
    /// else what the file says.
    ///
    /// # Errors
    /// A case is wrong, or this build cannot write what is asked for.
    pub fn planned(
        &self,
        config: Config,
        file: ExperimentFile,
        instead: Option<RecordTo>,
    ) -> Result<PlannedSweep, CliError> {
        let plan = SweepPlan::new(&file)?;
        refuse_unknown_names(&config.path, &file, &plan, &self.experiment)?;
        let record = plan.cases.first().map(|first| &first.case.experiment.record);
        let said = record.and_then(|record| record.to);
        let fails_alone = record.is_some_and(|record| record.cases == RecordCases::Failing);
        // Who asks for files of what fails means this command.
        let targets = self.run.targets(if fails_alone && said.is_some() { said } else { instead.or(said) })?;
        let planned = PlannedSweep { config, file, plan, targets, judged_by: None };
        if fails_alone { planned.judging() } else { Ok(planned) }
    }

    /// Runs what is missing of a file's sweep.
    ///
    /// # Errors
    /// The machine failed, or the folder holds something else; a case that fails is a row.
    pub fn sweep(&self, planned: &PlannedSweep) -> Result<Swept, CliError> {
        let PlannedSweep { config, plan, targets, .. } = planned;
        let dir = config.out(self.run.out.as_deref(), &self.experiment);
        let mut store = Store::open(&dir, plan, self.keep)?;
        if self.retry_failed {
            store.forget_failed();
        }
        if let Some(edited) = store.edited().filter(|_| !self.output.quiet) {
            say(format!("{}: {edited}", dir.display()));
        }
        let store = Arc::new(Mutex::new(store));
        keep_rows_when_interrupted(&store, &dir)?;
        if self.output.verbose {
            say(format!("{}: {} cases into {}", config.path.display(), plan.cases.len(), dir.display()));
        }
        let work = |planned: &Planned, targets: &[Target]| build_and_run(planned, &dir, targets);
        let bar = Bar::new(&config.path, self.output, self.run.progress).stopping_at_failure(self.fail_fast);
        let (begun, clock) = (SystemTime::now(), Instant::now());
        let job = Job { dir: &dir, targets, csv: self.csv, work: &work, progress: &bar };
        let ran = quietly(|| job.sweep(&plan.cases, &store))?;
        let mut rows = lock(&store).rows();
        let (judged, broken) = planned.judge(&rows);
        let rule = plan.cases.first().map(|first| first.case.experiment.record.cases);
        if rule == Some(RecordCases::Failing) {
            quietly(|| job.record(&in_turn(&judged, check::MOST), &plan.cases, &store))?;
            rows = lock(&store).rows();
        }
        let took = clock.elapsed();
        // Rows are in plan order, with gaps where there are none.
        let mut cases = plan.cases.iter();
        let mut case_of = |row: &Row| cases.find(|planned| planned.case.id == row.case);
        let seen =
            rows.iter().filter_map(|row| Some(Seen::of(&row.measured, &case_of(row)?.case.experiment))).collect();
        let (config, planned) = (config.path.clone(), plan.cases.len());
        Ok(Swept { config, dir, ran, planned, rows, seen, judged, broken, begun, took })
    }
}

impl PlannedSweep {
    /// The sweep, with verdicts on what its file expects.
    ///
    /// # Errors
    /// An expectation names what no row has.
    pub fn judging(self) -> Result<Self, CliError> {
        let mut schema = schema(&self.file, &self.plan);
        let search = self.file.search();
        if let Ok(first) = self.file.case(&vec![0; self.file.axes().axes.len()]) {
            schema.magnitudes = Magnitudes::of(&first);
        }
        refuse_unknown(&schema, self.file.expect(), search).map_err(|error| self.file.placed(error))?;
        Ok(PlannedSweep { judged_by: Some(schema), ..self })
    }

    /// Verdicts, and the cases that have failed.
    fn judge(&self, rows: &[Row]) -> (Vec<Judged>, Vec<Failing>) {
        let Some(schema) = &self.judged_by else { return Default::default() };
        let cells = cells_of(rows);
        let verdict = |expectation| match rows.len() == self.plan.cases.len() {
            true => judge(expectation, schema, &cells),
            false => Judged::not_judged(
                expectation,
                &format!("not judged: {} of {} rows are there", rows.len(), self.plan.cases.len()),
            ),
        };
        (self.file.expect().iter().map(verdict).collect(), broken(schema, &cells))
    }
}

/// Columns that the rows of a file's cases will have.
fn schema(file: &ExperimentFile, plan: &SweepPlan) -> Schema {
    let mut names: Vec<String> = Vec::new();
    for name in plan.cases.iter().flat_map(|planned| more::names(&planned.case.experiment)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let search = file.search();
    names.extend(search.iter().flat_map(|_| columns::names(&SEARCH)));
    Schema::new(file.axes(), search.and_then(|search| search.over), &names)
}

/// Refuses what a file expects of columns or values that no row has, judged or not. What flags leave of the axes is no
/// slip of the file: its names may be those of the file as it is written too. What a folder of results keeps has had
/// its flags, and is taken as it is.
///
/// # Errors
/// An expectation names what no row has.
pub(super) fn refuse_unknown_names(
    config: &Path,
    file: &ExperimentFile,
    plan: &SweepPlan,
    given: &ExperimentArgs,
) -> Result<(), CliError> {
    let is_recording = config.extension().is_some_and(|ending| ending == Target::Mcap.extension());
    if (file.expect().is_empty() && file.search().is_none()) || kept_in(config).is_some() || is_recording {
        return Ok(());
    }
    let own = schema(file, plan);
    let Err(error) = refuse_unknown(&own, file.expect(), file.search()) else { return Ok(()) };
    if !given.is_empty() {
        // A file that is nothing without its flags says nothing against a name.
        let Ok(written) = ExperimentArgs::load_as_written(config) else { return Ok(()) };
        let Ok(plan) = SweepPlan::unbuilt(&written, "") else { return Ok(()) };
        if refuse_unknown(&own.or(schema(&written, &plan)), file.expect(), file.search()).is_ok() {
            return Ok(());
        }
    }
    Err(file.placed(error).into())
}

impl Config {
    /// Folder of a file's results; of several files every one has a folder of its own, also below `--out`.
    pub fn out(&self, given: Option<&Path>, experiment: &ExperimentArgs) -> PathBuf {
        match (given, &self.apart) {
            (Some(out), Some(place)) => return out.join(place),
            (None, Some(place)) => return experiment.default_below(place),
            (_, None) => {}
        }
        match given {
            Some(out) if self.below.as_os_str().is_empty() => out.to_path_buf(),
            Some(out) => out.join(&self.below),
            None => experiment.default_out(&self.path),
        }
    }
}

/// The files that are given, and all .yaml below given folders in the order of their paths.
///
/// # Errors
/// A path that is not there or cannot be read, a folder without a .yaml, or a folder of results.
pub fn configs(given: &[PathBuf]) -> Result<Vec<Config>, CliError> {
    configs_of_each(given).into_iter().map(|config| config.map_err(|(_, error)| error)).collect()
}

/// The same, each on its own: what is wrong with a path that is given, beside the files of the others.
pub(super) fn configs_of_each(given: &[PathBuf]) -> Vec<Result<Config, (PathBuf, CliError)>> {
    let mut all = Vec::new();
    for path in given {
        match configs_of(path, given.len() > 1) {
            Ok(configs) => all.extend(configs.into_iter().map(Ok)),
            Err(error) => all.push(Err((path.clone(), error))),
        }
    }
    all
}

/// Gives files whose results would go into one folder folders of their own: the second would write over the first.
///
/// # Errors
/// Two files cannot be told apart by their paths.
pub(super) fn tell_apart(
    configs: &mut [&mut Config],
    out: Option<&Path>,
    experiment: &ExperimentArgs,
) -> Result<(), CliError> {
    let whole = |config: &&mut Config| std::fs::canonicalize(&config.path).unwrap_or_else(|_| config.path.clone());
    let paths: Vec<PathBuf> = configs.iter().map(whole).collect();
    let most = paths.iter().map(|path| path.components().count()).max().unwrap_or(0);
    // By ever more of the folders that they are in; at last by the endings of their names.
    for parts in 2..=most + 1 {
        let clashing = clashing(configs, &paths, out, experiment);
        if clashing.is_empty() {
            return Ok(());
        }
        for at in clashing {
            configs[at].apart = Some(last_of(&paths[at], parts, parts <= most));
        }
    }
    match clashing(configs, &paths, out, experiment)[..] {
        [first, .., last] => {
            let [first, last] = [first, last].map(|at| configs[at].path.display());
            Err(CliError::Input(format!("{first}, {last}: expected files whose results have folders of their own")))
        }
        _ => Ok(()),
    }
}

/// Files of which another one, at another path, has the same folder of results.
fn clashing(configs: &[&mut Config], paths: &[PathBuf], out: Option<&Path>, experiment: &ExperimentArgs) -> Vec<usize> {
    let mut of: HashMap<PathBuf, Vec<usize>> = HashMap::new();
    for (at, config) in configs.iter().enumerate() {
        of.entry(config.out(out, experiment)).or_default().push(at);
    }
    let clash = |all: &Vec<usize>| all.iter().any(|at| paths[*at] != paths[all[0]]);
    let mut clashing: Vec<usize> = of.into_values().filter(clash).flatten().collect();
    clashing.sort_unstable();
    clashing
}

/// The last parts of a path, without the ending of its name if one can do without it.
fn last_of(path: &Path, parts: usize, is_bare: bool) -> PathBuf {
    let named: Vec<_> = path.components().filter(|part| matches!(part, Component::Normal(_))).collect();
    let place: PathBuf = named[named.len().saturating_sub(parts)..].iter().collect();
    if is_bare { place.with_extension("") } else { place }
}

fn configs_of(path: &Path, is_one_of_several: bool) -> Result<Vec<Config>, CliError> {
    // A folder of its own only where there is another to tell it from.
    let base = if is_one_of_several { below_configs(path) } else { PathBuf::new() };
    if Folder::is_one(path) {
        let path = path.display().to_string();
        let [file, dir] = [format!("{path}/experiment.yaml"), path.clone()].map(|word| quoted(&word));
        return Err(CliError::Input(format!(
            "{path}: expected experiment files, found a folder of results; go on in it with `gotai sweep {file} --out \
             {dir}`"
        )));
    }
    if !path.is_dir() {
        return Ok(vec![Config { path: path.to_path_buf(), below: base, apart: None, is_of_folder: false }]);
    }
    let below = |file: &Path| base.join(file.strip_prefix(path).unwrap_or(file).with_extension(""));
    let files = files_of(path)?.into_iter();
    Ok(files.map(|file| Config { below: below(&file), apart: None, path: file, is_of_folder: true }).collect())
}

fn files_of(given: &Path) -> Result<Vec<PathBuf>, CliError> {
    let mut found = Vec::new();
    let mut folders = vec![given.to_path_buf()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder);
        let entries = entries.map_err(|error| CliError::Machine(format!("{}: {error}", folder.display())))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            if path.is_dir() && !path.is_symlink() {
                // What results keep of their question is no question of its own.
                folders.extend((!Folder::is_one(&path)).then_some(path));
            } else if path.extension().is_some_and(|ending| ending == "yaml" || ending == "yml") {
                found.push(path);
            }
        }
    }
    if found.is_empty() {
        return Err(CliError::Input(format!("{}: expected experiment files (*.yaml), found none", given.display())));
    }
    found.sort();
    Ok(found)
}

/// Sees to it that on Ctrl-C or SIGTERM no row is torn, the tables are written, and the exit code says which signal it
/// was.
fn keep_rows_when_interrupted(store: &Arc<Mutex<Store>>, dir: &Path) -> Result<(), CliError> {
    let signals = Signals::new([SIGINT, SIGTERM]);
    let mut signals = signals.map_err(|error| CliError::Machine(format!("cannot listen for signals: {error}")))?;
    let (store, dir) = (Arc::downgrade(store), dir.to_path_buf());
    std::thread::spawn(move || {
        // A sweep that has ended has dropped its store; the next one of the folder listens for itself.
        if let (Some(signal), Some(store)) = (signals.forever().next(), store.upgrade()) {
            let store = lock(&store);
            if let Err(error) = store.write_tables(false) {
                say(format!("gotai: {error}"));
            }
            // Below the bar, which is left as it stands.
            if std::io::stderr().is_terminal() {
                say("");
            }
            say(format!(
                "interrupted: {} rows are kept in {}; run again to do the rest",
                store.rows().len(),
                dir.display()
            ));
            std::process::exit(128 + signal);
        }
    });
    Ok(())
}

/// A case that panics says so in its row; its backtrace does not belong between the lines of a progress bar.
fn quietly<T>(work: impl FnOnce() -> T) -> T {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let result = work();
    std::panic::set_hook(usual);
    result
}

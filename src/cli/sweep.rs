//! `gotai sweep`: the axes' cases on all cores, a row each; run again, it does only what is missing.

use super::progress::Bar;
use super::{CliError, ExperimentArgs, OutputArgs, RunArgs, print, print_json};
use crate::case::Case;
use crate::record::writer::Target;
use crate::row::{Outcome, Row, count};
use crate::sweep::plan::{PlanFile, cases};
use crate::sweep::runner::{Job, build_and_run, lock};
use crate::sweep::store::Store;
use clap::Args;
use serde_json::json;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Arc, Mutex};

#[derive(Args)]
pub struct Command {
    /// An experiment file (YAML), or a folder of them
    config: PathBuf,
    /// Take rows of another build as they are
    #[arg(long)]
    keep: bool,
    #[command(flatten)]
    experiment: ExperimentArgs,
    #[command(flatten)]
    run: RunArgs,
    #[command(flatten)]
    output: OutputArgs,
}

/// What became of one file's sweep.
struct Swept {
    config: PathBuf,
    dir: PathBuf,
    ran: usize,
    planned: usize,
    rows: Vec<Row>,
}

impl Command {
    pub fn run(self) -> Result<ExitCode, CliError> {
        let configs = configs(&self.config)?;
        // Every case of every file is checked before the first run.
        let pool = self.run.pool()?;
        let planned = configs.iter().map(|config| pool.install(|| self.planned(config)));
        let planned = planned.collect::<Result<Vec<_>, _>>()?;
        let mut swept = Vec::with_capacity(configs.len());
        for (config, (cases, targets)) in configs.iter().zip(&planned) {
            swept.push(pool.install(|| self.sweep_one(config, cases, targets))?);
            if !self.output.json {
                print(swept.last().map(summary).unwrap_or_default());
            }
        }
        if self.output.json {
            print_document(&swept);
        }
        let failed = swept.iter().any(|s| count(&s.rows, Outcome::Failed) > 0);
        Ok(ExitCode::from(u8::from(failed)))
    }

    /// All cases of a file, and what they are recorded into.
    fn planned(&self, config: &Path) -> Result<(Vec<Case>, Vec<Target>), CliError> {
        let cases = cases(&self.experiment.load(config)?)?;
        let targets = self.run.targets(cases.first().and_then(|case| case.experiment.record.to))?;
        Ok((cases, targets))
    }

    fn sweep_one(&self, config: &Path, cases: &[Case], targets: &[Target]) -> Result<Swept, CliError> {
        let dir = self.out(config);
        let store = Arc::new(Mutex::new(Store::open(&dir, PlanFile::new(cases), self.keep)?));
        keep_rows_when_interrupted(&store, &dir)?;
        if self.output.verbose {
            eprintln!("{}: {} cases into {}", config.display(), cases.len(), dir.display());
        }
        let work = |case: &Case, targets: &[Target]| build_and_run(case, &dir, targets);
        let bar = Bar::new(self.output.quiet);
        let job = Job { dir: &dir, targets, work: &work, progress: &bar };
        let ran = quietly(|| job.sweep(cases, &store))?;
        let rows = lock(&store).rows();
        Ok(Swept { config: config.to_path_buf(), dir, ran, planned: cases.len(), rows })
    }

    /// In a folder's sweep every file has a folder of its own, also below `--out`.
    fn out(&self, config: &Path) -> PathBuf {
        match (&self.run.out, config.strip_prefix(&self.config)) {
            (Some(out), Ok(below)) if !below.as_os_str().is_empty() => out.join(below.with_extension("")),
            _ => self.run.out(config),
        }
    }
}

/// The file itself, or all .yaml below a folder, in the order of their paths.
fn configs(path: &Path) -> Result<Vec<PathBuf>, CliError> {
    if !path.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let mut found = Vec::new();
    let mut folders = vec![path.to_path_buf()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder);
        let entries = entries.map_err(|error| CliError::Machine(format!("{}: {error}", folder.display())))?;
        for path in entries.flatten().map(|entry| entry.path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "yaml" || ending == "yml") {
                found.push(path);
            }
        }
    }
    if found.is_empty() {
        return Err(CliError::Input(format!("{}: expected experiment files (*.yaml), found none", path.display())));
    }
    found.sort();
    Ok(found)
}

/// On Ctrl-C or SIGTERM: no row is torn, the tables are written, and the exit code says which signal it was.
fn keep_rows_when_interrupted(store: &Arc<Mutex<Store>>, dir: &Path) -> Result<(), CliError> {
    let signals = Signals::new([SIGINT, SIGTERM]);
    let mut signals = signals.map_err(|error| CliError::Machine(format!("cannot listen for signals: {error}")))?;
    let (store, dir) = (Arc::downgrade(store), dir.to_path_buf());
    std::thread::spawn(move || {
        // A sweep that has ended has dropped its store; the next one of the folder listens for itself.
        if let (Some(signal), Some(store)) = (signals.forever().next(), store.upgrade()) {
            let store = lock(&store);
            if let Err(error) = store.write_tables() {
                eprintln!("gotai: {error}");
            }
            // Below the bar, which is left as it stands.
            if std::io::stderr().is_terminal() {
                eprintln!();
            }
            eprintln!(
                "interrupted: {} rows are kept in {}; run again to do the rest",
                store.rows().len(),
                dir.display()
            );
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

fn summary(swept: &Swept) -> String {
    let mut text = format!("{}: {} cases, {} run now", swept.config.display(), swept.planned, swept.ran);
    for (name, outcome) in OUTCOMES {
        match count(&swept.rows, outcome) {
            0 => {}
            n => text += &format!(" · {n} {name}"),
        }
    }
    text + &format!("\n  rows: {}", swept.dir.join("rows.csv").display())
}

const OUTCOMES: [(&str, Outcome); 4] = [
    ("finished", Outcome::Finished),
    ("diverged", Outcome::Diverged),
    ("stalled", Outcome::Stalled),
    ("failed", Outcome::Failed),
];

/// One object for a file, a list for a folder.
fn print_document(swept: &[Swept]) {
    let document = |s: &Swept| {
        let counted = OUTCOMES.iter().map(|(name, outcome)| (name.to_string(), count(&s.rows, *outcome).into()));
        let outcomes: serde_json::Map<_, _> = counted.collect();
        json!({
            "config": s.config, "dir": s.dir, "cases": s.planned, "ran": s.ran, "outcomes": outcomes, "rows": s.rows,
        })
    };
    match swept {
        [only] => print_json(&document(only)),
        all => print_json(&all.iter().map(document).collect::<Vec<_>>()),
    }
}

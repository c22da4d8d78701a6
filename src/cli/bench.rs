//! `gotai bench`: run time against error, as a table, files and a diagram.

use super::args::{ExperimentArgs, OutputArgs};
use super::bench_table::bench_table;
use super::error::CliError;
use super::output::{ProgressFlag, print, print_json, say, width};
use super::progress::Bar;
use super::remarks::{Remarks, Seen};
use super::reporting::{Known, OF_BENCH, Reported, others_of, write_beside};
use super::sweeping::{Config, configs, tell_apart};
use crate::bench::{self, Contender, Ran, timing};
use crate::experiment::ExperimentFile;
use crate::experiment::bench::Bench;
use crate::files::make_folder;
use crate::heading::unit_of;
use crate::report::pareto;
use crate::report::subject::{Ground, Subject};
use crate::report::tried;
use crate::rows::trials::{Trial, best_of_each_engine, to_csv};
use crate::study::reference;
use crate::sweep::runner::Progress;
use clap::Args;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// An experiment file (YAML), or a folder of them; in a folder, files without `bench:` are left out
    config: PathBuf,
    /// Folder for the results [default: recordings/<path of the config below configs/, without .yaml>+<what is set>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write no report.html
    #[arg(long)]
    no_report: bool,
    /// Rows of other engines on these scenes (CSV: scene, engine, method, step_s or dt, steps, error, error_kind,
    /// wall_s), of which the best are shown beside these, as `benches/peers/` makes them
    #[arg(long, value_name = "FILE.csv")]
    with: Vec<PathBuf>,
    #[command(flatten)]
    experiment: ExperimentArgs,
    /// How progress is told, on stderr [default: a bar on a terminal]
    #[arg(long, value_enum, value_name = "HOW", default_value_t, hide_default_value = true)]
    progress: ProgressFlag,
    #[command(flatten)]
    output: OutputArgs,
}

/// A file whose trials have all been checked.
struct PlannedBench {
    config: Config,
    file: ExperimentFile,
    bench: Bench,
    trials: Vec<Contender>,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        // Every trial of every file is checked before the first run.
        let planned = self.planned()?;
        let others = self.others()?;
        let beside: Vec<Vec<Trial>> =
            planned.iter().map(|planned| beside(planned, &others)).collect::<Result<_, CliError>>()?;
        let (mut all, mut seen, mut has_failed) = (Vec::new(), Vec::new(), false);
        for (planned, beside) in planned.iter().zip(&beside) {
            let dir = planned.config.out(self.out.as_deref(), &self.experiment);
            self.make_references(&planned.trials, &dir)?;
            let (rows, seen_here): (Vec<Trial>, Vec<Seen>) = self.on_one_core(planned, &dir)?.into_iter().unzip();
            let documents: Vec<Value> = rows.iter().zip(&seen_here).map(document).collect();
            write(&dir, &title(planned), planned.file.written(), (&rows, beside), &documents)?;
            let page = if self.no_report { None } else { write_report(&dir) };
            if !self.output.json {
                print(shown(&planned.config.path, (&rows, beside), &dir, page.as_deref()));
            }
            has_failed |= rows.iter().any(|row| row.outcome == "failed");
            all.extend(documents);
            seen.extend(seen_here);
        }
        if self.output.json {
            print_json(&all);
        }
        Remarks::about(&seen, &[]).say(self.output.quiet);
        Ok(ExitCode::from(u8::from(has_failed)))
    }

    fn planned(&self) -> Result<Vec<PlannedBench>, CliError> {
        let given = self.config.display();
        let mut planned = Vec::new();
        let mut configs = configs(std::slice::from_ref(&self.config))?;
        tell_apart(&mut configs.iter_mut().collect::<Vec<_>>(), self.out.as_deref(), &self.experiment)?;
        for config in configs {
            let file = self.experiment.load(&config.path)?;
            match file.bench().cloned() {
                Some(bench) => {
                    let trials = bench::plan(&file, &bench)?;
                    planned.push(PlannedBench { config, file, bench, trials });
                }
                None if config.is_of_folder => {}
                None => return Err(CliError::Input(format!("{given}: bench: missing: nothing to compare"))),
            }
        }
        if planned.is_empty() {
            return Err(CliError::Input(format!("{given}: no file in it has a `bench:`")));
        }
        Ok(planned)
    }

    /// Rows of all files of other engines.
    fn others(&self) -> Result<Vec<Trial>, CliError> {
        let mut all = Vec::new();
        for path in &self.with {
            all.extend(others_of(path)?.into_iter().filter(|row| row.point().is_some()));
        }
        Ok(all)
    }

    fn make_references(&self, trials: &[Contender], dir: &Path) -> Result<(), CliError> {
        if trials.iter().any(|trial| trial.experiment.reference.is_some()) {
            let bar = Bar::new(&self.config, self.output, self.progress);
            bar.begin("references", 1);
            for Contender { experiment, model, start, .. } in trials {
                reference::of(dir, experiment, model, start)?;
            }
            bar.end();
        }
        Ok(())
    }

    /// Rows of all trials of a file, made on a thread that stays on one core.
    fn on_one_core(&self, planned: &PlannedBench, dir: &Path) -> Result<Vec<(Trial, Seen)>, CliError> {
        let work = || {
            if !timing::pin() && !self.output.quiet {
                say("gotai: this system does not let a thread stay on one core: times may scatter more");
            }
            let scene = planned.config.path.with_extension("").display().to_string();
            let bar = Bar::new(&planned.config.path, self.output, self.progress);
            bar.begin("trials", planned.trials.len());
            let rows = planned.trials.iter().map(|trial| {
                let ran = bench::run(trial, &planned.bench, &scene, Some(dir));
                bar.one_done();
                ran.map(|Ran { row, measured }| (row, Seen::of(&measured, &trial.experiment)))
            });
            let rows = rows.collect::<Result<Vec<_>, _>>();
            bar.end();
            rows.map_err(|error| CliError::Machine(error.to_string()))
        };
        if self.output.verbose {
            let path = planned.config.path.display();
            say(format!("{path}: {} trials, each at least {} times", planned.trials.len(), planned.bench.repeats));
        }
        std::thread::scope(|scope| scope.spawn(work).join())
            .unwrap_or_else(|_| Err(CliError::Machine("the thread of the bench has failed".into())))
    }
}

/// Best rows of every other engine on the scene of a file: rows belong to it by its name, where `-` and `_` are alike.
fn beside(planned: &PlannedBench, others: &[Trial]) -> Result<Vec<Trial>, CliError> {
    if others.is_empty() {
        return Ok(Vec::new());
    }
    let name = |path: &str| path.rsplit('/').next().unwrap_or_default().replace('_', "-");
    let own = name(&planned.config.path.with_extension("").display().to_string());
    let of_scene: Vec<Trial> = others.iter().filter(|row| name(&row.scene) == own).cloned().collect();
    let path = planned.config.path.display();
    if of_scene.is_empty() && planned.config.is_of_folder {
        return Ok(Vec::new());
    }
    if of_scene.is_empty() {
        let known: BTreeSet<&str> = others.iter().map(|row| row.scene.as_str()).collect();
        let known: Vec<&str> = known.into_iter().collect();
        return Err(CliError::Input(format!("{path}: --with has no rows of this scene; it has {}", known.join(", "))));
    }
    // A scene may have several kinds of error; those of the same unit can be compared.
    let unit = unit_of(&planned.bench.error);
    let alike: Vec<Trial> = of_scene.iter().filter(|row| unit_of(&row.error_kind) == unit).cloned().collect();
    if alike.is_empty() {
        let found = &of_scene[0].error_kind;
        return Err(CliError::Input(format!(
            "{path}: --with has errors in another unit (`{found}`) than `{}`",
            planned.bench.error
        )));
    }
    Ok(best_of_each_engine(&alike))
}

/// JSON of a row, with the remarks about its run, if there are some.
fn document((row, seen): (&Trial, &Seen)) -> Value {
    let mut document = serde_json::to_value(row).unwrap_or_default();
    if seen.is_doubtful() {
        Remarks::about([seen], &[]).put_into(&mut document);
    }
    document
}

/// Title of the diagram: the question, else the file's name.
fn title(planned: &PlannedBench) -> String {
    let question = planned.trials.iter().find_map(|trial| trial.experiment.question.clone());
    question.unwrap_or_else(|| planned.file.path().display().to_string())
}

/// Writes `bench.json`, which has the remarks too, `.csv`, `.svg` and `.png`, and what they are of.
fn write(
    dir: &Path,
    title: &str,
    experiment: String,
    (rows, beside): (&[Trial], &[Trial]),
    documents: &[Value],
) -> Result<(), CliError> {
    // Another engine's best rows are of several of its methods: one line.
    let of_engine = |row: &Trial| Trial { method: String::new(), ..row.clone() };
    let drawn = rows.iter().cloned().chain(beside.iter().map(of_engine)).collect();
    let subject = Subject { trials: drawn, ..Subject::default() };
    let figure = pareto::figure(title, &tried::trials(&Ground::of(&subject)), &subject.magnitudes);
    let failed = |error: &dyn std::fmt::Display| CliError::Machine(format!("{}: {error}", dir.display()));
    let mut json = serde_json::to_vec(documents).map_err(|error| failed(&error))?;
    json.push(b'\n');
    let files = [
        (OF_BENCH, experiment.into_bytes()),
        ("bench.json", json),
        ("bench.csv", to_csv(rows).map_err(|error| failed(&error))?),
        ("bench.svg", figure.svg().into_bytes()),
        ("bench.png", figure.png().map_err(|error| failed(&error))?),
    ];
    make_folder(dir)?;
    files.iter().try_for_each(|(name, content)| std::fs::write(dir.join(name), content)).map_err(|error| failed(&error))
}

/// Writes report.html; what fails is a warning.
fn write_report(dir: &Path) -> Option<PathBuf> {
    match Reported::of_folder(dir, Known::default()) {
        Ok(reported) => write_beside(&reported),
        Err(error) => {
            say(format!("warning: no report is written: {error}"));
            None
        }
    }
}

fn shown(config: &Path, (rows, beside): (&[Trial], &[Trial]), dir: &Path, page: Option<&Path>) -> String {
    let head = format!("{}: {} rows; ◆ is on the Pareto front", config.display(), rows.len());
    let mut text = format!("{head}\n{}\n", bench_table(rows, beside, width().into()));
    text += &format!("diagram: {}", dir.join("bench.svg").display());
    if let Some(page) = page {
        text += &format!("\nreport: {}", page.display());
    }
    text
}

//! `gotai run`: one experiment, its recordings, a summary; or a row of a results folder once more.

use super::args::{ExperimentArgs, OutputArgs, RunArgs};
use super::error::CliError;
use super::ghosts::Ghosts;
use super::interrupted;
use super::live;
use super::output::{print, print_json, say};
use super::progress::Bar;
use super::remarks::{Remarks, Seen, table_of};
use super::replay::replay;
use super::shown::{describe_plan, document, say_where, summary, to_open};
use super::sweeping::{SweepArgs, Swept, refuse_unknown_names};
use crate::experiment::ExperimentFile;
use crate::experiment::types::RecordTo;
use crate::files::quoted;
use crate::outcome::Outcome;
use crate::plan::Plan;
use crate::record::read::experiment_of;
use crate::record::schema::text;
use crate::record::writer::Target;
use crate::study::{Place, Recording, reference};
use crate::sweep::build::build;
use crate::sweep::folder::Folder;
use crate::sweep::plan::SweepPlan;
use crate::sweep::runner::{Progress, run_one};
use crate::sweep::store::Store;
use clap::Args;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// An experiment file (YAML), or a recording (.mcap), which holds its own; with --case a folder of results
    config: PathBuf,
    /// Run this row of a folder of results again, recorded at every step: the first digits of its id
    #[arg(long, value_name = "ID")]
    case: Option<String>,
    #[command(flatten)]
    experiment: ExperimentArgs,
    #[command(flatten)]
    run: RunArgs,
    #[command(flatten)]
    output: OutputArgs,
    /// Show the run in a Rerun Viewer on this machine while it goes on: in one that listens, or a new one
    #[arg(long, value_name = "PORT", num_args = 0..=1, require_equals = true, default_missing_value = "9876")]
    live: Option<u16>,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        match &self.case {
            Some(id) => {
                self.refuse_beside_case()?;
                replay(&self.config, id, &self.run, self.output, self.live)
            }
            None => self.run_experiment(),
        }
    }

    /// A row is run again as it was.
    fn refuse_beside_case(&self) -> Result<(), CliError> {
        let given = [("--set or --axis", !self.experiment.is_empty()), ("--out", self.run.out.is_some())];
        match given.iter().find(|(_, is_given)| *is_given) {
            None => Ok(()),
            Some((flag, _)) => Err(CliError::Input(format!(
                "{flag}: --case runs a row again as it was, into its folder's replays/; expected no {flag} beside it"
            ))),
        }
    }

    fn run_experiment(&self) -> Result<ExitCode, CliError> {
        if let Some(axis) = self.experiment.first_axis() {
            if self.live.is_some() {
                return Err(CliError::Input(format!("--live: expected one run, found the axis {axis}")));
            }
            return self.run_together(axis);
        }
        let file = self.load()?;
        let plan = SweepPlan::single(&file)?;
        refuse_unknown_names(&self.config, &file, &plan, &self.experiment)?;
        let planned = &plan.cases[0];
        let case = &planned.case;
        let targets = self.run.targets(case.experiment.record.to)?;
        let dir = self.run.out.clone().unwrap_or_else(|| self.experiment.default_out(&self.config));
        let (model, start) = build(&file, &planned.point, &case.experiment)?;
        let mut store = Store::open(&dir, &plan, false)?;
        if let Some(edited) = store.edited().filter(|_| !self.output.quiet) {
            say(format!("{}: {edited}", dir.display()));
        }
        if self.output.verbose {
            describe_plan(&Plan::new(&model, &case.experiment.method));
        }
        if case.experiment.reference.is_some() {
            let bar = Bar::new(&self.config, self.output, self.run.progress);
            bar.begin("references", 1);
            reference::of(&dir, &case.experiment, &model, &start)?;
            bar.end();
        }
        let live = self.live.and_then(|port| live::viewer(port, self.output.quiet));
        let recording = Recording { dir: &dir, targets: &targets, case, name: &planned.name, live };
        let recording = (!targets.is_empty() || live.is_some()).then_some(recording);
        interrupted::listen()?;
        let place = Place { references: Some(&dir), recording };
        let (ended, kept) = run_one(case, &model, start, &place, &mut store);
        let name = planned.name.ended(ended.measured.outcome);
        let remarks = Remarks::about(&[Seen::of(&ended.measured, &case.experiment)], &[table_of(&dir)]);
        let kept = kept.map_err(CliError::from);
        if self.output.json {
            let recording = (!targets.is_empty() && kept.is_ok()).then_some(name.as_str());
            let mut document = document(case, recording, &model, &ended, &remarks);
            if let Err(error) = &kept {
                error.put_into(&mut document);
            }
            print_json(&document);
        } else {
            print(summary(&case.id, &ended.measured));
        }
        remarks.say(self.output.quiet);
        kept?;
        if !self.output.quiet {
            say_where(&dir, &name, &targets);
            live.iter().for_each(|port| live::say_if_gone(*port));
        }
        if let Some(code) = interrupted::code(ended.state.time_s) {
            return Ok(code);
        }
        Ok(ExitCode::from(u8::from(ended.measured.outcome == Outcome::Failed)))
    }

    /// Runs the few cases of the axes on the command line, and writes one recording of all.
    fn run_together(&self, axis: &str) -> Result<ExitCode, CliError> {
        let file = self.load()?;
        let cases = file.axes().len();
        if cases > Ghosts::MOST || file.search().is_some() {
            return Err(CliError::Input(format!(
                "--axis {axis}: expected at most {} cases, which are shown together, found {cases}; `gotai sweep` runs \
                 any number",
                Ghosts::MOST
            )));
        }
        let record = self.run.targets(file.case(&file.axes().point(0))?.record.to)?;
        let sweep = SweepArgs::for_run(self.experiment.clone(), self.run.clone(), self.output);
        let pool = self.run.pool()?;
        // One recording of all is made of those of the cases.
        let together = record.contains(&Target::Rerun);
        let to = if record.is_empty() { RecordTo::None } else { RecordTo::Mcap };
        let planned = pool.install(|| sweep.planned_into(self.config.clone(), file, to))?;
        let swept = pool.install(|| sweep.sweep(&planned))?;
        let recordings = swept.rows.iter().filter_map(|row| row.recording.as_deref());
        let files: Vec<PathBuf> = recordings.map(|name| Target::Mcap.path(&swept.dir, name)).collect();
        let shown = match together && !files.is_empty() {
            true => Some(Ghosts::of_files(&files)?.write(&swept.dir)?),
            false => None,
        };
        if self.output.json {
            let name = shown.as_deref().and_then(Path::file_stem).map(|name| name.to_string_lossy().into_owned());
            let mut document = json!({ "dir": swept.dir, "rows": swept.rows, "recording": name });
            Swept::remarks(&[&swept]).put_into(&mut document);
            print_json(&document);
        } else {
            for row in &swept.rows {
                let axes: Vec<_> = row.axes.iter().map(|(path, value)| format!("{path} = {}", text(value))).collect();
                print(format!("{}\n{}", axes.join(", "), summary(&row.case, &row.measured)));
            }
        }
        Swept::remarks(&[&swept]).say(self.output.quiet);
        if let Some(path) = shown.filter(|_| !self.output.quiet) {
            say(to_open(&path));
        }
        Ok(ExitCode::from(u8::from(swept.failed() > 0)))
    }

    fn load(&self) -> Result<ExperimentFile, CliError> {
        let path = self.config.display();
        let [word, kept] =
            [self.config.display().to_string(), format!("{path}/experiment.yaml")].map(|word| quoted(&word));
        if Folder::is_one(&self.config) {
            return Err(CliError::Input(format!(
                "{path}: expected an experiment file, found a folder of results; run one of its rows again with \
                 --case ID (`gotai rows {word}` shows them), go on with all of them with `gotai sweep \
                 {kept} --out {word}`"
            )));
        }
        if self.config.is_dir() {
            return Err(CliError::Input(format!(
                "{path}: expected an experiment file, found a folder; run all experiments in it with `gotai sweep \
                 {word}`"
            )));
        }
        if self.config.extension().is_some_and(|ending| ending == "rrd") {
            return Err(CliError::Input(format!(
                "{path}: expected an experiment file or an .mcap, found an .rrd; the .mcap beside it holds the \
                 configuration for programs"
            )));
        }
        let is_recording = self.config.extension().is_some_and(|ending| ending == "mcap") && self.config.exists();
        if !is_recording {
            return self.experiment.load(&self.config);
        }
        match experiment_of(&self.config)? {
            Some(text) => self.experiment.read(&self.config, &text),
            None => Err(CliError::Input(format!("{path}: expected a recording of gotai, found no experiment in it"))),
        }
    }
}

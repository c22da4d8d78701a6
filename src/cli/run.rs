//! `gotai run`: one experiment, its recordings, a summary; or a row of a results folder once more.

use super::args::{ExperimentArgs, OutputArgs, RunArgs};
use super::error::CliError;
use super::output::{print, print_json};
use super::progress::Bar;
use super::remarks::{Remarks, Seen, table_of};
use super::replay::replay;
use super::shown::{describe_plan, document, say_where, summary};
use crate::experiment::ExperimentFile;
use crate::outcome::Outcome;
use crate::plan::Plan;
use crate::record::read::experiment_of;
use crate::rows::cells;
use crate::study::{Place, reference};
use crate::sweep::build::build;
use crate::sweep::folder::Folder;
use crate::sweep::plan::SweepPlan;
use crate::sweep::runner::{Progress, run_one};
use crate::sweep::store::Store;
use clap::Args;
use std::path::PathBuf;
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
                replay(&self.config, id, &self.run, self.output)
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
        self.experiment.refuse_axes()?;
        let file = self.load()?;
        let plan = SweepPlan::single(&file)?;
        let planned = &plan.cases[0];
        let case = &planned.case;
        let targets = self.run.targets(case.experiment.record.to)?;
        let dir = self.run.out.clone().unwrap_or_else(|| self.experiment.default_out(&self.config));
        let (model, start) = build(&file, &planned.point, &case.experiment)?;
        let mut store = Store::open(&dir, &plan, false)?;
        if let Some(edited) = store.edited().filter(|_| !self.output.quiet) {
            eprintln!("{}: {edited}", dir.display());
        }
        if self.output.verbose {
            describe_plan(&Plan::new(&model, &case.experiment.method));
        }
        if case.experiment.reference.is_some() {
            let bar = Bar::new(self.output.quiet);
            bar.begin("references", 1);
            reference::of(&dir, &case.experiment, &model, &start)?;
            bar.end();
        }
        let place = Place { references: Some(&dir), recording: planned.recording(&dir, &targets) };
        let (ended, kept) = run_one(case, &model, start, &place, &mut store);
        let name = planned.name.ended(ended.measured.outcome);
        let remarks = Remarks::about(&[Seen::of(&cells(&ended.measured), &case.experiment)], &[table_of(&dir)]);
        if self.output.json {
            let recording = (!targets.is_empty() && kept.is_ok()).then_some(name.as_str());
            print_json(&document(case, recording, &model, &ended, &remarks));
        } else {
            print(summary(&case.id, &ended.measured));
        }
        remarks.say(self.output.quiet);
        kept?;
        if !self.output.quiet {
            say_where(&dir, &name, &targets);
        }
        Ok(ExitCode::from(u8::from(ended.measured.outcome == Outcome::Failed)))
    }

    fn load(&self) -> Result<ExperimentFile, CliError> {
        let path = self.config.display();
        if Folder::is_one(&self.config) {
            return Err(CliError::Input(format!(
                "{path}: expected an experiment file, found a folder of results; run one of its rows again with \
                 --case ID (`gotai rows {path}` shows them), go on with all of them with `gotai sweep \
                 {path}/experiment.yaml --out {path}`"
            )));
        }
        if self.config.is_dir() {
            return Err(CliError::Input(format!(
                "{path}: expected an experiment file, found a folder; run all experiments in it with `gotai sweep \
                 {path}`"
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

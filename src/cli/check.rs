//! `gotai check`: runs experiments and judges their `expect:`. The command of a CI.

use super::checked::Checked;
use super::error::CliError;
use super::junit;
use super::output::{print, print_json};
use super::remarks::Remarks;
use super::sweeping::{Config, PlannedSweep, SweepArgs, Swept, configs};
use super::table::table;
use crate::check::{Schema, cells_of, judge, one_sided, refuse_unknown};
use crate::experiment::types::RecordTo;
use crate::measure::more;
use crate::rows::columns::{self, SEARCH};
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// Experiment files (YAML), or folders of them; in a folder, files without `expect:` are left out
    #[arg(required = true)]
    configs: Vec<PathBuf>,
    /// Write the verdicts as a JUnit file too
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    #[command(flatten)]
    sweep: SweepArgs,
}

impl Command {
    /// Runs the command; the exit code is that of the program.
    ///
    /// # Errors
    /// The input is wrong, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let pool = self.sweep.run.pool()?;
        // Every case and every expectation of every file is checked before the first run.
        let planned = pool.install(|| self.planned())?;
        let mut checked = Vec::with_capacity(planned.len());
        for (planned, schema) in &planned {
            let swept = pool.install(|| self.sweep.sweep(planned))?;
            let rows = cells_of(&swept.rows);
            let judged = planned.file.expect().iter().map(|expectation| judge(expectation, schema, &rows)).collect();
            checked.push(Checked { swept, judged });
            if !self.sweep.output.json {
                print(checked.last().map(shown).unwrap_or_default());
            }
        }
        let remarks = remarks(&planned, &checked);
        match self.sweep.output.json {
            true => print_json(&document(&checked, &remarks)),
            false => print(summary(&checked)),
        }
        remarks.say(self.sweep.output.quiet);
        if let Some(path) = &self.junit {
            junit::write(path, &checked)?;
        }
        Ok(ExitCode::from(u8::from(!checked.iter().all(Checked::is_met))))
    }

    fn planned(&self) -> Result<Vec<(PlannedSweep, Schema)>, CliError> {
        let mut planned = Vec::new();
        for config in configs(&self.configs)? {
            planned.extend(self.plan_one(config)?);
        }
        if planned.is_empty() {
            let given: Vec<_> = self.configs.iter().map(|path| path.display().to_string()).collect();
            return Err(CliError::Input(format!("{}: no file in it has an `expect:`", given.join(", "))));
        }
        Ok(planned)
    }

    fn plan_one(&self, config: Config) -> Result<Option<(PlannedSweep, Schema)>, CliError> {
        let file = self.sweep.load(&config)?;
        if file.expect().is_empty() {
            let path = config.path.display();
            return match config.is_of_folder {
                true => Ok(None),
                false => Err(CliError::Input(format!("{path}: expect: missing: nothing to check"))),
            };
        }
        // Verdicts need rows alone; `--record` asks for more.
        let planned = self.sweep.planned(config, file, Some(RecordTo::None))?;
        let schema = schema(&planned);
        let file = &planned.file;
        refuse_unknown(&schema, file.expect(), file.search()).map_err(|error| file.placed(error))?;
        Ok(Some((planned, schema)))
    }
}

/// The columns that the rows of a plan have.
fn schema(planned: &PlannedSweep) -> Schema {
    let mut names: Vec<String> = Vec::new();
    for name in planned.plan.cases.iter().flat_map(|planned| more::names(&planned.case.experiment)) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let search = planned.file.search();
    names.extend(search.iter().flat_map(|_| columns::names(&SEARCH)));
    Schema::new(planned.file.axes(), search.and_then(|search| search.over), &names)
}

/// Remarks about bounds that pass what they seem to guard against, and about the cases.
fn remarks(planned: &[(PlannedSweep, Schema)], checked: &[Checked]) -> Remarks {
    let mut remarks = Swept::remarks(&checked.iter().map(|checked| &checked.swept).collect::<Vec<_>>());
    let found = planned.iter().flat_map(|(PlannedSweep { file, .. }, _)| {
        one_sided(file.expect()).into_iter().map(|found| {
            let place = file.place(found.at.clone());
            (found, place)
        })
    });
    remarks.warn_of_one_sided(&found.collect::<Vec<_>>());
    remarks
}

fn verdict(met: bool) -> &'static str {
    if met { "met" } else { "NOT MET" }
}

/// The table of one experiment.
fn shown(checked: &Checked) -> String {
    let mut table = table(&["verdict", "expectation", "bound", "measured", "why"]);
    for judged in &checked.judged {
        let why = judged.why.clone().unwrap_or_default();
        let cells = [&judged.expectation, &judged.bound, &judged.measured, &why];
        table.add_row([verdict(judged.met)].into_iter().chain(cells.map(String::as_str)));
    }
    let Swept { planned, ran, .. } = checked.swept;
    let failed = match checked.swept.failed() {
        0 => String::new(),
        n => format!(", {n} FAILED (criterion in {})", checked.swept.dir.join("rows.csv").display()),
    };
    format!("{}: {planned} cases, {ran} run now{failed}\n{table}\n", checked.name())
}

fn summary(checked: &[Checked]) -> String {
    let all = checked.iter().map(|checked| checked.judged.len()).sum::<usize>();
    let met = checked.iter().flat_map(|checked| &checked.judged).filter(|judged| judged.met).count();
    let failed: usize = checked.iter().map(|checked| checked.swept.failed()).sum();
    let mut text = format!("{met} of {all} expectations met in {} experiments", checked.len());
    if failed > 0 {
        text += &format!("; {failed} cases failed");
    }
    text
}

fn document(checked: &[Checked], remarks: &Remarks) -> Value {
    let verdicts = checked.iter().flat_map(|checked| checked.judged.iter().map(move |judged| (checked, judged)));
    let expectations: Vec<Value> = verdicts
        .map(|(checked, judged)| {
            json!({
                "experiment": checked.name(), "expectation": judged.expectation, "bound": judged.bound,
                "measured": judged.measured, "verdict": if judged.met { "met" } else { "not met" },
                "met": judged.met, "why": judged.why, "rows": judged.rows,
            })
        })
        .collect();
    let experiments: Vec<Value> = checked
        .iter()
        .map(|c| {
            json!({
                "experiment": c.name(), "dir": c.swept.dir, "cases": c.swept.planned, "ran": c.swept.ran,
                "failed": c.swept.failed(), "met": c.is_met(),
            })
        })
        .collect();
    let met = checked.iter().all(Checked::is_met);
    let mut document = json!({ "met": met, "expectations": expectations, "experiments": experiments });
    remarks.put_into(&mut document);
    document
}

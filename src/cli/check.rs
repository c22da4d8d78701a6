//! `gotai check`: runs experiments and judges their `expect:`. The command of a CI.

use super::checked::{Checked, NamedCase, Report, Unchecked};
use super::error::CliError;
use super::junit;
use super::output::{Hue, counted, print, print_json, width, wrapped};
use super::remarks::Remarks;
use super::sweeping::{Config, PlannedSweep, SweepArgs, Swept, configs_of_each};
use super::table::table;
use crate::check::{Failing, Judged, one_sided};
use crate::experiment::ExperimentFile;
use crate::experiment::error::Kind;
use crate::experiment::types::RecordTo;
use crate::sweep::plan::SweepPlan;
use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// Experiment files (YAML), or folders of them; in a folder, files without `expect:` are left out and counted
    #[arg(required = true)]
    configs: Vec<PathBuf>,
    /// Write the verdicts as a JUnit file too
    #[arg(long, value_name = "FILE")]
    junit: Option<PathBuf>,
    #[command(flatten)]
    sweep: SweepArgs,
}

/// Most cases that an expectation names on the screen; -v shows those that JSON has.
const SHOWN: usize = 6;

impl Command {
    /// Runs the command; the exit code is that of the program: of several files the largest.
    ///
    /// # Errors
    /// There is nothing to check, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let pool = self.sweep.run.pool()?;
        // Every case and every expectation of every file is checked before the first run.
        let mut report = Report::default();
        let (planned, unchecked) = pool.install(|| self.planned(&mut report.without_expect));
        unchecked.into_iter().for_each(|unchecked| report.cannot_check(unchecked));
        for planned in &planned {
            if self.sweep.fail_fast && report.code() > 0 {
                report.skipped.push(planned.config.path.display().to_string());
                continue;
            }
            match pool.install(|| self.sweep.sweep(planned)) {
                Err(error) => report.cannot_check(Unchecked { path: planned.config.path.clone(), error }),
                Ok(swept) => {
                    let checked = Checked::new(swept);
                    self.show(&checked);
                    report.checked.push(checked);
                }
            }
        }
        let remarks = remarks(&planned, &report.checked);
        match self.sweep.output.json {
            true => print_json(&document(&report, &remarks)),
            false if planned.is_empty() || (self.sweep.output.quiet && report.code() == 0) => {}
            false => print(summary(&report)),
        }
        remarks.say(self.sweep.output.quiet);
        if let Some(path) = &self.junit {
            junit::write(path, &report)?;
        }
        Ok(ExitCode::from(report.code()))
    }

    /// Sweeps of all files with something to check, and the files that are wrong; those of folders without `expect:`
    /// are put beside.
    fn planned(&self, without: &mut Vec<PathBuf>) -> (Vec<PlannedSweep>, Vec<Unchecked>) {
        let (mut planned, mut unchecked) = (Vec::new(), Vec::new());
        let mut configs = configs_of_each(&self.configs);
        let mut found: Vec<&mut Config> = configs.iter_mut().flatten().collect();
        if let Err(error) = self.sweep.tell_apart(&mut found) {
            unchecked.push(Unchecked { path: self.configs.first().cloned().unwrap_or_default(), error });
            return (planned, unchecked);
        }
        for config in configs {
            let path = config.as_ref().map_or_else(|(path, _)| path.clone(), |config| config.path.clone());
            match config.map_err(|(_, error)| error).and_then(|config| self.plan_one(config)) {
                Ok(Some(found)) => planned.push(found),
                Ok(None) => without.push(path),
                Err(error) => unchecked.push(Unchecked { path, error }),
            }
        }
        if planned.is_empty() && unchecked.is_empty() {
            let given: Vec<_> = self.configs.iter().map(|path| path.display().to_string()).collect();
            let error = CliError::Input(format!("{}: no file in it has an `expect:`", given.join(", ")));
            unchecked.push(Unchecked { path: self.configs.first().cloned().unwrap_or_default(), error });
        }
        (planned, unchecked)
    }

    fn plan_one(&self, config: Config) -> Result<Option<PlannedSweep>, CliError> {
        let file = self.sweep.load(&config)?;
        if file.expect().is_empty() {
            refuse_wrong(&file)?;
            let path = config.path.display();
            return match config.is_of_folder {
                true => Ok(None),
                false => Err(CliError::Input(format!("{path}: expect: missing: nothing to check"))),
            };
        }
        // Verdicts need rows alone; `--record` asks for more.
        self.sweep.planned(config, file, Some(RecordTo::None))?.judging().map(Some)
    }

    /// Prints a file's line, and what is not met.
    fn show(&self, checked: &Checked) {
        let output = self.sweep.output;
        if output.json || (output.quiet && checked.is_met()) {
            return;
        }
        let page = Page { width: width().into(), is_colored: output.is_colored(), most: SHOWN };
        print(page.line(checked));
        if output.verbose {
            print(verdicts(checked));
        }
        let page = Page { most: if output.verbose { usize::MAX } else { SHOWN }, ..page };
        checked.judged().iter().filter(|judged| !judged.met).for_each(|judged| print(page.unmet(checked, judged)));
        if checked.swept.failed() > 0 {
            print(page.broken(checked));
        }
    }
}

/// Refuses a file without `expect:` that is wrong, as a slip in that word makes it; what others extend may lack what
/// they bring.
fn refuse_wrong(file: &ExperimentFile) -> Result<(), CliError> {
    match SweepPlan::unbuilt(file, "") {
        Err(error) if error.details().kind != Kind::Missing => Err(error.into()),
        _ => Ok(()),
    }
}

/// Remarks about bounds that pass what they seem to guard against, and about the cases.
fn remarks(planned: &[PlannedSweep], checked: &[Checked]) -> Remarks {
    let mut remarks = Swept::remarks(&checked.iter().map(|checked| &checked.swept).collect::<Vec<_>>());
    let found = planned.iter().flat_map(|PlannedSweep { file, .. }| {
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

/// The table of all verdicts of one experiment.
fn verdicts(checked: &Checked) -> String {
    let mut table = table(&["verdict", "expectation", "bound", "measured", "why"]);
    for judged in checked.judged() {
        let why = judged.why.clone().unwrap_or_default();
        let cells = [&judged.expectation, &judged.bound, &judged.measured, &why];
        table.add_row([verdict(judged.met)].into_iter().chain(cells.map(String::as_str)));
    }
    format!("{table}\n")
}

/// Paper that lines are printed on.
struct Page {
    width: usize,
    is_colored: bool,
    /// Most cases of an expectation.
    most: usize,
}

impl Page {
    /// One line: the verdict, the file, how much was run.
    fn line(&self, checked: &Checked) -> String {
        let Swept { planned, ran, took, .. } = checked.swept;
        let all = checked.judged().len();
        let unmet = checked.judged().iter().filter(|judged| !judged.met).count();
        let mut said = match unmet {
            0 => format!("{all} met"),
            n => format!("{n} of {all} not met"),
        };
        match checked.swept.failed() {
            0 => {}
            n => said += &format!(", {n} FAILED"),
        }
        let hue = if checked.is_met() { Hue::Good } else { Hue::Bad };
        let verdict = hue.paint(&format!("{:7}", verdict(checked.is_met())), self.is_colored);
        let took = took.as_secs_f64();
        format!("{verdict}  {}: {}, {ran} run now, {took:.1} s: {said}", checked.name(), counted(planned, "case"))
    }

    fn unmet(&self, checked: &Checked, judged: &Judged) -> String {
        let Judged { expectation, bound, measured, why, failing, .. } = judged;
        let mut lines = vec![wrapped(expectation, self.width, "  ", "    ")];
        lines.push(wrapped(&format!("expected {bound}, measured {measured}"), self.width, "    ", "    "));
        if let Some(why) = why {
            lines.push(wrapped(&format!("why: {why}"), self.width, "    ", "    "));
        }
        lines.extend(self.cases(checked, failing));
        lines.join("\n")
    }

    fn broken(&self, checked: &Checked) -> String {
        let said = format!("  {} FAILED: a fault of the program", counted(checked.swept.failed(), "case"));
        let cases = self.cases(checked, &checked.swept.broken);
        [vec![Hue::Bad.paint(&said, self.is_colored)], cases].concat().join("\n")
    }

    fn cases(&self, checked: &Checked, failing: &[Failing]) -> Vec<String> {
        let shown = checked.cases(failing).into_iter().take(self.most);
        let mut lines: Vec<String> = shown.map(|case| self.case(&case)).collect();
        if failing.len() > lines.len() && !lines.is_empty() {
            lines.push(format!("    … and {} more", failing.len() - lines.len()));
        }
        lines
    }

    fn case(&self, case: &NamedCase) -> String {
        let NamedCase { id, place, measured, command, recordings, .. } = case;
        let place = if place.is_empty() { String::new() } else { format!(", at {place}") };
        let mut lines = vec![wrapped(&format!("{measured}{place}"), self.width, &format!("    {id}  "), "      ")];
        // What is copied to a shell is in one line, however long.
        lines.push(format!("      {}", Hue::Faint.paint(command, self.is_colored)));
        lines.extend(recordings.iter().map(|file| format!("      {}", file.display())));
        lines.join("\n")
    }
}

fn summary(report: &Report) -> String {
    let Report { checked, unchecked, without_expect, skipped } = report;
    let all = checked.iter().map(|checked| checked.judged().len()).sum::<usize>();
    let met = checked.iter().flat_map(Checked::judged).filter(|judged| judged.met).count();
    let failed: usize = checked.iter().map(|checked| checked.swept.failed()).sum();
    let mut text = format!("{met} of {all} expectations met in {}", counted(checked.len(), "experiment"));
    for (count, thing, said) in [
        (failed, "case", "failed"),
        (unchecked.len(), "file", "could not be checked"),
        (without_expect.len(), "file", "without `expect:` left out"),
        (skipped.len(), "file", "left out (--fail-fast)"),
    ] {
        if count > 0 {
            text += &format!("; {} {said}", counted(count, thing));
        }
    }
    text
}

fn document(report: &Report, remarks: &Remarks) -> Value {
    let Report { checked, unchecked, without_expect, skipped } = report;
    let verdicts = checked.iter().flat_map(|checked| checked.judged().iter().map(move |judged| (checked, judged)));
    let cases =
        |checked: &Checked, failing| -> Vec<Value> { checked.cases(failing).iter().map(NamedCase::document).collect() };
    let expectations: Vec<Value> = verdicts
        .map(|(checked, judged)| {
            json!({
                "experiment": checked.name(), "expectation": judged.expectation, "bound": judged.bound,
                "measured": judged.measured, "verdict": if judged.met { "met" } else { "not met" },
                "met": judged.met, "why": judged.why, "rows": judged.rows,
                "failing": cases(checked, &judged.failing), "failing_count": judged.failing.len(),
            })
        })
        .collect();
    let experiments: Vec<Value> = checked
        .iter()
        .map(|c| {
            json!({
                "experiment": c.name(), "dir": c.swept.dir, "cases": c.swept.planned, "ran": c.swept.ran,
                "failed": c.swept.failed(), "failed_cases": cases(c, &c.swept.broken), "met": c.is_met(),
                "took_s": c.swept.took.as_secs_f64(),
            })
        })
        .collect();
    let errors: Vec<Value> = unchecked
        .iter()
        .map(|u| json!({ "experiment": u.path, "error": u.error.to_string(), "exit_code": u.error.code() }))
        .collect();
    let mut document = json!({
        "met": report.code() == 0, "exit_code": report.code(), "expectations": expectations,
        "experiments": experiments, "errors": errors, "left_out": skipped, "without_expect": without_expect,
    });
    remarks.put_into(&mut document);
    document
}

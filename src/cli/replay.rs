//! `gotai run DIR --case ID`: a row of a results folder once more, bit for bit, recorded at every step.

use super::args::{OutputArgs, RunArgs};
use super::error::CliError;
use super::interrupted;
use super::live;
use super::output::{print, print_json, say};
use super::remarks::{Remarks, Seen};
use super::shown::{document, say_where, summary};
use crate::build_info::BUILD;
use crate::case::Case;
use crate::experiment::types::{Experiment, Record};
use crate::files::{self, FileError, make_folder};
use crate::outcome::Outcome;
use crate::rows::columns::is_beside_the_run;
use crate::rows::{Measured, cells};
use crate::study::{Place, Recording};
use crate::sweep::build::build;
use crate::sweep::folder::Folder;
use crate::sweep::journal::{Entry, open_alone};
use crate::sweep::planned::Planned;
use crate::sweep::runner::{SweepError, run_case};
use crate::sweep::unneeded::{LOCK, REPLAYS};
use serde_json::{Value, json};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// A column of the row that the replay has not met.
struct Differing {
    column: String,
    row: Value,
    replay: Value,
}

pub(super) fn replay(
    dir: &Path,
    id: &str,
    run: &RunArgs,
    output: OutputArgs,
    live: Option<u16>,
) -> Result<ExitCode, CliError> {
    let folder = Folder::read(dir)?;
    let found = find(&folder, id)?;
    let row = folder.journal.rows.get(&found.case.id);
    let planned = Planned { case: at_every_step(found, row)?, ..found.clone() };
    let targets = run.targets(planned.case.experiment.record.to)?;
    let (model, start) = build(&folder.file, &planned.point, &planned.case.experiment)?;
    let replays = dir.join(REPLAYS);
    let _alone = (!targets.is_empty()).then(|| Alone::with(&replays, &planned.case.id)).transpose()?;
    let live = live.and_then(|port| live::viewer(port, output.quiet));
    let recording = Recording { dir: &replays, targets: &targets, case: &planned.case, name: &planned.name, live };
    let recording = (!targets.is_empty() || live.is_some()).then_some(recording);
    interrupted::listen()?;
    let place = Place { references: Some(dir), recording };
    let (ended, written) = run_case(&planned.case, &model, start, &place);
    let differing = row.map_or(Vec::new(), |row| differing(&row.measured, &ended.measured));
    let name = planned.name.ended(ended.measured.outcome);
    let remarks = Remarks::about(&[Seen::of(&ended.measured, &planned.case.experiment)], &[]);
    if output.json {
        let recording = (!targets.is_empty() && written.is_ok()).then_some(name.as_str());
        let mut document = document(&planned.case, recording, &model, &ended, &remarks);
        document["row_build"] = json!(row.map(|row| &row.build));
        document["differing"] = differing.iter().map(|d| json!([d.column, d.row, d.replay])).collect();
        print_json(&document);
    } else {
        print(summary(&planned.case.id, &ended.measured));
        if !output.quiet {
            say(compared(row, &differing));
        }
    }
    remarks.say(output.quiet);
    written?;
    if !output.quiet {
        say_where(&replays, &name, &targets);
    }
    if let Some(code) = interrupted::code(ended.state.time_s) {
        return Ok(code);
    }
    let is_ours = row.is_some_and(|row| row.build == BUILD) && planned.case.experiment.limits.wall_s.is_none();
    if is_ours && !differing.is_empty() {
        return Err(SweepError::NotDeterministic(planned.case.id).into());
    }
    Ok(ExitCode::from(u8::from(ended.measured.outcome == Outcome::Failed)))
}

/// A file that is locked while a case is recorded, and gone after it.
struct Alone {
    path: PathBuf,
    _lock: File,
}

impl Alone {
    /// The lock of a case among the replays.
    ///
    /// # Errors
    /// Somebody else records this case at the same time, or the machine failed.
    fn with(replays: &Path, case: &str) -> Result<Self, FileError> {
        make_folder(replays)?;
        let path = replays.join(format!("{case}.{LOCK}"));
        Ok(Alone { _lock: open_alone(replays, &path)?, path })
    }
}

impl Drop for Alone {
    fn drop(&mut self) {
        // What is left is empty, and dropped by `clean`.
        let _ = files::remove(&self.path);
    }
}

/// The one case whose id begins with these digits; the name of its recording holds the id too.
fn find<'a>(folder: &'a Folder, given: &str) -> Result<&'a Planned, CliError> {
    let dir = folder.dir.display();
    let name = given.strip_suffix(".mcap").or(given.strip_suffix(".rrd")).unwrap_or(given);
    let id = &name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    let begins = |planned: &&Planned| !id.is_empty() && planned.case.id.starts_with(id.as_str());
    let mut found: Vec<&Planned> = folder.cases.iter().filter(begins).collect();
    found.dedup_by_key(|planned| &planned.case.id);
    match found[..] {
        [only] => Ok(only),
        [] if folder.journal.rows.keys().any(|case| !id.is_empty() && case.starts_with(id.as_str())) => {
            Err(CliError::Input(format!("--case {id}: this row is in the store of {dir}, but no longer in its plan")))
        }
        [] => Err(CliError::Input(format!(
            "--case {id}: expected the first digits of a row's id, found none that begins so (`gotai rows {dir}` shows \
             them)"
        ))),
        [first, second, ..] => Err(CliError::Input(format!(
            "--case {id}: expected enough digits for one row, found {} that begin so: {} and {}",
            found.len(),
            described(first),
            described(second)
        ))),
    }
}

fn described(planned: &Planned) -> String {
    let values: Vec<_> = planned.case.axes.iter().map(|(path, value)| format!("{path} = {value}")).collect();
    format!("{} ({})", planned.case.id, values.join(", "))
}

/// Case of a row with its recording at every step; of a search, that of its run at `search_low`.
fn at_every_step(found: &Planned, row: Option<&Entry>) -> Result<Case, CliError> {
    let experiment = match (&found.search, row) {
        (None, _) => found.case.experiment.clone(),
        (Some(cell), Some(row)) => cell.shown_by(&row.measured)?,
        (Some(_), None) => {
            return Err(CliError::Input(format!(
                "--case {}: this row of a search is not there yet; run its sweep first",
                found.case.id
            )));
        }
    };
    let record = Record { every_s: 0.0, ..experiment.record.clone() };
    Ok(Case { experiment: Experiment { record, ..experiment }, ..found.case.clone() })
}

/// Columns of what the run measured that the replay has not met; the columns of a search are of many runs.
fn differing(row: &Measured, replay: &Measured) -> Vec<Differing> {
    let row = cells(row);
    let found = cells(replay).into_iter().filter(|(column, _)| !is_beside_the_run(column));
    let differing = found.filter(|(column, value)| row.get(column) != Some(value));
    differing
        .map(|(column, replay)| Differing { row: row.get(&column).cloned().unwrap_or_default(), column, replay })
        .collect()
}

fn compared(row: Option<&Entry>, differing: &[Differing]) -> String {
    let Some(row) = row else { return "this case has no row yet".to_string() };
    let of = match row.build == BUILD {
        true => "the row".to_string(),
        false => format!("the row of another build ({}, this is {BUILD})", row.build),
    };
    if differing.is_empty() {
        return format!("the same as {of}, bit for bit");
    }
    let lines = differing.iter().map(|d| format!("\n  {}: {} there, {} here", d.column, d.row, d.replay));
    format!("not the same as {of}:{}", lines.collect::<String>())
}

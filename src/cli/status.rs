//! `gotai status`: how much of a sweep is done, and what its folder takes.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{megabytes, print, print_json};
use crate::build_info::BUILD;
use crate::outcome::Outcome;
use crate::rows::count;
use crate::rows::table::Table;
use crate::sweep::folder::Folder;
use crate::sweep::unneeded::Bytes;
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// A folder of results (it has plan.json)
    dir: PathBuf,
    /// Rows of another build count as done
    #[arg(long)]
    keep: bool,
    #[command(flatten)]
    output: OutputArgs,
}

impl Command {
    /// Prints how much is done; the exit code is 1 while a row is missing or has failed.
    ///
    /// # Errors
    /// The folder is none, or the machine failed.
    pub fn run(self) -> Result<ExitCode, CliError> {
        let mut folder = Folder::read(&self.dir)?;
        let bytes = Bytes::of(&folder)?;
        let other_build = folder.journal.rows.values().filter(|entry| entry.build != BUILD).count();
        if !self.keep {
            folder.journal.retain_build();
        }
        let rows = folder.rows();
        let (total, failed) = (folder.cases.len(), count(&rows, Outcome::Failed));
        let missing = total - rows.len();
        if self.output.json {
            print_json(&json!({
                "dir": self.dir, "question": folder.plan.question, "methods": methods(&folder), "cases": total,
                "done": rows.len(), "missing": missing, "failed": failed,
                "finished": count(&rows, Outcome::Finished), "diverged": count(&rows, Outcome::Diverged),
                "stalled": count(&rows, Outcome::Stalled), "of_another_build": other_build,
                "recordings": rows.iter().filter(|row| row.recording.is_some()).count(), "bytes": bytes,
                "plan_hash": folder.plan.hash, "rows_hash": Table::new(&folder.plan.axes, &rows).hash(),
            }));
        } else {
            if let Some(question) = &folder.plan.question {
                print(question.trim());
            }
            print(format!("by {}", methods(&folder).join(", ")));
            print(format!("{} of {total} done, {missing} missing, {failed} failed", rows.len()));
            if other_build > 0 && !self.keep {
                print(format!("{other_build} rows are of another build (--keep takes them, `gotai clean` drops them)"));
            }
            print(format!(
                "{} in all: recordings {}, replays {}, unneeded {}",
                megabytes(bytes.total),
                megabytes(bytes.recordings),
                megabytes(bytes.replays),
                megabytes(bytes.unneeded)
            ));
        }
        Ok(ExitCode::from(u8::from(missing > 0 || failed > 0)))
    }
}

/// Words of all methods that are planned, in their order.
fn methods(folder: &Folder) -> Vec<&'static str> {
    let mut words: Vec<&str> = Vec::new();
    for word in folder.cases.iter().map(|planned| planned.case.experiment.method.word()) {
        if !words.contains(&word) {
            words.push(word);
        }
    }
    words
}

//! `gotai status`: how much of a sweep is done.

use super::args::OutputArgs;
use super::error::CliError;
use super::output::{print, print_json};
use crate::build_info::BUILD;
use crate::outcome::Outcome;
use crate::rows::count;
use crate::rows::table::Table;
use crate::sweep::store::{Store, rows};
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
    /// Exit code 1 while incomplete.
    pub fn run(self) -> Result<ExitCode, CliError> {
        if !self.dir.join("plan.json").is_file() {
            let dir = self.dir.display();
            return Err(CliError::Input(format!("{dir}: expected a folder of results, found no plan.json in it")));
        }
        let (plan, mut done) = Store::read(&self.dir)?;
        let all = done.len();
        if !self.keep {
            done.retain(|_, entry| entry.build == BUILD);
        }
        let other_build = all - done.len();
        let rows = rows(&plan, &done);
        let (total, failed) = (plan.cases.len(), count(&rows, Outcome::Failed));
        let missing = total - rows.len();
        if self.output.json {
            print_json(&json!({
                "dir": self.dir, "cases": total, "done": rows.len(), "missing": missing, "failed": failed,
                "finished": count(&rows, Outcome::Finished), "diverged": count(&rows, Outcome::Diverged),
                "stalled": count(&rows, Outcome::Stalled), "of_another_build": other_build,
                "rows_hash": Table::new(&plan.axes, &rows).hash(),
            }));
        } else {
            print(format!("{} of {total} done, {missing} missing, {failed} failed", rows.len()));
            if other_build > 0 && missing > 0 {
                print(format!("{other_build} rows are of another build (--keep takes them)"));
            }
        }
        Ok(ExitCode::from(u8::from(missing > 0 || failed > 0)))
    }
}

//! Folder of results as a reader finds it: its question, its plan, its rows.

use super::journal::Journal;
use super::kept::{EXPERIMENT, PLAN, read_plan};
use super::plan::SweepPlan;
use super::planned::Planned;
use super::store::{order, rows, write_tables};
use crate::build_info::BUILD;
use crate::experiment::{ExperimentError, ExperimentFile};
use crate::files::{FileError, quoted};
use crate::rows::Row;
use crate::rows::plan_file::PlanFile;
use std::path::{Path, PathBuf};

/// A folder of results, read; nobody is kept from working in it.
pub struct Folder {
    pub dir: PathBuf,
    /// Plan as the folder says it.
    pub plan: PlanFile,
    /// The configuration that was run.
    pub file: ExperimentFile,
    /// Cases of the folder, as this program resolves them.
    pub cases: Vec<Planned>,
    pub journal: Journal,
}

/// Reason why a folder of results cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    #[error("{0}: expected a folder of results, found no {PLAN} in it")]
    NoResults(String),
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    /// Failure of the machine, or a plan that is none.
    #[error(transparent)]
    File(#[from] FileError),
    /// Plan and configuration of which one was changed, or belongs to another build.
    #[error("{dir}: {PLAN} is not what {EXPERIMENT} beside it makes{why}; `{mend}` mends it")]
    OtherPlan { dir: String, why: String, mend: String },
}

impl Folder {
    pub fn is_one(dir: &Path) -> bool {
        dir.join(PLAN).is_file()
    }

    /// The results in a folder.
    ///
    /// # Errors
    /// It is none, cannot be read, or its configuration is not that of its plan.
    pub fn read(dir: &Path) -> Result<Self, FolderError> {
        if !Self::is_one(dir) {
            return Err(FolderError::NoResults(dir.display().to_string()));
        }
        let plan = read_plan(dir)?;
        let file = ExperimentFile::load(&dir.join(EXPERIMENT), &[])?;
        let SweepPlan { cases, file: made, .. } = SweepPlan::unbuilt(&file, &plan.name)?;
        let PlanFile { program, build, .. } = plan.clone();
        if (PlanFile { program, build, ..made }) != plan {
            let why = match plan.build == BUILD {
                true => String::new(),
                false => format!(" (it was planned by the build {}, this is {BUILD})", plan.build),
            };
            let dir = dir.display().to_string();
            let file = quoted(&format!("{dir}/{EXPERIMENT}"));
            let mend = format!("gotai sweep {file} --out {}", quoted(&dir));
            return Err(FolderError::OtherPlan { dir, why, mend });
        }
        Ok(Folder { dir: dir.to_path_buf(), plan, file, cases, journal: Journal::read(dir)? })
    }

    /// Rows that there are, in plan order.
    pub fn rows(&self) -> Vec<Row> {
        rows(&self.dir, &order(&self.cases), &self.journal)
    }

    /// Writes the tables anew, one of text where there is one.
    ///
    /// # Errors
    /// The machine failed.
    pub fn write_tables(&self) -> Result<(), FileError> {
        write_tables(&self.dir, &self.plan, &self.rows(), self.dir.join("rows.csv").exists())
    }
}

//! Question of a folder of results, as it keeps it: experiment.yaml, and the plan that follows from it.

use crate::files::{self, FileError};
use crate::rows::plan_file::{FORMAT, PlanFile};
use serde_json::Value;
use std::path::Path;

pub const PLAN: &str = "plan.json";
pub const EXPERIMENT: &str = "experiment.yaml";

/// The plan of a folder.
///
/// # Errors
/// There is none that this program can read.
pub fn read_plan(dir: &Path) -> Result<PlanFile, FileError> {
    let path = dir.join(PLAN);
    let plan: Value = serde_json::from_slice(&files::read(&path)?).map_err(|error| FileError::new(&path, error))?;
    let format = plan["format"].as_u64();
    if format != Some(u64::from(FORMAT)) {
        let found = format.map_or("no format, as of an older gotai".to_string(), |found| found.to_string());
        return Err(FileError::new(&path, format!("expected format {FORMAT}, found {found}; run its sweep again")));
    }
    serde_json::from_value(plan).map_err(|error| FileError::new(&path, error))
}

/// Whether a plan is one of ours, of whatever format.
pub fn is_ours(plan: &Path) -> bool {
    let said: Option<Value> = files::read(plan).ok().and_then(|text| serde_json::from_slice(&text).ok());
    said.is_some_and(|said| said["program"].as_str().is_some_and(|program| program.starts_with("gotai")))
}

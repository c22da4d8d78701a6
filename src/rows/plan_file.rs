//! The plan of a folder of results, as data.

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// What `plan.json` says.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PlanFile {
    pub program: String,
    pub build: String,
    /// Of the axes and the case ids.
    pub hash: String,
    pub axes: Vec<PlanAxis>,
    /// Case ids with their values on the axes, in plan order.
    pub cases: Vec<PlanCase>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PlanAxis {
    pub path: String,
    pub values: Vec<Value>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct PlanCase {
    pub case: String,
    pub at: Map<String, Value>,
}

//! The plan of a folder of results, as data.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Version of the files in a folder of results. A column whose meaning changes raises it too.
pub const FORMAT: u32 = 3;

/// Content of `plan.json`: the axes, from which the cases follow, with experiment.yaml beside it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlanFile {
    pub format: u32,
    pub program: String,
    pub build: String,
    /// Name of the configuration; recordings of a sweep without axes are called so.
    pub name: String,
    pub question: Option<String>,
    /// Hash of the axes and the ids of the cases, in their order.
    pub hash: String,
    /// Number of rows.
    pub rows: usize,
    /// Axes in their order, the first one slowest.
    pub axes: Vec<PlanAxis>,
    /// Groups of axes that advance side by side.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub together: Vec<Vec<String>>,
    /// Key of which every row has the critical value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub search: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanAxis {
    pub path: String,
    pub values: Vec<Value>,
}

impl PlanFile {
    /// Phrases about what an edit has done to the axes, one an axis.
    pub fn changes_from(&self, before: &PlanFile) -> Vec<String> {
        let find = |plan: &'_ PlanFile, path: &str| plan.axes.iter().position(|axis| axis.path == path);
        let gone = before.axes.iter().filter(|axis| find(self, &axis.path).is_none());
        let gone = gone.map(|axis| format!("{} is no axis any more", axis.path));
        let kept = self.axes.iter().filter_map(|axis| match find(before, &axis.path) {
            None => Some(format!("{} is a new axis of {}", axis.path, values(axis.values.len()))),
            Some(at) => axis.change_from(&before.axes[at]),
        });
        kept.chain(gone).collect()
    }
}

impl PlanAxis {
    fn change_from(&self, before: &PlanAxis) -> Option<String> {
        let missing = |of: &PlanAxis, there: &PlanAxis| of.values.iter().filter(|v| !there.values.contains(v)).count();
        let now = self.values.len();
        match (missing(self, before), missing(before, self)) {
            (0, 0) if self.values == before.values => None,
            (0, 0) => Some(format!("{} is in another order", self.path)),
            (more, 0) => Some(format!("{} has grown by {more} to {}", self.path, values(now))),
            (0, fewer) => Some(format!("{} has shrunk by {fewer} to {}", self.path, values(now))),
            (more, fewer) => Some(format!("{} has {more} other values for {fewer}, {} in all", self.path, values(now))),
        }
    }
}

fn values(count: usize) -> String {
    format!("{count} value{}", if count == 1 { "" } else { "s" })
}

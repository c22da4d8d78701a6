//! Row of a case: the outcome and what the judges measured.

use super::Measured;
use crate::heading::columns;
use crate::outcome::Outcome;
use crate::shared::Shared;
use serde::Serialize;
use serde_json::{Map, Value};

columns! {
    /// Row of a case. Fields are columns, in this order.
    #[derive(Clone, Debug, Default, PartialEq, Serialize)]
    pub struct Row {
        /// Id of the case, which depends on its resolved configuration alone.
        pub case: String,
        /// Every axis by its path.
        #[serde(flatten)]
        pub axes: Shared<Map<String, Value>>,
        /// Measurements of the run.
        #[serde(flatten)]
        pub measured: Shared<Measured>,
        /// Name of the case's recording, without the ending of its files (`.rrd`, `.mcap`). Null where there is none.
        pub recording: Option<String>,
        /// Hash of the program that made the row.
        pub build: String,
    }
}

/// Cells of a row, or of a part of one, by the names of its columns.
pub fn cells(row: &impl Serialize) -> Map<String, Value> {
    match serde_json::to_value(row) {
        Ok(Value::Object(cells)) => cells,
        // Rows are structs of plain data.
        _ => Map::new(),
    }
}

/// Number of rows with this outcome.
pub fn count(rows: &[Row], outcome: Outcome) -> usize {
    rows.iter().filter(|row| row.measured.outcome == outcome).count()
}

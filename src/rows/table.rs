//! Rows as a table: CSV for spreadsheets, Parquet for everything columnar. Null is an empty cell.

use super::plan_file::{PlanAxis, PlanFile};
use super::{Row, cells, columns};
use crate::digest::hex;
use crate::heading::{CellKind, unit_of};
use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use std::sync::Arc;

/// Table: columns by name, and every row's cells in their order.
pub struct Table {
    columns: Vec<(String, CellKind)>,
    rows: Vec<Map<String, Value>>,
}

impl Table {
    /// Table of the rows. Columns are there even if there is no row: those of every row in their order, axes and what
    /// only some experiments have at their places in it.
    pub fn new(axes: &[PlanAxis], rows: &[Row]) -> Self {
        let mut blank = Row::default();
        blank.axes.extend(axes.iter().map(|axis| (axis.path.clone(), Value::Null)));
        let more = rows.iter().flat_map(|row| row.measured.more.keys());
        blank.measured.more.extend(more.map(|name| (name.clone(), Value::Null)));
        let listed = columns::of_every_row();
        let kind = |name: &str| {
            let values = |axis: &PlanAxis| kind_of(axis.values.iter());
            let axis = axes.iter().find(|axis| axis.path == name).map(values);
            let own = || listed.iter().find(|heading| heading.name == name).map(|heading| heading.kind);
            axis.or_else(own).unwrap_or_else(|| kind_of(rows.iter().filter_map(|row| row.measured.more.get(name))))
        };
        let column = |(name, _): (String, Value)| {
            let kind = kind(&name);
            (name, kind)
        };
        Table { columns: cells(&blank).into_iter().map(column).collect(), rows: rows.iter().map(cells).collect() }
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// Cells by the names of their columns.
    pub fn rows(&self) -> impl Iterator<Item = &Map<String, Value>> {
        self.rows.iter()
    }

    /// SHA-256 of all columns but those that a clock makes or that say what was recorded, by name, row by row: the same
    /// of the same rows, recorded or not.
    pub fn hash(&self) -> String {
        let names = self.columns.iter().map(|(name, _)| name.as_str());
        let hashed: Vec<&str> = names.filter(|name| !columns::is_beside_the_run(name)).collect();
        let mut hash = Sha256::new();
        for (row, name) in self.rows.iter().flat_map(|row| hashed.iter().map(move |name| (row, name))) {
            for part in [name, "=", text(row.get(*name)).unwrap_or_default().as_str(), "\n"] {
                hash.update(part);
            }
        }
        hex(&hash.finalize())
    }

    /// The table as CSV, null as nothing.
    ///
    /// # Errors
    /// None that cells can cause; the writer's own.
    pub fn to_csv(&self) -> Result<Vec<u8>, csv::Error> {
        to_csv(&self.names().collect::<Vec<_>>(), self.rows())
    }

    /// The table as Parquet, with the plan's question, the units, program and format in its metadata.
    ///
    /// # Errors
    /// None that cells can cause; the writer's own.
    pub fn to_parquet(&self, plan: &PlanFile) -> Result<Vec<u8>, ParquetError> {
        let columns = self.columns.iter().map(|(name, kind)| (name.as_str(), self.column(name, *kind), true));
        let batch = RecordBatch::try_from_iter_with_nullable(columns)?;
        let compression = Compression::ZSTD(ZstdLevel::default());
        let properties = WriterProperties::builder().set_compression(compression);
        let properties = properties.set_key_value_metadata(Some(self.said_of(plan))).build();
        let mut file = Vec::new();
        let mut writer = ArrowWriter::try_new(&mut file, batch.schema(), Some(properties))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok(file)
    }

    fn said_of(&self, plan: &PlanFile) -> Vec<KeyValue> {
        let units = self.columns.iter().map(|(name, _)| (name, unit_of(name))).filter(|(_, unit)| !unit.is_empty());
        let units: Map<_, _> = units.map(|(name, unit)| (name.clone(), Value::from(unit))).collect();
        let said = [
            ("question", plan.question.clone().unwrap_or_default()),
            ("units", Value::from(units).to_string()),
            ("program", plan.program.clone()),
            ("build", plan.build.clone()),
            ("format", plan.format.to_string()),
            ("plan_hash", plan.hash.clone()),
            ("rows_hash", self.hash()),
        ];
        said.into_iter().map(|(key, value)| KeyValue::new(key.to_string(), value)).collect()
    }

    fn column(&self, name: &str, kind: CellKind) -> ArrayRef {
        let cells = self.rows.iter().map(|row| row.get(name));
        match kind {
            CellKind::Text => Arc::new(cells.map(text).collect::<StringArray>()),
            CellKind::Count => Arc::new(cells.map(|cell| cell.and_then(Value::as_i64)).collect::<Int64Array>()),
            CellKind::Number => Arc::new(cells.map(|cell| cell.and_then(Value::as_f64)).collect::<Float64Array>()),
        }
    }
}

/// Some columns of some rows as CSV, null as nothing.
///
/// # Errors
/// None that cells can cause; the writer's own.
pub fn to_csv<'a>(columns: &[&str], rows: impl Iterator<Item = &'a Map<String, Value>>) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(columns)?;
    for row in rows {
        writer.write_record(columns.iter().map(|name| text(row.get(*name)).unwrap_or_default()))?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

/// Kind of a column: of whole numbers or numbers if all its values are; null is either.
fn kind_of<'a>(values: impl Iterator<Item = &'a Value> + Clone) -> CellKind {
    let all = |is: fn(&Value) -> bool| values.clone().all(|value| value.is_null() || is(value));
    if all(Value::is_i64) {
        CellKind::Count
    } else if all(Value::is_number) {
        CellKind::Number
    } else {
        CellKind::Text
    }
}

fn text(cell: Option<&Value>) -> Option<String> {
    match cell {
        None | Some(Value::Null) => None,
        Some(Value::String(text)) => Some(text.clone()),
        Some(other) => Some(other.to_string()),
    }
}

//! Rows as a table: CSV for spreadsheets, Parquet for everything columnar. Null is an empty cell.

use super::plan_file::PlanAxis;
use super::{Measured, Row, cells};
use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use serde_json::{Map, Value};
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Text,
    Integer,
    Number,
}

/// Columns by name, and every row's cells in their order.
pub struct Table {
    columns: Vec<(String, Kind)>,
    rows: Vec<Map<String, Value>>,
}

impl Table {
    /// Columns are there even if there is no row.
    pub fn new(axes: &[PlanAxis], rows: &[Row]) -> Self {
        let mut columns = vec![("case".to_string(), Kind::Text)];
        columns.extend(axes.iter().map(|axis| (axis.path.clone(), kind_of(&axis.values))));
        columns.extend(cells(&Measured::nothing()).into_iter().map(|(name, value)| {
            let kind = match name.as_str() {
                "outcome" | "criterion" | "method_used" => Kind::Text,
                _ if value.is_u64() => Kind::Integer,
                _ => Kind::Number,
            };
            (name, kind)
        }));
        let rows: Vec<_> = rows.iter().map(|row| (cells(row), &row.measured.more)).collect();
        for name in rows.iter().flat_map(|(_, more)| more.keys()) {
            if !columns.iter().any(|(known, _)| known == name) {
                let values: Vec<_> = rows.iter().filter_map(|(_, more)| more.get(name)).cloned().collect();
                columns.push((name.clone(), kind_of(&values)));
            }
        }
        columns.push(("build".to_string(), Kind::Text));
        Table { columns, rows: rows.into_iter().map(|(row, _)| row).collect() }
    }

    pub fn to_csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|(name, _)| name))?;
        for row in &self.rows {
            writer.write_record(self.columns.iter().map(|(name, _)| text(row.get(name)).unwrap_or_default()))?;
        }
        writer.into_inner().map_err(|error| error.into_error().into())
    }

    pub fn to_parquet(&self) -> Result<Vec<u8>, ParquetError> {
        let columns = self.columns.iter().map(|(name, kind)| (name.as_str(), self.column(name, *kind), true));
        let batch = RecordBatch::try_from_iter_with_nullable(columns)?;
        let compression = Compression::ZSTD(ZstdLevel::default());
        let properties = WriterProperties::builder().set_compression(compression).build();
        let mut file = Vec::new();
        let mut writer = ArrowWriter::try_new(&mut file, batch.schema(), Some(properties))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok(file)
    }

    fn column(&self, name: &str, kind: Kind) -> ArrayRef {
        let cells = self.rows.iter().map(|row| row.get(name));
        match kind {
            Kind::Text => Arc::new(cells.map(text).collect::<StringArray>()),
            Kind::Integer => Arc::new(cells.map(|cell| cell.and_then(Value::as_i64)).collect::<Int64Array>()),
            Kind::Number => Arc::new(cells.map(|cell| cell.and_then(Value::as_f64)).collect::<Float64Array>()),
        }
    }
}

/// A column of integers or numbers if all its values are; null is either.
fn kind_of(values: &[Value]) -> Kind {
    let all = |is: fn(&Value) -> bool| values.iter().all(|value| value.is_null() || is(value));
    if all(Value::is_i64) {
        Kind::Integer
    } else if all(Value::is_number) {
        Kind::Number
    } else {
        Kind::Text
    }
}

fn text(cell: Option<&Value>) -> Option<String> {
    match cell {
        None | Some(Value::Null) => None,
        Some(Value::String(text)) => Some(text.clone()),
        Some(other) => Some(other.to_string()),
    }
}

//! Rows as a table: CSV for spreadsheets, Parquet for everything columnar. Null is an empty cell.

use super::plan_file::{PlanAxis, PlanFile};
use super::{Row, cells, columns};
use crate::digest::hex;
use crate::heading::{CellKind, Datum, Headings, unit_of};
use arrow_array::builder::{Float64Builder, Int64Builder, StringBuilder};
use arrow_array::{Array, ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use parquet::arrow::ArrowWriter;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use prost::bytes::Bytes;
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};
use std::sync::Arc;

/// Rows of which a Parquet file is written as it is: to compress its many short columns takes longer than all else that
/// a run of some milliseconds does.
const FEW: usize = 64;

/// Table: columns by name, and the rows.
pub struct Table<'a> {
    columns: Vec<(String, CellKind)>,
    rows: &'a [Row],
}

/// A table as text, and the hash of its rows.
pub struct TableText {
    pub csv: Vec<u8>,
    pub hash: String,
}

impl<'a> Table<'a> {
    /// Table of the rows. Columns are there even if there is no row: those of every row in their order, axes and what
    /// only some experiments have at their places in it.
    pub fn new(axes: &[PlanAxis], rows: &'a [Row]) -> Self {
        let mut blank = Row::default();
        blank.axes.extend(axes.iter().map(|axis| (axis.path.clone(), Value::Null)));
        for name in rows.iter().flat_map(|row| row.measured.more.keys()) {
            if !blank.measured.more.contains_key(name) {
                blank.measured.more.insert(name.clone(), Value::Null);
            }
        }
        let listed = columns::of_every_row();
        let kind = |name: &str| {
            let values = |axis: &PlanAxis| kind_of(axis.values.iter());
            let axis = axes.iter().find(|axis| axis.path == name).map(values);
            let own = || listed.iter().find(|heading| heading.name == name).map(|heading| heading.kind);
            axis.or_else(own).unwrap_or_else(|| kind_of(rows.iter().filter_map(|row| row.measured.more.get(name))))
        };
        let mut columns = Vec::new();
        blank.each_cell(&mut |name, _| columns.push((name.to_string(), kind(name))));
        Table { columns, rows }
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// Cells of every row by the names of their columns.
    pub fn rows(&self) -> impl Iterator<Item = Map<String, Value>> {
        self.rows.iter().map(cells)
    }

    /// Shows every row's cells in the order of the columns.
    fn each_row(&self, mut visit: impl FnMut(&[Datum<'a>])) {
        let mut cells = Vec::new();
        for row in self.rows {
            cells.clear();
            cells.resize(self.columns.len(), Datum::Null);
            let mut next = 0;
            row.each_cell(&mut |name, cell| {
                // Mostly the one behind the last; what only some rows have may stand in another order.
                let is_it = |at: &usize| self.columns[*at].0 == name;
                if let Some(at) = (next..self.columns.len()).chain(0..next).find(is_it) {
                    cells[at] = cell;
                    next = at + 1;
                }
            });
            visit(&cells);
        }
    }

    /// SHA-256 of all columns but those that a clock makes or that say what was recorded, by name, row by row: the same
    /// of the same rows, recorded or not.
    pub fn hash(&self) -> String {
        self.written().hash
    }

    /// The table as CSV, null as nothing, and its hash.
    pub fn written(&self) -> TableText {
        let is_hashed: Vec<bool> = self.names().map(|name| !columns::is_beside_the_run(name)).collect();
        let (mut csv, mut hash, mut hashed) = (Vec::new(), Sha256::new(), Vec::new());
        for (at, name) in self.names().enumerate() {
            write_field(name.as_bytes(), at == 0, &mut csv);
        }
        csv.push(b'\n');
        self.each_row(|cells| {
            hashed.clear();
            for (at, (cell, (name, _))) in cells.iter().zip(&self.columns).enumerate() {
                let begin = hashed.len();
                hashed.extend_from_slice(name.as_bytes());
                hashed.push(b'=');
                let text = hashed.len();
                cell.write_text(&mut hashed);
                write_field(&hashed[text..], at == 0, &mut csv);
                hashed.push(b'\n');
                if !is_hashed[at] {
                    hashed.truncate(begin);
                }
            }
            csv.push(b'\n');
            hash.update(&hashed);
        });
        TableText { csv, hash: hex(&hash.finalize()) }
    }

    /// The table as Parquet, with the plan's question, the units, program, format and the rows' hash in its metadata.
    ///
    /// # Errors
    /// None that cells can cause; the writer's own.
    pub fn to_parquet(&self, plan: &PlanFile, hash: &str) -> Result<Vec<u8>, ParquetError> {
        let mut filled: Vec<Filled> = self.columns.iter().map(|(_, kind)| Filled::new(*kind)).collect();
        self.each_row(|cells| filled.iter_mut().zip(cells).for_each(|(column, cell)| column.append(*cell)));
        let columns = self.names().zip(&mut filled).map(|(name, column)| (name, column.finish(), true));
        let batch = RecordBatch::try_from_iter_with_nullable(columns)?;
        let properties = match self.rows.len() {
            0..FEW => {
                let properties = WriterProperties::builder().set_dictionary_enabled(false);
                properties.set_statistics_enabled(EnabledStatistics::None).set_offset_index_disabled(true)
            }
            _ => WriterProperties::builder().set_compression(Compression::ZSTD(ZstdLevel::default())),
        };
        let properties = properties.set_key_value_metadata(Some(self.said_of(plan, hash))).build();
        let mut file = Vec::new();
        let mut writer = ArrowWriter::try_new(&mut file, batch.schema(), Some(properties))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok(file)
    }

    fn said_of(&self, plan: &PlanFile, hash: &str) -> Vec<KeyValue> {
        let units = self.columns.iter().map(|(name, _)| (name, unit_of(name))).filter(|(_, unit)| !unit.is_empty());
        let units: Map<_, _> = units.map(|(name, unit)| (name.clone(), Value::from(unit))).collect();
        let said = [
            ("question", plan.question.clone().unwrap_or_default()),
            ("units", Value::from(units).to_string()),
            ("program", plan.program.clone()),
            ("build", plan.build.clone()),
            ("format", plan.format.to_string()),
            ("plan_hash", plan.hash.clone()),
            ("rows_hash", hash.to_string()),
        ];
        said.into_iter().map(|(key, value)| KeyValue::new(key.to_string(), value)).collect()
    }
}

/// A column of a Parquet file, on its way.
enum Filled {
    Text(StringBuilder),
    Count(Int64Builder),
    Number(Float64Builder),
}

impl Filled {
    fn new(kind: CellKind) -> Self {
        match kind {
            CellKind::Text => Filled::Text(StringBuilder::new()),
            CellKind::Count => Filled::Count(Int64Builder::new()),
            CellKind::Number => Filled::Number(Float64Builder::new()),
        }
    }

    fn append(&mut self, cell: Datum) {
        match self {
            Filled::Text(column) => match cell {
                Datum::Null | Datum::Other(Value::Null) => column.append_null(),
                Datum::Text(text) => column.append_value(text),
                other => {
                    let mut text = Vec::new();
                    other.write_text(&mut text);
                    column.append_value(String::from_utf8_lossy(&text));
                }
            },
            Filled::Count(column) => column.append_option(cell.as_i64()),
            Filled::Number(column) => column.append_option(cell.as_f64()),
        }
    }

    fn finish(&mut self) -> ArrayRef {
        match self {
            Filled::Text(column) => Arc::new(column.finish()),
            Filled::Count(column) => Arc::new(column.finish()),
            Filled::Number(column) => Arc::new(column.finish()),
        }
    }
}

/// Appends a field of a line of CSV, in quotes where it needs them.
fn write_field(text: &[u8], is_first: bool, csv: &mut Vec<u8>) {
    if !is_first {
        csv.push(b',');
    }
    if !text.iter().any(|byte| b",\"\r\n".contains(byte)) {
        return csv.extend_from_slice(text);
    }
    csv.push(b'"');
    for byte in text {
        csv.extend(std::iter::repeat_n(*byte, if *byte == b'"' { 2 } else { 1 }));
    }
    csv.push(b'"');
}

/// Rows of a table that was written as Parquet, by the names of its columns in their order.
///
/// # Errors
/// It is none, or has columns of kinds that no table of ours has.
pub fn rows_of_parquet(file: Vec<u8>) -> Result<Vec<Map<String, Value>>, ParquetError> {
    let reader = ParquetRecordBatchReaderBuilder::try_new(Bytes::from(file))?.build()?;
    let mut rows = Vec::new();
    for batch in reader {
        let batch = batch?;
        let schema = batch.schema();
        let columns = schema.fields().iter().zip(batch.columns());
        let columns = columns.map(|(field, column)| Ok((field.name().clone(), cells_of(column)?)));
        let columns = columns.collect::<Result<Vec<_>, ParquetError>>()?;
        let row = |i: usize| columns.iter().map(|(name, cells)| (name.clone(), cells[i].clone())).collect();
        rows.extend((0..batch.num_rows()).map(row));
    }
    Ok(rows)
}

fn cells_of(column: &ArrayRef) -> Result<Vec<Value>, ParquetError> {
    let column = column.as_any();
    if let Some(texts) = column.downcast_ref::<StringArray>() {
        return Ok(texts.iter().map(Value::from).collect());
    }
    if let Some(counts) = column.downcast_ref::<Int64Array>() {
        return Ok(counts.iter().map(Value::from).collect());
    }
    match column.downcast_ref::<Float64Array>() {
        Some(numbers) => Ok(numbers.iter().map(Value::from).collect()),
        None => Err(ParquetError::General("expected columns of texts, counts and numbers".into())),
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

//! Rows as columns: a third of what rows by name take, and quick to go through.

use super::number::{of_cell, shown};
use arrow_array::{Array, Float64Array, Int64Array, StringArray};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::file::reader::ChunkReader;
use serde_json::{Map, Value};
use std::collections::HashMap;

/// Table of a report, column by column.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RowFrame {
    columns: Vec<FrameColumn>,
    rows: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct FrameColumn {
    name: String,
    cells: FrameCells,
}

#[derive(Clone, Debug, PartialEq)]
enum FrameCells {
    /// All null so far.
    Nothing,
    /// NaN is null.
    Numbers(Vec<f64>),
    /// Each word once; the code `NULL` is null.
    Words { words: Vec<String>, codes: Vec<u32> },
}

const NULL: u32 = u32::MAX;

/// Columns that are words whatever they look like: an id of decimal digits alone is no number.
pub(super) const WORDS: [&str; 6] = ["case", "outcome", "criterion", "recording", "build", "search_verdict"];

/// Builder of a frame: rows come one by one, or columns in batches.
#[derive(Default)]
pub struct Framing {
    columns: Vec<FrameColumn>,
    places: HashMap<String, usize>,
    words: Vec<HashMap<String, u32>>,
    rows: usize,
}

impl Framing {
    /// RowFrame with these columns, so far without a row.
    pub fn of(names: impl IntoIterator<Item = String>) -> Self {
        let mut framing = Framing::default();
        for name in names {
            framing.place(&name);
        }
        framing
    }

    /// Place of a column, which is made if it is not there.
    fn place(&mut self, name: &str) -> usize {
        if let Some(place) = self.places.get(name) {
            return *place;
        }
        self.places.insert(name.to_string(), self.columns.len());
        self.columns.push(FrameColumn { name: name.to_string(), cells: FrameCells::Nothing });
        self.words.push(HashMap::new());
        self.columns.len() - 1
    }

    /// Adds a row by the names of its columns.
    pub fn row(&mut self, row: &Map<String, Value>) {
        for (name, cell) in row {
            let place = self.place(name);
            match cell {
                Value::Null => {}
                Value::Number(number) => self.number(place, number.as_f64().unwrap_or(f64::NAN)),
                other => self.word(place, &of_cell(other)),
            }
        }
        self.rows += 1;
    }

    /// Adds a row of texts, in the order of the columns: numbers where all of a column are, and nothing is null.
    pub fn texts<'a>(&mut self, row: impl Iterator<Item = &'a str>) {
        for (place, cell) in row.enumerate().take(self.columns.len()) {
            let cell = cell.trim();
            if cell.is_empty() {
                continue;
            }
            let is_word = WORDS.contains(&self.columns[place].name.as_str());
            match cell.parse::<f64>() {
                Ok(x) if !is_word => self.number(place, x),
                _ => self.word(place, cell),
            }
        }
        self.rows += 1;
    }

    /// Adds a number to the row that is under way.
    pub fn number(&mut self, column: usize, x: f64) {
        let rows = self.rows;
        match &mut self.columns[column].cells {
            cells @ FrameCells::Nothing => {
                let mut numbers = vec![f64::NAN; rows];
                numbers.push(x);
                *cells = FrameCells::Numbers(numbers);
            }
            FrameCells::Numbers(numbers) => {
                numbers.resize(rows, f64::NAN);
                numbers.push(x);
            }
            FrameCells::Words { .. } => self.word(column, &shown(x)),
        }
    }

    /// Adds a word to the row that is under way.
    pub fn word(&mut self, column: usize, word: &str) {
        let rows = self.rows;
        let known = &mut self.words[column];
        let cells = &mut self.columns[column].cells;
        match cells {
            FrameCells::Nothing => *cells = FrameCells::Words { words: Vec::new(), codes: Vec::new() },
            // A column of numbers in which a word comes is one of words.
            FrameCells::Numbers(numbers) => {
                let (mut words, mut codes) = (Vec::new(), Vec::new());
                for x in numbers.iter() {
                    codes.push(if x.is_nan() { NULL } else { coded(known, &mut words, &shown(*x)) });
                }
                *cells = FrameCells::Words { words, codes };
            }
            FrameCells::Words { .. } => {}
        }
        if let FrameCells::Words { words, codes } = cells {
            codes.resize(rows, NULL);
            codes.push(coded(known, words, word));
        }
    }

    /// Adds a batch of a column below the rows that there are.
    fn batch(&mut self, place: usize, column: &dyn Array) -> Result<(), String> {
        if column.null_count() == column.len() {
            return Ok(());
        }
        let any = column.as_any();
        let before = self.rows;
        for i in (0..column.len()).filter(|i| column.is_valid(*i)) {
            self.rows = before + i;
            if let Some(numbers) = any.downcast_ref::<Float64Array>() {
                self.number(place, numbers.value(i));
            } else if let Some(counts) = any.downcast_ref::<Int64Array>() {
                self.number(place, counts.value(i) as f64);
            } else if let Some(words) = any.downcast_ref::<StringArray>() {
                self.word(place, words.value(i));
            } else {
                return Err(format!("a column of {}", column.data_type()));
            }
        }
        Ok(())
    }

    /// The frame, whole.
    pub fn framed(mut self) -> RowFrame {
        for column in &mut self.columns {
            match &mut column.cells {
                FrameCells::Nothing => {}
                FrameCells::Numbers(numbers) => numbers.resize(self.rows, f64::NAN),
                FrameCells::Words { codes, .. } => codes.resize(self.rows, NULL),
            }
        }
        RowFrame { columns: self.columns, rows: self.rows }
    }
}

fn coded(known: &mut HashMap<String, u32>, words: &mut Vec<String>, word: &str) -> u32 {
    if let Some(code) = known.get(word) {
        return *code;
    }
    let code = words.len() as u32;
    known.insert(word.to_string(), code);
    words.push(word.to_string());
    code
}

impl RowFrame {
    /// The frame of rows by name.
    pub fn of_rows(names: impl IntoIterator<Item = String>, rows: impl Iterator<Item = Map<String, Value>>) -> Self {
        let mut framing = Framing::of(names);
        rows.for_each(|row| framing.row(&row));
        framing.framed()
    }

    /// The frame of a text with commas, whose first line names the columns.
    ///
    /// # Errors
    /// The text is no such table: why, in words.
    pub fn of_csv(content: &[u8]) -> Result<Self, String> {
        let mut reader = csv::Reader::from_reader(content);
        let names: Vec<String> =
            reader.headers().map_err(|error| error.to_string())?.iter().map(str::to_string).collect();
        let mut framing = Framing::of(names.iter().cloned());
        if framing.columns.len() != names.len() {
            return Err("two columns of one name".to_string());
        }
        for row in reader.records() {
            framing.texts(row.map_err(|error| error.to_string())?.iter());
        }
        Ok(framing.framed())
    }

    /// The frame of a Parquet file of numbers and texts.
    ///
    /// # Errors
    /// The file is no such table: why, in words.
    pub fn of_parquet(file: impl ChunkReader + 'static) -> Result<Self, String> {
        let said = |error: &dyn std::fmt::Display| error.to_string();
        let reader = ParquetRecordBatchReaderBuilder::try_new(file).map_err(|error| said(&error))?;
        let mut framing = Framing::of(reader.schema().fields().iter().map(|field| field.name().clone()));
        for batch in reader.build().map_err(|error| said(&error))? {
            let batch = batch.map_err(|error| said(&error))?;
            let before = framing.rows;
            for (place, column) in batch.columns().iter().enumerate() {
                framing.rows = before;
                framing.batch(place, column.as_ref())?;
            }
            framing.rows = before + batch.num_rows();
        }
        Ok(framing.framed())
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|column| column.name.as_str())
    }

    pub fn has(&self, name: &str) -> bool {
        self.column(name).is_some()
    }

    fn column(&self, name: &str) -> Option<&FrameCells> {
        self.columns.iter().find(|column| column.name == name).map(|column| &column.cells)
    }

    /// Numbers of a column, NaN where it is null; None where it is none of numbers, or all null.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.column(name)? {
            FrameCells::Numbers(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// Words of a column, each once, and the place among them of each row's, past their end where it is null.
    pub fn words(&self, name: &str) -> Option<(&[String], &[u32])> {
        match self.column(name)? {
            FrameCells::Words { words, codes } => Some((words, codes)),
            _ => None,
        }
    }

    /// Number of a row.
    pub fn number(&self, name: &str, row: usize) -> Option<f64> {
        self.numbers(name)?.get(row).copied().filter(|x| !x.is_nan())
    }

    /// Word of a row.
    pub fn word(&self, name: &str, row: usize) -> Option<&str> {
        let (words, codes) = self.words(name)?;
        words.get(*codes.get(row)? as usize).map(String::as_str)
    }

    /// GridCell of a row as text; nothing where it is null.
    pub fn text(&self, name: &str, row: usize) -> String {
        self.number(name, row).map(shown).or(self.word(name, row).map(str::to_string)).unwrap_or_default()
    }

    /// A row of some columns as cells by name.
    pub fn cells(&self, names: &[&str], row: usize) -> Map<String, Value> {
        let cell = |name: &str| {
            let number = self.number(name, row).map(|x| match x {
                // As rows have it: a count is whole.
                x if x.fract() == 0.0 && x.abs() < 9e15 => Value::from(x as i64),
                x => Value::from(x),
            });
            number.or(self.word(name, row).map(Value::from)).unwrap_or_default()
        };
        names.iter().map(|name| (name.to_string(), cell(name))).collect()
    }

    /// Whether no row has anything in a column.
    pub fn is_blank(&self, name: &str) -> bool {
        self.column(name).is_none_or(|cells| *cells == FrameCells::Nothing)
    }

    /// Number of rows with this outcome.
    pub fn count(&self, outcome: &str) -> usize {
        let Some((words, codes)) = self.words("outcome") else { return 0 };
        let Some(code) = words.iter().position(|word| word == outcome) else { return 0 };
        codes.iter().filter(|c| **c == code as u32).count()
    }
}

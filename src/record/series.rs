//! Series of a recording as tables: one line a sample, one a contact, one an event; numbers to their last bit.

use super::read::ReadBack;
use super::sample::{ContactSample, Severity};
use arrow_array::{ArrayRef, Float64Array, Int64Array, RecordBatch, StringArray};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use std::sync::Arc;

/// Values of a column.
enum Cells {
    Numbers(Vec<f64>),
    Counts(Vec<u64>),
    Texts(Vec<String>),
}

/// Table of one kind of thing in a recording.
pub struct SeriesTable {
    /// What it is a table of, as a part of a file's name: `series`, `contacts`, `log`.
    pub name: &'static str,
    columns: Vec<(String, Cells)>,
}

/// Names of the tables that a recording may have.
pub const TABLES: [&str; 3] = ["series", "contacts", "log"];

/// Tables of a recording: of its samples, of its contacts, of its events. What was not recorded has no column.
pub fn tables(recording: &ReadBack) -> Vec<SeriesTable> {
    vec![of_samples(recording), of_contacts(recording), of_events(recording)]
}

fn clock(recording: &ReadBack) -> Vec<(String, Cells)> {
    let batch = &recording.samples;
    vec![
        ("time_s".to_string(), Cells::Numbers(batch.time_s.clone())),
        ("step".to_string(), Cells::Counts(batch.step.clone())),
    ]
}

fn of_samples(recording: &ReadBack) -> SeriesTable {
    let batch = &recording.samples;
    let mut columns = clock(recording);
    let mut add = |name: String, values: Vec<f64>| columns.push((name, Cells::Numbers(values)));
    if !batch.energy.is_empty() {
        let of = |pick: fn(&super::sample::EnergySample) -> f64| batch.energy.iter().map(pick).collect::<Vec<_>>();
        add("kinetic_j".to_string(), of(|e| e.kinetic_j));
        add("potential_j".to_string(), of(|e| e.potential_j));
        add("total_j".to_string(), of(|e| e.total_j));
        add("penetration_m".to_string(), of(|e| e.penetration_m));
    }
    if !batch.contacts_len.is_empty() {
        add("contacts".to_string(), batch.contacts_len.iter().map(|&len| f64::from(len)).collect());
    }
    let bodies = recording.bodies.len();
    for (i, body) in recording.bodies.iter().enumerate().filter(|_| !batch.bodies.is_empty()) {
        let states = || batch.bodies.iter().skip(i).step_by(bodies);
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            add(format!("{body}.position_m.{name}"), states().map(|at| at.position_m[axis]).collect());
        }
        for (axis, name) in ["x", "y", "z", "w"].iter().enumerate() {
            add(format!("{body}.orientation_xyzw.{name}"), states().map(|at| at.orientation_xyzw[axis]).collect());
        }
        // An .rrd shows none.
        if states().all(|at| at.velocity_m_s.iter().all(|x| x.is_nan())) {
            continue;
        }
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            add(format!("{body}.velocity_m_s.{name}"), states().map(|at| at.velocity_m_s[axis]).collect());
        }
        for (axis, name) in ["x", "y", "z"].iter().enumerate() {
            let values = states().map(|at| at.angular_velocity_rad_s[axis]).collect();
            add(format!("{body}.angular_velocity_rad_s.{name}"), values);
        }
    }
    SeriesTable { name: TABLES[0], columns }
}

fn of_contacts(recording: &ReadBack) -> SeriesTable {
    let batch = &recording.samples;
    let lengths = batch.contacts_len.iter().map(|&len| len as usize);
    let samples: Vec<usize> = lengths.enumerate().flat_map(|(i, len)| std::iter::repeat_n(i, len)).collect();
    let number = |pick: &dyn Fn(&ContactSample) -> f64| Cells::Numbers(batch.contacts.iter().map(pick).collect());
    let name = |index: u32| recording.bodies.get(index as usize).cloned().unwrap_or_default();
    let other = |contact: &ContactSample| contact.other.map_or(super::schema::CONTAINER.to_string(), name);
    let mut columns = vec![
        ("time_s".to_string(), Cells::Numbers(samples.iter().map(|&i| batch.time_s[i]).collect())),
        ("step".to_string(), Cells::Counts(samples.iter().map(|&i| batch.step[i]).collect())),
        ("body".to_string(), Cells::Texts(batch.contacts.iter().map(|contact| name(contact.body)).collect())),
        ("other".to_string(), Cells::Texts(batch.contacts.iter().map(other).collect())),
        ("mode".to_string(), Cells::Texts(batch.contacts.iter().map(|c| c.mode.name().to_string()).collect())),
        ("gap_m".to_string(), number(&|contact| contact.gap_m)),
        ("friction_use".to_string(), number(&|contact| contact.friction_use)),
    ];
    for (axis, part) in ["x", "y", "z"].iter().enumerate() {
        columns.push((format!("point_m.{part}"), number(&|contact| contact.point_m[axis])));
        columns.push((format!("normal.{part}"), number(&|contact| contact.normal[axis])));
        columns.push((format!("force_n.{part}"), number(&|contact| contact.force_n[axis])));
    }
    SeriesTable { name: TABLES[1], columns }
}

fn of_events(recording: &ReadBack) -> SeriesTable {
    let events = &recording.samples.events;
    let level = |severity: Severity| match severity {
        Severity::Info => "info",
        Severity::Warning => "warning",
        Severity::Error => "error",
    };
    let columns = vec![
        ("time_s".to_string(), Cells::Numbers(events.iter().map(|event| event.time_s).collect())),
        ("step".to_string(), Cells::Counts(events.iter().map(|event| event.step).collect())),
        ("level".to_string(), Cells::Texts(events.iter().map(|event| level(event.severity).to_string()).collect())),
        ("text".to_string(), Cells::Texts(events.iter().map(|event| event.text.clone()).collect())),
    ];
    SeriesTable { name: TABLES[2], columns }
}

impl SeriesTable {
    /// Number of its lines.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, |(_, cells)| match cells {
            Cells::Numbers(values) => values.len(),
            Cells::Counts(values) => values.len(),
            Cells::Texts(values) => values.len(),
        })
    }

    /// Whether it has no line.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The table as CSV, numbers as the shortest decimals that read back.
    ///
    /// # Errors
    /// None that cells can cause; the writer's own.
    pub fn to_csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|(name, _)| name))?;
        for i in 0..self.len() {
            writer.write_record(self.columns.iter().map(|(_, cells)| match cells {
                Cells::Numbers(values) => number(values[i]),
                Cells::Counts(values) => values[i].to_string(),
                Cells::Texts(values) => values[i].clone(),
            }))?;
        }
        writer.into_inner().map_err(|error| error.into_error().into())
    }

    /// The table as Parquet.
    ///
    /// # Errors
    /// None that cells can cause; the writer's own.
    pub fn to_parquet(&self) -> Result<Vec<u8>, ParquetError> {
        let array = |cells: &Cells| -> ArrayRef {
            match cells {
                Cells::Numbers(values) => Arc::new(Float64Array::from(values.clone())),
                Cells::Counts(values) => {
                    Arc::new(values.iter().map(|&n| i64::try_from(n).ok()).collect::<Int64Array>())
                }
                Cells::Texts(values) => Arc::new(values.iter().map(Some).collect::<StringArray>()),
            }
        };
        let columns = self.columns.iter().map(|(name, cells)| (name.as_str(), array(cells), true));
        let batch = RecordBatch::try_from_iter_with_nullable(columns)?;
        let compression = Compression::ZSTD(ZstdLevel::default());
        let properties = WriterProperties::builder().set_compression(compression).build();
        let mut file = Vec::new();
        let mut writer = ArrowWriter::try_new(&mut file, batch.schema(), Some(properties))?;
        writer.write(&batch)?;
        writer.close()?;
        Ok(file)
    }
}

/// The shortest decimal that reads back; nothing for what is no number.
fn number(x: f64) -> String {
    if x.is_nan() { String::new() } else { format!("{x:?}") }
}

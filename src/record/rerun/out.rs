//! Columns and events as chunks of an .rrd.

use super::headline::level;
use super::live::Live;
use super::names::{LOG, SIM_TIME, STEP};
use crate::record::sample::Event;
use crate::record::schema;
use ::rerun::external::re_log_encoding::Encoder;
use ::rerun::log::{Chunk, ChunkId, LogMsg};
use ::rerun::{EntityPath, Scalars, SerializedComponentColumn, StoreId, TextLog, TimeColumn};
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;

/// Result of a write. Rerun's errors come from five crates; all end as the reason of a `RecordError`.
pub type Appended = Result<(), Box<dyn Error>>;

/// Where messages go: into a file, or to a viewer.
pub enum Sink {
    File(Encoder<BufWriter<File>>),
    Viewer(Live),
}

impl Sink {
    pub fn append(&mut self, message: &LogMsg) -> Appended {
        match self {
            Sink::File(encoder) => drop(encoder.append(message)?),
            Sink::Viewer(viewer) => viewer.send(message),
        }
        Ok(())
    }

    pub fn flush(&mut self) -> Appended {
        match self {
            Sink::File(encoder) => encoder.flush_blocking()?,
            Sink::Viewer(viewer) => viewer.flush(),
        }
        Ok(())
    }

    /// The end of a file; a viewer needs none.
    pub fn finish(&mut self) -> Appended {
        if let Sink::File(encoder) = self {
            encoder.finish()?;
        }
        self.flush()
    }
}

/// The sink, and the name of the recording in it.
pub struct Out {
    pub store: StoreId,
    pub sink: Sink,
}

impl Out {
    /// A batch of one entity: as many rows as there are times.
    pub fn columns(
        &mut self,
        path: EntityPath,
        times: &Times,
        columns: impl Iterator<Item = SerializedComponentColumn>,
    ) -> Appended {
        let timelines = times.iter().map(|column| (*column.timeline().name(), column.clone())).collect();
        let components = columns.map(|column| (column.descriptor, column.list_array)).collect();
        let chunk = Chunk::from_auto_row_ids(ChunkId::new(), path, timelines, components)?;
        self.sink.append(&LogMsg::ArrowMsg(self.store.clone(), chunk.to_arrow_msg()?))
    }

    pub fn scalars(&mut self, path: EntityPath, times: &Times, values: impl Iterator<Item = f64>) -> Appended {
        let scalars = Scalars::update_fields().with_scalars(values);
        self.columns(path, times, scalars.columns_of_unit_batches()?)
    }

    pub fn events(&mut self, events: &[Event]) -> Appended {
        self.events_at(LOG.into(), events)
    }

    pub fn events_at(&mut self, path: EntityPath, events: &[Event]) -> Appended {
        if events.is_empty() {
            return Ok(());
        }
        let column = |of: fn(&Event) -> u64| events.iter().map(of).collect::<Vec<_>>();
        let times_s: Vec<f64> = events.iter().map(|event| event.time_s).collect();
        let text = TextLog::update_fields()
            .with_many_text(events.iter().map(|event| event.text.as_str()))
            .with_many_level(events.iter().map(|event| level(event.severity)));
        self.columns(path, &times(&column(|event| event.step), &times_s), text.columns_of_unit_batches()?)
    }
}

/// The two timelines of a batch.
pub type Times = [TimeColumn; 2];

/// Times of a batch on both timelines.
pub fn times(step: &[u64], time_s: &[f64]) -> Times {
    // Both timelines are i64; 2⁶³ nanoseconds are 292 years.
    let signed = |n: u64| i64::try_from(n).unwrap_or(i64::MAX);
    [
        TimeColumn::new_duration_nanos(SIM_TIME, time_s.iter().map(|&t| signed(schema::time_ns(t)))),
        TimeColumn::new_sequence(STEP, step.iter().map(|&n| signed(n))),
    ]
}

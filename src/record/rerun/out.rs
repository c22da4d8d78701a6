//! Columns and events as chunks of an .rrd.

use super::headline::level;
use super::live::Live;
use super::names::{LOG, SIM_TIME, STEP};
use crate::record::ahead_file::{AheadFile, SkipBytes};
use crate::record::sample::Event;
use crate::record::schema;
use ::rerun::external::re_log_encoding::Encoder;
use ::rerun::log::{Chunk, ChunkId, LogMsg};
use ::rerun::{EntityPath, Scalars, SerializedComponentColumn, StoreId, TextLog, TimeColumn};
use std::error::Error;

/// Result of a write. Rerun's errors come from five crates; all end as the reason of a `RecordError`.
pub type Appended = Result<(), Box<dyn Error>>;

/// Where messages go: into a file, or to a viewer.
pub enum Sink {
    File(Encoder<AheadFile>, AheadFile),
    Viewer(Live),
    /// Into memory, to stand ahead in a file.
    Ahead(Encoder<Vec<u8>>),
}

impl Sink {
    pub fn append(&mut self, message: &LogMsg) -> Appended {
        match self {
            Sink::File(encoder, _) => drop(encoder.append(message)?),
            Sink::Ahead(encoder) => drop(encoder.append(message)?),
            Sink::Viewer(viewer) => viewer.send(message),
        }
        Ok(())
    }

    pub fn flush(&mut self) -> Appended {
        match self {
            Sink::File(encoder, _) => encoder.flush_blocking()?,
            Sink::Ahead(_) => {}
            Sink::Viewer(viewer) => viewer.flush(),
        }
        Ok(())
    }

    /// Bytes that are due and written; 0 of what is no file.
    pub fn whole(&self) -> u64 {
        match self {
            Sink::File(_, file) => file.whole(),
            Sink::Viewer(_) | Sink::Ahead(_) => 0,
        }
    }

    /// The end of a file; a viewer needs none.
    pub fn finish(&mut self) -> Appended {
        if let Sink::File(encoder, _) = self {
            encoder.finish()?;
        }
        self.flush()
    }
}

/// What has been encoded, without the head of a file.
fn without_head(encoder: Encoder<Vec<u8>>) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut bytes = encoder.into_inner()?;
    let head = Encoder::local()?.into_inner()?.len();
    bytes.drain(..head.min(bytes.len()));
    Ok(bytes)
}

/// How readers of a file are made to skip something: by a message that says again what the first one says of the
/// recording, and after that, in a field that no reader knows, what is to be skipped.
///
/// # Errors
/// Rerun's own.
pub fn skip(first: &LogMsg) -> Result<SkipBytes, Box<dyn Error>> {
    /// Kind and length of a message, eight bytes each, and Protobuf's head of field 1000, of a length in five bytes.
    const HEAD: usize = 16;
    const FIELD: [u8; 2] = [0xc2, 0x3e];
    const LENGTH: u64 = 5;
    let mut encoder = Encoder::local()?;
    encoder.do_not_emit_footer();
    encoder.append(first)?;
    let said = without_head(encoder)?;
    let (Some(kind), Some(said)) = (said.get(..HEAD / 2).map(<[u8]>::to_vec), said.get(HEAD..).map(<[u8]>::to_vec))
    else {
        return Err("a message without a head".into());
    };
    Ok(Box::new(move |bytes| {
        let length = said.len() as u64 + FIELD.len() as u64 + LENGTH + bytes;
        // Seven bits each, the lowest first, and in all but the last the mark that more follow.
        let digits = (0..LENGTH).map(|i| (bytes >> (7 * i)) as u8 & 0x7f | if i + 1 < LENGTH { 0x80 } else { 0 });
        let head = kind.iter().copied().chain(length.to_le_bytes()).chain(said.iter().copied());
        head.chain(FIELD).chain(digits).collect()
    }))
}

/// The sink, and the name of the recording in it.
pub struct Out {
    pub store: StoreId,
    pub sink: Sink,
}

impl Out {
    /// Lets all that follows stand ahead in the file, up to `end_ahead`, which takes what is given back; None of what
    /// is no file.
    pub fn begin_ahead(&mut self) -> Result<Option<Sink>, Box<dyn Error>> {
        if !matches!(self.sink, Sink::File(..)) {
            return Ok(None);
        }
        let mut encoder = Encoder::local()?;
        encoder.do_not_emit_footer();
        Ok(Some(std::mem::replace(&mut self.sink, Sink::Ahead(encoder))))
    }

    pub fn end_ahead(&mut self, due: Sink) -> Appended {
        let ahead = std::mem::replace(&mut self.sink, due);
        if let (Sink::Ahead(encoder), Sink::File(_, file)) = (ahead, &self.sink) {
            file.ahead(&without_head(encoder)?)?;
        }
        Ok(())
    }

    /// A batch of one entity: as many rows as there are times.
    pub fn columns(
        &mut self,
        path: EntityPath,
        times: &Times,
        columns: impl Iterator<Item = SerializedComponentColumn>,
    ) -> Appended {
        self.sink.append(&chunk(&self.store, path, times, columns)?)
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

/// A chunk of one entity, with as many rows as there are times.
///
/// # Errors
/// Rerun's own.
pub fn chunk(
    store: &StoreId,
    path: EntityPath,
    times: &Times,
    columns: impl Iterator<Item = SerializedComponentColumn>,
) -> Result<LogMsg, Box<dyn Error>> {
    let timelines = times.iter().map(|column| (*column.timeline().name(), column.clone())).collect();
    let components = columns.map(|column| (column.descriptor, column.list_array)).collect();
    let chunk = Chunk::from_auto_row_ids(ChunkId::new(), path, timelines, components)?;
    Ok(LogMsg::ArrowMsg(store.clone(), chunk.to_arrow_msg()?))
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

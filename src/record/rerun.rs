//! Rerun files (.rrd): the run in the Rerun Viewer, with a layout of its own.
//!
//! The head (layout, surfaces, configuration) goes through Rerun's stream into memory; the columns become chunks here
//! and now, and everything is encoded on the calling thread. Rerun's own file sink writes on a further thread and only
//! logs its errors; here a full disk is an error, and a recording needs no threads.
//!
//! 3-D data is f32 in this format; the plotted numbers are f64.

mod head;
mod layout;
mod names;

use self::names::{BODIES, CONTACT_COUNT, CONTACT_FORCE, CONTACTS, FORCES, LOG, SIM_TIME, STEP, energy_path};
use super::name::RecordingName;
use super::sample::{Batch, Ending, Event, ForceArrows, Header, Severity, Streams, norm};
use super::schema::{self};
use super::{RecordError, Recorder};
use ::rerun::external::re_build_info::CrateVersion;
use ::rerun::external::re_log_encoding::{Encoder, EncodingOptions};
use ::rerun::log::{Chunk, ChunkId, LogMsg};
use ::rerun::{
    Arrows3D, EntityPath, Points3D, Scalars, SerializedComponentColumn, StoreId, TextLog, TextLogLevel, TimeColumn,
    Transform3D,
};
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};

/// Result of a write. Rerun's errors come from five crates; all end as the reason of a `RecordError`.
type Written = Result<(), Box<dyn Error>>;

/// A recording as one .rrd file.
pub struct RerunRecorder {
    path: PathBuf,
    streams: Streams,
    arrows: ForceArrows,
    bodies: Vec<EntityPath>,
    recording_id: String,
    name: RecordingName,
    out: Out,
}

impl RerunRecorder {
    /// A recording in a new file, with its head.
    ///
    /// # Errors
    /// The file cannot be made or written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, RecordError> {
        Self::try_create(path, header).map_err(|error| RecordError::caused(path, error.as_ref()))
    }

    fn try_create(path: &Path, header: &Header) -> Result<Self, Box<dyn Error>> {
        let bodies: Vec<_> = header.bodies.iter().map(|body| body_path(&body.name)).collect();
        let (store, messages) = head::messages(header, &bodies)?;
        let file = BufWriter::new(File::create(path)?);
        let encoder = Encoder::new_eager(CrateVersion::LOCAL, EncodingOptions::PROTOBUF_COMPRESSED, file)?;
        let mut out = Out { store, encoder };
        for message in &messages {
            out.encoder.append(message)?;
        }
        out.encoder.flush_blocking()?;
        Ok(RerunRecorder {
            path: path.to_path_buf(),
            streams: header.streams,
            arrows: header.force_arrows(),
            bodies,
            recording_id: head::recording_id(header),
            name: header.name.clone(),
            out,
        })
    }

    fn batch(&mut self, batch: &Batch) -> Written {
        batch.check(self.streams, self.bodies.len())?;
        if batch.is_empty() {
            return Ok(());
        }
        let times = times(&batch.step, &batch.time_s);
        if self.streams.bodies {
            self.poses(batch, &times)?;
        }
        if self.streams.contacts {
            self.contact_points(batch, &times)?;
        }
        if self.streams.forces {
            self.forces(batch, &times)?;
        }
        if self.streams.energy {
            for series in &schema::ENERGY_SERIES {
                let values = batch.energy.iter().map(series.value);
                self.out.scalars(energy_path(series), &times, values)?;
            }
        }
        Ok(self.out.encoder.flush_blocking()?)
    }

    fn close(&mut self, ending: &Ending) -> Written {
        let encoder = &mut self.out.encoder;
        for message in head::ending(&self.recording_id, &self.name, ending)? {
            encoder.append(&message)?;
        }
        encoder.finish()?;
        Ok(encoder.flush_blocking()?)
    }

    fn poses(&mut self, batch: &Batch, times: &Times) -> Written {
        for (i, path) in self.bodies.iter().enumerate() {
            let states = || batch.bodies.iter().skip(i).step_by(self.bodies.len());
            let poses = Transform3D::update_fields()
                .with_many_translation(states().map(|body| body.position_m))
                .with_many_quaternion(states().map(|body| body.orientation_xyzw.map(|q| q as f32)));
            self.out.columns(path.clone(), times, poses.columns_of_unit_batches()?)?;
        }
        Ok(())
    }

    fn contact_points(&mut self, batch: &Batch, times: &Times) -> Written {
        let points = Points3D::update_fields().with_positions(batch.contacts.iter().map(|contact| contact.point_m));
        self.out.columns(CONTACTS.into(), times, points.columns(lengths(batch))?)?;
        self.out.scalars(CONTACT_COUNT.into(), times, batch.contacts_len.iter().map(|&len| f64::from(len)))
    }

    fn forces(&mut self, batch: &Batch, times: &Times) -> Written {
        let arrows = Arrows3D::update_fields()
            .with_vectors(batch.contacts.iter().map(|contact| self.arrows.vector_m(contact.force_n)))
            .with_origins(batch.contacts.iter().map(|contact| contact.point_m));
        self.out.columns(FORCES.into(), times, arrows.columns(lengths(batch))?)?;
        let sums = batch.samples().map(|sample| sample.contacts.iter().map(|contact| norm(contact.force_n)).sum());
        self.out.scalars(CONTACT_FORCE.into(), times, sums)
    }
}

impl Recorder for RerunRecorder {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError> {
        self.batch(batch).map_err(|error| RecordError::caused(&self.path, error.as_ref()))
    }

    fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.out.event(event).map_err(|error| RecordError::caused(&self.path, error.as_ref()))
    }

    fn finish(mut self: Box<Self>, ending: &Ending) -> Result<(), RecordError> {
        self.close(ending).map_err(|error| RecordError::caused(&self.path, error.as_ref()))
    }
}

/// The file, and the name of the recording in it.
struct Out {
    store: StoreId,
    encoder: Encoder<BufWriter<File>>,
}

impl Out {
    /// A batch of one entity: as many rows as there are times.
    fn columns(
        &mut self,
        path: EntityPath,
        times: &Times,
        columns: impl Iterator<Item = SerializedComponentColumn>,
    ) -> Written {
        let timelines = times.iter().map(|column| (*column.timeline().name(), column.clone())).collect();
        let components = columns.map(|column| (column.descriptor, column.list_array)).collect();
        let chunk = Chunk::from_auto_row_ids(ChunkId::new(), path, timelines, components)?;
        self.encoder.append(&LogMsg::ArrowMsg(self.store.clone(), chunk.to_arrow_msg()?))?;
        Ok(())
    }

    fn scalars(&mut self, path: EntityPath, times: &Times, values: impl Iterator<Item = f64>) -> Written {
        let scalars = Scalars::update_fields().with_scalars(values);
        self.columns(path, times, scalars.columns_of_unit_batches()?)
    }

    fn event(&mut self, event: &Event) -> Written {
        let level = match event.severity {
            Severity::Info => TextLogLevel::INFO,
            Severity::Warning => TextLogLevel::WARN,
        };
        let text = TextLog::update_fields().with_many_text([event.text.as_str()]).with_many_level([level]);
        self.columns(LOG.into(), &times(&[event.step], &[event.time_s]), text.columns_of_unit_batches()?)?;
        Ok(self.encoder.flush_blocking()?)
    }
}

type Times = [TimeColumn; 2];

fn times(step: &[u64], time_s: &[f64]) -> Times {
    // Both timelines are i64; 2⁶³ nanoseconds are 292 years.
    let signed = |n: u64| i64::try_from(n).unwrap_or(i64::MAX);
    [
        TimeColumn::new_duration_nanos(SIM_TIME, time_s.iter().map(|&t| signed(schema::time_ns(t)))),
        TimeColumn::new_sequence(STEP, step.iter().map(|&n| signed(n))),
    ]
}

fn lengths(batch: &Batch) -> impl Iterator<Item = usize> + Clone {
    batch.contacts_len.iter().map(|&len| len as usize)
}

/// A body's name is one part of the path, whatever characters it has.
fn body_path(name: &str) -> EntityPath {
    EntityPath::from(BODIES).join(&EntityPath::from_single_string(name))
}

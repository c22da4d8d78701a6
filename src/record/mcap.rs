//! MCAP files: our own f64 messages at every sample, Foxglove's messages for pictures at display rate.
//!
//! Every batch ends with a complete chunk on disk, so that a kill loses no batch that was written.

use super::ahead_file::AheadFile;
use super::foxglove_layout::{layout, surfaces_as_files};
use super::name::RecordingName;
use super::sample::{Batch, BodyHeader, Ending, EnergySample, Event, Header, Sample, Streams};
use super::scene::{Scene, log, surfaces};
use super::{RecordError, Recorder, schema};
use crate::rows::BodyRow;
use foxglove::Encode;
use mcap::records::{MessageHeader, Metadata, op};
use mcap::{Attachment, Compression, McapResult, WriteOptions};
use prost::Message;
use serde_json::{Value, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Uncompressed size of a chunk, bytes. A quarter of the library's, so that a reader that seeks decodes less.
const CHUNK_BYTES: u64 = 256 * 1024;

/// Zstd's fastest ordinary level; writing at the default level takes a third longer (measured: 4.3 µs a step for 3.2).
const ZSTD_LEVEL: u32 = 1;

/// Pictures in a second of simulated time: no display shows more, and a picture is larger than the numbers.
const DISPLAY_HZ: f64 = 60.0;

/// A recording as one MCAP file.
pub struct McapRecorder {
    path: PathBuf,
    streams: Streams,
    /// Statements of the head, for the end to say again.
    said: BTreeMap<String, String>,
    name: RecordingName,
    out: Out,
    channels: Channels,
    messages: Messages,
    scene: Scene,
    /// Number of the last display interval that had its picture; None before the first.
    shown: Option<u64>,
    /// Time and bodies of the last sample, which a step's contacts act on.
    last: (f64, Vec<BodyRow>),
}

impl McapRecorder {
    /// A recording in a new file, with its head.
    ///
    /// # Errors
    /// The file cannot be made or written.
    pub fn create(path: &Path, header: &Header) -> Result<Self, RecordError> {
        let file = AheadFile::create(path).map_err(|error| RecordError::caused(path, &error))?;
        Self::begin(file, path, header)
    }

    /// The same in a file that is there.
    pub(super) fn begin(file: AheadFile, path: &Path, header: &Header) -> Result<Self, RecordError> {
        Self::try_begin(file, path, header).map_err(|error| RecordError::caused(path, &error))
    }

    fn try_begin(file: AheadFile, path: &Path, header: &Header) -> McapResult<Self> {
        let mut out = Out::new(file, &header.program)?;
        let (files, of_bodies) = surfaces_as_files(header);
        let said = said(header, &of_bodies);
        let channels = out.head(header, &files, &said)?;
        out.send(channels.scene, 0, 0, &surfaces(header))?;
        // What the file opens with does not wait for the heads of other files.
        out.writer.flush()?;
        Ok(McapRecorder {
            path: path.to_path_buf(),
            streams: header.streams,
            said,
            name: header.name.clone(),
            out,
            channels,
            messages: Messages::new(&header.bodies),
            scene: Scene::new(header),
            shown: None,
            last: (f64::NAN, Vec::new()),
        })
    }

    /// Samples and events, each event after the sample of its step.
    fn batch(&mut self, batch: &Batch) -> McapResult<()> {
        let mut events = batch.events.iter().peekable();
        for sample in batch.samples() {
            while let Some(event) = events.next_if(|event| event.step < sample.step) {
                self.log(event)?;
            }
            self.sample(&sample)?;
        }
        events.try_for_each(|event| self.log(event))
    }

    /// A batch as a chunk behind those that are due, its numbers and events without pictures.
    fn batch_ahead(&mut self, batch: &Batch) -> McapResult<()> {
        self.out.ahead = Some(Chunk::default());
        let written = self.batch(batch);
        let chunk = self.out.ahead.take().unwrap_or_default();
        written?;
        Ok(self.out.file.ahead(&chunk.record())?)
    }

    fn log(&mut self, event: &Event) -> McapResult<()> {
        let time_ns = schema::time_ns(event.time_s);
        self.out.send(self.channels.log, time_ns, event.step, &log(event, time_ns))
    }

    fn sample(&mut self, sample: &Sample<'_>) -> McapResult<()> {
        let Self { out, channels, messages, .. } = self;
        let time_ns = schema::time_ns(sample.time_s);
        if let Some(channel) = channels.bodies {
            out.send(channel, time_ns, sample.step, messages.bodies(sample))?;
        }
        if let Some(channel) = channels.contacts {
            out.send(channel, time_ns, sample.step, messages.contacts(sample, self.streams))?;
        }
        if let (Some(channel), Some(energy)) = (channels.energy, sample.energy) {
            out.send(channel, time_ns, sample.step, &Messages::energy(sample, energy))?;
        }
        if self.out.ahead.is_some() {
            return Ok(());
        }
        let picture = (sample.time_s * DISPLAY_HZ) as u64;
        if self.shown.is_none_or(|shown| picture > shown) {
            self.shown = Some(picture);
            self.picture(sample)?;
        }
        self.last.0 = sample.time_s;
        self.last.1.clear();
        self.last.1.extend_from_slice(sample.bodies);
        Ok(())
    }

    /// The bodies where the contacts act on them.
    fn picture(&mut self, sample: &Sample<'_>) -> McapResult<()> {
        let (time_s, bodies) = match sample.acted {
            [] if sample.acted_s == self.last.0 && !sample.contacts.is_empty() => (sample.acted_s, &self.last.1[..]),
            [] => (sample.time_s, sample.bodies),
            acted => (sample.acted_s, acted),
        };
        let time_ns = schema::time_ns(time_s);
        if let Some(channel) = self.channels.transforms {
            self.out.send(channel, time_ns, sample.step, self.scene.transforms(bodies, time_ns))?;
        }
        if let Some(channel) = self.channels.scene_contacts
            && let Some(update) = self.scene.contacts(sample, time_ns)
        {
            self.out.send(channel, time_ns, sample.step, update)?;
        }
        Ok(())
    }
}

impl Recorder for McapRecorder {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError> {
        let bodies = self.messages.bodies.bodies.len();
        batch.check(self.streams, bodies).map_err(|reason| RecordError::new(&self.path, reason))?;
        let written = self.batch(batch).and_then(|()| self.out.writer.flush());
        written.map_err(|error| RecordError::caused(&self.path, &error))
    }

    fn ahead(&mut self, batch: &Batch) -> Result<(), RecordError> {
        // Before the first chunk no reader would know the channels. What finds no room is written later, or fails then.
        if !batch.is_empty() && self.shown.is_some() {
            let _ = self.batch_ahead(batch);
        }
        Ok(())
    }

    fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.log(event).and_then(|()| self.out.writer.flush()).map_err(|error| RecordError::caused(&self.path, &error))
    }

    fn bytes(&self) -> u64 {
        self.out.file.whole()
    }

    fn finish(self: Box<Self>, ending: &Ending) -> Result<(), RecordError> {
        let McapRecorder { path, mut out, mut said, name, .. } = *self;
        said.extend(ended(&name, ending));
        let end = Metadata { name: schema::METADATA.to_owned(), metadata: said };
        // JSON of numbers and texts cannot fail.
        let json = serde_json::to_string(ending).unwrap_or_default();
        let whole = [(schema::ENDING_JSON.to_owned(), json)].into();
        let whole = Metadata { name: schema::ENDING.to_owned(), metadata: whole };
        let written = out.writer.write_metadata(&whole).and_then(|()| out.writer.write_metadata(&end));
        let closed = written.and_then(|()| close(out.writer));
        closed.map_err(|error| RecordError::caused(&path, &error))
    }
}

/// Dropping a writer would swallow its errors.
fn close(mut writer: mcap::Writer<AheadFile>) -> McapResult<()> {
    writer.finish()?;
    Ok(writer.into_inner().flush()?)
}

/// The file and the buffer that messages are encoded in.
struct Out {
    writer: mcap::Writer<AheadFile>,
    file: AheadFile,
    buffer: Vec<u8>,
    /// Where messages go while they are written ahead.
    ahead: Option<Chunk>,
}

/// Messages as a chunk without compression, which is gone soon.
#[derive(Default)]
struct Chunk {
    messages: Vec<u8>,
    times_ns: Option<(u64, u64)>,
}

impl Chunk {
    fn add(&mut self, header: &MessageHeader, data: &[u8]) {
        const HEADER_BYTES: u64 = 2 + 4 + 8 + 8;
        let to = &mut self.messages;
        to.push(op::MESSAGE);
        to.extend_from_slice(&(HEADER_BYTES + data.len() as u64).to_le_bytes());
        to.extend_from_slice(&header.channel_id.to_le_bytes());
        to.extend_from_slice(&header.sequence.to_le_bytes());
        to.extend_from_slice(&header.log_time.to_le_bytes());
        to.extend_from_slice(&header.publish_time.to_le_bytes());
        to.extend_from_slice(data);
        let (least, most) = self.times_ns.unwrap_or((u64::MAX, 0));
        self.times_ns = Some((least.min(header.log_time), most.max(header.log_time)));
    }

    /// The record of the format: times, length, no checksum, no compression, length again, messages.
    fn record(&self) -> Vec<u8> {
        const HEADER_BYTES: usize = 8 + 8 + 8 + 4 + 4 + 8;
        let len = self.messages.len() as u64;
        let (first_ns, last_ns) = self.times_ns.unwrap_or_default();
        let mut record = Vec::with_capacity(9 + HEADER_BYTES + self.messages.len());
        record.push(op::CHUNK);
        record.extend_from_slice(&(HEADER_BYTES as u64 + len).to_le_bytes());
        for number in [first_ns, last_ns, len] {
            record.extend_from_slice(&number.to_le_bytes());
        }
        record.extend_from_slice(&[0; 8]);
        record.extend_from_slice(&len.to_le_bytes());
        record.extend_from_slice(&self.messages);
        record
    }
}

/// The head of a record of so many bytes of a kind that applications may use, and that readers skip.
fn room(bytes: u64) -> Vec<u8> {
    const PRIVATE: u8 = 0x80;
    std::iter::once(PRIVATE).chain(bytes.to_le_bytes()).collect()
}

/// Channel of each topic; None where its stream is off.
struct Channels {
    bodies: Option<u16>,
    contacts: Option<u16>,
    energy: Option<u16>,
    transforms: Option<u16>,
    scene: u16,
    scene_contacts: Option<u16>,
    log: u16,
}

impl Out {
    fn new(file: AheadFile, program: &str) -> McapResult<Self> {
        file.skip_by(Box::new(room));
        let writer = WriteOptions::new()
            .library(program)
            .compression(Some(Compression::Zstd))
            .compression_level(ZSTD_LEVEL)
            // No threads beside the recording thread: in a sweep, the other cores have cases of their own.
            .compression_threads(0)
            .chunk_size(Some(CHUNK_BYTES))
            .create(file.clone())?;
        Ok(Out { writer, file, buffer: Vec::new(), ahead: None })
    }

    /// Configuration, versions and channels, before the first sample.
    fn head(
        &mut self,
        header: &Header,
        surfaces: &[(String, String)],
        said: &BTreeMap<String, String>,
    ) -> McapResult<Channels> {
        self.attach(schema::CONFIG_FILE, "application/yaml", header.config_yaml.as_bytes())?;
        self.attach(schema::LAYOUT_FILE, "application/json", layout(header.streams, header).as_bytes())?;
        for (name, surface) in surfaces {
            self.attach(name, "model/obj", surface.as_bytes())?;
        }
        let start = Metadata { name: schema::METADATA_START.to_owned(), metadata: said.clone() };
        self.writer.write_metadata(&start)?;

        let streams = header.streams;
        let own = schema::descriptor_set();
        let mut own_channel = |on: bool, topic: &str, name: &str| -> McapResult<Option<u16>> {
            on.then(|| {
                let id = self.writer.add_schema(&format!("gotai.{name}"), "protobuf", &own)?;
                self.writer.add_channel(id, topic, "protobuf", &BTreeMap::new())
            })
            .transpose()
        };
        let contacts_topic = if streams.contacts { schema::CONTACTS } else { schema::FORCES };
        let bodies = own_channel(streams.bodies, schema::BODIES, "Bodies")?;
        let contacts = own_channel(streams.any_contact(), contacts_topic, "Contacts")?;
        let energy = own_channel(streams.energy, schema::ENERGY, "Energy")?;

        use foxglove::messages::{FrameTransforms, Log, SceneUpdate};
        let transforms =
            streams.bodies.then(|| self.foxglove_channel::<FrameTransforms>(schema::TRANSFORMS)).transpose()?;
        let scene_contacts =
            streams.any_contact().then(|| self.foxglove_channel::<SceneUpdate>(schema::SCENE_CONTACTS)).transpose()?;
        let scene = self.foxglove_channel::<SceneUpdate>(schema::SCENE)?;
        let log = self.foxglove_channel::<Log>(schema::LOG)?;
        Ok(Channels { bodies, contacts, energy, transforms, scene, scene_contacts, log })
    }

    fn attach(&mut self, name: &str, media_type: &str, data: &[u8]) -> McapResult<()> {
        self.writer.attach(&Attachment {
            log_time: 0,
            // A file depends on its run alone, not on the hour.
            create_time: 0,
            name: name.to_owned(),
            media_type: media_type.to_owned(),
            data: Cow::Borrowed(data),
        })
    }

    fn foxglove_channel<T: Encode>(&mut self, topic: &str) -> McapResult<u16> {
        let id = match T::get_schema() {
            Some(schema) => self.writer.add_schema(&schema.name, &schema.encoding, &schema.data)?,
            // The format's number for "no schema".
            None => 0,
        };
        self.writer.add_channel(id, topic, &T::get_message_encoding(), &BTreeMap::new())
    }

    fn send(&mut self, channel_id: u16, time_ns: u64, step: u64, message: &impl Message) -> McapResult<()> {
        self.buffer.clear();
        // Encoding into a growing buffer cannot fail.
        message.encode_raw(&mut self.buffer);
        // The format's number has 32 bits; the messages hold all 64.
        let header = MessageHeader { channel_id, sequence: step as u32, log_time: time_ns, publish_time: time_ns };
        match &mut self.ahead {
            Some(chunk) => {
                chunk.add(&header, &self.buffer);
                Ok(())
            }
            None => self.writer.write_to_known_channel(&header, &self.buffer),
        }
    }
}

/// Statements from the start: case, axes by their paths, program.
fn said(header: &Header, surfaces: &BTreeMap<String, String>) -> BTreeMap<String, String> {
    let axes = header.axes.iter().map(|(path, value)| (path.as_str(), schema::text(value)));
    let known = [
        ("case", header.case.clone()),
        ("title", header.title.clone()),
        ("schema", schema::VERSION.to_owned()),
        (schema::AXES, Value::from(header.axes.iter().map(|(path, _)| path.as_str()).collect::<Vec<_>>()).to_string()),
        ("question", header.question.clone()),
        (schema::MESHES, json!(surfaces).to_string()),
        ("method", header.method.clone()),
        ("time", "simulated, from zero".to_owned()),
        ("up", "y in the frame world, z in the frame root".to_owned()),
        ("program", header.program.clone()),
        ("build", header.build.clone()),
        ("sample_every_s", header.sample_every_s.to_string()),
    ];
    let step = header.step_s.map(|step_s| ("step_s", step_s.to_string()));
    known.into_iter().chain(step).chain(axes).map(|(key, value)| (key.to_owned(), value)).collect()
}

/// Statements that the end adds.
fn ended(name: &RecordingName, ending: &Ending) -> impl Iterator<Item = (String, String)> {
    let row = ending.row.iter().map(|(column, cell)| (column.as_str(), schema::text(cell)));
    let texts = ending.texts().map(|(field, text)| (field, text.to_owned()));
    let known = [
        ("name", name.ended(ending.outcome)),
        ("outcome", ending.outcome.name().to_owned()),
        ("end_time_s", ending.end_time_s.to_string()),
        ("steps", ending.steps.to_string()),
        ("calm_until_s", ending.story.calm_until_s.to_string()),
        ("left_out", ending.left_out.to_string()),
        ("stretch_s", format!("{} {}", ending.story.stretch_s[0], ending.story.stretch_s[1])),
    ];
    row.chain(known).chain(texts).map(|(key, value)| (key.to_owned(), value))
}

/// Messages that are filled again for every sample; their memory and the bodies' names stay.
struct Messages {
    bodies: schema::Bodies,
    contacts: schema::Contacts,
}

impl Messages {
    fn new(headers: &[BodyHeader]) -> Self {
        let state = |body: &BodyHeader| schema::BodyState { name: body.name.clone(), ..Default::default() };
        Messages {
            bodies: schema::Bodies { bodies: headers.iter().map(state).collect(), ..Default::default() },
            contacts: schema::Contacts::default(),
        }
    }

    fn bodies(&mut self, sample: &Sample<'_>) -> &schema::Bodies {
        let message = &mut self.bodies;
        (message.time_s, message.step) = (sample.time_s, sample.step);
        for (state, body) in message.bodies.iter_mut().zip(sample.bodies) {
            set(&mut state.position_m, &body.position_m);
            set(&mut state.orientation_xyzw, &body.orientation_xyzw);
            set(&mut state.velocity_m_s, &body.velocity_m_s);
            set(&mut state.angular_velocity_rad_s, &body.angular_velocity_rad_s);
        }
        message
    }

    fn contacts(&mut self, sample: &Sample<'_>, streams: Streams) -> &schema::Contacts {
        let message = &mut self.contacts;
        let bodies = &self.bodies.bodies;
        let name = |body: u32| bodies.get(body as usize).map_or("", |state| &state.name);
        (message.time_s, message.step) = (sample.time_s, sample.step);
        message.acted_s = sample.acted_s;
        message.count = sample.contacts.len() as u64;
        message.acted.resize_with(sample.acted.len(), schema::BodyPose::default);
        for (to, from) in message.acted.iter_mut().zip(sample.acted) {
            set(&mut to.position_m, &from.position_m);
            set(&mut to.orientation_xyzw, &from.orientation_xyzw);
        }
        message.contacts.resize_with(sample.contacts.len(), schema::Contact::default);
        for (to, from) in message.contacts.iter_mut().zip(sample.contacts) {
            name(from.body).clone_into(&mut to.body);
            from.other.map_or(schema::CONTAINER, name).clone_into(&mut to.other);
            set(&mut to.point_m, &from.point_m);
            set(&mut to.normal, if streams.contacts { &from.normal } else { &[] });
            set(&mut to.force_n, if streams.forces { &from.force_n } else { &[] });
            to.gap_m = if streams.contacts { from.gap_m } else { f64::NAN };
            to.friction_use = if streams.forces { from.friction_use } else { f64::NAN };
            if streams.forces { from.mode.name() } else { "" }.clone_into(&mut to.mode);
        }
        message
    }

    fn energy(sample: &Sample<'_>, energy: &EnergySample) -> schema::Energy {
        schema::Energy {
            time_s: sample.time_s,
            step: sample.step,
            kinetic_j: energy.kinetic_j,
            potential_j: energy.potential_j,
            total_j: energy.total_j,
            penetration_m: energy.penetration_m,
        }
    }
}

fn set(array: &mut Vec<f64>, values: &[f64]) {
    array.clear();
    array.extend_from_slice(values);
}

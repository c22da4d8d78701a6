//! Reader of recordings: what an .mcap of ours says of itself, and its samples.

use super::sample::{Batch, ContactMode, ContactSample, Ending, EnergySample, Event, Severity};
use super::schema;
use crate::files::{self, FileError};
use crate::rows::BodyRow;
use foxglove::messages::Log;
use foxglove::messages::log::Level;
use mcap::MessageStream;
use mcap::read::{LinearReader, Options};
use mcap::records::Record;
use prost::Message;
use std::collections::BTreeMap;
use std::path::Path;

/// A recording that has been read back.
#[derive(Clone, Debug, Default)]
pub struct ReadBack {
    /// What the recording says of itself; of a torn one, what its head says.
    pub said: BTreeMap<String, String>,
    /// The experiment, as YAML.
    pub experiment: String,
    /// How the run ended; None of a torn recording, and of one by an older version.
    pub ending: Option<Ending>,
    /// Names of the bodies, in the order of their states.
    pub bodies: Vec<String>,
    /// Samples in the order of time, and events. Streams that were not recorded are empty.
    pub samples: Batch,
    /// Whether the file lacks its end, or a part of it cannot be read.
    pub is_cut: bool,
}

impl ReadBack {
    /// Time of the last sample or event.
    pub fn until_s(&self) -> Option<f64> {
        let events = self.samples.events.iter().map(|event| event.time_s);
        self.samples.time_s.iter().copied().chain(events).reduce(f64::max)
    }
}

/// The experiment that an .mcap of ours shows, as YAML, of a torn file too; None where there is none in it.
///
/// # Errors
/// The file cannot be read.
pub fn experiment_of(path: &Path) -> Result<Option<String>, FileError> {
    let bytes = files::read(path)?;
    Ok(about(&bytes).map(|about| about.experiment))
}

/// A recording of ours with its samples, of a torn file as many as are whole; None where it is none.
///
/// # Errors
/// The file cannot be read.
pub fn recording_of(path: &Path) -> Result<Option<ReadBack>, FileError> {
    let bytes = files::read(path)?;
    let Some(about) = about(&bytes) else { return Ok(None) };
    let Some(found) = Found::in_file(&bytes) else { return Ok(None) };
    Ok(Some(found.read_back(about)))
}

/// What a file says before and after its samples.
struct About {
    experiment: String,
    said: BTreeMap<String, String>,
    ending: Option<String>,
}

/// The experiment in a file, and what it says of itself.
fn about(bytes: &[u8]) -> Option<About> {
    let reader = LinearReader::new_with_options(bytes, Options::IgnoreEndMagic.into()).ok()?;
    let (mut experiment, mut said, mut ending) = (None, BTreeMap::new(), None);
    for record in reader.map_while(Result::ok) {
        match record {
            Record::Attachment { header, data, .. } if header.name == schema::CONFIG_FILE => {
                experiment = String::from_utf8(data.into_owned()).ok();
            }
            Record::Metadata(mut metadata) if metadata.name == schema::ENDING => {
                ending = metadata.metadata.remove(schema::ENDING_JSON);
            }
            Record::Metadata(metadata) if [schema::METADATA_START, schema::METADATA].contains(&&*metadata.name) => {
                said.extend(metadata.metadata);
            }
            _ => {}
        }
    }
    Some(About { experiment: experiment?, said, ending })
}

/// Messages of a file, by topic, in the order of the file.
#[derive(Default)]
struct Found {
    bodies: Vec<schema::Bodies>,
    contacts: Vec<schema::Contacts>,
    energies: Vec<schema::Energy>,
    events: Vec<Event>,
    is_cut: bool,
}

impl Found {
    fn in_file(bytes: &[u8]) -> Option<Found> {
        let mut found = Found { is_cut: !bytes.ends_with(mcap::MAGIC), ..Found::default() };
        let stream = MessageStream::new_with_options(bytes, Options::IgnoreEndMagic.into()).ok()?;
        // A file that ends early gives its complete chunks, then one error.
        for message in stream {
            let Ok(message) = message else {
                found.is_cut = true;
                break;
            };
            let data = &message.data[..];
            match message.channel.topic.as_str() {
                schema::BODIES => found.bodies.extend(schema::Bodies::decode(data).ok()),
                schema::CONTACTS | schema::FORCES => found.contacts.extend(schema::Contacts::decode(data).ok()),
                schema::ENERGY => found.energies.extend(schema::Energy::decode(data).ok()),
                schema::LOG => found.events.extend(Log::decode(data).ok().map(|log| event(&log, message.sequence))),
                _ => {}
            }
        }
        Some(found)
    }

    fn read_back(self, About { experiment, said, ending }: About) -> ReadBack {
        let names = |first: &schema::Bodies| first.bodies.iter().map(|body| body.name.clone()).collect();
        let bodies: Vec<String> = self.bodies.first().map(names).unwrap_or_default();
        // Each stream that is there has a message a sample; a torn file may lack the last of one.
        let lengths = [self.bodies.len(), self.contacts.len(), self.energies.len()];
        let samples = lengths.into_iter().filter(|len| *len > 0).min().unwrap_or(0);
        let clock = |i: usize| {
            let of_bodies = self.bodies.get(i).map(|message| (message.time_s, message.step));
            let of_contacts = self.contacts.get(i).map(|message| (message.time_s, message.step));
            of_bodies.or(of_contacts).or(self.energies.get(i).map(|message| (message.time_s, message.step)))
        };
        let mut order: Vec<(f64, u64, usize)> =
            (0..samples).filter_map(|i| clock(i).map(|(time_s, step)| (time_s, step, i))).collect();
        // Steps that turned out to decide stand behind those that came later.
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let is_older = said.get("schema").and_then(|text| text.parse::<u32>().ok()).is_some_and(|version| version < 3);
        let mut batch = Batch { events: self.events, ..Batch::default() };
        for (time_s, step, i) in order {
            batch.time_s.push(time_s);
            batch.step.push(step);
            batch.bodies.extend(self.bodies.get(i).into_iter().flat_map(|message| &message.bodies).map(body_row));
            if let Some(message) = self.contacts.get(i) {
                batch.contacts_len.push(message.contacts.len() as u32);
                batch.contacts.extend(message.contacts.iter().map(|contact| contact_sample(contact, &bodies)));
                // Of an older version nothing is known but the sample.
                let acted_s = if is_older { time_s } else { message.acted_s };
                batch.acted_s.push(acted_s);
                batch.acted_len.push(message.acted.len() as u32);
                batch.acted.extend(message.acted.iter().map(|pose| BodyRow {
                    position_m: numbers(&pose.position_m),
                    orientation_xyzw: numbers(&pose.orientation_xyzw),
                    ..BodyRow::default()
                }));
            }
            batch.energy.extend(self.energies.get(i).map(|message| EnergySample {
                kinetic_j: message.kinetic_j,
                potential_j: message.potential_j,
                total_j: message.total_j,
                penetration_m: message.penetration_m,
            }));
        }
        let ending = ending.and_then(|json| serde_json::from_str(&json).ok());
        ReadBack { said, experiment, ending, bodies, samples: batch, is_cut: self.is_cut }
    }
}

fn body_row(body: &schema::BodyState) -> BodyRow {
    BodyRow {
        position_m: numbers(&body.position_m),
        orientation_xyzw: numbers(&body.orientation_xyzw),
        velocity_m_s: numbers(&body.velocity_m_s),
        angular_velocity_rad_s: numbers(&body.angular_velocity_rad_s),
    }
}

fn contact_sample(contact: &schema::Contact, bodies: &[String]) -> ContactSample {
    let index = |name: &str| bodies.iter().position(|body| body == name).map(|i| i as u32);
    let mode = ContactMode::ALL.into_iter().find(|mode| mode.name() == contact.mode).unwrap_or_default();
    ContactSample {
        body: index(&contact.body).unwrap_or(0),
        other: index(&contact.other),
        point_m: numbers(&contact.point_m),
        normal: numbers(&contact.normal),
        force_n: numbers(&contact.force_n),
        gap_m: contact.gap_m,
        friction_use: contact.friction_use,
        mode,
    }
}

/// Numbers of a vector; not numbers where there are none.
fn numbers<const N: usize>(values: &[f64]) -> [f64; N] {
    std::array::from_fn(|i| values.get(i).copied().unwrap_or(f64::NAN))
}

fn event(log: &Log, sequence: u32) -> Event {
    let severity = match Level::try_from(log.level) {
        Ok(Level::Warning) => Severity::Warning,
        Ok(Level::Error | Level::Fatal) => Severity::Error,
        _ => Severity::Info,
    };
    let time_s = log.timestamp.map_or(0.0, |at| f64::from(at.sec()) + 1e-9 * f64::from(at.nsec()));
    Event { step: u64::from(sequence), time_s, severity, text: log.message.clone() }
}

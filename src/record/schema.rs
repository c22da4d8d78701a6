//! Names of a recording, once for every file format: topics, message types, fields with units, colours.
//!
//! Numbers are f64 in SI units, world frame. Own messages are protobuf (package `gotai`), written by hand together with
//! the descriptors that a reader needs. Vectors are arrays, which are shorter on the wire than a nested x, y, z. A
//! field that is `required` here is optional in the descriptor: it is always on the wire, so that -0.0 keeps its sign.

use super::sample::{ContactMode, EnergySample};
use prost::Message;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet};
use serde_json::Value;

/// Topics of every sample: `gotai.Bodies`, `gotai.Contacts`, `gotai.Energy`.
pub const BODIES: &str = "/bodies";
pub const CONTACTS: &str = "/contacts";
/// Topic of `gotai.Contacts` without normals and gaps, when forces are recorded and contacts are not.
pub const FORCES: &str = "/forces";
pub const ENERGY: &str = "/energy";
/// Topic at display rate: `foxglove.FrameTransforms`.
pub const TRANSFORMS: &str = "/tf";
/// Topic of one message: surfaces and container as `foxglove.SceneUpdate`.
pub const SCENE: &str = "/scene";
/// Topic at display rate: contact points and force arrows as `foxglove.SceneUpdate`. It is one of its own, because a
/// viewer that seeks reads the last message of each topic, and the surfaces must still be there.
pub const SCENE_CONTACTS: &str = "/scene/contacts";
/// Topic of events: `foxglove.Log`.
pub const LOG: &str = "/log";

/// Version of what stands in a recording and what it is called; it rises when either changes.
pub const VERSION: &str = "4";

/// Version of Rerun that .rrd files are of; a viewer of the same or a later one shows them.
pub const RERUN_VERSION: &str = "0.36.3";

/// Most contacts of a sample that an .rrd draws, those with the largest forces: more make a file that no viewer opens
/// at once. All are counted, and all are in an .mcap.
pub const MOST_CONTACTS: usize = 1_000;

/// Title of the page of a recording whose run has no end in it.
pub const NOT_FINISHED: &str = "Not finished";
/// Name of the view of the page that a recording opens with.
pub const PAGE: &str = "what happened";

/// Most cases that are shown together: as many as have colours apart from each other.
pub const MOST_TOGETHER: usize = 12;

/// Key of the list of axes among what a recording says of itself, as JSON.
pub const AXES: &str = "axes";

/// Name of the configuration attached to a recording.
pub const CONFIG_FILE: &str = "experiment.yaml";
/// Name of the record of case, axes, program and step, at the start; and of the same with name and outcome, at the end.
pub const METADATA_START: &str = "gotai.start";
pub const METADATA: &str = "gotai";
/// Name of the record of the end as JSON: the instants that decide, the row, the contacts of the largest gain.
pub const ENDING: &str = "gotai.ending";
/// Key of the JSON in it.
pub const ENDING_JSON: &str = "json";
/// Folder of the bodies' surfaces among the attachments, and key of which is whose, as JSON.
pub const MESHES: &str = "meshes";
/// Name of Foxglove's layout, among the attachments and beside the recordings.
pub const LAYOUT_FILE: &str = "gotai.foxglove-layout.json";

/// Text of a value on an axis: text as it is, everything else as JSON.
pub fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// A value on an axis for people: of a word with settings the word and the settings, e.g. `lecture sweeps=50`.
pub fn label(value: &Value) -> String {
    match value {
        Value::Object(map) => {
            let parts = map.iter().map(|(key, value)| match value {
                Value::Object(settings) => {
                    let settings = settings.iter().map(|(key, value)| format!(" {key}={}", label(value)));
                    format!("{key}{}", settings.collect::<String>())
                }
                value => format!("{key}={}", label(value)),
            });
            parts.collect::<Vec<_>>().join(" ")
        }
        value => text(value),
    }
}

/// The frame that everything is in, and what `other` says for a contact with the container.
pub const WORLD: &str = "world";
/// The frame that the world stands upright in for viewers whose z is up.
pub const ROOT: &str = "root";
pub const CONTAINER: &str = "container";

/// A colour: red, green, blue, of 255.
pub type Rgb = [u8; 3];

/// Colours of the bodies in turn: Tableau's ten, without the grey and the red that container and forces have.
pub const BODY_COLOURS: [Rgb; 8] = [
    [78, 121, 167],
    [242, 142, 43],
    [89, 161, 79],
    [176, 122, 161],
    [118, 183, 178],
    [237, 201, 72],
    [255, 157, 167],
    [156, 117, 95],
];
pub const CONTAINER_COLOUR: Rgb = [150, 150, 160];
/// Colour of a contact by what it does, and the word for it.
pub fn mode_colour(mode: ContactMode) -> Rgb {
    match mode {
        ContactMode::Open => [190, 190, 198],
        ContactMode::Sticking => [90, 220, 130],
        ContactMode::Sliding => [255, 214, 70],
        ContactMode::Unsolved => [255, 70, 220],
    }
}

pub fn mode_word(mode: ContactMode) -> &'static str {
    match mode {
        ContactMode::Open => "grey",
        ContactMode::Sticking => "green",
        ContactMode::Sliding => "yellow",
        ContactMode::Unsolved => "magenta",
    }
}

pub const FORCE_COLOUR: Rgb = [225, 87, 89];

/// A number of every sample that a viewer plots.
pub struct Series {
    pub name: &'static str,
    pub colour: Rgb,
    pub value: fn(&EnergySample) -> f64,
}

impl Series {
    /// Whether it is a length; else it is an energy.
    pub fn is_length(&self) -> bool {
        self.name == "penetration"
    }
}

/// Series of the energy stream, field by field.
pub const ENERGY_SERIES: [Series; 4] = [
    Series { name: "kinetic", colour: [242, 142, 43], value: |e| e.kinetic_j },
    Series { name: "potential", colour: [78, 121, 167], value: |e| e.potential_j },
    Series { name: "total", colour: [170, 170, 180], value: |e| e.total_j },
    Series { name: "penetration", colour: [225, 87, 89], value: |e| e.penetration_m },
];

/// Simulated time in nanoseconds, the clock of both file formats. What a clock cannot show (negative, not a number)
/// becomes 0; the f64 beside it is exact.
pub fn time_ns(time_s: f64) -> u64 {
    (time_s * 1e9).round() as u64
}

/// All bodies at one time.
#[derive(Clone, PartialEq, Message)]
pub struct Bodies {
    #[prost(double, required, tag = "1")]
    pub time_s: f64,
    #[prost(uint64, required, tag = "2")]
    pub step: u64,
    #[prost(message, repeated, tag = "3")]
    pub bodies: Vec<BodyState>,
}

/// State of a body at its centre of mass; the orientation turns body axes into world axes.
#[derive(Clone, PartialEq, Message)]
pub struct BodyState {
    #[prost(string, required, tag = "1")]
    pub name: String,
    #[prost(double, repeated, tag = "2")]
    pub position_m: Vec<f64>,
    #[prost(double, repeated, tag = "3")]
    pub orientation_xyzw: Vec<f64>,
    #[prost(double, repeated, tag = "4")]
    pub velocity_m_s: Vec<f64>,
    #[prost(double, repeated, tag = "5")]
    pub angular_velocity_rad_s: Vec<f64>,
}

/// All contacts of the step that led to one time.
#[derive(Clone, PartialEq, Message)]
pub struct Contacts {
    #[prost(double, required, tag = "1")]
    pub time_s: f64,
    #[prost(uint64, required, tag = "2")]
    pub step: u64,
    #[prost(message, repeated, tag = "3")]
    pub contacts: Vec<Contact>,
    /// Instant at which they act: points, normals and gaps are those of the bodies then.
    #[prost(double, required, tag = "4")]
    pub acted_s: f64,
    /// Bodies at that instant, in the order of `/bodies`; empty where a sample of that time shows them.
    #[prost(message, repeated, tag = "5")]
    pub acted: Vec<BodyPose>,
    /// Number of the contacts, which every reader can plot.
    #[prost(uint64, required, tag = "6")]
    pub count: u64,
}

/// Place of a body, without its name.
#[derive(Clone, PartialEq, Message)]
pub struct BodyPose {
    #[prost(double, repeated, tag = "1")]
    pub position_m: Vec<f64>,
    #[prost(double, repeated, tag = "2")]
    pub orientation_xyzw: Vec<f64>,
}

/// A contact. The normal points from the other to the body; the force (impulse over the step) acts on the body.
#[derive(Clone, PartialEq, Message)]
pub struct Contact {
    #[prost(string, required, tag = "1")]
    pub body: String,
    /// Name of the other body, or `container`.
    #[prost(string, required, tag = "2")]
    pub other: String,
    #[prost(double, repeated, tag = "3")]
    pub point_m: Vec<f64>,
    /// Unit normal; empty on `/forces`.
    #[prost(double, repeated, tag = "4")]
    pub normal: Vec<f64>,
    /// Force; empty when forces are not recorded.
    #[prost(double, repeated, tag = "5")]
    pub force_n: Vec<f64>,
    /// Gap; negative where there is penetration, not a number on `/forces`.
    #[prost(double, required, tag = "6")]
    pub gap_m: f64,
    /// |f_t| / μ f_n; not a number when forces are not recorded.
    #[prost(double, required, tag = "7")]
    pub friction_use: f64,
    /// `open`, `sticking`, `sliding` or `unsolved`; empty when forces are not recorded.
    #[prost(string, required, tag = "8")]
    pub mode: String,
}

/// Energies and deepest penetration at one time.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Energy {
    #[prost(double, required, tag = "1")]
    pub time_s: f64,
    #[prost(uint64, required, tag = "2")]
    pub step: u64,
    #[prost(double, required, tag = "3")]
    pub kinetic_j: f64,
    #[prost(double, required, tag = "4")]
    pub potential_j: f64,
    #[prost(double, required, tag = "5")]
    pub total_j: f64,
    #[prost(double, required, tag = "6")]
    pub penetration_m: f64,
}

/// The encoded `FileDescriptorSet` of the messages above: what readers decode them with.
pub fn descriptor_set() -> Vec<u8> {
    let clock = [("time_s", F64), ("step", U64)];
    let file = FileDescriptorProto {
        name: Some("gotai.proto".to_owned()),
        package: Some("gotai".to_owned()),
        syntax: Some("proto3".to_owned()),
        message_type: vec![
            message("Bodies", &[&clock[..], &[("bodies", Kind::Messages(".gotai.BodyState"))]].concat()),
            message(
                "BodyState",
                &[
                    ("name", TEXT),
                    ("position_m", Kind::Array),
                    ("orientation_xyzw", Kind::Array),
                    ("velocity_m_s", Kind::Array),
                    ("angular_velocity_rad_s", Kind::Array),
                ],
            ),
            message(
                "Contacts",
                &[
                    &clock[..],
                    &[
                        ("contacts", Kind::Messages(".gotai.Contact")),
                        ("acted_s", F64),
                        ("acted", Kind::Messages(".gotai.BodyPose")),
                        ("count", U64),
                    ],
                ]
                .concat(),
            ),
            message("BodyPose", &[("position_m", Kind::Array), ("orientation_xyzw", Kind::Array)]),
            message(
                "Contact",
                &[
                    ("body", TEXT),
                    ("other", TEXT),
                    ("point_m", Kind::Array),
                    ("normal", Kind::Array),
                    ("force_n", Kind::Array),
                    ("gap_m", F64),
                    ("friction_use", F64),
                    ("mode", TEXT),
                ],
            ),
            message(
                "Energy",
                &[&clock[..], &[("kinetic_j", F64), ("potential_j", F64), ("total_j", F64), ("penetration_m", F64)]]
                    .concat(),
            ),
        ],
        ..Default::default()
    };
    FileDescriptorSet { file: vec![file] }.encode_to_vec()
}

/// Type of a field: a scalar, an array of doubles, messages.
#[derive(Clone, Copy)]
enum Kind {
    Scalar(Type),
    Array,
    Messages(&'static str),
}

const F64: Kind = Kind::Scalar(Type::Double);
const U64: Kind = Kind::Scalar(Type::Uint64);
const TEXT: Kind = Kind::Scalar(Type::String);

/// Fields are numbered from 1 in the order given, as the tags above are.
fn message(name: &str, fields: &[(&str, Kind)]) -> DescriptorProto {
    let field = fields.iter().zip(1..).map(|(&(name, kind), number)| {
        let (label, r#type, type_name) = match kind {
            Kind::Scalar(scalar) => (Label::Optional, scalar, None),
            Kind::Array => (Label::Repeated, Type::Double, None),
            Kind::Messages(message) => (Label::Repeated, Type::Message, Some(message)),
        };
        FieldDescriptorProto {
            name: Some(name.to_owned()),
            number: Some(number),
            label: Some(label.into()),
            r#type: Some(r#type.into()),
            type_name: type_name.map(str::to_owned),
            ..Default::default()
        }
    });
    DescriptorProto { name: Some(name.to_owned()), field: field.collect(), ..Default::default() }
}

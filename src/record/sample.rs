//! Data that a run shows its recorders: a `Header` once, then `Batch`es of samples in columns.
//!
//! Columns, because both file formats are written fastest a thousand samples at a time. A batch is filled by the
//! simulating thread, sent to the recording thread and comes back empty to be filled again. Columns of a stream that is
//! off stay empty. Nothing here knows a file format or a method.

use super::flight::Flight;
use super::name::RecordingName;
use super::story::Story;
use crate::outcome::Outcome;
use crate::rows::BodyRow;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Choice of streams that are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Streams {
    pub bodies: bool,
    pub contacts: bool,
    pub forces: bool,
    pub energy: bool,
    /// Arrows of velocities, where bodies are on.
    pub velocities: bool,
}

impl Streams {
    /// Whether a batch carries contacts: forces need them too, for where and on whom they act.
    pub fn any_contact(self) -> bool {
        self.contacts || self.forces
    }
}

/// Constants of a run; written once, at the head of a recording.
#[derive(Clone, Debug)]
pub struct Header {
    /// Id of the case.
    pub case: String,
    /// Name of the recording, of its file and inside it.
    pub name: RecordingName,
    /// One line for people: the experiment's question or name, and the values on the axes.
    pub title: String,
    /// What the experiment asks; empty where it asks nothing.
    pub question: String,
    /// The method in words, as it stands in the configuration.
    pub method: String,
    /// Axes of the sweep by their paths, with this case's values.
    pub axes: Vec<(String, Value)>,
    /// Program and version, e.g. `gotai 0.1.0`.
    pub program: String,
    /// Hash of the build.
    pub build: String,
    /// The whole resolved experiment, as YAML.
    pub config_yaml: String,
    /// Step of the clock; None of a method that makes steps of its own.
    pub step_s: Option<f64>,
    /// Time between two samples, a whole number of steps.
    pub sample_every_s: f64,
    pub streams: Streams,
    pub bodies: Vec<BodyHeader>,
    /// Line strips that draw a container of box form, world frame.
    pub container_strips_m: Vec<Vec<[f64; 3]>>,
    /// Free half-spaces n·x ≥ offset whose boundary is drawn as ground, as large as the motion: unit normal, offset.
    pub planes: Vec<([f64; 3], f64)>,
    /// Middle and half side of the squares of planes, as far as the start tells.
    pub ground: ([f64; 3], f64),
    /// Length of a force arrow: metres a newton.
    pub arrow_m_per_n: f64,
    /// Weight that an arrow as long as `arrow_body_m` stands for; None without gravity.
    pub arrow_weight_n: Option<f64>,
    /// Longest arrow.
    pub arrow_longest_m: f64,
    /// Length of an arrow of a velocity: metres for 1 m/s.
    pub arrow_m_per_m_s: f64,
    /// Multiple of the energy at the start at which the run counts as diverged.
    pub energy_factor: Option<f64>,
    /// Unit in which energies are plotted, and its size in joules.
    pub energy_unit: (&'static str, f64),
    /// Time at which the run ends unless something stops it.
    pub end_s: f64,
    /// Most bytes of a file.
    pub most_bytes: u64,
}

#[derive(Clone, Debug)]
pub struct BodyHeader {
    pub name: String,
    /// Whether it is drawn by its moments of inertia, having no shape; a body with no moments either is a ball.
    pub has_no_shape: bool,
    /// Whether it touches with the vertices of its surface.
    pub touches_with_nodes: bool,
    /// Places that a pin holds, relative to the centre of mass, in body axes.
    pub pins_m: Vec<[f64; 3]>,
    /// Surface, relative to the centre of mass, in body axes.
    pub vertices_m: Vec<[f64; 3]>,
    /// Corners of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    pub bounding_radius_m: f64,
}

impl Header {
    /// Lowest and highest corner of the container; None without one.
    pub fn container_box_m(&self) -> Option<([f64; 3], [f64; 3])> {
        self.container_strips_m.iter().flatten().fold(None, |corners, p| {
            let (low, high) = corners.unwrap_or((*p, *p));
            Some((std::array::from_fn(|i| low[i].min(p[i])), std::array::from_fn(|i| high[i].max(p[i]))))
        })
    }

    /// Corners of the squares that planes are drawn as, about the point of each that is nearest to a middle.
    pub fn squares(&self, middle: [f64; 3], half_m: f64) -> Vec<[[f64; 3]; 4]> {
        self.planes.iter().map(|plane| square(*plane, middle, half_m)).collect()
    }

    /// Length that the scene's drawings are in proportion to: the container's diagonal, else the ground's side.
    pub fn scene_size_m(&self) -> f64 {
        match self.container_box_m() {
            Some((low, high)) => norm(std::array::from_fn(|i| high[i] - low[i])),
            None => 2.0 * self.ground.1,
        }
    }

    pub fn force_arrows(&self) -> Arrows {
        Arrows { m_per_unit: self.arrow_m_per_n, longest_m: self.arrow_longest_m }
    }

    pub fn velocity_arrows(&self) -> Arrows {
        Arrows { m_per_unit: self.arrow_m_per_m_s, longest_m: self.arrow_longest_m }
    }
}

/// Drawing of forces, or of velocities: in proportion, up to a length that stays in the picture. The force of an
/// impact, its impulse over one step, can be thousands of weights; the numbers beside the picture are whole.
#[derive(Clone, Copy, Debug)]
pub struct Arrows {
    pub m_per_unit: f64,
    pub longest_m: f64,
}

impl Arrows {
    pub fn vector_m(self, vector: [f64; 3]) -> [f64; 3] {
        let length_m = norm(vector) * self.m_per_unit;
        let cut = if length_m > self.longest_m { self.longest_m / length_m } else { 1.0 };
        vector.map(|x| x * self.m_per_unit * cut)
    }
}

fn square((normal, offset_m): ([f64; 3], f64), middle: [f64; 3], half_m: f64) -> [[f64; 3]; 4] {
    let height_m = dot(normal, middle) - offset_m;
    let centre: [f64; 3] = std::array::from_fn(|i| middle[i] - height_m * normal[i]);
    // Along the world's axes where the plane is level.
    let along = if normal[0].abs() < 0.9 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let t2 = cross(along, normal);
    let t2 = t2.map(|x| x / norm(t2));
    let t1 = cross(normal, t2);
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(a, b)| std::array::from_fn(|i| centre[i] + half_m * (a * t1[i] + b * t2[i])))
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

pub(super) fn norm([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// Samples in a full batch: larger ones write no faster, and a kill loses what was not yet written.
const BATCH_SAMPLES: usize = 1_000;

/// Bytes of a full batch, for scenes with many bodies: several batches circulate.
const BATCH_BYTES: usize = 2 << 20;

/// Samples in columns. "Sample-major": all bodies of sample 0, then all of sample 1, …
#[derive(Clone, Debug, Default)]
pub struct Batch {
    pub step: Vec<u64>,
    pub time_s: Vec<f64>,
    /// State of every body in every sample, sample-major.
    pub bodies: Vec<BodyRow>,
    /// Number of contacts in each sample, when contacts or forces are on.
    pub contacts_len: Vec<u32>,
    /// All contacts of sample 0, then of sample 1, …
    pub contacts: Vec<ContactSample>,
    /// Instant at which each sample's contacts act; empty where all act at the sample's own.
    pub acted_s: Vec<f64>,
    /// Bodies at that instant, sample after sample, and their number: none where it is the sample's own, where the
    /// sample before shows them, or where nothing acts.
    pub acted_len: Vec<u32>,
    pub acted: Vec<BodyRow>,
    /// Whether a sample is due by the rate alone, and may be left out to save room; empty where none may.
    pub by_rate: Vec<bool>,
    /// Energies, one a sample, when energy is on.
    pub energy: Vec<EnergySample>,
    /// What happened since the batch before, in the order of time.
    pub events: Vec<Event>,
    /// Whether modes of contacts and depths of overlap are still to be worked out. Until then a contact's use of
    /// friction is its coefficient.
    pub is_raw: bool,
}

impl Batch {
    pub fn len(&self) -> usize {
        self.step.len()
    }

    /// Whether there is neither a sample nor an event in it.
    pub fn is_empty(&self) -> bool {
        self.step.is_empty() && self.events.is_empty()
    }

    /// Whether it is to be written as it is.
    pub fn is_full(&self) -> bool {
        self.len() >= BATCH_SAMPLES || self.bytes() >= BATCH_BYTES
    }

    /// Bytes of its bodies and contacts; the rest is little.
    pub fn bytes(&self) -> usize {
        (self.bodies.len() + self.acted.len()) * size_of::<BodyRow>() + self.contacts.len() * size_of::<ContactSample>()
    }

    /// Adds the samples and events of another batch behind its own.
    pub fn append(&mut self, other: &Batch) {
        self.append_since(other, [0, 0]);
    }

    /// Adds the samples from one on, and the events from one on, of another batch behind its own.
    pub fn append_since(&mut self, other: &Batch, [sample, event]: [usize; 2]) {
        let sum = |lens: &[u32]| lens.iter().take(sample).map(|&len| len as usize).sum::<usize>();
        let bodies = other.bodies.len() / other.len().max(1);
        self.step.extend_from_slice(rest(&other.step, sample));
        self.time_s.extend_from_slice(rest(&other.time_s, sample));
        self.bodies.extend_from_slice(rest(&other.bodies, sample * bodies));
        self.contacts_len.extend_from_slice(rest(&other.contacts_len, sample));
        self.contacts.extend_from_slice(rest(&other.contacts, sum(&other.contacts_len)));
        self.acted_s.extend_from_slice(rest(&other.acted_s, sample));
        self.acted_len.extend_from_slice(rest(&other.acted_len, sample));
        self.acted.extend_from_slice(rest(&other.acted, sum(&other.acted_len)));
        self.by_rate.extend_from_slice(rest(&other.by_rate, sample));
        self.energy.extend_from_slice(rest(&other.energy, sample));
        self.events.extend_from_slice(rest(&other.events, event));
        self.is_raw |= other.is_raw;
    }

    /// Empties every column and keeps its memory.
    pub fn clear(&mut self) {
        self.step.clear();
        self.time_s.clear();
        self.bodies.clear();
        self.contacts_len.clear();
        self.contacts.clear();
        self.acted_s.clear();
        self.acted_len.clear();
        self.acted.clear();
        self.by_rate.clear();
        self.energy.clear();
        self.events.clear();
        self.is_raw = false;
    }

    /// Adds one sample of another batch.
    pub fn push(&mut self, sample: &Sample<'_>, streams: Streams) {
        self.step.push(sample.step);
        self.time_s.push(sample.time_s);
        self.bodies.extend_from_slice(sample.bodies);
        if streams.any_contact() {
            self.contacts_len.push(sample.contacts.len() as u32);
            self.contacts.extend_from_slice(sample.contacts);
        }
        self.acted_s.push(sample.acted_s);
        self.acted_len.push(sample.acted.len() as u32);
        self.acted.extend_from_slice(sample.acted);
        self.by_rate.push(sample.by_rate);
        self.energy.extend(sample.energy);
    }

    /// Checks that every column has the length that the streams ask for; the recorders rely on it.
    ///
    /// # Errors
    /// A sentence about the first column that has another length.
    pub fn check(&self, streams: Streams, bodies: usize) -> Result<(), &'static str> {
        let samples = self.len();
        let on = |stream: bool, len: usize| if stream { len } else { 0 };
        let contacts: u64 = self.contacts_len.iter().map(|&len| u64::from(len)).sum();
        let acted: u64 = self.acted_len.iter().map(|&len| u64::from(len)).sum();
        let is_none_or_all = |len: usize| len == 0 || len == samples;
        match () {
            () if self.time_s.len() != samples => Err("a batch needs one time a step"),
            () if self.bodies.len() != on(streams.bodies, samples * bodies) => {
                Err("a batch needs every body in every sample when bodies are on, none when they are off")
            }
            () if self.contacts_len.len() != on(streams.any_contact(), samples) => Err(
                "a batch needs one count of contacts a sample when contacts or forces are on, none when they are off",
            ),
            () if self.contacts.len() as u64 != contacts => Err("a batch's contacts differ from their counts"),
            () if ![self.acted_s.len(), self.acted_len.len(), self.by_rate.len()].into_iter().all(is_none_or_all) => {
                Err("a batch says of all its samples or of none when their contacts act and why they are there")
            }
            () if self.acted.len() as u64 != acted => {
                Err("a batch's bodies where contacts act differ from their counts")
            }
            () if self.energy.len() != on(streams.energy, samples) => {
                Err("a batch needs one energy a sample when energy is on, none when it is off")
            }
            () => Ok(()),
        }
    }

    /// The samples one by one, each a view into the columns. The batch must have passed `check`.
    pub fn samples(&self) -> impl Iterator<Item = Sample<'_>> {
        let bodies = self.bodies.len() / self.len().max(1);
        let mut first_contact = 0;
        let mut first_acted = 0;
        (0..self.len()).map(move |i| {
            let acted = self.acted_len.get(i).map_or(0, |&len| len as usize);
            let acted_range = first_acted..first_acted + acted;
            first_acted = acted_range.end;
            let contacts = self.contacts_len.get(i).map_or(0, |&len| len as usize);
            let contact_range = first_contact..first_contact + contacts;
            first_contact = contact_range.end;
            Sample {
                step: self.step[i],
                time_s: self.time_s[i],
                bodies: &self.bodies[i * bodies..(i + 1) * bodies],
                contacts: &self.contacts[contact_range],
                acted_s: self.acted_s.get(i).copied().unwrap_or(self.time_s[i]),
                acted: &self.acted[acted_range],
                by_rate: self.by_rate.get(i).copied().unwrap_or(false),
                energy: self.energy.get(i),
            }
        })
    }
}

fn rest<T>(column: &[T], from: usize) -> &[T] {
    column.get(from..).unwrap_or_default()
}

/// Sample of a batch. Streams that are off are empty.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    pub step: u64,
    pub time_s: f64,
    pub bodies: &'a [BodyRow],
    pub contacts: &'a [ContactSample],
    /// Instant at which the contacts act, and the bodies then; none where the sample's own, or the sample before, shows
    /// them.
    pub acted_s: f64,
    pub acted: &'a [BodyRow],
    /// Whether it is there by the rate of samples alone.
    pub by_rate: bool,
    pub energy: Option<&'a EnergySample>,
}

/// One contact of the step that led to the sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSample {
    /// Index of the body that the force acts on.
    pub body: u32,
    /// Index of the other body; None for the container.
    pub other: Option<u32>,
    pub point_m: [f64; 3],
    /// Unit normal from the other to the body.
    pub normal: [f64; 3],
    /// Force on the body: impulse over the step.
    pub force_n: [f64; 3],
    /// Gap along the normal; negative where there is penetration.
    pub gap_m: f64,
    /// Part of the friction that Coulomb's law lets be: |f_t| / μ f_n; 0 where nothing pushes, infinite where only
    /// friction does.
    pub friction_use: f64,
    pub mode: ContactMode,
}

/// What a contact does, by its force alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ContactMode {
    /// It pushes nothing.
    #[default]
    Open,
    /// Friction is inside Coulomb's cone.
    Sticking,
    /// Friction is on the cone: all that there can be.
    Sliding,
    /// The force is one that no law of contact allows: a pull, or outside the cone.
    Unsolved,
}

impl ContactMode {
    pub const ALL: [ContactMode; 4] =
        [ContactMode::Open, ContactMode::Sticking, ContactMode::Sliding, ContactMode::Unsolved];

    /// Word of the mode in files.
    pub fn name(self) -> &'static str {
        match self {
            ContactMode::Open => "open",
            ContactMode::Sticking => "sticking",
            ContactMode::Sliding => "sliding",
            ContactMode::Unsolved => "unsolved",
        }
    }
}

/// Part of friction up to which the edge of the cone is met: an iteration ends within its tolerance of it.
const EDGE: f64 = 1e-6;

/// Whether a contact's mode is to stick.
pub fn sticks(force_n: [f64; 3], normal: [f64; 3], friction: f64) -> bool {
    let normal_n = dot(force_n, normal);
    let tangential_n = norm(std::array::from_fn(|i| force_n[i] - normal_n * normal[i]));
    normal_n > 0.0 && tangential_n < friction * normal_n * (1.0 - EDGE)
}

/// Mode of a contact and the use it makes of its friction, from its force.
pub fn contact_mode(force_n: [f64; 3], normal: [f64; 3], friction: f64) -> (ContactMode, f64) {
    let normal_n = dot(force_n, normal);
    let tangential_n = norm(std::array::from_fn(|i| force_n[i] - normal_n * normal[i]));
    if normal_n == 0.0 && tangential_n == 0.0 {
        return (ContactMode::Open, 0.0);
    }
    let most_n = friction * normal_n;
    let used = if tangential_n == 0.0 { 0.0 } else { (tangential_n / most_n).abs() };
    // Without friction a rounding of the tangential force is none.
    let is_rounding = tangential_n <= EDGE * EDGE * normal_n.abs();
    let mode = match () {
        () if normal_n < 0.0 || normal_n.is_nan() => ContactMode::Unsolved,
        () if friction == 0.0 && is_rounding => return (ContactMode::Sliding, 0.0),
        () if tangential_n > most_n * (1.0 + EDGE) => ContactMode::Unsolved,
        () if tangential_n >= most_n * (1.0 - EDGE) => ContactMode::Sliding,
        () => ContactMode::Sticking,
    };
    (mode, used)
}

/// Energies and deepest penetration of one state.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EnergySample {
    pub kinetic_j: f64,
    pub potential_j: f64,
    pub total_j: f64,
    pub penetration_m: f64,
}

/// End of a run; written once, at the end of a recording.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Ending {
    pub outcome: Outcome,
    /// Criterion that stopped the run; None where it came to its end.
    pub criterion: Option<String>,
    pub end_time_s: f64,
    pub steps: u64,
    /// What is in doubt about the run, of a method that claims to solve the law of contact.
    pub warnings: Option<String>,
    /// What is in doubt about the run, of another method.
    pub notes: Option<String>,
    /// Columns of the row that are the same on every machine and not empty.
    pub row: Map<String, Value>,
    pub story: Story,
    /// The contacts of the step of the largest gain, of a recording of every step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub flight: Option<Flight>,
    /// Samples that are left out to keep the file small.
    #[serde(default)]
    pub left_out: u64,
}

impl Ending {
    /// Texts that are there, by the names of their fields.
    pub fn texts(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let all = [("criterion", &self.criterion), ("warnings", &self.warnings), ("notes", &self.notes)];
        all.into_iter().filter_map(|(field, text)| Some((field, text.as_deref()?)))
    }
}

/// Something that happened at a time, in words: a divergence, the end of the run.
#[derive(Clone, Debug)]
pub struct Event {
    pub step: u64,
    pub time_s: f64,
    pub severity: Severity,
    pub text: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    Info,
    Warning,
    /// The run cannot be gone on with: it diverged.
    Error,
}

//! The vocabulary of the experiment file: one type a word, defaults with their reasons.
//!
//! These types say only what can be written. Whether it makes sense together (a mesh for the shape, a positive mass)
//! is `validate.rs`; how a file, `--set` and a sweep axis become a value of them is `file.rs`.
//! SI units stand last in the key. Unknown keys are errors.

pub use super::accuracy::Accuracy;
use super::defaults::is_default;
pub use super::facts::{About, Approach, ContactModel, Facts, MethodSettings, Restitution};
pub use super::integrator::Integrator;
pub use super::limits::{Limits, ReferenceRun};
pub use super::loads::*;
pub use super::method::*;
pub use super::scene::*;
pub use super::skips::{Planning, Skip, Skips};
pub use super::solver::{
    AFFORDABLE_BODIES, AFFORDABLE_PROBLEMS, AFFORDABLE_PRODUCTS, FEWEST_PROBLEMS, Solver, SolverFacts, rule_of_auto,
};
pub use super::variants::*;
use crate::clock::Clock;
use crate::shared::Shared;
use serde::{Deserialize, Serialize};
use strum::{IntoStaticStr, VariantArray};

/// One resolved experiment: no axes left in it, every default filled in. What a file holds besides (`sweep`, `expect`,
/// `bench`) is taken out by `file.rs` before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// Question that the experiment answers, in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub question: Option<String>,
    pub scene: Shared<Scene>,
    /// Seed of all random draws, which depend on it and on the body's name.
    #[serde(default)]
    pub seed: u64,
    #[serde(default)]
    pub method: Method,
    pub time: Time,
    #[serde(default)]
    pub diverge: Diverge,
    #[serde(default, skip_serializing_if = "is_default")]
    pub limits: Limits,
    /// How it is made; no part of a case's id.
    #[serde(default, skip_serializing_if = "is_default")]
    pub plan: Planning,
    #[serde(default)]
    pub record: Record,
    /// Columns beyond those of every row.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measure: Vec<Measure>,
    /// The closed form that errors are measured against.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exact: Option<Exact>,
    /// The run that errors are measured against instead of a closed form.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<ReferenceRun>,
}

impl Experiment {
    /// Clock of the run; without a step one step to the end, of a method that needs none.
    pub fn clock(&self) -> Clock {
        let end_s = self.time.end_s;
        Clock::new(self.time.step_s.unwrap_or(end_s), end_s)
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Step that is asked for: n = max(1, round(end/step)) equal steps of end/n are made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_s: Option<f64>,
    pub end_s: f64,
}

/// Criteria by which a run counts as diverged and stops; `not-finite` is always on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Diverge {
    /// Multiple of the start value above which the sum of kinetic and potential energy is a divergence. By default
    /// 1000: smaller factors count contact steps, not explosions. `null` switches it off.
    pub energy_factor: Option<f64>,
    /// Whether a body has diverged whose centre of mass is outside the container by more than its bounding radius.
    pub escape: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub penetration_m: Option<f64>,
}

impl Default for Diverge {
    fn default() -> Self {
        Diverge { energy_factor: Some(1000.0), escape: true, speed_m_s: None, penetration_m: None }
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Record {
    /// Kinds of file; where absent, everything that this build can write.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<RecordTo>,
    /// Sampling interval; first and last state are always recorded. At 0 every step is.
    pub every_s: f64,
    pub cases: RecordCases,
    pub streams: Vec<Stream>,
    /// Largest file of a recording, in megabytes. (Written where it is another than the default: ids of cases and older
    /// files know nothing of it.)
    #[serde(skip_serializing_if = "is_usual_size")]
    pub max_mb: f64,
}

/// Megabytes of a recording that a viewer opens at once.
const USUAL_MB: f64 = 32.0;

fn is_usual_size(max_mb: &f64) -> bool {
    *max_mb == USUAL_MB
}

impl Default for Record {
    /// A sampling rate of 100 Hz: above every display's rate, small beside the step count of an accurate run.
    fn default() -> Self {
        Record { to: None, every_s: 0.01, cases: RecordCases::Few, streams: Stream::USUAL.to_vec(), max_mb: USUAL_MB }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RecordTo {
    None,
    Rerun,
    Mcap,
    Both,
}

/// Choice of the cases of a sweep that are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RecordCases {
    None,
    /// Few cases, at most 24, both outcomes shown.
    Few,
    All,
    Diverged,
    /// At most 24 cases that an unmet expectation names.
    Failing,
    First,
    /// A number of cases, evenly through the plan.
    Sample(u32),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stream {
    Bodies,
    Contacts,
    Forces,
    Energy,
    /// Arrows of the bodies' velocities, which are many.
    Velocities,
}

impl Stream {
    /// Those that are recorded where nothing is said.
    pub const USUAL: [Stream; 4] = [Stream::Bodies, Stream::Contacts, Stream::Forces, Stream::Energy];
}

/// Closed forms, by name; what each is and of which scenes stands in its file, `exact/<name>.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, IntoStaticStr, VariantArray)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum Exact {
    // Bodies that meet nothing.
    FreeMotion,
    SymmetricBody,
    LinearDrag,
    QuadraticDrag,
    HeavyTop,
    Pendulum,
    // Bodies in contact, from here on: `touches`.
    Rest,
    Sliding,
    Ball,
    Turntable,
    RockingBlock,
    FallingRod,
    Ladder,
    RimlessWheel,
    Dome,
    StickSlip,
}

impl Exact {
    pub const ALL: &'static [Exact] = Exact::VARIANTS;

    /// Word of the closed form in the file.
    pub fn word(self) -> &'static str {
        self.into()
    }

    /// Whether the motion is of bodies in contact; in the others they meet nothing.
    pub fn touches(self) -> bool {
        self >= Exact::Rest
    }
}

/// Measurement that is made only when asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// Each body's state at the end: `<body>.position_m.x`, ….
    State,
    /// Each body's mass, centre of mass and inertia: `<body>.inertia_kg_m2.xx`, ….
    Inertia,
    /// Rank of A = J M⁻¹ Jᵀ, and how fast Jacobi's iteration grows, in the step with the most contacts.
    ContactMatrix,
    /// The penalty method's critical step, of the first step with a contact.
    CriticalStep,
    /// Forward, backward and central quotients of the positions against the velocities.
    DifferenceQuotients,
    /// Growth of an error of the start at the end, at the cost of three more runs; with `auto` and `reference:` it is
    /// always measured.
    Sensitivity,
}

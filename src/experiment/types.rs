//! The vocabulary of the experiment file: one type a word, defaults with their reasons.
//!
//! These types say only what can be written. Whether it makes sense together (a mesh for the shape, a positive mass)
//! is `validate.rs`; how a file, `--set` and a sweep axis become a value of them is `file.rs`.
//! SI units stand last in the key. Unknown keys are errors.

pub use super::accuracy::Accuracy;
use super::defaults::is_default;
pub use super::limits::{Limits, ReferenceRun};
pub use super::loads::*;
pub use super::method::*;
use crate::clock::Clock;
use crate::shape::mesh::box_counts;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// One resolved experiment: no axes left in it, every default filled in. What a file holds besides (`sweep`, `expect`,
/// `bench`) is taken out by `file.rs` before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experiment {
    /// What the experiment wants to know, in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub question: Option<String>,
    pub scene: Scene,
    /// All random draws depend on this and on the body's name.
    #[serde(default)]
    pub seed: u64,
    #[serde(default)]
    pub method: Method,
    pub time: Time,
    #[serde(default)]
    pub diverge: Diverge,
    #[serde(default, skip_serializing_if = "is_default")]
    pub limits: Limits,
    #[serde(default)]
    pub record: Record,
    /// Columns beyond those of every row.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measure: Vec<Measure>,
    /// The closed form that errors are measured against.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exact: Option<Exact>,
    /// The run that errors are measured against instead.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference: Option<ReferenceRun>,
}

impl Experiment {
    /// Without a step: one to the end, of a method that needs none.
    pub fn clock(&self) -> Clock {
        let end_s = self.time.end_s;
        Clock::new(self.time.step_s.unwrap_or(end_s), end_s)
    }
}

/// Everything that exists, at rest or in motion, at t = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    #[serde(default = "default_gravity")]
    pub gravity_m_s2: [f64; 3],
    /// Coulomb coefficient of every pair that does not say otherwise. 0: nobody asked for friction.
    #[serde(default)]
    pub friction: f64,
    /// Newton restitution of every pair that does not say otherwise. 0: the lecture's plastic contact.
    #[serde(default)]
    pub restitution: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub container: Option<Container>,
    pub bodies: Vec<Body>,
    /// Pairs whose values are not the mean of the two bodies'.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pairs: Vec<Pair>,
    /// Ball joints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<Pin>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forces: Vec<Force>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub air: Option<Air>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub random: Option<Random>,
    /// A body may start inside a face.
    #[serde(default, skip_serializing_if = "is_default")]
    pub allow_overlap: bool,
}

/// y is up, and g is the lecture's (L5).
fn default_gravity() -> [f64; 3] {
    [0.0, -9.8, 0.0]
}

/// How pairs and contacts call the container.
pub const CONTAINER: &str = "container";

/// What bodies hit. All faces look inward.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Container {
    Box(ContainerBox),
    Plane(Plane),
    Planes(Vec<Plane>),
}

/// Six faces; the floor is at y = 0 and the box centred on x and z, unless `center_m` moves it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContainerBox {
    pub size_m: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center_m: Option<[f64; 3]>,
}

impl ContainerBox {
    /// Its middle, given or by default.
    pub fn center(&self) -> [f64; 3] {
        self.center_m.unwrap_or([0.0, self.size_m[1] / 2.0, 0.0])
    }
}

/// A half-space: n·x ≥ offset is free.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    pub normal: [f64; 3],
    #[serde(default)]
    pub offset_m: f64,
}

/// Two bodies, or a body and the `container`; what is absent is the mean of the two, the tangential restitution 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pair {
    pub between: [String; 2],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// What an impact gives back of the slip, in the other direction, where friction can.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangential_restitution: Option<f64>,
}

/// A rigid body: shape, mass properties, first state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    pub name: String,
    pub shape: Shape,
    /// Asks for the lecture's tetrahedral volume mesh (L8); absent: the analytic shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSpec>,
    /// The whole mass; or `density_kg_m3`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Times the volume, of the mesh if there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_kg_m3: Option<f64>,
    #[serde(default)]
    pub inertia_from: InertiaFrom,
    /// Three principal moments or 3×3, about the centre of mass, body axes. Overrides `inertia_from`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia_kg_m2: Option<Inertia>,
    /// In the body frame. Overrides that of the shape or mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center_of_mass_m: Option<[f64; 3]>,
    /// Of the body frame's origin.
    #[serde(default)]
    pub position_m: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<Orientation>,
    /// Of the centre of mass, world frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity_m_s: Option<[f64; 3]>,
    /// World frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_velocity_rad_s: Option<[f64; 3]>,
    /// Body frame; instead of `angular_velocity_rad_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_velocity_body_rad_s: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// A row or a grid of bodies like this one; absent in a resolved case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copies: Option<Copies>,
    /// It stays where it is.
    #[serde(default, skip_serializing_if = "is_default")]
    pub fixed: bool,
    /// It moves as it is told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinematic: Option<Kinematic>,
}

/// `count` along `step_m`, or a `grid` along the axes, `step_m` apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Copies {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grid: Option<[u32; 3]>,
    pub step_m: [f64; 3],
}

impl Body {
    /// Nothing that acts on it changes its motion.
    pub fn is_driven(&self) -> bool {
        self.fixed || self.kinematic.is_some()
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    Sphere(Sphere),
    Box(BoxShape),
    Cylinder(Cylinder),
    Capsule(Capsule),
    Ellipsoid(Ellipsoid),
    Convex(Convex),
    /// A point with mass and inertia, without contact.
    None,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    pub radius_m: f64,
}

/// Edge lengths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxShape {
    pub size_m: [f64; 3],
}

/// Its axis is y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    pub radius_m: f64,
    pub height_m: f64,
}

/// Its axis is y. `height_m` is between the centres of its two spheres, as a rod's length is: it measures
/// `height_m` + 2 `radius_m` from end to end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Capsule {
    pub radius_m: f64,
    pub height_m: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ellipsoid {
    pub semi_axes_m: [f64; 3],
}

/// The convex hull of its vertices, all of which are corners of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Convex {
    pub vertices_m: Vec<[f64; 3]>,
}

impl Convex {
    pub fn vertices(&self) -> Vec<Vector3<f64>> {
        self.vertices_m.iter().map(|v| Vector3::from(*v)).collect()
    }
}

/// Resolution of the volume mesh: `nodes_per_edge` for a box, `subdivisions` for a sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeshSpec {
    /// n nodes along the shortest edge and near-cubic cells, or the three counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nodes_per_edge: Option<NodesPerEdge>,
    /// Icosphere of 12, 42, 162, … surface nodes and a centre node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub subdivisions: Option<u32>,
}

/// `n` or `[nx, ny, nz]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum NodesPerEdge {
    Shortest(u32),
    Each([u32; 3]),
}

impl NodesPerEdge {
    /// Along each edge of a box. With one count, the cells are as near to cubes as whole numbers allow.
    pub fn counts(&self, size_m: [f64; 3]) -> [u32; 3] {
        match self {
            NodesPerEdge::Shortest(n) => box_counts(size_m, *n),
            NodesPerEdge::Each(counts) => *counts,
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum InertiaFrom {
    /// Over the tets of a mesh (Tonon 2004), else the shape's closed form: the lumped sum of L9 is wrong by
    /// −½/(n−1)² for a cube and does not converge for a sphere.
    #[default]
    Exact,
    /// The slide's: a tet's mass at its centroid (L8, L9).
    Lumped,
}

/// `[I1, I2, I3]` or three rows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Inertia {
    Principal([f64; 3]),
    Full([[f64; 3]; 3]),
}

/// Body → world, one key of three.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Orientation {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quaternion_xyzw: Option<[f64; 4]>,
    /// R = Rz Ry Rx.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub euler_xyz_deg: Option<[f64; 3]>,
}

/// Draws that replace the given velocities (and attitude) of every body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Random {
    /// |v|, direction uniform on the sphere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// |ω|, direction uniform on the sphere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spin_rad_s: Option<f64>,
    /// Attitude uniform on SO(3).
    #[serde(default)]
    pub attitude: bool,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Direction>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub place: Option<Place>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// The velocity is reflected into the lower half.
    Downward,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// Shifted along the floor's normal to the first step of a contact: the lowest point is inside by a random part of
    /// what it moves in a step.
    AtContact,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// n = max(1, round(end/step)) equal steps of end/n are made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_s: Option<f64>,
    pub end_s: f64,
}

/// When a run counts as diverged and stops; `not-finite` is always on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Diverge {
    /// Kinetic + potential above this times the start value. 1000: smaller factors count contact steps, not explosions.
    /// `null` switches it off.
    pub energy_factor: Option<f64>,
    /// The centre of mass is outside the container by more than the body's bounding radius.
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
    /// Absent: everything this build can write.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to: Option<RecordTo>,
    /// Sampling interval; first and last state are always recorded. 0: every step.
    pub every_s: f64,
    pub cases: RecordCases,
    pub streams: Vec<Stream>,
}

impl Default for Record {
    /// 100 Hz: above every display's rate, small beside the step count of an accurate run.
    fn default() -> Self {
        Record { to: None, every_s: 0.01, cases: RecordCases::Few, streams: Stream::ALL.to_vec() }
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

/// Which cases of a sweep are recorded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RecordCases {
    None,
    /// At most 24, both outcomes shown.
    Few,
    All,
    Diverged,
    First,
    /// This many, evenly through the plan.
    Sample(u32),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stream {
    Bodies,
    Contacts,
    Forces,
    Energy,
}

impl Stream {
    pub const ALL: [Stream; 4] = [Stream::Bodies, Stream::Contacts, Stream::Forces, Stream::Energy];
}

/// Closed forms, by name; of which scenes: `exact/scene.rs`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Exact {
    /// Parabola, with constant and harmonic forces, and torque-free rotation of every body.
    FreeMotion,
    /// The same without forces, of bodies of revolution, by elementary functions.
    SymmetricBody,
    /// Gravity and linear drag.
    LinearDrag,
    /// Gravity and quadratic drag along one line.
    QuadraticDrag,
    /// A body of revolution on a pin.
    HeavyTop,
    /// A body on a pin that swings in a plane.
    Pendulum,
    /// Bodies that stay where they are.
    Rest,
    /// A body that slides on a plane without turning.
    Sliding,
    /// A ball that bounces, slides and rolls on a plane.
    Ball,
    /// A ball that rolls on a level table that turns.
    Turntable,
    /// A box that rocks on two edges.
    RockingBlock,
    /// A capsule that falls over on a smooth floor.
    FallingRod,
    /// A capsule that slides down a smooth wall, on a smooth floor.
    Ladder,
    /// A regular prism that rolls over its edges.
    RimlessWheel,
    /// A ball that slides or rolls off a fixed ball.
    Dome,
    /// A body on a plane under a harmonic force.
    StickSlip,
}

impl Exact {
    /// All of them, as written above; a test holds this against the parser's own list.
    pub const ALL: [Exact; 16] = [
        Exact::FreeMotion,
        Exact::SymmetricBody,
        Exact::LinearDrag,
        Exact::QuadraticDrag,
        Exact::HeavyTop,
        Exact::Pendulum,
        Exact::Rest,
        Exact::Sliding,
        Exact::Ball,
        Exact::Turntable,
        Exact::RockingBlock,
        Exact::FallingRod,
        Exact::Ladder,
        Exact::RimlessWheel,
        Exact::Dome,
        Exact::StickSlip,
    ];

    /// Its word in the file.
    pub const fn word(self) -> &'static str {
        match self {
            Exact::FreeMotion => "free-motion",
            Exact::SymmetricBody => "symmetric-body",
            Exact::LinearDrag => "linear-drag",
            Exact::QuadraticDrag => "quadratic-drag",
            Exact::HeavyTop => "heavy-top",
            Exact::Pendulum => "pendulum",
            Exact::Rest => "rest",
            Exact::Sliding => "sliding",
            Exact::Ball => "ball",
            Exact::Turntable => "turntable",
            Exact::RockingBlock => "rocking-block",
            Exact::FallingRod => "falling-rod",
            Exact::Ladder => "ladder",
            Exact::RimlessWheel => "rimless-wheel",
            Exact::Dome => "dome",
            Exact::StickSlip => "stick-slip",
        }
    }

    /// A motion of bodies in contact; the others meet nothing.
    pub const fn touches(self) -> bool {
        match self {
            Exact::FreeMotion | Exact::SymmetricBody | Exact::LinearDrag | Exact::QuadraticDrag => false,
            Exact::HeavyTop | Exact::Pendulum => false,
            Exact::Rest | Exact::Sliding | Exact::Ball => true,
            Exact::Turntable | Exact::RockingBlock | Exact::FallingRod | Exact::Ladder => true,
            Exact::RimlessWheel | Exact::Dome | Exact::StickSlip => true,
        }
    }
}

/// What is measured only when asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// Each body's end state: `<body>.position_m.x`, ….
    State,
    /// Each body's mass, centre of mass and inertia: `<body>.inertia_kg_m2.xx`, ….
    Inertia,
    /// Rank of A = J M⁻¹ Jᵀ, and how fast Jacobi's iteration grows, in the step with the most contacts.
    ContactMatrix,
    /// The penalty method's, of the first step with a contact.
    CriticalStep,
    /// Forward, backward and central quotients of the positions against the velocities.
    DifferenceQuotients,
    /// How an error of the start has grown at the end; of methods that follow events it is always measured.
    Sensitivity,
}

//! The vocabulary of `scene:`: what exists, at rest or in motion, at t = 0. A part of `types.rs`.

use super::defaults::is_default;
use super::loads::{Air, Force, Kinematic, Pin};
use crate::shape::mesh::box_counts;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Everything that exists, at rest or in motion, at t = 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    #[serde(default = "default_gravity")]
    pub gravity_m_s2: [f64; 3],
    /// Coulomb coefficient of every pair that does not say otherwise. By default 0: nobody asked for friction.
    #[serde(default)]
    pub friction: f64,
    /// Newton restitution of every pair that does not say otherwise. By default 0: the lecture's plastic contact.
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
    /// Whether a body may start inside a face.
    #[serde(default, skip_serializing_if = "is_default")]
    pub allow_overlap: bool,
}

/// y is up, and g is the lecture's (L5).
fn default_gravity() -> [f64; 3] {
    [0.0, -9.8, 0.0]
}

/// Name of the container in pairs and contacts.
pub const CONTAINER: &str = "container";

/// Container that bodies hit. All faces look inward.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Container {
    Box(ContainerBox),
    Plane(Plane),
    Planes(Vec<Plane>),
}

/// A box of six faces; the floor is at y = 0 and the box centred on x and z, unless `center_m` moves it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContainerBox {
    pub size_m: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center_m: Option<[f64; 3]>,
}

impl ContainerBox {
    /// Middle of the box, given or by default, in metres.
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

/// Surface of a pair, two bodies, or a body and the `container`; what is absent is the mean of the two, the tangential
/// restitution 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pair {
    pub between: [String; 2],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// Part of the slip that an impact gives back, in the other direction, where friction can.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangential_restitution: Option<f64>,
}

/// A rigid body: shape, mass properties, first state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    pub name: String,
    pub shape: Shape,
    /// The lecture's tetrahedral volume mesh (L8); where absent, the analytic shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mesh: Option<MeshSpec>,
    /// The whole mass; instead of `density_kg_m3`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_kg: Option<f64>,
    /// Density, times the volume, of the mesh if there is one; instead of `mass_kg`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density_kg_m3: Option<f64>,
    #[serde(default)]
    pub inertia_from: InertiaFrom,
    /// Three principal moments or 3×3, about the centre of mass, body axes. Overrides `inertia_from`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia_kg_m2: Option<Inertia>,
    /// Centre of mass in the body frame. Overrides that of the shape or mesh.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub center_of_mass_m: Option<[f64; 3]>,
    /// Position of the body frame's origin.
    #[serde(default)]
    pub position_m: [f64; 3],
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub orientation: Option<Orientation>,
    /// Velocity of the centre of mass, world frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity_m_s: Option<[f64; 3]>,
    /// Angular velocity, world frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_velocity_rad_s: Option<[f64; 3]>,
    /// Angular velocity, body frame; instead of `angular_velocity_rad_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_velocity_body_rad_s: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// A row or a grid of bodies like this one; absent in a resolved case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub copies: Option<Copies>,
    /// Whether the body stays where it is.
    #[serde(default, skip_serializing_if = "is_default")]
    pub fixed: bool,
    /// Velocities of a body that moves as it is told.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kinematic: Option<Kinematic>,
}

/// Copies of a body: `count` along `step_m`, or a `grid` along the axes, `step_m` apart.
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
    /// Whether nothing that acts on the body changes its motion.
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

/// A box by its edge lengths.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoxShape {
    pub size_m: [f64; 3],
}

/// A cylinder whose axis is y.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    pub radius_m: f64,
    pub height_m: f64,
}

/// A capsule whose axis is y. `height_m` is between the centres of its two spheres, as a rod's length is: it measures
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
    /// Number n of nodes along the shortest edge, with near-cubic cells, or the three counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub nodes_per_edge: Option<NodesPerEdge>,
    /// Number of subdivisions of the icosphere: 12, 42, 162, … surface nodes and a centre node.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub subdivisions: Option<u32>,
}

/// Nodes along the edges of a box: `n` or `[nx, ny, nz]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum NodesPerEdge {
    Shortest(u32),
    Each([u32; 3]),
}

impl NodesPerEdge {
    /// Numbers of nodes along each edge of a box. With one count, the cells are as near to cubes as whole numbers
    /// allow.
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
    /// Integrals over the tets of a mesh (Tonon 2004), else the shape's closed form: the lumped sum of L9 is wrong by
    /// −½/(n−1)² for a cube and does not converge for a sphere.
    #[default]
    Exact,
    /// The slide's sum: a tet's mass at its centroid (L8, L9).
    Lumped,
}

/// Inertia as `[I1, I2, I3]` or three rows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Inertia {
    Principal([f64; 3]),
    Full([[f64; 3]; 3]),
}

/// Attitude, body → world, by one key of three.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Orientation {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angle_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quaternion_xyzw: Option<[f64; 4]>,
    /// Angles of R = Rz Ry Rx.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub euler_xyz_deg: Option<[f64; 3]>,
}

/// Draws that replace the given velocities (and attitude) of every body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Random {
    /// Speed |v|; its direction is uniform on the sphere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_m_s: Option<f64>,
    /// Angular speed |ω|; its direction is uniform on the sphere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spin_rad_s: Option<f64>,
    /// Whether the attitude is drawn, uniform on SO(3).
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
    /// Downward: the velocity is reflected into the lower half.
    Downward,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Place {
    /// The first step of a contact, to which the body is shifted along the floor's normal: the lowest point is inside
    /// by a random part of what it moves in a step.
    AtContact,
}

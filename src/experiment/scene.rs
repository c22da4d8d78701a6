//! `scene:` what exists, at rest or in motion, at t = 0. A part of `types.rs`.

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

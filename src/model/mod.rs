//! What is constant during a run: bodies, their mass properties and contact geometry, the container, gravity, applied
//! forces, pins.
//!
//! Frames (L7): W is the world (the lecture's Σ), B the body's axes with the centre of mass as origin (ᴳΣ in body axes);
//! Bo is the origin of the body frame as the experiment file places it (ᴼΣ).

mod area;
mod build;
pub mod container;
pub mod loads;
pub mod mass;
pub mod mesh;
pub mod pins;
mod place;
pub mod random;
pub mod surface;
mod triangles;

pub use build::{BuildError, build};

use crate::collide::solid::Solid;
use crate::state::BodyState;
use container::Container;
use loads::{AppliedForce, Drag};
use mesh::TetMesh;
use nalgebra::{Matrix3, Vector3};
use pins::Pin;
use surface::{Pair, Surface};

#[derive(Clone, Debug)]
pub struct Model {
    pub gravity_m_s2: Vector3<f64>,
    pub bodies: Vec<Body>,
    pub container: Option<Container>,
    pub container_surface: Surface,
    /// Pairs that are not the mean of their own.
    pub pairs: Vec<Pair>,
    pub forces: Vec<AppliedForce>,
    pub pins: Vec<Pin>,
    /// A point at height zero of the potential energy.
    pub potential_zero_m: Vector3<f64>,
    /// Some two bodies may touch each other.
    pub touching_pairs: bool,
}

impl Model {
    /// Two bodies on one pin do not touch: they meet where they are pinned.
    pub fn are_pinned(&self, [a, b]: [usize; 2]) -> bool {
        let joins = |pin: &Pin, a, b| pin.body == a && matches!(pin.anchor, pins::Anchor::Body(other, _) if other == b);
        self.pins.iter().any(|pin| joins(pin, a, b) || joins(pin, b, a))
    }

    /// Of the bodies' bounding spheres; 0: points.
    pub fn largest_radius_m(&self) -> f64 {
        self.bodies.iter().map(|body| body.bounding_radius_m).fold(0.0, f64::max)
    }

    /// Of the body at `p_WB`: −m g·(p − p₀).
    pub fn potential_j(&self, body: &Body, p_WB: &Vector3<f64>) -> f64 {
        -body.mass_kg * self.gravity_m_s2.dot(&(p_WB - self.potential_zero_m))
    }
}

#[derive(Clone, Debug)]
pub struct Body {
    pub name: String,
    pub mass_kg: f64,
    /// About the centre of mass, body axes (L9).
    pub I_B: Matrix3<f64>,
    pub I_B_inverse: Matrix3<f64>,
    /// I is a multiple of the identity: no gyroscopic term, and I does not turn with the body.
    pub isotropic: bool,
    /// Centre of mass in the body frame.
    pub p_BoBcm: Vector3<f64>,
    pub geometry: Geometry,
    /// About the centre of mass.
    pub bounding_radius_m: f64,
    /// Its own; what counts is the pair's.
    pub surface: Surface,
    pub drag: Drag,
    /// It moves with its start velocities, whatever acts on it.
    pub driven: bool,
}

/// What touches, relative to the centre of mass, in body axes.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// A point without contact.
    None,
    /// A volume mesh (L18): nodes against the container, its hull against other bodies if there are any.
    Mesh { nodes: Vec<Vector3<f64>>, mesh: TetMesh, hull: Option<Solid>, centre: Vector3<f64> },
    /// An analytic shape; its axes are the body's.
    Solid { solid: Solid, centre: Vector3<f64> },
}

impl Geometry {
    /// Points that are held against a face.
    pub fn points(&self) -> usize {
        match self {
            Geometry::None => 0,
            Geometry::Mesh { nodes, .. } => nodes.len(),
            Geometry::Solid { solid, .. } => solid.lowest_points(),
        }
    }
}

impl Body {
    /// I = R ᴼI Rᵀ (L10; the slide prints Rᵀ ᴼI R).
    pub fn I_W(&self, state: &BodyState) -> Matrix3<f64> {
        self.turned(&self.I_B, state)
    }

    pub fn I_W_inverse(&self, state: &BodyState) -> Matrix3<f64> {
        self.turned(&self.I_B_inverse, state)
    }

    fn turned(&self, tensor_B: &Matrix3<f64>, state: &BodyState) -> Matrix3<f64> {
        if self.isotropic {
            return *tensor_B;
        }
        let R_WB = state.q_WB.to_rotation_matrix().into_inner();
        R_WB * tensor_B * R_WB.transpose()
    }

    /// Where the body frame's origin is.
    pub fn p_WBo(&self, state: &BodyState) -> Vector3<f64> {
        state.p_WB - state.q_WB * self.p_BoBcm
    }

    /// A body that moves as it is told does not; other bodies feel it.
    pub fn feels_container(&self) -> bool {
        !matches!(self.geometry, Geometry::None) && !self.driven
    }

    /// A ball about its centre of mass: how it has turned does not matter.
    pub fn is_centred_ball(&self) -> bool {
        let at_centre = |geometry: &Geometry| match geometry {
            Geometry::Solid { solid: Solid::Sphere { .. }, centre } => *centre == Vector3::zeros(),
            _ => false,
        };
        self.isotropic && at_centre(&self.geometry)
    }

    /// What other bodies touch, and its centre from the centre of mass, in body axes.
    pub fn solid(&self) -> Option<(&Solid, &Vector3<f64>)> {
        match &self.geometry {
            Geometry::None => None,
            Geometry::Mesh { hull, centre, .. } => hull.as_ref().map(|hull| (hull, centre)),
            Geometry::Solid { solid, centre } => Some((solid, centre)),
        }
    }

    /// Triangles for a picture, relative to the centre of mass, in body axes.
    pub fn surface(&self) -> (Vec<Vector3<f64>>, Vec<[u32; 3]>) {
        match &self.geometry {
            Geometry::None => (Vec::new(), Vec::new()),
            Geometry::Mesh { nodes, mesh, .. } => (nodes.clone(), mesh.surface()),
            Geometry::Solid { solid, centre } => {
                let (points, triangles) = triangles::of(solid);
                (points.iter().map(|u| u + centre).collect(), triangles)
            }
        }
    }
}

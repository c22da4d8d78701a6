//! A rigid body: what of it is constant during a run.

use super::loads::Drag;
use super::surface::Surface;
use crate::shape::mesh::TetMesh;
use crate::shape::solid::Solid;
use crate::state::BodyState;
use nalgebra::{Matrix3, Vector3};

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
                let (points, triangles) = solid.triangles();
                (points.iter().map(|u| u + centre).collect(), triangles)
            }
        }
    }
}

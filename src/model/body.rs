//! A rigid body: the part of it that is constant during a run.

use super::loads::Drag;
use super::surface::Surface;
use crate::shape::mesh::TetMesh;
use crate::shape::solid::{Pose, Solid};
use crate::state::BodyState;
use nalgebra::{Matrix3, Vector3};

#[derive(Clone, Debug)]
pub struct Body {
    pub name: String,
    pub mass_kg: f64,
    /// Inertia about the centre of mass, body axes (L9).
    pub I_B: Matrix3<f64>,
    pub I_B_inverse: Matrix3<f64>,
    /// Whether I is a multiple of the identity: no gyroscopic term, and I does not turn with the body.
    pub isotropic: bool,
    /// Whether steps turn it by its constant spin: it is isotropic, and the gyroscopic term may be skipped.
    pub spins_steadily: bool,
    /// Centre of mass in the body frame.
    pub p_BoBcm: Vector3<f64>,
    pub geometry: Geometry,
    /// Radius of the sphere about the centre of mass that holds the body.
    pub bounding_radius_m: f64,
    /// Surface of its own; what counts is the pair's.
    pub surface: Surface,
    pub drag: Drag,
    /// Whether it moves with its start velocities, whatever acts on it.
    pub driven: bool,
}

/// Geometry of what touches, relative to the centre of mass, in body axes.
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
    /// Number of points that are held against a face.
    pub fn points(&self) -> usize {
        match self {
            Geometry::None => 0,
            Geometry::Mesh { nodes, .. } => nodes.len(),
            Geometry::Solid { solid, .. } => solid.lowest_points(),
        }
    }
}

/// Pose of a body's solid, whose centre lies so far from the centre of mass in body axes.
pub fn pose_of_solid(centre_B: &Vector3<f64>, at: &BodyState) -> Pose {
    Pose { p_W: at.p_WB + at.q_WB * centre_B, q_W: at.q_WB }
}

impl Body {
    /// Greatest speed of its points against its centre of mass at an angular velocity, in m/s; a ball about its centre
    /// looks the same however it turns.
    pub fn turning_m_s(&self, w_WB: &Vector3<f64>) -> f64 {
        if self.is_centred_ball() { 0.0 } else { w_WB.norm() * self.bounding_radius_m }
    }

    /// Inertia in the world, I = R ᴼI Rᵀ (L10; the slide prints Rᵀ ᴼI R).
    pub fn I_W(&self, state: &BodyState) -> Matrix3<f64> {
        self.turned(&self.I_B, state)
    }

    pub fn I_W_inverse(&self, state: &BodyState) -> Matrix3<f64> {
        self.turned(&self.I_B_inverse, state)
    }

    /// Angular acceleration without a torque at an angular velocity, −I⁻¹ (ω × I ω), in rad/s², world axes.
    pub fn torque_free(&self, state: &BodyState, w_WB: &Vector3<f64>) -> Vector3<f64> {
        if self.isotropic || self.driven {
            return Vector3::zeros();
        }
        -(self.I_W_inverse(state) * w_WB.cross(&(self.I_W(state) * w_WB)))
    }

    /// The largest angular velocity, in rad/s, that the body comes to without a torque. Energy and momentum are linear
    /// in the squares of its components along the principal axes, of which one is none where their sum is largest.
    pub fn fastest_turn_rad_s(&self, state: &BodyState, w_WB: &Vector3<f64>) -> f64 {
        const EQUAL: f64 = 1e-9;
        let now = w_WB.norm();
        if self.isotropic || self.driven {
            return now;
        }
        let w_B = state.q_WB.inverse_transform_vector(w_WB);
        let (energy, momentum) = (w_B.dot(&(self.I_B * w_B)), (self.I_B * w_B).norm_squared());
        let I = self.I_B.symmetric_eigenvalues();
        let square = [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(|(i, j)| {
            let apart = I[i] - I[j];
            if apart.abs() <= EQUAL * I[i] {
                return None;
            }
            let [one, other] = [(I[i], I[j], apart), (I[j], I[i], -apart)]
                .map(|(own, other, apart)| (momentum - other * energy) / (own * apart));
            Some(one + other).filter(|square| square.is_finite() && one.min(other) >= -EQUAL * now * now)
        });
        square.fold(now * now, f64::max).sqrt()
    }

    /// What a free turn's mean angular velocity is beyond that at its start, in rad/s, world axes: of the implicit
    /// midpoint rule, half of the gyroscopic term's gain and the higher orders. Nothing of a turn by more than half a
    /// radian.
    pub fn turns_on(&self, state: &BodyState, w_WB: &Vector3<f64>, span_s: f64) -> Vector3<f64> {
        const MOST: u32 = 20;
        const LARGEST_RAD: f64 = 0.5;
        let turn_rad = w_WB.norm() * span_s;
        if self.isotropic || self.driven || turn_rad.is_nan() || turn_rad > LARGEST_RAD {
            return Vector3::zeros();
        }
        // Of what rounding turns, as of a slab that slides, it is none.
        if turn_rad * self.I_B.norm() * self.I_B_inverse.norm() <= f64::EPSILON {
            return Vector3::zeros();
        }
        let w_B = state.q_WB.inverse_transform_vector(w_WB);
        let mut beyond_B = Vector3::zeros();
        // Contracts by the turn in radians, as far as the principal inertias differ.
        for _ in 0..MOST {
            let mean_B = w_B + beyond_B;
            let next_B = self.I_B_inverse * (self.I_B * mean_B).cross(&mean_B) * (span_s / 2.0);
            let change = (next_B - beyond_B).amax();
            beyond_B = next_B;
            if change <= f64::EPSILON * beyond_B.amax() {
                break;
            }
        }
        state.q_WB * beyond_B
    }

    fn turned(&self, tensor_B: &Matrix3<f64>, state: &BodyState) -> Matrix3<f64> {
        if self.isotropic {
            return *tensor_B;
        }
        let R_WB = state.q_WB.to_rotation_matrix().into_inner();
        R_WB * tensor_B * R_WB.transpose()
    }

    /// Position of the body frame's origin.
    pub fn p_WBo(&self, state: &BodyState) -> Vector3<f64> {
        state.p_WB - state.q_WB * self.p_BoBcm
    }

    /// Whether the container acts on the body. On one that moves as it is told it does not; other bodies feel it all
    /// the same.
    pub fn feels_container(&self) -> bool {
        !matches!(self.geometry, Geometry::None) && !self.driven
    }

    /// Whether it is a ball about its centre of mass, so that how it has turned does not matter.
    pub fn is_centred_ball(&self) -> bool {
        let at_centre = |geometry: &Geometry| match geometry {
            Geometry::Solid { solid: Solid::Sphere { .. }, centre } => *centre == Vector3::zeros(),
            _ => false,
        };
        self.isotropic && at_centre(&self.geometry)
    }

    /// Bound of what an impulse changes the velocity of any point of the body by, 1/kg; 0 of what moves as it is told.
    pub fn compliance_1_kg(&self) -> f64 {
        if self.driven {
            return 0.0;
        }
        1.0 / self.mass_kg + self.bounding_radius_m * self.bounding_radius_m * self.I_B_inverse.norm()
    }

    /// Solid that other bodies touch, and its centre from the centre of mass, in body axes.
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

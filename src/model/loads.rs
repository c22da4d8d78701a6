//! Loads of bodies beside gravity, contact and pins: applied forces and the resistance of the air.

use crate::experiment::types::Frame;
use crate::state::BodyState;
use nalgebra::Vector3;

/// A force, and the torque about the body's centre of mass, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    pub force: Vector3<f64>,
    pub torque: Vector3<f64>,
}

impl Wrench {
    pub const ZERO: Wrench = Wrench { force: Vector3::new(0.0, 0.0, 0.0), torque: Vector3::new(0.0, 0.0, 0.0) };
}

/// One force of `scene.forces`.
#[derive(Clone, Debug, PartialEq)]
pub struct AppliedForce {
    pub body: usize,
    pub force_n: Vector3<f64>,
    pub torque_n_m: Vector3<f64>,
    /// Lever arm from the centre of mass to where the force acts, body axes.
    pub r_B: Vector3<f64>,
    /// Frame that `force_n` and `torque_n_m` are in.
    pub frame: Frame,
    /// Rate ω and phase φ of cos(ωt + φ); None for a constant force.
    pub cosine: Option<(f64, f64)>,
}

impl AppliedForce {
    /// Force and its torque at a time.
    pub fn wrench(&self, t_s: f64, at: &BodyState) -> Wrench {
        let part = self.cosine.map_or(1.0, |(w, phase)| libm::cos(w * t_s + phase));
        let (mut force, mut torque) = (self.force_n * part, self.torque_n_m * part);
        if self.frame == Frame::Body {
            (force, torque) = (at.q_WB * force, at.q_WB * torque);
        }
        if self.r_B != Vector3::zeros() {
            torque += (at.q_WB * self.r_B).cross(&force);
        }
        Wrench { force, torque }
    }

    /// Whether it is a force of the world that never changes: its work is F·Δ(point), whatever the way there.
    pub fn is_weight_like(&self) -> bool {
        self.frame == Frame::World && self.cosine.is_none() && self.torque_n_m == Vector3::zeros()
    }
}

/// Resistance of the air to one body: −(c + k|v|) v at its centre of mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drag {
    /// Coefficient c.
    pub linear_n_s_m: f64,
    /// Coefficient k = ½ ρ C A.
    pub quadratic_n_s2_m2: f64,
}

impl Drag {
    pub fn is_none(&self) -> bool {
        *self == Drag::default()
    }

    pub fn force(&self, v: &Vector3<f64>) -> Vector3<f64> {
        -v * (self.linear_n_s_m + self.quadratic_n_s2_m2 * v.norm())
    }
}

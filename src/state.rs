//! Variables of a run: time, poses, velocities.

use nalgebra::{UnitQuaternion, Vector3};

/// Motion of one body, at its centre of mass, in the world frame (L6: u_G, R, v, ω).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    pub p_WB: Vector3<f64>,
    /// Attitude, body → world.
    pub q_WB: UnitQuaternion<f64>,
    pub v_WB: Vector3<f64>,
    pub w_WB: Vector3<f64>,
}

impl BodyState {
    pub fn is_finite(&self) -> bool {
        let sum = self.p_WB.sum() + self.q_WB.coords.sum() + self.v_WB.sum() + self.w_WB.sum();
        sum.is_finite()
    }
}

/// Motion of all bodies, in the order of the model's.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub step: u64,
    pub time_s: f64,
    pub bodies: Vec<BodyState>,
}

impl State {
    /// Makes this the other state, of as many bodies, without allocating.
    pub fn copy_from(&mut self, other: &State) {
        (self.step, self.time_s) = (other.step, other.time_s);
        self.bodies.copy_from_slice(&other.bodies);
    }
}

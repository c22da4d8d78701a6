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

    /// Whether position and attitude are the other one's, to the last bit.
    pub fn is_placed_as(&self, other: &BodyState) -> bool {
        let places = |at: &BodyState| [at.p_WB.x, at.p_WB.y, at.p_WB.z, at.q_WB.i, at.q_WB.j, at.q_WB.k, at.q_WB.w];
        places(self).map(f64::to_bits) == places(other).map(f64::to_bits)
    }

    /// The same of all of it.
    pub fn has_bits_of(&self, other: &BodyState) -> bool {
        let speeds = |at: &BodyState| [at.v_WB.x, at.v_WB.y, at.v_WB.z, at.w_WB.x, at.w_WB.y, at.w_WB.z];
        self.is_placed_as(other) && speeds(self).map(f64::to_bits) == speeds(other).map(f64::to_bits)
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

//! What moves a body: linear and angular velocity in one.

use crate::state::BodyState;
use nalgebra::Vector3;

/// Velocity of a body, or a change of it: the lecture's generalised V (L13).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    pub v: Vector3<f64>,
    pub w: Vector3<f64>,
}

impl Twist {
    pub const ZERO: Twist = Twist { v: Vector3::new(0.0, 0.0, 0.0), w: Vector3::new(0.0, 0.0, 0.0) };

    pub fn of(at: &BodyState) -> Self {
        Twist { v: at.v_WB, w: at.w_WB }
    }

    /// A part of the way to another one.
    pub fn toward(&self, other: &Twist, part: f64) -> Twist {
        Twist { v: self.v + (other.v - self.v) * part, w: self.w + (other.w - self.w) * part }
    }

    pub fn times(&self, factor: f64) -> Twist {
        Twist { v: self.v * factor, w: self.w * factor }
    }

    pub(super) fn add_scaled(&mut self, other: &Twist, factor: f64) {
        self.v += other.v * factor;
        self.w += other.w * factor;
    }
}

//! Drive of a body between contacts.

use crate::model::{Body, Model};
use nalgebra::Vector3;

/// Accelerations of a body, gyroscopic term apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Acceleration of the centre of mass, in m/s², world axes.
    pub acceleration: Vector3<f64>,
    /// Torque about the centre of mass, in N m, body axes.
    pub torque_B: Vector3<f64>,
}

impl Drive {
    pub fn of_gravity(model: &Model) -> Self {
        Drive { acceleration: model.gravity_m_s2, torque_B: Vector3::zeros() }
    }

    /// Whether ω changes: without a torque, moments of inertia that are all equal leave it as it is.
    pub fn turns(&self, body: &Body) -> bool {
        !body.spins_steadily || self.torque_B != Vector3::zeros()
    }
}

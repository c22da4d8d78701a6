//! What drives a body between contacts.

use crate::model::{Body, Model};
use nalgebra::Vector3;

/// What changes a body's velocities, gyroscopic term apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Of the centre of mass, world axes.
    pub acceleration: Vector3<f64>,
    /// About the centre of mass, body axes.
    pub torque_B: Vector3<f64>,
}

impl Drive {
    pub fn of_gravity(model: &Model) -> Self {
        Drive { acceleration: model.gravity_m_s2, torque_B: Vector3::zeros() }
    }

    /// Without a torque, moments of inertia that are all equal leave ω as it is.
    pub fn turns(&self, body: &Body) -> bool {
        !body.isotropic || self.torque_B != Vector3::zeros()
    }
}

//! What moves with a point of contact.

use crate::collide::Contact;
use crate::state::BodyState;
use nalgebra::Vector3;

/// Rates of a geometric point of contact: from both centres of mass, and of the normal.
pub(super) struct Rates {
    pub(super) r_A: Vector3<f64>,
    pub(super) r_B: Vector3<f64>,
    pub(super) normal: Vector3<f64>,
}

/// A contact's two bodies; of one with the container the same twice.
pub(super) fn pair<'a>(found: &Contact, at: &impl Fn(usize) -> &'a BodyState) -> [&'a BodyState; 2] {
    [found.body, found.other.unwrap_or(found.body)].map(at)
}

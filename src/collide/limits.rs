//! How far a contact test looks: gaps up to which what is apart counts.

use super::closed::unresolved_m;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::Vector3;

/// Gap that still is a contact wherever bodies move, of the body's bounding radius: what touches with gap zero is one
/// whatever its last bit says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    pub margin: f64,
}

impl Reach {
    /// Reach of what is inside.
    pub const INSIDE: Reach = Reach { margin: 0.0 };

    /// Reach of one body, in metres.
    pub(super) fn margin_m(&self, body: &Body, at: &BodyState) -> f64 {
        if self.margin == 0.0 { 0.0 } else { self.margin * body.bounding_radius_m + unresolved_m(at.p_WB.amax()) }
    }
}

/// Gaps up to which a contact test looks, in metres.
pub(super) trait Limits {
    /// Of a body and a face with this normal.
    fn face_m(&self, body: usize, normal: &Vector3<f64>) -> f64;
    /// Of two bodies.
    fn pair_m(&self, pair: [usize; 2]) -> f64;
    /// Around a body, for the search of pairs: two of them cover `pair_m`.
    fn around_m(&self, body: usize) -> f64;
}

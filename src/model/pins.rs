//! Ball joints (L17): a point of a body is held where it was at the start, in the world or on another body.

use crate::state::BodyState;
use nalgebra::Vector3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Index of the body, which is moved by what acts on it.
    pub body: usize,
    /// Vector from its centre of mass to the pin, body axes.
    pub r_B: Vector3<f64>,
    pub anchor: Anchor,
}

/// Holder of a pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Anchor {
    World(Vector3<f64>),
    /// Index of a body, and the vector from its centre of mass to the pin in its axes.
    Body(usize, Vector3<f64>),
}

impl Pin {
    /// Whether the pin holds this body, on either side.
    pub fn holds(&self, index: usize) -> bool {
        self.body == index || matches!(self.anchor, Anchor::Body(other, _) if other == index)
    }

    /// Distance between the two points that it holds together.
    pub fn gap_m(&self, bodies: &[BodyState]) -> f64 {
        self.apart_W(bodies).norm()
    }

    /// Vector from the anchor to the body's point.
    pub fn apart_W(&self, bodies: &[BodyState]) -> Vector3<f64> {
        let point = |index: usize, r_B: &Vector3<f64>| bodies[index].p_WB + bodies[index].q_WB * r_B;
        let anchor = match &self.anchor {
            Anchor::World(p_W) => *p_W,
            Anchor::Body(other, r_B) => point(*other, r_B),
        };
        point(self.body, &self.r_B) - anchor
    }
}

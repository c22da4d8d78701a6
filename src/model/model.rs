//! The model: all that is constant during a run.

use super::body::Body;
use super::container::Container;
use super::loads::AppliedForce;
use super::pins::{self, Pin};
use super::surface::{Pair, Surface};
use nalgebra::Vector3;

#[derive(Clone, Debug)]
pub struct Model {
    pub gravity_m_s2: Vector3<f64>,
    pub bodies: Vec<Body>,
    pub container: Option<Container>,
    pub container_surface: Surface,
    /// Pairs that are not the mean of their own.
    pub pairs: Vec<Pair>,
    pub forces: Vec<AppliedForce>,
    pub pins: Vec<Pin>,
    /// A point at height zero of the potential energy.
    pub potential_zero_m: Vector3<f64>,
    /// Some two bodies may touch each other.
    pub touching_pairs: bool,
}

impl Model {
    /// Two bodies on one pin do not touch: they meet where they are pinned.
    pub fn are_pinned(&self, [a, b]: [usize; 2]) -> bool {
        let joins = |pin: &Pin, a, b| pin.body == a && matches!(pin.anchor, pins::Anchor::Body(other, _) if other == b);
        self.pins.iter().any(|pin| joins(pin, a, b) || joins(pin, b, a))
    }

    /// Of the bodies' bounding spheres; 0: points.
    pub fn largest_radius_m(&self) -> f64 {
        self.bodies.iter().map(|body| body.bounding_radius_m).fold(0.0, f64::max)
    }

    /// Of the body at `p_WB`: −m g·(p − p₀).
    pub fn potential_j(&self, body: &Body, p_WB: &Vector3<f64>) -> f64 {
        -body.mass_kg * self.gravity_m_s2.dot(&(p_WB - self.potential_zero_m))
    }
}

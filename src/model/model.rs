//! The model: all that is constant during a run.

use super::body::{Body, Geometry};
use super::container::Container;
use super::loads::{AppliedForce, Wrench};
use super::pins::{self, Pin};
use super::surface::{Pair, Surface};
use crate::experiment::types::Skips;
use crate::shared::Shared;
use crate::state::BodyState;
use nalgebra::Vector3;

#[derive(Clone, Debug)]
pub struct Model {
    pub gravity_m_s2: Vector3<f64>,
    /// Bodies, which cases of one scene share.
    pub bodies: Shared<Vec<Body>>,
    pub container: Option<Container>,
    pub container_surface: Surface,
    /// Pairs whose surface is not the mean of the two bodies'.
    pub pairs: Vec<Pair>,
    pub forces: Vec<AppliedForce>,
    pub pins: Vec<Pin>,
    /// A point at height zero of the potential energy.
    pub potential_zero_m: Vector3<f64>,
    /// What a run leaves out where the scene does not need it.
    pub skips: Skips,
    /// Whether some two bodies may touch each other.
    pub touching_pairs: bool,
}

impl Model {
    /// Whether two bodies are on one pin: such bodies do not touch, as they meet where they are pinned.
    pub fn are_pinned(&self, [a, b]: [usize; 2]) -> bool {
        let joins = |pin: &Pin, a, b| pin.body == a && matches!(pin.anchor, pins::Anchor::Body(other, _) if other == b);
        self.pins.iter().any(|pin| joins(pin, a, b) || joins(pin, b, a))
    }

    /// Largest radius of the bodies' bounding spheres; 0 for points.
    pub fn largest_radius_m(&self) -> f64 {
        self.bodies.iter().map(|body| body.bounding_radius_m).fold(0.0, f64::max)
    }

    /// Potential energy −m g·(p − p₀) of the body at `p_WB`.
    pub fn potential_j(&self, body: &Body, p_WB: &Vector3<f64>) -> f64 {
        -body.mass_kg * self.gravity_m_s2.dot(&(p_WB - self.potential_zero_m))
    }

    /// Whether anything but gravity, contact and pins acts on a body.
    pub fn has_loads(&self) -> bool {
        !self.forces.is_empty() || self.bodies.iter().any(|body| !body.drag.is_none())
    }

    /// Whether some of it changes along the way of its body.
    pub fn has_varying_loads(&self) -> bool {
        self.forces.iter().any(|force| !force.is_weight_like()) || self.bodies.iter().any(|body| !body.drag.is_none())
    }

    /// Whether a driven body holds a pin: else pins do no work.
    pub fn has_driven_pins(&self) -> bool {
        let driven = |pin: &Pin| matches!(pin.anchor, pins::Anchor::Body(other, _) if self.bodies[other].driven);
        self.pins.iter().any(driven)
    }

    /// The acceleration of the centre of mass, if nothing acts on the body but gravity and constant forces that do not
    /// turn it.
    pub fn constant_pull(&self, index: usize) -> Option<Vector3<f64>> {
        let body = &self.bodies[index];
        let mut pull = self.gravity_m_s2;
        for force in self.forces.iter().filter(|force| force.body == index) {
            if !force.is_weight_like() || force.r_B != Vector3::zeros() {
                return None;
            }
            pull += force.force_n / body.mass_kg;
        }
        body.drag.is_none().then_some(pull)
    }

    /// All that acts on one body beside gravity, contact and pins.
    pub fn load(&self, index: usize, t_s: f64, at: &BodyState) -> Wrench {
        let drag = &self.bodies[index].drag;
        let mut sum = Wrench::ZERO;
        if !drag.is_none() {
            sum.force = drag.force(&at.v_WB);
        }
        for applied in self.forces.iter().filter(|applied| applied.body == index) {
            let wrench = applied.wrench(t_s, at);
            sum.force += wrench.force;
            sum.torque += wrench.torque;
        }
        sum
    }

    /// Velocities M⁻¹ F_E h (L14) that gravity and loads add to v and ω of one body in a step, at the state before it.
    pub fn gained(&self, index: usize, t_s: f64, at: &BodyState, step_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let body = &self.bodies[index];
        if body.driven {
            return (Vector3::zeros(), Vector3::zeros());
        }
        let gravity = self.gravity_m_s2 * step_s;
        if self.forces.is_empty() && body.drag.is_none() {
            return (gravity, Vector3::zeros());
        }
        let load = self.load(index, t_s, at);
        (gravity + load.force * (step_s / body.mass_kg), body.I_W_inverse(at) * load.torque * step_s)
    }

    /// Largest gap of all pins; None without a pin.
    pub fn pin_gap_m(&self, bodies: &[BodyState]) -> Option<f64> {
        self.pins.iter().map(|pin| pin.gap_m(bodies)).reduce(f64::max)
    }

    /// Surface of a pair: two bodies, or a body and the container.
    pub fn pair(&self, body: usize, other: Option<usize>) -> Surface {
        let own = self.bodies[body].surface;
        let others = other.map_or(self.container_surface, |other| self.bodies[other].surface);
        let given = self.pairs.iter().find(|pair| {
            let [a, b] = pair.between;
            (a, b) == (Some(body), other) || (b, a) == (Some(body), other)
        });
        Surface {
            friction: given.and_then(|pair| pair.friction).unwrap_or_else(|| mean(own.friction, others.friction)),
            restitution: given
                .and_then(|pair| pair.restitution)
                .unwrap_or_else(|| mean(own.restitution, others.restitution)),
            tangential_restitution: given.and_then(|pair| pair.tangential_restitution).unwrap_or(0.0),
        }
    }

    /// Whether some contact that can be has friction.
    pub fn is_rough(&self) -> bool {
        let touching = |body: &Body| !matches!(body.geometry, Geometry::None) && body.surface.friction > 0.0;
        self.bodies.iter().any(touching) || self.pairs.iter().any(|pair| pair.friction.is_some_and(|f| f > 0.0))
    }
}

/// Geometric; of equal values the value itself, to the last bit.
fn mean(a: f64, b: f64) -> f64 {
    if a == b { a } else { (a * b).sqrt() }
}

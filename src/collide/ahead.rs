//! How far bodies may come in a step: by themselves, and by impulses that others put on them.

use super::closed::MARGIN;
use super::limits::{Limits, Reach};
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector3;

/// A turn in radians from which angular velocities do not stay as they are.
const FAR: f64 = 0.25;

/// Ways of all bodies through a step from where they stand.
pub struct Ahead<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    /// Velocity and angular velocity of a body, with the step's forces and without its impulses.
    pub free: &'a dyn Fn(usize) -> [Vector3<f64>; 2],
    /// How far the step's impulses may lead a body from its free way, any point of it, in metres.
    pub slack_m: &'a [f64],
    pub step_s: f64,
}

impl Ahead<'_> {
    /// The way of a body's points beside its centre's free way.
    fn beside_m(&self, body: usize) -> f64 {
        let [_, w] = (self.free)(body);
        let of = &self.model.bodies[body];
        // What turns far without a torque may come to turn faster.
        let is_far = w.norm() * self.step_s > FAR && !of.is_centred_ball();
        let turning_m_s = match is_far {
            true => of.fastest_turn_rad_s(&self.state.bodies[body], &w) * of.bounding_radius_m,
            false => of.turning_m_s(&w),
        };
        self.step_s * turning_m_s + self.slack_m[body]
    }

    fn margin_m(&self, body: usize) -> f64 {
        Reach { margin: MARGIN }.margin_m(&self.model.bodies[body], &self.state.bodies[body])
    }
}

impl Limits for Ahead<'_> {
    fn face_m(&self, body: usize, normal: &Vector3<f64>) -> f64 {
        let [v, _] = (self.free)(body);
        self.margin_m(body) + (self.beside_m(body) - self.step_s * normal.dot(&v)).max(0.0)
    }

    fn pair_m(&self, [a, b]: [usize; 2]) -> f64 {
        let together_m = self.step_s * ((self.free)(a)[0] - (self.free)(b)[0]).norm();
        self.margin_m(a).max(self.margin_m(b)) + together_m + self.beside_m(a) + self.beside_m(b)
    }

    fn around_m(&self, body: usize) -> f64 {
        self.margin_m(body) + self.step_s * (self.free)(body)[0].norm() + self.beside_m(body)
    }
}

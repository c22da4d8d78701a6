//! The way of a body through a step, or a part of it: straight on, turning steadily.

use super::figure::Stand;
use crate::state::BodyState;
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::{PI, TAU};

/// From one stand to another.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    pub from: Stand,
    pub moved: Vector3<f64>,
    /// Angle times axis, world frame.
    pub turned: Vector3<f64>,
}

impl Leg {
    /// Between two states of a body. What turns by more than half a turn shows it by its angular velocity alone.
    pub fn between(before: &BodyState, after: &BodyState, span_s: f64) -> Self {
        let mut turned = (after.q_WB * before.q_WB.inverse()).scaled_axis();
        let told = after.w_WB * span_s;
        let angle = turned.norm();
        if told.norm() > PI && angle > 0.0 {
            let axis = turned / angle;
            turned += axis * (TAU * ((axis.dot(&told) - angle) / TAU).round());
        }
        Leg { from: before.into(), moved: after.p_WB - before.p_WB, turned }
    }

    /// Between two stands that are less than half a turn apart.
    pub fn to(from: Stand, to: &Stand) -> Self {
        Leg { from, moved: to.p_WB - from.p_WB, turned: (to.q_WB * from.q_WB.inverse()).scaled_axis() }
    }

    pub fn at(&self, part: f64) -> Stand {
        let q_WB = UnitQuaternion::from_scaled_axis(self.turned * part) * self.from.q_WB;
        Stand { p_WB: self.from.p_WB + self.moved * part, q_WB }
    }
}

/// The most that the distance of two bodies can change on their ways.
pub fn most_m(legs: [&Leg; 2], radii_m: [f64; 2]) -> f64 {
    let [a, b] = legs;
    (a.moved - b.moved).norm() + a.turned.norm() * radii_m[0] + b.turned.norm() * radii_m[1]
}

//! Pins among the contacts of a problem.

use super::block::{Block, largest_eigenvalue};
use super::end::{End, Inertia};
use super::twist::Twist;
use crate::model::Model;
use crate::model::pins::{Anchor, Pin as Joint};
use crate::state::State;
use nalgebra::Vector3;

/// A point of a body that is held, or follows a point of another body: v_rel + A p = `velocity_W`, p any impulse, in
/// world axes.
#[derive(Clone, Copy, Debug)]
pub struct Pin {
    pub end: PinEnd,
    pub other: Option<PinEnd>,
    /// Wanted, of the first end's point against the other's times their signs.
    pub velocity_W: Vector3<f64>,
}

#[derive(Clone, Copy, Debug)]
pub struct PinEnd {
    pub body: usize,
    /// Of the pin's impulse on this body.
    pub sign: f64,
    /// From the centre of mass to the point, world axes.
    pub r_W: Vector3<f64>,
}

/// Fills `out` with the model's pins at this state. `wanted_W`: the velocity that one is to have, from its ends; a
/// pin to the world has one.
pub fn at(
    model: &Model,
    state: &State,
    wanted_W: impl Fn(&Joint, &PinEnd, Option<&PinEnd>) -> Vector3<f64>,
    out: &mut Vec<Pin>,
) {
    out.clear();
    out.extend(model.pins.iter().map(|pin| {
        let end = |body: usize, sign: f64, r_B: &Vector3<f64>| {
            let r_W = state.bodies[body].q_WB * r_B;
            PinEnd { body, sign, r_W }
        };
        let own = end(pin.body, 1.0, &pin.r_B);
        let other = match &pin.anchor {
            Anchor::World(_) => None,
            Anchor::Body(other, r_B) => Some(end(*other, -1.0, r_B)),
        };
        Pin { end: own, other, velocity_W: wanted_W(pin, &own, other.as_ref()) }
    }));
}

impl Block {
    pub(super) fn of_pin(pin: &Pin, free: &[Twist], inertias: &[Inertia]) -> Self {
        let frame = [Vector3::x(), Vector3::y(), Vector3::z()];
        let end = |end: &PinEnd| End::new(end.body, end.sign, &end.r_W, &frame, &inertias[end.body]);
        let (end, other) = (end(&pin.end), pin.other.as_ref().map(end));
        let ends = || std::iter::once(&end).chain(&other);
        let A = ends().map(|end| end.coupling(end)).reduce(|a, b| a + b).unwrap_or_default();
        Block {
            end,
            other,
            friction: 0.0,
            A,
            inverse_diagonal: A.diagonal().map(|d| 1.0 / d),
            tangent_step: 1.0 / largest_eigenvalue(A[(1, 1)], A[(2, 2)], A[(1, 2)]),
            b: ends().map(|end| end.motion(&free[end.body])).sum::<Vector3<f64>>() - pin.velocity_W,
            frame,
            pin: Some(A.try_inverse().unwrap_or_default()),
            least: 0.0,
            turning: 0.0,
            held: None,
            before: Vector3::zeros(),
            tangential_restitution: 0.0,
            hold: None,
            meant: false,
            against: Vector3::zeros(),
        }
    }
}

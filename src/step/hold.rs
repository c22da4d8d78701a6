//! Pins among the contacts of a step: the velocity that closes what gap there is until the next step.

use crate::model::Model;
use crate::model::pins::Anchor;
use crate::solve::pins::{Pin, PinEnd};
use crate::state::State;
use nalgebra::Vector3;

/// Fills `out` with the model's pins at this state.
pub fn pins(model: &Model, state: &State, step_s: f64, out: &mut Vec<Pin>) {
    out.clear();
    out.extend(model.pins.iter().map(|pin| {
        let at = |body: usize, r_B: &Vector3<f64>| state.bodies[body].q_WB * r_B;
        let end = PinEnd { body: pin.body, sign: 1.0, r_W: at(pin.body, &pin.r_B) };
        let point_W = state.bodies[pin.body].p_WB + end.r_W;
        let (other, held_W) = match &pin.anchor {
            Anchor::World(p_W) => (None, *p_W),
            Anchor::Body(other, r_B) => {
                let end = PinEnd { body: *other, sign: -1.0, r_W: at(*other, r_B) };
                (Some(end), state.bodies[*other].p_WB + end.r_W)
            }
        };
        Pin { end, other, velocity_W: (held_W - point_W) / step_s }
    }));
}

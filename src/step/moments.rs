//! States and forces on a smooth way, for what a judge adds up along it.

use crate::math::quadrature;
use crate::model::Model;
use crate::shown::{Moment, Passage};
use crate::state::State;

/// At the nodes of Gauss's quadrature with five points, of so long a way from a state.
pub(super) fn moments(way: &impl Passage, model: &Model, from: &State, span_s: f64) -> Vec<Moment> {
    let moment = |(node, weight): (f64, f64)| {
        let mut state = from.clone();
        state.time_s = from.time_s + node * span_s;
        way.state_at(model, &mut state);
        let contacts = way.forces_at(model, &state);
        Moment { state, contacts, weight_s: weight * span_s }
    };
    quadrature::FIVE.into_iter().map(moment).collect()
}

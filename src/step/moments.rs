//! States and forces on a smooth way, for what a judge adds up along it.

use crate::math::quadrature;
use crate::shown::{ContactForce, Moment};
use crate::state::State;

/// Moments at the nodes of Gauss's quadrature with five points, of so long a way from a state; `place` puts the bodies
/// of a state where they are at its time, and tells the forces of their contacts.
pub(super) fn moments(
    from: &State,
    span_s: f64,
    mut place: impl FnMut(&mut State) -> Vec<ContactForce>,
) -> Vec<Moment> {
    let moment = |(node, weight): (f64, f64)| {
        let mut state = from.clone();
        state.time_s = from.time_s + node * span_s;
        let contacts = place(&mut state);
        Moment { state, contacts, weight_s: weight * span_s }
    };
    quadrature::FIVE.into_iter().map(moment).collect()
}

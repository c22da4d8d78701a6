//! Bodies that are not driven: those that energy and momentum are of.

use crate::model::{Body, Model};
use crate::state::{BodyState, State};

/// Bodies that are not driven, with their states.
pub(super) fn moving<'a>(model: &'a Model, state: &'a State) -> impl Iterator<Item = (&'a Body, &'a BodyState)> {
    model.bodies.iter().zip(&state.bodies).filter(|(body, _)| !body.driven)
}

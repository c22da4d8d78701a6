//! Two bodies as one contact sees them.

use super::Contact;
use crate::model::Model;
use crate::model::surface::Surface;
use crate::shape::solid::Meeting;
use crate::state::State;

/// A point of contact of two bodies as they stand.
pub(super) fn of_pair(model: &Model, state: &State, pair: [usize; 2], touch: &Meeting) -> Contact {
    let Surface { friction, restitution, tangential_restitution } = model.pair(pair[0], Some(pair[1]));
    Contact {
        body: pair[0],
        other: Some(pair[1]),
        feature: touch.feature,
        r_BC_W: touch.p_W - state.bodies[pair[0]].p_WB,
        r_OC_W: touch.p_W - state.bodies[pair[1]].p_WB,
        p_WC: touch.p_W,
        normal: touch.normal,
        gap_m: touch.gap_m,
        friction,
        restitution,
        tangential_restitution,
    }
}

//! A corner that has slid over the end of a round side.

use super::moving::BORDER;
use crate::model::Body;
use crate::shape::cylinder::{EDGE, VERTEX, kind};
use crate::shape::solid::Solid;
use crate::state::BodyState;
use nalgebra::Vector3;

/// Whether what the contact test calls a corner on a round side is beyond that one's end: nothing is there, and what is
/// behind the corner comes to the rim. It takes the two as one up to half of this, and its point is half-way between.
pub fn is_past_end(bodies: [(&Body, &BodyState); 2], feature: (u32, u32), p_W: &Vector3<f64>) -> bool {
    let round = match [feature.0, feature.1].map(kind) {
        [EDGE, VERTEX] => 0,
        [VERTEX, EDGE] => 1,
        _ => return false,
    };
    let (body, at) = bodies[round];
    let Some((Solid::Cylinder { half_height_m, .. }, centre)) = body.solid() else { return false };
    let is_corner = matches!(bodies[1 - round].0.solid(), Some((Solid::Box { .. } | Solid::Convex(_), _)));
    let slack_m = 0.5 * BORDER * bodies.iter().map(|(body, _)| body.bounding_radius_m).sum::<f64>();
    is_corner && (at.q_WB.inverse_transform_vector(&(p_W - at.p_WB)) - centre).y.abs() > half_height_m + slack_m
}

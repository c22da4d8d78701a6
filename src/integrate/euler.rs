//! The lecture's two Euler methods (L5), order 1: the slide's formula moves with the old velocity (explicit), its C
//! program with the new one (semi-implicit). Rotation in body axes, with the gyroscopic term.

use super::rotation::{exponential, gyroscopic_acceleration_B};
use crate::experiment::types::Update;
use crate::measure::work::Work;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::Vector3;

/// One step of a body under a constant acceleration.
pub fn step(
    body: &Body,
    at: &mut BodyState,
    acceleration: &Vector3<f64>,
    update: Update,
    step_s: f64,
    work: &mut Work,
) {
    let old = *at;
    at.v_WB += acceleration * step_s;
    if !body.isotropic {
        work.gyroscopic += 1;
        let w_B = at.q_WB.inverse_transform_vector(&at.w_WB);
        at.w_WB += at.q_WB * gyroscopic_acceleration_B(body, &w_B) * step_s;
    }
    let moving = match update {
        Update::Explicit => &old,
        Update::SemiImplicit => &*at,
    };
    let (dp, dq) = (moving.v_WB * step_s, exponential(&(moving.w_WB * step_s)));
    at.p_WB += dp;
    if !body.isotropic {
        // ω was advanced in body axes: it turns with them.
        at.w_WB = dq * at.w_WB;
    }
    at.q_WB = dq * at.q_WB;
    at.q_WB.renormalize();
}

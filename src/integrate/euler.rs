//! The lecture's two Euler methods (L5), order 1: the slide's formula moves with the old velocity (explicit), its C
//! program with the new one (semi-implicit). Rotation in body axes, with the gyroscopic term.

use super::chain::Chain;
use super::drive::Drive;
use super::rotation::{exponential, gyroscopic_torque_B};
use crate::experiment::types::Update;
use crate::model::{Body, Model};
use crate::state::BodyState;
use crate::work::Work;

/// Takes an island over a step of `h` from `t_s`, by the drives at its start.
pub fn step(update: Update, island: &mut Chain, model: &Model, [t_s, h]: [f64; 2], work: &mut Work) {
    island.drive(model, t_s, work);
    for (body, at, drive) in island.each(model) {
        advance(body, at, drive, update, h, work);
    }
}

fn advance(body: &Body, at: &mut BodyState, drive: &Drive, update: Update, h: f64, work: &mut Work) {
    let old = *at;
    at.v_WB += drive.acceleration * h;
    let turns = drive.turns(body);
    if turns {
        work.gyroscopic += u64::from(!body.spins_steadily);
        let w_B = at.q_WB.inverse_transform_vector(&at.w_WB);
        let torque_B = gyroscopic_torque_B(body, &w_B) + drive.torque_B;
        at.w_WB += at.q_WB * (body.I_B_inverse * torque_B) * h;
    }
    let moving = match update {
        Update::Explicit => &old,
        Update::SemiImplicit => &*at,
    };
    let (dp, dq) = (moving.v_WB * h, exponential(&(moving.w_WB * h)));
    at.p_WB += dp;
    if turns {
        // ω was advanced in body axes: it turns with them.
        at.w_WB = dq * at.w_WB;
    }
    at.q_WB = dq * at.q_WB;
    at.q_WB.renormalize();
}

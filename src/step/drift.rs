//! Motion between impulses: straight on, and the torque-free rotation in closed form, which keeps energy and momentum.

use crate::exact::free_rotation::FreeRotation;
use crate::integrate::momentum::{momentum_W, velocity_W};
use crate::integrate::rotation::exponential;
use crate::measure::work::Work;
use crate::model::Model;
use crate::state::State;

/// Moves all bodies for a time at constant velocity and angular momentum; those that move as they are told at constant
/// angular velocity.
pub fn drift(model: &Model, state: &mut State, time_s: f64, work: &mut Work) {
    if time_s == 0.0 {
        return;
    }
    state.time_s += time_s;
    for (body, at) in model.bodies.iter().zip(&mut state.bodies) {
        at.p_WB += at.v_WB * time_s;
        if body.isotropic || body.driven {
            at.q_WB = exponential(&(at.w_WB * time_s)) * at.q_WB;
        } else if at.w_WB.amax() > 0.0 && at.is_finite() {
            work.gyroscopic += 1;
            let L_W = momentum_W(body, &at.q_WB, &at.w_WB);
            at.q_WB = FreeRotation::new(&body.I_B, &at.q_WB, &at.w_WB).at(time_s).0;
            at.w_WB = velocity_W(body, &at.q_WB, &L_W);
        }
        at.q_WB.renormalize();
    }
}

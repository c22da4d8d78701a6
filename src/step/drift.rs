//! Motion between impulses: straight on, and a torque-free rotation that keeps energy and momentum: the implicit
//! midpoint rule, order 2; of fast turns, which it cannot follow, and of those that lead far beside a body that may be
//! hit, the closed form at twenty times the cost.

use crate::exact::free_rotation::FreeRotation;
use crate::integrate::implicit_midpoint;
use crate::integrate::momentum::{cayley, momentum_W, turn, velocity_W};
use crate::integrate::rotation::exponential;
use crate::model::Model;
use crate::state::State;
use crate::work::Work;

/// Radians in a step.
const SLOW: f64 = 0.5;

/// Moves all bodies for a time at constant velocity and angular momentum; those that move as they are told at constant
/// angular velocity. `turns_far`: of every body, whether its turn is to be exact however short.
pub fn drift(model: &Model, state: &mut State, time_s: f64, turns_far: &[bool], work: &mut Work) {
    if time_s == 0.0 {
        return;
    }
    state.time_s += time_s;
    for ((body, at), turns_far) in model.bodies.iter().zip(&mut state.bodies).zip(turns_far) {
        at.p_WB += at.v_WB * time_s;
        if body.spins_steadily || body.driven {
            at.q_WB = exponential(&(at.w_WB * time_s)) * at.q_WB;
        } else if at.w_WB.amax() > 0.0 && at.is_finite() {
            let L_W = momentum_W(body, &at.q_WB, &at.w_WB);
            let is_slow = at.w_WB.norm() * time_s <= SLOW && !turns_far;
            let turn = is_slow.then(|| turn(implicit_midpoint::equation, body, &at.q_WB, &L_W, time_s, work)).flatten();
            at.q_WB = match turn {
                Some(c) => at.q_WB * cayley(&c),
                None => FreeRotation::new(&body.I_B, &at.q_WB, &at.w_WB).at(time_s).0,
            };
            at.w_WB = velocity_W(body, &at.q_WB, &L_W);
        }
        at.q_WB.renormalize();
    }
}

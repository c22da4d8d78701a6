//! Motion under constant acceleration and constant angular acceleration (world axes), and its succession: what a body
//! does between events. The attitude is elementary where the axis stays, else by `attitude.rs`, or by `following.rs` if
//! that takes fewer steps.

use super::attitude::{self, Turned};
use super::following;
use crate::state::BodyState;
use nalgebra::{UnitQuaternion, Vector3};

/// Steps of a radian, above which `following.rs` takes over: it makes at most 200 itself.
const MANY: f64 = 256.0;

#[derive(Clone, Debug)]
pub struct Arc {
    /// Time at which the arc begins, in seconds.
    pub t_s: f64,
    pub from: BodyState,
    pub acceleration_m_s2: Vector3<f64>,
    pub angular_rad_s2: Vector3<f64>,
}

impl Arc {
    /// An arc of a body that does not begin to turn.
    pub fn straight(t_s: f64, from: BodyState, acceleration_m_s2: Vector3<f64>) -> Self {
        Arc { t_s, from, acceleration_m_s2, angular_rad_s2: Vector3::zeros() }
    }

    pub fn at(&self, t_s: f64) -> BodyState {
        let (t, from) = (t_s - self.t_s, &self.from);
        BodyState {
            p_WB: from.p_WB + (from.v_WB + self.acceleration_m_s2 * (t / 2.0)) * t,
            q_WB: self.turned(t).q_WB,
            v_WB: from.v_WB + self.acceleration_m_s2 * t,
            w_WB: from.w_WB + self.angular_rad_s2 * t,
        }
    }

    /// The attitude after a time (s) from the beginning.
    pub fn turned(&self, t: f64) -> Turned {
        let (w, alpha) = (self.from.w_WB, self.angular_rad_s2);
        if w.cross(&alpha).norm() <= f64::EPSILON * w.norm() * alpha.norm() {
            let turn = UnitQuaternion::from_scaled_axis((w + alpha * (t / 2.0)) * t);
            return Turned { q_WB: turn * self.from.q_WB, steps: 0 };
        }
        let rate = w.norm() + alpha.norm() * t.abs();
        if rate * t.abs() > MANY {
            return following::turned(&self.from.q_WB, &w, &alpha, t);
        }
        attitude::turned(&self.from.q_WB, t, rate, |t| [w + alpha * t, alpha])
    }
}

/// State at a time of arcs that follow one another; the first is taken before its beginning as well.
pub fn at(arcs: &[Arc], t_s: f64) -> BodyState {
    let begun = arcs.partition_point(|arc| arc.t_s <= t_s);
    arcs[begun.max(1) - 1].at(t_s)
}

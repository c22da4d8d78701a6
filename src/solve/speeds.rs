//! What a step does to a body, which residuals are compared with: as the judge has it (`measure::residual`), by the
//! body that it does least to, so that a light body under a heavy one counts.

use super::twist::Twist;
use crate::state::BodyState;

/// Least change of a body's velocity, of its speed, as the judge has it.
const SMALL: f64 = 1e-5;

/// Speeds of a body, |v| and |ω|: with the step's forces, and what these add to them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Speeds {
    free: [f64; 2],
    gained: [f64; 2],
}

impl Speeds {
    pub(super) fn of(at: &BodyState, free: &Twist, is_instant: bool) -> Self {
        let gained = if is_instant { [0.0; 2] } else { [(free.v - at.v_WB).norm(), (free.w - at.w_WB).norm()] };
        Speeds { free: [free.v.norm(), free.w.norm()], gained }
    }

    /// Bound of the speed of a point so far from the centre of mass.
    pub(super) fn at(&self, arm_m: f64) -> f64 {
        self.free[0] + self.free[1] * arm_m
    }
}

/// What a step does to a body: the velocities that its impulses together change, the step's forces if these do more,
/// and what of Σ|p|/m counts beside them though impulses cancel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Acted {
    pub(super) speeds: Speeds,
    pub(super) changed: [f64; 2],
    pub(super) pressed: f64,
}

impl Acted {
    /// At a point so far from the centre of mass; at least 10⁻⁵ of its speed.
    pub(super) fn at(&self, arm_m: f64) -> f64 {
        let speed = |[v, w]: &[f64; 2]| v + w * arm_m;
        let acted = speed(&self.changed).max(speed(&self.speeds.gained)).max(self.pressed);
        acted.max(SMALL * self.speeds.at(arm_m))
    }
}

/// Part of a scale; 0 of a scale that is 0 as well.
pub(super) fn relative(amount: f64, scale: f64) -> f64 {
    if amount == 0.0 { 0.0 } else { amount / scale }
}

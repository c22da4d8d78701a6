//! How far impulses are from the law of contact, as the judge measures it (`measure::residual`): against what the step
//! does to the body that it does least to, so that a light body under a heavy one counts.

use super::Impulse;
use super::block::Block;
use super::law;
use super::problem::ContactProblem;
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
        acted.max(SMALL * speed(&self.speeds.free))
    }
}

/// Part of a scale; 0 of a scale that is 0 as well.
pub(super) fn relative(amount: f64, scale: f64) -> f64 {
    if amount == 0.0 { 0.0 } else { amount / scale }
}

/// The largest residual of all contacts, by what every body gets alone, however much presses it. `u`: M⁻¹ Jᵀ p.
pub fn strict_residual(problem: &ContactProblem, p: &[Impulse], u: &[Twist]) -> f64 {
    let scale = |block: &Block| {
        let of = |body: usize| {
            let changed = [u[body].v.norm(), u[body].w.norm()];
            Acted { speeds: problem.speeds[body], changed, pressed: 0.0 }
        };
        let moved = block.ends().map(|end| (end, end.compliance())).filter(|(_, compliance)| *compliance > 0.0);
        moved.map(|(end, compliance)| of(end.body).at(end.arm_m()) / compliance).fold(f64::INFINITY, f64::min)
    };
    let missed = |(block, p): (&Block, &Impulse)| {
        let c = block.velocity(u) / block.A.trace();
        let missed = relative(law::missed(p, &c, block.law()), scale(block));
        if missed.is_nan() { f64::INFINITY } else { missed }
    };
    problem.blocks.iter().zip(p).map(missed).fold(0.0, f64::max)
}

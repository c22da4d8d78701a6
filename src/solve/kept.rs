//! Impulses of the last step: whether they still obey the law, and are kept as they are.

use super::Impulse;
use super::missed::{shares_matter, strict_residual};
use super::problem::ContactProblem;
use super::twist::Twist;

/// Of the tolerance: impulses that are kept. Forces that stay the same hold no body for long (one that carries others
/// tips with e^(t √(m g/I r))): what they leave must be nothing beside the gaps that are closed, 1e-12 of a body.
pub(super) const KEPT: f64 = 1e-2;

/// A residual that is rounding to bodies that rest, which keep their impulses for thousands of steps: no method need do
/// better, if its tolerance does not say so.
pub(super) const AT_REST: f64 = 1e-13;

/// Impulses that are to be improved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// By what every body gets alone.
    pub(super) residual: f64,
    /// Even shares are a part of the answer.
    pub(super) is_shared: bool,
}

impl Start {
    /// `u`: memory for M⁻¹ Jᵀ p.
    pub(super) fn new(problem: &ContactProblem, p: &[Impulse], u: &mut Vec<Twist>) -> Self {
        problem.response(p, u);
        let residual = strict_residual(problem, p, u);
        Start { residual, is_shared: shares_matter(problem, 0..p.len(), p, u) }
    }

    /// Whether they are kept at this tolerance.
    pub(super) fn lasts(&self, tolerance: f64) -> bool {
        self.residual <= (KEPT * tolerance).max(AT_REST.min(tolerance)) && !self.is_shared
    }
}

//! The contact solvers that `time-stepping` picks from.
//!
//! Impulses of the last step that meet the tolerance, and more, are taken as they are, whichever it is: bodies at rest
//! cost a look.

use super::gauss_seidel::{self, Sweeps};
use super::kept::{KEPT, Start};
use super::problem::ContactProblem;
use super::twist::Twist;
use super::{Impulse, auto, newton, nncg};
use crate::experiment::types::Solver;
use crate::work::Work;

/// Residual of an iteration that counts as solved.
const ITERATED: f64 = 1e-6;

/// A solver with its scratch.
#[derive(Clone, Debug)]
pub struct ContactSolver {
    by: By,
    /// Whether impulses of the last step that still obey the law are taken as they are.
    keeps: bool,
    /// As `left` says.
    left: f64,
    u: Vec<Twist>,
}

/// Which, and its memory between steps.
#[derive(Clone, Debug)]
enum By {
    Auto(auto::Scratch),
    Pgs(gauss_seidel::Scratch),
    Nncg(nncg::Scratch),
    /// Of the sweeps that it begins with.
    Newton(gauss_seidel::Scratch),
}

impl ContactSolver {
    /// With room for so many contacts and bodies. `keeps`: whether impulses are taken as they are that still obey the
    /// law.
    pub fn new(which: Solver, contacts: usize, bodies: usize, keeps: bool) -> Self {
        let by = match which {
            Solver::Auto => By::Auto(auto::Scratch::with_capacity(contacts, bodies, keeps)),
            Solver::Pgs => By::Pgs(gauss_seidel::Scratch::with_capacity(contacts, bodies)),
            Solver::Nncg => By::Nncg(nncg::Scratch::with_capacity(contacts, bodies)),
            Solver::Newton => By::Newton(gauss_seidel::Scratch::with_capacity(contacts, bodies)),
        };
        ContactSolver { by, keeps, left: 0.0, u: Vec::with_capacity(bodies) }
    }

    /// Residual up to which impulses need not be improved where something next to nothing else is asked for.
    pub fn may_miss(&self, tolerance: f64) -> f64 {
        match self.by {
            By::Auto(_) | By::Newton(_) => KEPT * tolerance,
            By::Pgs(_) | By::Nncg(_) => tolerance.max(ITERATED),
        }
    }

    /// Whether impulses get nearer and nearer to the law from step to step, and need not obey it after any.
    pub fn is_iteration(&self) -> bool {
        matches!(self.by, By::Pgs(_) | By::Nncg(_))
    }

    /// The residual of the last impulses, if they were kept as they were; else 0.
    pub fn left(&self) -> f64 {
        self.left
    }

    /// Improves `p`. Whether it is solved, or has settled. `expected`: what impulses become if they go on as they
    /// changed, for what is solved anew in every step; may be empty.
    pub fn solve(
        &mut self,
        problem: &ContactProblem,
        sweeps: &Sweeps,
        (p, expected): (&mut [Impulse], &[Impulse]),
        work: &mut Work,
    ) -> bool {
        let start = Start::new(problem, p, &mut self.u);
        let is_kept = self.keeps && start.lasts(sweeps.tolerance);
        self.left = if is_kept { start.residual } else { 0.0 };
        if is_kept {
            work.kept_solves += 1;
            return true;
        }
        match &mut self.by {
            By::Auto(scratch) => auto::solve(problem, sweeps, (p, expected), (start, &mut self.u), scratch, work),
            By::Pgs(scratch) => gauss_seidel::iterate(problem, sweeps, p, scratch, work),
            By::Nncg(scratch) => nncg::iterate(problem, sweeps, p, scratch, work),
            By::Newton(scratch) => newton::solve(problem, sweeps, p, scratch, work),
        }
    }
}

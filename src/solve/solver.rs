//! The contact solvers that `time-stepping` picks from.

use super::gauss_seidel::{self, Sweeps};
use super::problem::ContactProblem;
use super::{Impulse, auto, newton, nncg};
use crate::experiment::types::Solver;
use crate::work::Work;

/// Residual of an iteration that counts as solved.
const ITERATED: f64 = 1e-6;

/// A solver with its scratch.
#[derive(Clone, Debug)]
pub enum ContactSolver {
    Auto(auto::Scratch),
    Pgs(gauss_seidel::Scratch),
    Nncg(nncg::Scratch),
    /// Of the sweeps that it begins with.
    Newton(gauss_seidel::Scratch),
}

impl ContactSolver {
    /// With room for so many contacts and bodies. `keeps`: whether `auto` takes impulses as they are that still obey
    /// the law.
    pub fn new(which: Solver, contacts: usize, bodies: usize, keeps: bool) -> Self {
        match which {
            Solver::Auto => ContactSolver::Auto(auto::Scratch::with_capacity(contacts, bodies, keeps)),
            Solver::Pgs => ContactSolver::Pgs(gauss_seidel::Scratch::with_capacity(contacts, bodies)),
            Solver::Nncg => ContactSolver::Nncg(nncg::Scratch::with_capacity(contacts, bodies)),
            Solver::Newton => ContactSolver::Newton(gauss_seidel::Scratch::with_capacity(contacts, bodies)),
        }
    }

    /// Residual up to which impulses need not be improved where something next to nothing else is asked for.
    pub fn may_miss(&self, tolerance: f64) -> f64 {
        match self {
            ContactSolver::Auto(_) | ContactSolver::Newton(_) => auto::KEPT * tolerance,
            ContactSolver::Pgs(_) | ContactSolver::Nncg(_) => tolerance.max(ITERATED),
        }
    }

    /// Whether impulses get nearer and nearer to the law from step to step, and need not obey it after any.
    pub fn is_iteration(&self) -> bool {
        matches!(self, ContactSolver::Pgs(_) | ContactSolver::Nncg(_))
    }

    /// Improves `p`. Whether it is solved, or has settled.
    pub fn solve(&mut self, problem: &ContactProblem, sweeps: &Sweeps, p: &mut [Impulse], work: &mut Work) -> bool {
        match self {
            ContactSolver::Auto(scratch) => auto::solve(problem, sweeps, p, scratch, work),
            ContactSolver::Pgs(scratch) => gauss_seidel::iterate(problem, sweeps, p, scratch, work),
            ContactSolver::Nncg(scratch) => nncg::iterate(problem, sweeps, p, scratch, work),
            ContactSolver::Newton(scratch) => newton::solve(problem, sweeps, p, scratch, work),
        }
    }
}

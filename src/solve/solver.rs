//! The contact solvers that `time-stepping` picks from.

use super::gauss_seidel::{self, Sweeps};
use super::problem::ContactProblem;
use super::{Impulse, auto, newton, nncg};
use crate::experiment::types::Solver;
use crate::work::Work;

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

    /// Part of the tolerance that may be missing of a solution; of an iteration that has settled all of it.
    pub fn leaves(&self) -> f64 {
        match self {
            ContactSolver::Auto(_) | ContactSolver::Newton(_) => auto::KEPT,
            ContactSolver::Pgs(_) | ContactSolver::Nncg(_) => 1.0,
        }
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

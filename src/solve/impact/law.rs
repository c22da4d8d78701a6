//! Which law of impact resolves simultaneous impacts.

use super::super::Impulse;
use super::super::problem::ContactProblem;
use super::plastic::Plastic;
use super::{poisson, sequential};
use crate::deadline::Deadline;

/// How simultaneous impacts are resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    Poisson,
    Sequential,
}

/// Fills `p` with the impulses of the impact. `restitution`: of every contact. Whether the law came to its own end: the
/// solver settled, and no bound on a number of iterations, nor the deadline, was met. If not, `p` still gains no
/// energy.
pub fn resolve(
    law: Law,
    problem: &ContactProblem,
    restitution: &[f64],
    solver: &mut Plastic,
    deadline: Deadline,
    p: &mut Vec<Impulse>,
) -> bool {
    p.clear();
    p.resize(problem.blocks.len(), Impulse::zeros());
    match law {
        Law::Poisson => poisson::resolve(problem, restitution, solver, deadline, p),
        Law::Sequential => sequential::resolve(problem, restitution, solver, deadline, p),
    }
}

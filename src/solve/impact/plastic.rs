//! Plastic contacts: the part of an impact that takes.

use super::super::Impulse;
use super::super::problem::ContactProblem;

/// Improves impulses (all 0 at first) until the problem's contacts obey the law of plastic contacts: c = 0 or
/// separating, Coulomb friction. Whether it has settled.
pub type Plastic<'a> = dyn FnMut(&ContactProblem, &mut [Impulse]) -> bool + 'a;

/// An approach below this part of the fastest velocity of the problem is rounding.
const ROUNDING: f64 = 1e-12;

/// What is rounding of this problem's velocities.
pub(super) fn rounding(problem: &ContactProblem) -> f64 {
    ROUNDING * problem.blocks.iter().map(|block| block.b.norm()).fold(0.0, f64::max)
}

/// The solver's impulses, or the part of them that gains no energy. Whether it has settled.
pub(super) fn plastic(problem: &ContactProblem, solver: &mut Plastic) -> (Vec<Impulse>, bool) {
    let mut p = vec![Impulse::zeros(); problem.blocks.len()];
    let settled = solver(problem, &mut p);
    let mut u = Vec::new();
    problem.response(&p, &mut u);
    problem.take_back(&mut p, &u);
    (p, settled)
}

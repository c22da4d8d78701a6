//! Laws of impact: from the velocities just before an impact to its impulses, on the plain data of a `ContactProblem`.
//!
//! `ContactProblem::b` holds the contacts' velocities just before the impact: no forces, no restitution in it. Newton's law
//! is the one that is not here: it is e v⁻ in b, and with friction it can gain kinetic energy. These laws never do, for any
//! J, M, μ and 0 ≤ e ≤ 1:
//!
//! - `darboux_keller`: one contact; its sliding is followed along the normal impulse
//! - `sequential`: that law, one contact at a time
//! - `poisson`: all contacts at once, compression and expansion
//!
//! Impulses in N s, velocities in m/s, rows normal, tangent 1, tangent 2. The laws allocate.

pub mod darboux_keller;
mod disc;
mod hodograph;
mod poisson;
mod sequential;

use super::Impulse;
use super::problem::ContactProblem;

/// How simultaneous impacts are resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    Poisson,
    Sequential,
}

/// Improves impulses (all 0 at first) until the problem's contacts obey the law of plastic contacts: c = 0 or separating,
/// Coulomb friction. Whether it has settled.
pub type Plastic<'a> = dyn FnMut(&ContactProblem, &mut [Impulse]) -> bool + 'a;

/// Fills `p` with the impulses of the impact. `restitution`: of every contact. Whether the law came to its own end: the
/// solver settled, and no bound on a number of iterations was met. If not, `p` still gains no energy.
pub fn resolve(
    law: Law,
    problem: &ContactProblem,
    restitution: &[f64],
    solver: &mut Plastic,
    p: &mut Vec<Impulse>,
) -> bool {
    p.clear();
    p.resize(problem.blocks.len(), Impulse::zeros());
    match law {
        Law::Poisson => poisson::resolve(problem, restitution, solver, p),
        Law::Sequential => sequential::resolve(problem, restitution, solver, p),
    }
}

/// An approach below this part of the fastest velocity of the problem is rounding.
const ROUNDING: f64 = 1e-12;

/// What is rounding of this problem's velocities.
fn rounding(problem: &ContactProblem) -> f64 {
    ROUNDING * problem.blocks.iter().map(|block| block.b.norm()).fold(0.0, f64::max)
}

/// The solver's impulses, or the part of them that gains no energy. Whether it has settled.
fn plastic(problem: &ContactProblem, solver: &mut Plastic) -> (Vec<Impulse>, bool) {
    let mut p = vec![Impulse::zeros(); problem.blocks.len()];
    let settled = solver(problem, &mut p);
    let mut u = Vec::new();
    problem.response(&p, &mut u);
    problem.take_back(&mut p, &u);
    (p, settled)
}

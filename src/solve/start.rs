//! The lecture's first guess of the constraint force, F = −A⁻¹ b (L20).
//!
//! A is singular from two contacts of one body on (rank 3, 5, 6, 6, …): `direct` and `inverse` then return rubbish or
//! nothing, and a start that is not finite is replaced by 0. These starts build A and allocate; the default does not.

use super::Impulse;
use super::problem::ContactProblem;
use crate::experiment::types::Start;
use crate::math::least_norm::least_norm;
use nalgebra::Vector3;

/// Eigenvalues below this part of the largest are rounding.
const RANK: f64 = 1e-12;

/// Fills `p` with the first guess, not yet corrected.
pub fn first_guess(problem: &ContactProblem, start: Start, p: &mut Vec<Impulse>) {
    p.clear();
    p.resize(problem.blocks.len(), Impulse::zeros());
    let solved = match start {
        _ if problem.blocks.is_empty() => return,
        Start::None => return,
        Start::Direct => problem.A().lu().solve(&-problem.b()),
        Start::Inverse => problem.A().try_inverse().map(|inverse| inverse * -problem.b()),
        Start::PseudoInverse => Some(least_norm(problem.A(), &-problem.b(), RANK)),
    };
    if let Some(solved) = solved.filter(|s| s.iter().all(|x| x.is_finite())) {
        for (i, p) in p.iter_mut().enumerate() {
            *p = Vector3::new(solved[3 * i], solved[3 * i + 1], solved[3 * i + 2]);
        }
    }
}

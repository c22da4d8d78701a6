//! The exact contact solver: the law of contact (`law.rs`) of all contacts of an island at once, to rounding.
//!
//! After some sweeps of projected Gauss–Seidel, which settle most small problems, proximal problems with a falling η come
//! nearer to the solution (`proximal.rs`: from anywhere, at any mass ratio), and after each of them Newton's method on the
//! law itself has a try (`active_set.rs`: quadratic, once it is known which contacts stick and slip). All of them work on six
//! velocities a body; contacts may be as redundant as they like. Last, of all impulses that make these velocities the
//! smallest are taken (`smallest.rs`), wherever the iteration started.
//!
//! Allocates. Residuals are the judge's (`measure::residual`), worked out from J and M⁻¹ as the solver has them.

use super::gauss_seidel::{self, Sweeps};
use super::island::{Island, islands};
use super::problem::ContactProblem;
use super::{Impulse, active_set, proximal, smallest};
use crate::measure::work::Work;

/// Sweeps to begin with: each costs a thousandth of a Newton step of a large island.
const SWEEPS: u32 = 100;

/// η of the first proximal problem and least, contacts having blocks of trace 1 (rounding of a velocity is felt as 1/η of
/// it); what it is multiplied by when the problem was solved, and when it was not.
const FIRST_ETA: f64 = 0.1;
const LEAST_ETA: f64 = 1e-8;
const ON: f64 = 0.5;
const BACK: f64 = 4.0;

/// Improves `p` until the residual of every island is below the tolerance, by at most `sweeps.most` proximal problems each,
/// and makes it the smallest. Whether it is solved.
pub fn solve(
    problem: &ContactProblem,
    sweeps: &Sweeps,
    p: &mut [Impulse],
    scratch: &mut gauss_seidel::Scratch,
    work: &mut Work,
) -> bool {
    gauss_seidel::iterate(problem, &Sweeps { most: SWEEPS, tolerance: 0.0, ..*sweeps }, p, scratch, work);
    let mut solved = true;
    for island in islands(problem) {
        let mut own = island.impulses(p);
        solved &= solve_island(&island, sweeps, &mut own, &mut work.newton_steps) <= sweeps.tolerance;
        island.put(&own, p);
    }
    solved
}

fn solve_island(island: &Island, goal: &Sweeps, p: &mut Vec<Impulse>, steps: &mut u64) -> f64 {
    let mut best = active_set::improve(island, p, goal.tolerance, steps);
    let (mut centre, mut eta) = (p.clone(), FIRST_ETA);
    for _ in 0..goal.most {
        if best <= goal.tolerance {
            break;
        }
        let Some(next) = proximal::solve(island, &centre, eta, steps) else {
            eta *= BACK;
            continue;
        };
        eta = (eta * ON).max(LEAST_ETA);
        centre.clone_from(&next);
        let mut tried = next;
        let residual = active_set::improve(island, &mut tried, goal.tolerance, steps);
        if residual < best {
            best = residual;
            *p = tried;
        }
    }
    // A velocity that so exact impulses leave is rounding.
    let small = (100.0 * best).clamp(1e-13, 1e-10);
    let (least, residual) = smallest::impulses(island, p, small, steps);
    if residual > best.max(goal.tolerance) {
        return best;
    }
    *p = least;
    residual
}

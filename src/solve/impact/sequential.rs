//! Simultaneous impacts one at a time: always the contact that approaches fastest has an impact by Darboux–Keller, as
//! if it were alone, until none approaches.
//!
//! Order: the fastest approach; of contacts that are as fast to rounding, the first in the order of contacts. What
//! several contacts of a symmetric scene get then depends on that order, and need not be symmetric. End: no approach
//! above 1e-12 of the problem's fastest contact velocity. Elastic impacts end after few; at a smaller e some scenes (a
//! ball between heavier ones that close on it, contacts of one face) need infinitely many, weaker and weaker. After 100
//! impacts per contact the law has not come to its own end, and a plastic solve settles what is left. No impact gains
//! energy, so the sequence does not.

use super::super::Impulse;
use super::super::coupling::{Coupling, Memory};
use super::super::problem::ContactProblem;
use super::darboux_keller;
use super::plastic::{Plastic, plastic, rounding};
use crate::deadline::Deadline;

const MOST_PER_CONTACT: usize = 100;

pub(super) fn resolve(
    problem: &ContactProblem,
    restitution: &[f64],
    solver: &mut Plastic,
    deadline: Deadline,
    p: &mut [Impulse],
) -> bool {
    if one_by_one(problem, restitution, deadline, p) {
        return true;
    }
    let mut u = Vec::new();
    problem.response(p, &mut u);
    let (left, _) = plastic(&problem.after(&u), solver);
    p.iter_mut().zip(left).for_each(|(p, left)| *p += left);
    false
}

/// Whether no contact approaches any more.
fn one_by_one(problem: &ContactProblem, restitution: &[f64], deadline: Deadline, p: &mut [Impulse]) -> bool {
    let rounding = rounding(problem);
    let mut memory = Memory::default();
    let mut coupling = problem.through_bodies(p, &mut memory);
    for _ in 0..MOST_PER_CONTACT * problem.blocks.len() {
        if deadline.is_over() {
            break;
        }
        let velocity = |i: usize| coupling.velocity(i, &problem.blocks[i], p);
        let normals = || (0..problem.blocks.len()).map(|i| velocity(i).x);
        let fastest = normals().fold(0.0, f64::min);
        if fastest >= -rounding {
            return true;
        }
        let Some(i) = normals().position(|c| c <= fastest + rounding) else { return false };
        let block = &problem.blocks[i];
        let change = darboux_keller::impulse(&block.A, &velocity(i), block.friction, restitution[i]);
        p[i] += change;
        coupling.moved(block, &change);
    }
    false
}

//! Simultaneous impacts one after the other: always the pair that approaches fastest has an impact as if it were alone,
//! until none approaches.
//!
//! One contact has it by Darboux–Keller. Contacts of one pair with one normal, the corners of a face or the ends of a
//! line, belong together: those of them that approach are struck as one, by Poisson's law, which does not ask which of
//! them comes first, so that what falls flat comes straight back. Of two bodies on a third, or of two faces of one
//! body, one comes after the other.
//!
//! Order: the fastest approach; of contacts that are as fast to rounding, the first in the order of contacts. What
//! several bodies of a symmetric scene get then depends on that order, and need not be symmetric. End: no approach
//! above 1e-12 of the problem's fastest contact velocity. Elastic impacts end after few; at a smaller e some scenes (a
//! ball between heavier ones that close on it) need infinitely many, weaker and weaker. After 100 impacts per contact
//! the law has not come to its own end, and a plastic solve settles what is left. No impact gains energy, so the
//! sequence does not.

use super::super::Impulse;
use super::super::problem::ContactProblem;
use super::plastic::{Plastic, plastic, rounding};
use super::{darboux_keller, poisson};
use crate::deadline::Deadline;

const MOST_PER_CONTACT: usize = 100;

/// Sine of the angle between normals that are one.
const ONE_NORMAL: f64 = 1e-6;

pub(super) fn resolve(
    problem: &ContactProblem,
    restitution: &[f64],
    solver: &mut Plastic,
    deadline: Deadline,
    p: &mut [Impulse],
) -> bool {
    if one_by_one(problem, restitution, solver, deadline, p) {
        return true;
    }
    let mut u = Vec::new();
    problem.response(p, &mut u);
    let (left, _) = plastic(&problem.after(&u), solver);
    p.iter_mut().zip(left).for_each(|(p, left)| *p += left);
    false
}

/// Whether no contact approaches any more.
fn one_by_one(
    problem: &ContactProblem,
    restitution: &[f64],
    solver: &mut Plastic,
    deadline: Deadline,
    p: &mut [Impulse],
) -> bool {
    let rounding = rounding(problem);
    let mut u = Vec::new();
    problem.response(p, &mut u);
    for _ in 0..MOST_PER_CONTACT * problem.blocks.len() {
        if deadline.is_over() {
            break;
        }
        let normals: Vec<f64> = problem.blocks.iter().map(|block| block.velocity(&u).x).collect();
        let fastest = normals.iter().copied().fold(0.0, f64::min);
        if fastest >= -rounding {
            return true;
        }
        let Some(i) = normals.iter().position(|c| *c <= fastest + rounding) else { return false };
        let together: Vec<usize> =
            (0..normals.len()).filter(|j| normals[*j] < -rounding && is_one(problem, i, *j)).collect();
        if let [i] = together[..] {
            let block = &problem.blocks[i];
            let change = darboux_keller::impulse(&block.A, &block.velocity(&u), block.friction, restitution[i]);
            p[i] += change;
            block.apply(&change, &mut u);
            continue;
        }
        let own: Vec<f64> = together.iter().map(|j| restitution[*j]).collect();
        let mut changes = vec![Impulse::zeros(); together.len()];
        poisson::resolve(&problem.part_after(&together, &u), &own, solver, deadline, &mut changes);
        for (j, change) in together.into_iter().zip(changes) {
            p[j] += change;
            problem.blocks[j].apply(&change, &mut u);
        }
    }
    false
}

/// Whether two contacts are of one pair, with one normal.
fn is_one(problem: &ContactProblem, i: usize, j: usize) -> bool {
    let (a, b) = (&problem.blocks[i], &problem.blocks[j]);
    let is_same = a.ends().map(|end| end.body).eq(b.ends().map(|end| end.body));
    is_same && a.frame[0].cross(&b.frame[0]).norm() <= ONE_NORMAL && a.frame[0].dot(&b.frame[0]) > 0.0
}

//! The nonsmooth nonlinear conjugate gradient method (M. Silcowitz-Hansen, S. Niebe, K. Erleben, The Visual Computer 26
//! (2010) 893): what a sweep of projected Gauss–Seidel changes is taken for a negative gradient, and directions follow
//! Fletcher and Reeves. It starts again whenever a gradient is longer than the one before.

use super::Impulse;
use super::coupling::Coupling;
use super::gauss_seidel::{self, Sweeps, has_settled, sweep};
use super::problem::ContactProblem;
use crate::work::Work;

/// The solver's memory between steps, to spare the allocator.
#[derive(Clone, Debug)]
pub struct Scratch {
    pub(super) sweeps: gauss_seidel::Scratch,
    direction: Vec<Impulse>,
}

impl Scratch {
    pub fn with_capacity(contacts: usize, bodies: usize) -> Self {
        Scratch {
            sweeps: gauss_seidel::Scratch::with_capacity(contacts, bodies),
            direction: Vec::with_capacity(contacts),
        }
    }
}

/// Improves `p` by at most `sweeps.most` sweeps, the last of which leaves it in the cones. Whether it has settled.
pub fn iterate(
    problem: &ContactProblem,
    sweeps: &Sweeps,
    p: &mut [Impulse],
    scratch: &mut Scratch,
    work: &mut Work,
) -> bool {
    scratch.sweeps.restart(sweeps, p.len());
    if problem.is_dense() {
        return descend(problem, &mut problem.dense(), sweeps, p, scratch, work);
    }
    let mut memory = std::mem::take(&mut scratch.sweeps.coupling);
    let settled = descend(problem, &mut problem.through_bodies(p, &mut memory), sweeps, p, scratch, work);
    scratch.sweeps.coupling = memory;
    settled
}

fn descend(
    problem: &ContactProblem,
    coupling: &mut impl Coupling,
    sweeps: &Sweeps,
    p: &mut [Impulse],
    scratch: &mut Scratch,
    work: &mut Work,
) -> bool {
    let Scratch { sweeps: gauss_seidel::Scratch { before, order, .. }, direction } = scratch;
    direction.clear();
    direction.resize(p.len(), Impulse::zeros());
    let mut last = f64::INFINITY;
    for number in 0..sweeps.most {
        if sweeps.deadline.is_over() {
            break;
        }
        work.sweeps += 1;
        sweep(problem, coupling, sweeps, p, before, order, number);
        if has_settled(before, p, sweeps.tolerance) {
            return true;
        }
        if number + 1 == sweeps.most {
            break;
        }
        let gradient: f64 = before.iter().zip(&*p).map(|(old, new)| (new - old).norm_squared()).sum();
        let beta = if gradient > last { 0.0 } else { gradient / last };
        last = gradient;
        let contacts = problem.blocks.iter().zip(&*before).zip(p.iter_mut()).zip(direction.iter_mut());
        for (((block, old), p), direction) in contacts {
            let (change, onward) = (*p - old, *direction * beta);
            coupling.moved(block, &onward);
            *p += onward;
            *direction = onward + change;
        }
    }
    false
}

//! Impacts: what touches at one moment, by the law of impact chosen.
//!
//! Newton's law of restitution is the target of the same contact problem that time-stepping solves, with no forces in
//! it; the other laws are `solve::impact`. Held contacts take part. Bodies do not move in an impact.

use super::forces::{Gathered, Solved};
use super::law;
use crate::collide::{Contact, SolvedContact};
use crate::deadline::Deadline;
use crate::experiment::types::Impact;
use crate::model::Model;
use crate::solve::block::Block;
use crate::solve::gauss_seidel::Scratch;
use crate::solve::impact::{Law, resolve};
use crate::solve::problem::ContactProblem;
use crate::solve::twist::Twist;
use crate::solve::{Impulse, exact_contact, newton};
use crate::state::State;
use crate::work::Work;

/// Proximal problems of an island before the law is given up.
const MOST: u32 = 500;

/// Changes the velocities, and tells the impulses. False: the law did not come to its end.
pub fn strike(
    model: &Model,
    state: &mut State,
    contacts: &[Contact],
    law: Impact,
    gathered: &mut Gathered,
    solved: &mut Vec<SolvedContact>,
    work: &mut Work,
) -> bool {
    gathered.gather_plain(model, state, contacts);
    let (problem, deadline) = (&mut gathered.problem, gathered.deadline);
    let mut p = vec![Impulse::zeros(); problem.blocks.len()];
    let ended = match law {
        Impact::Newton => {
            for (block, contact) in problem.blocks.iter_mut().zip(contacts) {
                let rebound = -contact.restitution * block.before.x.min(0.0);
                block.b.x -= rebound;
                block.least = rebound;
            }
            plastic(problem, &mut p, deadline, work)
        }
        Impact::Poisson | Impact::Sequential => {
            let restitution: Vec<f64> = contacts.iter().map(|contact| contact.restitution).collect();
            let law = if law == Impact::Poisson { Law::Poisson } else { Law::Sequential };
            let mut solver = |problem: &ContactProblem, p: &mut [Impulse]| plastic(problem, p, deadline, work);
            resolve(law, problem, &restitution, &mut solver, deadline, &mut p)
        }
    };
    apply(model, state, gathered, &gathered.solved(p, ended), contacts, solved);
    ended
}

/// Without restitution, from nothing.
pub(super) fn plastic(problem: &ContactProblem, p: &mut [Impulse], deadline: Deadline, work: &mut Work) -> bool {
    if let [block] = &problem.blocks[..]
        && block.pin.is_none()
    {
        p[0] = exact_contact::solve(&block.A, &block.b, &Impulse::zeros(), block.friction);
        return true;
    }
    law::solve_evenly(problem, p, deadline, work)
}

/// Of the slip: an approach that is none.
const HINT: f64 = 1e-6;

/// Of contacts that only slip, the impulses that end a slip: besides none at all, these obey the law too. They are
/// found from those of a slight approach, which has no others (F. Génot, B. Brogliato 1999). False: there are none.
pub fn jam(
    model: &Model,
    state: &mut State,
    contacts: &[Contact],
    gathered: &mut Gathered,
    solved: &mut Vec<SolvedContact>,
    work: &mut Work,
) -> bool {
    gathered.gather_plain(model, state, contacts);
    let mut p = vec![Impulse::zeros(); gathered.problem.blocks.len()];
    let slip = gathered.problem.blocks.iter().map(|block| block.b.yz().norm()).fold(0.0, f64::max);
    let mut hinted = gathered.problem.clone();
    hinted.blocks.iter_mut().for_each(|block| block.b.x -= HINT * slip);
    let mut ended = plastic(&hinted, &mut p, gathered.deadline, work);
    match &gathered.problem.blocks[..] {
        [only] if only.pin.is_none() => {
            let stopping = only.A.try_inverse().map(|inverse| -inverse * only.b);
            let inside = stopping.filter(|p| p.x > 0.0 && p.yz().norm() <= only.friction * p.x);
            p[0] = inside.unwrap_or_else(Impulse::zeros);
        }
        blocks => {
            let mut scratch = Scratch::with_capacity(blocks.len(), 0);
            let goal = newton::to_rounding(MOST, gathered.deadline);
            ended = ended && newton::solve(&gathered.problem, &goal, &mut p, &mut scratch, work);
        }
    }
    let change = |(block, p): (&Block, &Impulse)| (block.A * p).norm();
    let largest = gathered.problem.blocks.iter().zip(&p).map(change).fold(0.0, f64::max);
    if !ended || largest <= 10.0 * HINT * slip {
        return false;
    }
    apply(model, state, gathered, &gathered.solved(p, true), contacts, solved);
    true
}

fn apply(
    model: &Model,
    state: &mut State,
    gathered: &Gathered,
    Solved { p, added, .. }: &Solved,
    contacts: &[Contact],
    solved: &mut Vec<SolvedContact>,
) {
    for (i, at) in state.bodies.iter_mut().enumerate() {
        if model.bodies[i].driven {
            continue;
        }
        let Twist { v, w } = added[i];
        at.v_WB += v;
        at.w_WB += w;
    }
    solved.clear();
    let of = contacts.iter().zip(&gathered.problem.blocks).zip(p);
    solved.extend(of.map(|((contact, block), p)| SolvedContact { contact: *contact, impulse_W: block.in_world(p) }));
}

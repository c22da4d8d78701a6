//! Forces of the last look at redundant contacts, and whether they go on: those of the law, found from nothing, cost
//! thirty to a hundred linear systems, and from one look to the next they hardly change.
//!
//! What pressed then presses on, by the smallest change of its forces that keeps what holds. They are lawful as well if
//! no contact pulls, none needs more friction than it has, and nothing comes nearer or leaves. Shares differ from those
//! that the law finds; whether all contacts go on does not. Where it is not so the law is asked.

use super::forces::{Gathered, Held, Mode, Solved, edge, matrix, unknowns};
use super::law::ROUNDING;
use crate::math::few::Few;
use crate::math::full_pivot::Numbers;
use crate::solve::Impulse;
use crate::work::Work;
use nalgebra::Vector3;

/// Of the largest force: what is less did not press.
const NO_FORCE: f64 = 1e-9;

/// Of what is held, in its order, world axes; empty, nothing is known.
#[derive(Clone, Debug, Default)]
pub struct LastForces {
    forces_W: Vec<Option<Vector3<f64>>>,
}

impl LastForces {
    /// Other contacts hold, by these forces; known if all that have been gathered do.
    pub fn begin(&mut self, gathered: &Gathered, contacts: usize, solved: &Solved) {
        self.forces_W.clear();
        if solved.holds && gathered.here.len() == contacts {
            let all: Vec<usize> = (0..contacts).collect();
            self.note(gathered, contacts, &all, &solved.p);
        }
    }

    /// Forces by the law of these contacts, which go on.
    pub fn note(&mut self, gathered: &Gathered, contacts: usize, own: &[usize], p: &[Impulse]) {
        self.forces_W.resize(contacts, None);
        let blocks = &gathered.problem.blocks;
        own.iter().zip(p).for_each(|(i, p)| self.forces_W[*i] = Some(blocks[*i].in_world(p)));
    }

    /// Forces of an island's contacts that are so near, and obey the law. None: there are none, or pins.
    pub fn go_on(&self, held: &[Held], gathered: &Gathered, own: &[usize], work: &mut Work) -> Option<Few<Impulse>> {
        let blocks = &gathered.problem.blocks;
        if self.forces_W.len() != held.len() || blocks.len() != held.len() {
            return None;
        }
        let modes: Few<Mode> = gathered.modes(held).collect();
        let mut p: Few<Impulse> = Few::from_elem(Impulse::zeros(), blocks.len());
        for i in own {
            let before = blocks[*i].in_frame(&self.forces_W[*i]?);
            p[*i] = match &modes[*i] {
                Mode::Stick => before,
                Mode::Slide(d) => edge(blocks[*i].friction, &blocks[*i].frame, d) * before.x,
            };
        }
        let least = NO_FORCE * p.iter().map(|p| p.norm()).fold(0.0, f64::max);
        let left_out: Few<usize> = own.iter().copied().filter(|i| p[*i].x <= least).collect();
        left_out.iter().for_each(|i| p[*i] = Impulse::zeros());
        work.newton_steps += 1;
        let unknowns = unknowns(own, &gathered.rows(modes.iter().copied()));
        let K = matrix(&gathered.problem, &unknowns, gathered.deadline)?;
        let before = gathered.solved(p.clone(), true);
        let y: Numbers = unknowns.iter().map(|of| -blocks[of.block].velocity(&before.added)[of.row]).collect();
        gathered.hold_without(&left_out, (&unknowns, &K), &y, &mut p)?;
        let solved = gathered.solved(p, true);
        own.iter().all(|i| is_lawful(gathered, *i, modes[*i], &solved)).then_some(solved.p)
    }
}

/// Whether a contact goes on by these forces, and neither pulls nor needs more friction than it has.
pub(super) fn is_lawful(gathered: &Gathered, i: usize, mode: Mode, solved: &Solved) -> bool {
    let (block, p) = (&gathered.problem.blocks[i], &solved.p[i]);
    let (a, none) = (block.velocity(&solved.added), ROUNDING * gathered.scale());
    match mode {
        Mode::Stick => p.x >= 0.0 && p.yz().norm() <= block.friction * p.x * (1.0 + ROUNDING) && a.amax() <= none,
        Mode::Slide(_) => p.x >= 0.0 && a.x.abs() <= none,
    }
}

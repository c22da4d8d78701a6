//! Removing penetration without adding kinetic energy (split impulse: E. Guendelman, R. Bridson, R. Fedkiw, ACM TOG 22
//! (2003) 871 separate positions from velocities likewise): displacements d = M⁻¹ J_nᵀ λ, λ ≥ 0, that move every
//! contact that would stay inside out, found by projected Gauss–Seidel on the normal rows alone.
//!
//! The law of contact lets gaps close to zero and no further, so that there is little to remove: what a linear forecast
//! of the gap misses, and impacts that were seen late. A contact that loses no energy (e = 1) is left to leave by
//! itself.

use super::block::Block;
use super::problem::ContactProblem;
use super::twist::Twist;
use crate::collide::Contact;
use crate::collide::closed::{rounding_m, size_m};
use crate::model::{Body, Model};
use crate::work::Work;

/// Part of the depth that is removed in a step whatever it costs, and of a greater depth at most: 10 steps for 90 %.
/// All of it at once would turn bodies so far that they leave the contacts that hold them, and a pile would shake.
const PART: f64 = 0.2;

/// Sweeps; what they leave is the next step's.
const MOST: u32 = 50;

/// Of the smaller body's bounding radius.
const SHALLOW: f64 = 2e-3;

/// Multipliers of the contacts and displacements of the bodies, kept to spare the allocator.
#[derive(Clone, Debug)]
pub struct Push {
    tolerance: f64,
    multipliers: Vec<f64>,
    /// Motion out that is asked for at least; of a contact with room to spare, less than nothing.
    wanted_m: Vec<f64>,
    pub moved: Vec<Twist>,
}

impl Push {
    /// Sweeps end when none changes a multiplier by more than this part of the largest.
    pub fn new(tolerance: f64, contacts: usize, bodies: usize) -> Self {
        Push {
            tolerance,
            multipliers: Vec::with_capacity(contacts),
            wanted_m: Vec::with_capacity(contacts),
            moved: Vec::with_capacity(bodies),
        }
    }

    /// Finds every body's displacement; false if no contact will be inside (then `moved` means nothing). `response`:
    /// what the impulses did to the velocities, which last until the next step's contacts are seen. `lost_j`: what the
    /// contacts of this step took.
    pub fn find(
        &mut self,
        problem: &ContactProblem,
        contacts: &[Contact],
        model: &Model,
        (response, step_s): (&[Twist], f64),
        lost_j: impl FnOnce() -> f64,
        work: &mut Work,
    ) -> bool {
        let wanted_m = |block: &Block, contact: &Contact| {
            let moves_m = step_s * (block.velocity(response).x + block.least);
            let inside_m = -(contact.gap_m + moves_m.max(0.0));
            let is_pushed = contact.restitution < 1.0 && inside_m > rounding_m(model, contact);
            let at_once_m = SHALLOW * size_m(model, contact);
            if is_pushed { inside_m.min(at_once_m.max(PART * inside_m)) } else { -(contact.gap_m + moves_m).max(0.0) }
        };
        self.wanted_m.clear();
        self.wanted_m.extend(problem.blocks.iter().zip(contacts).map(|(block, contact)| wanted_m(block, contact)));
        if !self.wanted_m.iter().any(|wanted_m| *wanted_m > 0.0) {
            return false;
        }
        self.multipliers.clear();
        self.multipliers.resize(contacts.len(), 0.0);
        self.moved.clear();
        self.moved.resize(model.bodies.len(), Twist::ZERO);
        for _ in 0..MOST {
            work.sweeps += 1;
            if self.sweep(problem) <= self.tolerance {
                break;
            }
        }
        self.shorten(model, lost_j);
        true
    }

    /// Lifting bodies costs energy: all of it at once only if the contacts of the same step have lost as much.
    fn shorten(&mut self, model: &Model, lost_j: impl FnOnce() -> f64) {
        let weight = |(body, moved): (&Body, &Twist)| -body.mass_kg * model.gravity_m_s2.dot(&moved.v);
        let moving = model.bodies.iter().zip(&self.moved).filter(|(body, _)| !body.driven);
        let cost_j: f64 = moving.map(weight).sum();
        if cost_j > 0.0 {
            let part = (lost_j() / cost_j).clamp(PART, 1.0);
            self.moved.iter_mut().for_each(|moved| *moved = moved.times(part));
        }
    }

    /// The largest change of a multiplier, as a part of the largest.
    fn sweep(&mut self, problem: &ContactProblem) -> f64 {
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        let contacts = problem.blocks.iter().zip(&self.wanted_m).zip(&mut self.multipliers);
        for ((block, wanted_m), multiplier) in contacts {
            let missing_m = wanted_m - block.normal_motion(&self.moved);
            let new = (*multiplier + missing_m * block.inverse_diagonal.x).max(0.0);
            let moved = new - *multiplier;
            if moved != 0.0 {
                block.apply_normal(moved, &mut self.moved);
                *multiplier = new;
                change = change.max(moved.abs());
            }
            largest = largest.max(new);
        }
        if largest > 0.0 { change / largest } else { 0.0 }
    }
}

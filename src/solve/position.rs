//! Removing penetration without adding energy (split impulse: E. Guendelman, R. Bridson, R. Fedkiw, ACM TOG 22 (2003)
//! 871 separate positions from velocities likewise): displacements d = M⁻¹ J_nᵀ λ, λ ≥ 0, that move every contact that
//! would stay inside out, found by projected Gauss–Seidel on the normal rows alone.
//!
//! The law of contact lets gaps close to zero and no further, so that there is little to remove: what a linear forecast
//! of the gap misses, and impacts that were seen late. A contact that loses no energy (e = 1) is left to leave by
//! itself, and one that lasts through steps whose kick is half-way may be as deep as the step's own accelerations lead
//! it: its gap swings by so much.
//!
//! Lifting costs energy. An island gets what its contacts have taken from it in the same step and no more: so a solver
//! that lets bodies sink pays for their way back, and one that does not has nothing to lift. Only bodies that are
//! deeply inside each other, as a scene may begin, are moved out whatever it costs. Whoever moves the bodies keeps the
//! account (`step::push_out`).

use super::Impulse;
use super::block::Block;
use super::problem::ContactProblem;
use super::twist::Twist;
use crate::collide::Contact;
use crate::collide::closed::{rounding_m, size_m};
use crate::collide::islands::Islands;
use crate::model::Model;
use crate::model::pins::Anchor;
use crate::work::Work;

/// Part of the depth that is removed in a step whatever it costs, and of a greater depth at most: 10 steps for 90 %.
/// All of it at once would turn bodies so far that they leave the contacts that hold them, and a pile would shake.
const PART: f64 = 0.2;

/// Sweeps; what they leave is the next step's. A light body between a heavy one and the floor would take as many as
/// their masses differ by, and what fewer have found may lead its other side in: an island goes no further than nothing
/// in it gets deeper than the deepest was.
const MOST: u32 = 50;

/// Of the smaller body's bounding radius.
const SHALLOW: f64 = 2e-3;

/// The same of a depth from which bodies are moved out at no one's cost.
const DEEP: f64 = 1e-2;

/// What the bodies of an island have in common, by its first body.
#[derive(Clone, Copy, Debug, Default)]
pub struct Account {
    /// Energy that the step has taken from it.
    pub taken_j: f64,
    /// Something is deeply inside: so much of the way out is gone whatever it costs.
    pub least: f64,
    /// The container, a body that nothing moves, or a pin holds it.
    pub is_held: bool,
    is_pushed: bool,
    /// What is deepest inside, as far as it is to come out; and the part of the way after which nothing is deeper.
    deepest_m: f64,
    part: f64,
}

/// Multipliers of the contacts and displacements of the bodies, kept to spare the allocator.
#[derive(Clone, Debug)]
pub struct Push {
    tolerance: f64,
    multipliers: Vec<f64>,
    /// Motion out that is asked for at least; of a contact with room to spare, less than nothing.
    wanted_m: Vec<f64>,
    pub moved: Vec<Twist>,
    /// Of every body: the first body of its island.
    pub first: Vec<usize>,
    islands: Islands,
    accounts: Vec<Account>,
    /// Of every contact.
    taken_j: Vec<f64>,
}

impl Push {
    /// Sweeps end when none changes a multiplier by more than this part of the largest.
    pub fn new(tolerance: f64, contacts: usize, bodies: usize) -> Self {
        Push {
            tolerance,
            multipliers: Vec::with_capacity(contacts),
            wanted_m: Vec::with_capacity(contacts),
            moved: Vec::with_capacity(bodies),
            first: Vec::with_capacity(bodies),
            islands: Islands::with_capacity(bodies),
            accounts: Vec::with_capacity(bodies),
            taken_j: Vec::with_capacity(contacts),
        }
    }

    /// Finds every body's displacement; false if no contact will be inside (then `moved` means nothing). `response`:
    /// what the impulses did to the velocities, which last until the next step's contacts are seen. `taken_j`: what
    /// every contact of this step took; `lost_j_kg`: what every body has lost beside that. `left_m`: a depth that is
    /// left to a contact.
    pub fn find(
        &mut self,
        (problem, contacts, model): (&ContactProblem, &[Contact], &Model),
        (impulses, response, step_s): (&[Impulse], &[Twist], f64),
        (taken_j, lost_j_kg, left_m): (impl FnOnce(&mut Vec<f64>), f64, impl Fn(&Contact) -> f64),
        work: &mut Work,
    ) -> bool {
        let wanted_m = |block: &Block, contact: &Contact| {
            let moves_m = step_s * (block.velocity(response).x + block.least + block.turning);
            let inside_m = -(contact.gap_m + moves_m.max(0.0)) - block.swing(step_s) - left_m(contact);
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
        let mut is_settled = false;
        for _ in 0..MOST {
            work.sweeps += 1;
            is_settled = self.sweep(problem) <= self.tolerance;
            if is_settled {
                break;
            }
        }
        taken_j(&mut self.taken_j);
        self.settle(contacts, impulses, model, lost_j_kg);
        if !is_settled {
            self.hold_back(problem);
        }
        true
    }

    /// What islands have in common.
    fn settle(&mut self, contacts: &[Contact], impulses: &[Impulse], model: &Model, lost_j_kg: f64) {
        let Push { wanted_m, multipliers, first, islands, accounts, taken_j, .. } = self;
        let joins = |(contact, (p, multiplier)): &(&Contact, (&Impulse, &f64))| {
            p.x > 0.0 || **multiplier > 0.0 || contact.gap_m <= rounding_m(model, contact)
        };
        let joining =
            || contacts.iter().zip(impulses.iter().zip(&*multipliers)).filter(joins).map(|(contact, _)| *contact);
        islands.find(model, joining());
        first.clear();
        first.extend((0..model.bodies.len()).map(|body| islands.first(body)));
        accounts.clear();
        accounts.resize(model.bodies.len(), Account { part: 1.0, ..Account::default() });
        for contact in joining() {
            accounts[islands.of(model, &contact)].is_held |= contact.is_fixed(model);
        }
        for pin in &model.pins {
            accounts[first[pin.body]].is_held = true;
            if let Anchor::Body(other, _) = pin.anchor {
                accounts[first[other]].is_held = true;
            }
        }
        let pushes = wanted_m.iter().zip(&*multipliers);
        for ((contact, (wanted_m, multiplier)), taken_j) in contacts.iter().zip(pushes).zip(&*taken_j) {
            let account = &mut accounts[islands.of(model, contact)];
            account.taken_j += taken_j;
            if *wanted_m > PART * DEEP * size_m(model, contact) {
                account.least = PART;
            }
            account.is_pushed |= *multiplier > 0.0;
        }
        for (i, body) in model.bodies.iter().enumerate().filter(|(_, body)| !body.driven) {
            accounts[first[i]].taken_j += body.mass_kg * lost_j_kg;
        }
    }

    /// Lets islands go only so far that nothing in them gets deeper than the deepest was.
    fn hold_back(&mut self, problem: &ContactProblem) {
        let Push { wanted_m, moved, first, accounts, .. } = self;
        for (wanted_m, block) in wanted_m.iter().zip(&problem.blocks) {
            for end in block.ends() {
                let deepest_m = &mut accounts[first[end.body]].deepest_m;
                *deepest_m = deepest_m.max(*wanted_m);
            }
        }
        for (wanted_m, block) in wanted_m.iter().zip(&problem.blocks) {
            let deeper_m = -block.normal_motion(moved);
            for end in block.ends() {
                let account = &mut accounts[first[end.body]];
                let left_m = account.deepest_m - wanted_m;
                if deeper_m > left_m {
                    account.part = account.part.min(left_m / deeper_m);
                }
            }
        }
        for (moved, first) in moved.iter_mut().zip(&*first) {
            *moved = moved.times(accounts[*first].part);
        }
    }

    /// The island of this first body, if it is moved.
    pub fn island(&self, first: usize) -> Option<&Account> {
        Some(&self.accounts[first]).filter(|account| account.is_pushed)
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

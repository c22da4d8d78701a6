//! Contacts gathered once for every solver (L12, L13, L16): J, M⁻¹ and b, with A = J M⁻¹ Jᵀ as a view of them.
//!
//! With impulses p = F Δt the slide's ᶜV_C[n+1] = b + A ᶜF_C reads c = b + (J M⁻¹ Jᵀ) p. Rows of a contact are ordered
//! normal, tangent 1, tangent 2. The target is c = 0; what else is asked of the
//! normal velocity (restitution, a gap that may close) is taken off the normal row of b (`collide::approach`), and an
//! impact's tangential restitution off the tangents' rows: friction is then against the slip u_t⁺ + ε_t u_t⁻.

use super::Impulse;
use super::block::Block;
use super::coupling::{Dense, Memory, ThroughBodies};
use super::end::{End, Inertia};
use super::gains::Gains;
use super::pins::Pin;
use super::speeds::Speeds;
use super::twist::Twist;
use crate::collide::Contact;
use crate::collide::approach::Approach;
use crate::collide::lasting::Hold;
use crate::model::Model;
use crate::state::State;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use std::cell::RefCell;

/// All contacts of a step.
#[derive(Clone, Debug, Default)]
pub struct ContactProblem {
    pub blocks: Vec<Block>,
    bodies: usize,
    pub(super) inertias: Vec<Inertia>,
    /// Of every body, what residuals are compared with.
    pub(super) speeds: Vec<Speeds>,
    /// Part of Σ|p|/m of a body that counts beside what it changes, though impulses cancel.
    pub(super) cancelling: f64,
    /// Of few contacts, once somebody has asked for it; else empty.
    A_blocks: RefCell<Vec<Matrix3<f64>>>,
}

/// Contacts up to which A is worked out, where it is swept over. A sweep costs 9 L² products with A and 36 L (in long
/// chains) without it.
const DENSE: usize = 32;

/// Of the speed of a body there: a slip below it is none, and has no sign to change.
const NO_SLIP: f64 = 1e-9;

/// Part of the impulses of a step that counts though they cancel: a light body under one that is up to 10⁴ times as
/// heavy is solved by its own weight (as the judge has it, `measure::exchange`).
const CANCELLING: f64 = 1e-4;

impl ContactProblem {
    pub fn with_capacity(contacts: usize, bodies: usize) -> Self {
        ContactProblem {
            blocks: Vec::with_capacity(contacts),
            bodies: 0,
            inertias: Vec::with_capacity(bodies),
            speeds: Vec::with_capacity(bodies),
            cancelling: 0.0,
            A_blocks: RefCell::new(Vec::with_capacity(contacts.min(DENSE) * contacts.min(DENSE))),
        }
    }

    /// `V = V[n] + M⁻¹ F_E Δt` is in `free`, the state before the step in `state`.
    /// Contacts that `approach` does not see in this step are dropped.
    pub fn gather(
        &mut self,
        model: &Model,
        state: &State,
        free: &[Twist],
        contacts: &mut Vec<Contact>,
        through: (Approach, f64),
    ) {
        self.gather_held(model, state, free, contacts, through, |_| None);
    }

    /// The same, of which some contacts last.
    pub fn gather_held(
        &mut self,
        model: &Model,
        state: &State,
        free: &[Twist],
        contacts: &mut Vec<Contact>,
        through: (Approach, f64),
        mut hold: impl FnMut(&Contact) -> Option<Hold>,
    ) {
        self.blocks.clear();
        self.A_blocks.get_mut().clear();
        self.bodies = model.bodies.len();
        self.inertias.clear();
        if !contacts.is_empty() {
            self.inertias.extend(model.bodies.iter().zip(&state.bodies).map(|(body, at)| Inertia::of(body, at)));
        }
        // Impacts and forces at an instant go through a body at rest; a step's are judged by its own weight as well.
        let is_instant = through.0 == Approach::Touching;
        self.cancelling = if is_instant { 1.0 } else { CANCELLING };
        self.speeds.clear();
        self.speeds.extend(state.bodies.iter().zip(free).map(|(at, free)| Speeds::of(at, free, is_instant)));
        contacts.retain(|contact| {
            let block = Block::new(contact, model, &state.bodies, free, &self.inertias, through, hold(contact));
            let is_there = block.is_some();
            self.blocks.extend(block);
            is_there
        });
    }

    /// Asks for gaps to what nothing moves to close by the mean velocities of the step: `turning` is what every body's
    /// mean angular velocity has beyond that after the impulses (`Body::turns_on`).
    pub fn turn(&mut self, contacts: &[Contact], model: &Model, turning: &[Vector3<f64>], through: (Approach, f64)) {
        let contacts = self.blocks.iter_mut().zip(contacts).filter(|(_, contact)| contact.is_fixed(model));
        for (block, contact) in contacts {
            let turning = contact.normal.dot(&contact.velocity(|i| [Vector3::zeros(), turning[i]]));
            if turning != block.turning {
                block.turn(contact, model, turning, through);
            }
        }
    }

    /// Adds pins to the contacts gathered; their impulses are the last ones.
    pub fn pin(&mut self, model: &Model, state: &State, free: &[Twist], pins: &[Pin]) {
        if self.inertias.is_empty() {
            self.inertias.extend(model.bodies.iter().zip(&state.bodies).map(|(body, at)| Inertia::of(body, at)));
        }
        self.blocks.extend(pins.iter().map(|pin| Block::of_pin(pin, free, &self.inertias)));
        self.A_blocks.get_mut().clear();
    }

    /// Whether sweeps go through A: for few contacts that costs less than going through the bodies in every sweep.
    pub fn is_dense(&self) -> bool {
        !self.blocks.is_empty() && self.blocks.len() <= DENSE
    }

    /// A p by A's 3×3 blocks, which are worked out here if they are not known. Only if `is_dense`.
    pub fn dense(&self) -> Dense<'_> {
        if self.A_blocks.borrow().is_empty() {
            let n = self.blocks.len();
            let mut A_blocks = self.A_blocks.borrow_mut();
            A_blocks.resize(n * n, Matrix3::zeros());
            for (i, row) in self.blocks.iter().enumerate() {
                A_blocks[i * n + i] = row.A;
                for (j, column) in self.blocks.iter().enumerate().skip(i + 1) {
                    let A = row.coupling(column);
                    (A_blocks[i * n + j], A_blocks[j * n + i]) = (A, A.transpose());
                }
            }
        }
        Dense { A_blocks: self.A_blocks.borrow() }
    }

    /// A p = J (M⁻¹ Jᵀ p), without A.
    pub fn through_bodies<'a>(&self, impulses: &[Impulse], memory: &'a mut Memory) -> ThroughBodies<'a> {
        self.response(impulses, &mut memory.u);
        ThroughBodies { u: &mut memory.u }
    }

    /// u = M⁻¹ Jᵀ p.
    pub fn response(&self, impulses: &[Impulse], u: &mut Vec<Twist>) {
        u.clear();
        u.resize(self.bodies, Twist::ZERO);
        self.add_response(impulses, u);
    }

    /// u += M⁻¹ Jᵀ p.
    pub fn add_response(&self, impulses: &[Impulse], u: &mut [Twist]) {
        for (block, p) in self.blocks.iter().zip(impulses) {
            block.apply(p, u);
        }
    }

    /// ½ pᵀ A p + pᵀ b: for plastic contacts the kinetic energy that `p` adds.
    pub fn energy(&self, impulses: &[Impulse], u: &[Twist]) -> f64 {
        let half = |block: &Block, p: &Impulse| p.dot(&(block.velocity(u) + block.b)) / 2.0;
        self.blocks.iter().zip(impulses).map(|(block, p)| half(block, p)).sum()
    }

    /// Contacts that last, slid, and would now turn their slip over come to rest instead: their slip at the end of the
    /// step is to be none, else it would change its sign for ever. Whether there is any.
    pub fn stop(&mut self, impulses: &[Impulse], u: &[Twist]) -> bool {
        let ContactProblem { blocks, speeds, .. } = self;
        let mut any = false;
        for (block, _) in blocks.iter_mut().zip(impulses).filter(|(_, p)| p.x > 0.0) {
            let speed = block.ends().map(|end| speeds[end.body].at(end.arm_m())).fold(0.0, f64::max);
            let stops = block.stop(u, NO_SLIP * speed);
            any |= stops;
        }
        any
    }

    /// Islands whose contacts would give energy to the bodies: friction against the velocity after the step may give
    /// back what the step's forces have done against it. There it is put against the mean, but where contacts rebound.
    /// Whether there is any.
    pub fn take_mean(&mut self, contacts: &[Contact], model: &Model, impulses: &[Impulse], u: &[Twist]) -> bool {
        if self.blocks.iter().all(|block| block.meant || block.friction == 0.0) {
            return false;
        }
        let twice =
            |(block, p): (&Block, &Impulse)| (p.dot(&(block.before + block.after(u))), p.norm() * block.before.norm());
        let mut given = Gains::with_capacity(self.bodies);
        given.add_up(model, contacts, self.blocks.iter().zip(impulses).map(twice));
        let mut any = false;
        for (block, contact) in self.blocks.iter_mut().zip(contacts) {
            let is_free = !block.meant && block.friction > 0.0 && (block.hold.is_some() || block.least <= 0.0);
            if is_free && given.to_island_of(model, contact) {
                block.mean(true);
                any = true;
            }
        }
        any
    }

    /// Energy that every contact's impulse takes from bodies that were at `before`, −p·½(c⁻ + c⁺), the forces of the
    /// step acting with the impulses (`free`: velocities with them) or after them.
    pub fn taken_j(
        &self,
        before: &State,
        free: Option<&[Twist]>,
        (impulses, u): (&[Impulse], &[Twist]),
        taken: &mut Vec<f64>,
    ) {
        let mean = |end: &End| {
            let (at, u) = (Twist::of(&before.bodies[end.body]), &u[end.body]);
            let free = free.map_or(at, |free| free[end.body]);
            end.motion(&Twist { v: (at.v + free.v + u.v) / 2.0, w: (at.w + free.w + u.w) / 2.0 })
        };
        let of = |(block, p): (&Block, &Impulse)| -p.dot(&block.ends().map(mean).sum::<Vector3<f64>>());
        taken.clear();
        taken.extend(self.blocks.iter().zip(impulses).map(of));
    }

    /// Impulses of an iteration that has not settled may add energy (a bar at μ = 1: up to 1.004 of it): only that part
    /// of them is kept which takes the most. The cones allow it, as they are cones; approaches that remain are next
    /// step's.
    pub fn take_back(&self, impulses: &mut [Impulse], u: &[Twist]) {
        let added = self.energy(impulses, u);
        // What holds a pin is no cone's to choose a part of.
        if added > 0.0 && self.blocks.iter().all(|block| block.pin.is_none()) {
            let linear: f64 = self.blocks.iter().zip(&*impulses).map(|(block, p)| p.dot(&block.b)).sum();
            let part = (-linear / (2.0 * (added - linear))).max(0.0);
            impulses.iter_mut().for_each(|p| *p *= part);
        }
    }

    /// b as it was before the bodies' velocities changed by `u`.
    pub fn take_off(&mut self, u: &[Twist]) {
        self.blocks.iter_mut().for_each(|block| block.b -= block.motion(u));
    }

    /// Some of its contacts, for iterations alone.
    pub(super) fn part(&self, contacts: impl Iterator<Item = usize>) -> ContactProblem {
        let blocks = contacts.map(|i| self.blocks[i]).collect();
        ContactProblem { blocks, bodies: self.bodies, ..ContactProblem::default() }
    }

    /// The same contacts once their bodies' velocities have changed by `u`: b is now c.
    pub fn after(&self, u: &[Twist]) -> ContactProblem {
        let mut after = self.clone();
        after.blocks.iter_mut().for_each(|block| block.b = block.velocity(u));
        after
    }

    /// Some of the contacts alone, once their bodies' velocities have changed by `u`.
    pub fn part_after(&self, places: &[usize], u: &[Twist]) -> ContactProblem {
        let mut part = self.part(places.iter().copied());
        part.inertias.clone_from(&self.inertias);
        part.speeds.clone_from(&self.speeds);
        part.cancelling = self.cancelling;
        part.blocks.iter_mut().for_each(|block| block.b = block.velocity(u));
        part
    }

    /// A as a dense matrix, 3L × 3L.
    pub fn A(&self) -> DMatrix<f64> {
        let n = self.blocks.len();
        DMatrix::from_fn(3 * n, 3 * n, |i, j| self.blocks[i / 3].coupling(&self.blocks[j / 3])[(i % 3, j % 3)])
    }

    pub fn b(&self) -> DVector<f64> {
        DVector::from_iterator(3 * self.blocks.len(), self.blocks.iter().flat_map(|block| block.b.iter().copied()))
    }
}

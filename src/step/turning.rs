//! Bodies that turn on by themselves in a step, which contacts that hold their faces are to know of.
//!
//! A body whose moments of inertia differ turns through a step with another mean angular velocity than that after the
//! impulses (`Body::turns_on`). Gaps close by the mean: else a face that spins on the floor is put h² |ω|² off in every
//! step, and bears on a few of its points. What bodies turn on depends on the impulses. So it is worked out with those
//! of the last step first, and again when those of the step are known, until it asks for nothing else.
//!
//! It is left out where it does not matter or cannot be had: bodies that in the last step fewer than three contacts
//! pressed, or another body that moves, or that a pin holds; contacts that would give energy for it, as they may have
//! to open at first; and what is then not solved. There gaps close by the velocities after the impulses, as if nothing
//! turned on.

use super::scratch::Scratch;
use crate::collide::approach::Approach;
use crate::collide::{Contact, SolvedContact};
use crate::model::Model;
use crate::model::pins::Anchor;
use crate::solve::gains::Gains;
use crate::solve::missed::strict_residual;
use crate::solve::twist::Twist;
use crate::state::State;
use nalgebra::Vector3;

/// Rounds after which it is left out.
const MOST: u32 = 3;
/// Contacts that hold a face.
const FACE: u32 = 3;

/// What the contacts of a step know of the bodies' turning.
#[derive(Debug, Default)]
pub(super) struct Turning {
    /// Some body turns on.
    any: bool,
    round: u32,
    /// The impulses of the round before were a solution.
    was_solved: bool,
    /// Of every body: contacts with what nothing moves that pressed it in the last step; none if another body did.
    pressed: Vec<u32>,
    /// Of every body: its contacts are to know nothing of it in this step.
    is_left_out: Vec<bool>,
    given: Gains,
}

/// What there is left of contacts after a blow, and what that did to the bodies.
pub(super) type Struck<'a> = Option<(&'a [Contact], &'a [Twist])>;

impl Turning {
    /// With room for so many bodies, so that no step allocates.
    pub(super) fn with_capacity(bodies: usize) -> Self {
        Turning {
            pressed: Vec::with_capacity(bodies),
            is_left_out: Vec::with_capacity(bodies),
            given: Gains::with_capacity(bodies),
            ..Turning::default()
        }
    }

    /// Looks at what bodies turn on after impulses like the last ones. A kick half-way has as much of it before it as
    /// after it.
    pub(super) fn begin(&mut self, model: &Model, state: &State, scratch: &mut Scratch, through: (Approach, f64)) {
        (self.round, self.was_solved) = (0, false);
        self.pressed.resize(model.bodies.len(), 0);
        self.is_left_out.clear();
        self.is_left_out.extend(self.pressed.iter().map(|pressed| through.0 != Approach::Start || *pressed < FACE));
        for pin in &model.pins {
            self.is_left_out[pin.body] = true;
            if let Anchor::Body(other, _) = pin.anchor {
                self.is_left_out[other] = true;
            }
        }
        self.look(model, state, scratch, None, through.1);
    }

    fn look(&mut self, model: &Model, state: &State, scratch: &mut Scratch, blow: Option<&[Twist]>, step_s: f64) {
        let Scratch { free, response, turning, .. } = scratch;
        let of = |u: Option<&Twist>| u.map_or_else(Vector3::zeros, |u| u.w);
        let turns_on = |i: usize| {
            if self.is_left_out[i] {
                return Vector3::zeros();
            }
            let w = free[i].w + of(response.get(i)) + of(blow.map(|blow| &blow[i]));
            model.bodies[i].turns_on(&state.bodies[i], &w, step_s)
        };
        turning.clear();
        turning.extend((0..free.len()).map(turns_on));
        self.any = turning.iter().any(|turning| *turning != Vector3::zeros());
    }

    /// Lets gaps close by the mean velocities.
    pub(super) fn ask(&self, model: &Model, struck: Struck, scratch: &mut Scratch, through: (Approach, f64)) {
        if self.any {
            scratch.problem.turn(struck.map_or(&scratch.found, |(left, _)| left), model, &scratch.turning, through);
        }
    }

    /// Whether the impulses in `scratch` ask for something else than they were found for, which is asked for then.
    /// `is_solved`: they are a solution; `tolerance`: what may be missing of one.
    pub(super) fn revise(
        &mut self,
        model: &Model,
        state: &State,
        scratch: &mut Scratch,
        struck: Struck,
        (through, is_solved, tolerance): ((Approach, f64), bool, f64),
    ) -> bool {
        if !self.any || scratch.found.is_empty() {
            return false;
        }
        self.round += 1;
        let residual = |s: &Scratch| strict_residual(&s.problem, &s.impulses, &s.response);
        let left = residual(scratch);
        let is_given_up = self.round > MOST || (self.was_solved && !is_solved);
        let is_less = self.leave_out(model, scratch, is_given_up);
        self.was_solved = is_solved;
        self.look(model, state, scratch, struck.map(|(_, blow)| blow), through.1);
        self.any |= is_less;
        self.ask(model, struck, scratch, through);
        is_less || residual(scratch) > tolerance.max(2.0 * left)
    }

    /// Leaves it out in islands whose contacts give energy, or in all of them. Whether there is any.
    fn leave_out(&mut self, model: &Model, scratch: &Scratch, all: bool) -> bool {
        let Turning { is_left_out, given, .. } = self;
        let Scratch { found, problem, impulses, response, turning, .. } = scratch;
        given.add_up(model, found, problem.blocks.iter().zip(impulses).map(|(block, p)| block.given_j(p, response)));
        let mut any = false;
        for (i, is_left_out) in is_left_out.iter_mut().enumerate().filter(|(i, _)| turning[*i] != Vector3::zeros()) {
            if all || given.to_island_with(i) {
                *is_left_out = true;
                any = true;
            }
        }
        any
    }

    /// Keeps which bodies the contacts of a step have pressed.
    pub(super) fn note(&mut self, model: &Model, solved: &[SolvedContact]) {
        self.pressed.fill(0);
        let pressing = || solved.iter().filter(|solved| solved.impulse_W != Vector3::zeros());
        let ends = |fixed: bool| {
            let contacts = pressing().map(|solved| &solved.contact).filter(move |c| c.is_fixed(model) == fixed);
            contacts.flat_map(Contact::ends)
        };
        ends(true).for_each(|(i, ..)| self.pressed[i] += 1);
        ends(false).for_each(|(i, ..)| self.pressed[i] = 0);
    }
}

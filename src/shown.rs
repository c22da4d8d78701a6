//! What a step shows to those who judge and record it. It borrows: no step allocates for being looked at.

use crate::collide::approach::Approach;
use crate::collide::{Contact, SolvedContact};
use crate::model::Model;
use crate::outcome::Criterion;
use crate::state::State;
use nalgebra::Vector3;

/// One step: what was before, what contacts did, what is after.
#[derive(Clone, Copy)]
pub struct Shown<'a> {
    pub before: &'a State,
    /// Of a step that could not be made, `before` again.
    pub after: &'a State,
    pub acted: Acted<'a>,
    /// The way between the two, of a method that follows events.
    pub way: Option<&'a dyn Passage>,
    /// Why the step could not be made.
    pub stalled: Option<Criterion>,
    /// Nothing comes after it.
    pub is_last: bool,
}

impl<'a> Shown<'a> {
    /// Contacts with the impulses of the step; none of a motion, whose contacts have forces.
    pub fn impulses(&self) -> &'a [SolvedContact] {
        match self.acted {
            Acted::Kick { contacts, .. } | Acted::Blow { contacts } => contacts,
            Acted::Motion(_) => &[],
        }
    }

    /// Whether it is the beginning of a step of the clock, of which more is to come.
    pub fn is_part(&self) -> bool {
        self.after.step == self.before.step && self.after.time_s > self.before.time_s
    }
}

/// What contacts did in a step.
#[derive(Clone, Copy)]
pub enum Acted<'a> {
    /// Impulses at one state, in a step of some length.
    Kick { kicked: &'a State, contacts: &'a [SolvedContact], step_s: f64, approach: Approach },
    /// An impact, which takes no time and changes velocities alone.
    Blow { contacts: &'a [SolvedContact] },
    /// Forces all along the way.
    Motion(&'a dyn Smooth),
}

/// The way of a step that is known at every time in it.
pub trait Passage {
    /// Puts the bodies where they were at the state's time.
    fn state_at(&self, model: &Model, state: &mut State);
    /// Forces of contact at a state of the way.
    fn forces_at(&self, model: &Model, state: &State) -> Vec<ContactForce>;
}

/// What acts along the way of a step.
pub trait Smooth {
    /// States and forces on the way between two states of it, for a quadrature.
    fn moments(&self, model: &Model, span: [&State; 2]) -> Vec<Moment>;
}

/// A contact and the force that it puts on its body, world axes, in newtons. (Of a step that kicks: `SolvedContact`,
/// with an impulse in newton seconds.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    pub contact: Contact,
    pub force_W: Vector3<f64>,
}

impl ContactForce {
    /// The mean force of an impulse over a step.
    pub fn mean(solved: &SolvedContact, step_s: f64) -> Self {
        ContactForce { contact: solved.contact, force_W: solved.impulse_W / step_s }
    }
}

/// A state on the way of a smooth motion, the forces of its contacts, and the time that it stands for.
#[derive(Clone, Debug)]
pub struct Moment {
    pub state: State,
    pub contacts: Vec<ContactForce>,
    pub weight_s: f64,
}

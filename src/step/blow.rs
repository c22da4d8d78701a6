//! Impacts by a law of their own (`solve::impact`), before a step's contact forces: what strikes in the step, together
//! with what touches, passes through the law from the velocities just before; the step then goes on, plastic, from
//! those just after.

use crate::collide::Contact;
use crate::collide::approach::{Approach, NormalMotion, comes};
use crate::collide::closed::is_closed_to_rounding;
use crate::collide::islands::Islands;
use crate::deadline::Deadline;
use crate::experiment::types::Impact;
use crate::model::Model;
use crate::solve::Impulse;
use crate::solve::impact::{self, Law, Plastic};
use crate::solve::problem::ContactProblem;
use crate::solve::twist::Twist;
use crate::state::State;
use nalgebra::Vector3;

/// Whether a contact may have an impact: what lasts has none.
type MayStrike<'a> = dyn Fn(&Contact) -> bool + 'a;

pub struct Blow {
    law: Law,
    pub approach: Approach,
    problem: ContactProblem,
    /// Those that take part, their places among all, their restitution.
    contacts: Vec<Contact>,
    places: Vec<usize>,
    restitution: Vec<f64>,
    own: Vec<Impulse>,
    islands: Islands,
    /// Of every island by its first body: something strikes.
    struck: Vec<bool>,
    /// Of every contact: its island is struck.
    pub is_struck: Vec<bool>,
    /// Of all contacts; and what they do to the bodies.
    pub impulses: Vec<Impulse>,
    pub response: Vec<Twist>,
    /// The bodies just after.
    pub after: State,
}

impl Blow {
    /// None: Newton's law, which the targets of the step's own contact problem are.
    pub fn new(law: Impact, approach: Approach, start: &State) -> Option<Self> {
        let law = match law {
            Impact::Newton => return None,
            Impact::Poisson => Law::Poisson,
            Impact::Sequential => Law::Sequential,
        };
        Some(Blow {
            law,
            approach,
            problem: ContactProblem::default(),
            contacts: Vec::new(),
            places: Vec::new(),
            restitution: Vec::new(),
            own: Vec::new(),
            islands: Islands::default(),
            struck: Vec::new(),
            is_struck: Vec::new(),
            impulses: Vec::new(),
            response: Vec::new(),
            after: start.clone(),
        })
    }

    /// None if nothing strikes; else whether the law came to its end. `free`: velocities with the forces of the step.
    pub fn strike(
        &mut self,
        model: &Model,
        state: &State,
        free: &[Twist],
        (found, may_strike): (&[Contact], &MayStrike),
        (step_s, deadline): (f64, Deadline),
        solver: &mut Plastic,
    ) -> Option<bool> {
        self.impulses.clear();
        if !self.take_part(model, state, free, (found, may_strike), step_s) {
            return None;
        }
        // Half-way through the kick of `moreau` half of the forces have acted: with e = 1 no energy is lost.
        let part = if self.approach == Approach::Middle { 0.5 } else { 0.0 };
        let before: Vec<Twist> =
            state.bodies.iter().zip(free).map(|(at, free)| Twist::of(at).toward(free, part)).collect();
        self.problem.gather(model, state, &before, &mut self.contacts, (Approach::Touching, step_s));
        let ended = impact::resolve(self.law, &self.problem, &self.restitution, solver, deadline, &mut self.own);
        self.impulses.clear();
        self.impulses.resize(found.len(), Impulse::zeros());
        self.places.iter().zip(&self.own).for_each(|(place, p)| self.impulses[*place] = *p);
        self.problem.response(&self.own, &mut self.response);
        self.after.copy_from(state);
        for (at, u) in self.after.bodies.iter_mut().zip(&self.response) {
            at.v_WB += u.v;
            at.w_WB += u.w;
        }
        Some(ended)
    }

    /// Whether anything strikes. What strikes takes its island along: all that bodies hand on among each other.
    fn take_part(
        &mut self,
        model: &Model,
        state: &State,
        free: &[Twist],
        (found, may_strike): (&[Contact], &MayStrike),
        step_s: f64,
    ) -> bool {
        self.islands.find(model, found.iter().copied());
        self.struck.clear();
        self.struck.resize(model.bodies.len(), false);
        let strikes: Vec<bool> = found
            .iter()
            .map(|contact| {
                let motion = normal_motion(contact, state, free);
                let speed = |(i, r_W, _): (usize, Vector3<f64>, f64)| free[i].v.norm() + free[i].w.norm() * r_W.norm();
                may_strike(contact)
                    && comes(motion, contact.ends().map(speed))
                    && self.approach.strikes(model, contact, motion, step_s)
            })
            .collect();
        for (contact, _) in found.iter().zip(&strikes).filter(|(_, strikes)| **strikes) {
            let first = self.islands.of(model, contact);
            self.struck[first] = true;
        }
        self.is_struck.clear();
        self.contacts.clear();
        self.places.clear();
        self.restitution.clear();
        for (place, (contact, strikes)) in found.iter().zip(strikes).enumerate() {
            let is_struck = self.struck[self.islands.of(model, contact)];
            self.is_struck.push(is_struck);
            if strikes || (is_struck && is_closed_to_rounding(model, contact)) {
                self.contacts.push(*contact);
                self.places.push(place);
                self.restitution.push(contact.restitution);
            }
        }
        !self.contacts.is_empty()
    }
}

/// Normal velocity of a contact in a step in which bodies do not turn on by themselves.
pub(super) fn normal_motion(contact: &Contact, state: &State, free: &[Twist]) -> NormalMotion {
    let before = contact.normal.dot(&contact.velocity(|i| [state.bodies[i].v_WB, state.bodies[i].w_WB]));
    let gained = contact.normal.dot(&contact.velocity(|i| [free[i].v, free[i].w])) - before;
    NormalMotion { before, gained, turning: 0.0 }
}

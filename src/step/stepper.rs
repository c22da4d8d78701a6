//! A method and its scratch, stepping a whole system.

use super::scratch::Scratch;
use super::{event_driven, free, lecture, penalty, time_stepping};
use crate::clock::Clock;
use crate::collide::SolvedContact;
use crate::collide::approach::Approach;
use crate::deadline::Deadline;
use crate::experiment::types::SteppingMethod as Settings;
use crate::integrate::rotation::exponential;
use crate::model::Model;
use crate::outcome::Criterion;
use crate::plan::Plan;
use crate::shown::{Acted, ContactForce, Passage};
use crate::state::{BodyState, State};
use crate::work::Work;

/// A method, and the bodies that move as they are told.
pub struct Stepper {
    method: Method,
    /// How steps of the clock go through a contact.
    approach: Approach,
    driven: Vec<Driven>,
}

/// A method and its scratch.
enum Method {
    Free(free::Free),
    Lecture(lecture::Lecture),
    Penalty(penalty::Penalty),
    TimeStepping(Box<time_stepping::TimeStepping>),
    EventDriven(Box<event_driven::EventDriven>),
}

/// A body at constant velocities, by its index, from its start.
struct Driven(usize, BodyState);

impl Driven {
    fn write(&self, state: &mut State) {
        let BodyState { p_WB, q_WB, v_WB, w_WB } = self.1;
        let (p_WB, q_WB) = (p_WB + v_WB * state.time_s, exponential(&(w_WB * state.time_s)) * q_WB);
        state.bodies[self.0] = BodyState { p_WB, q_WB, v_WB, w_WB };
    }
}

impl Stepper {
    pub fn new(method: &Settings, plan: &Plan, model: &Model, start: &State) -> Self {
        let scratch = || Scratch::new(model, plan);
        let method = match method {
            Settings::Free(settings) => Method::Free(free::Free::new(settings, model, start)),
            Settings::Lecture(settings) => Method::Lecture(lecture::Lecture::new(settings, scratch())),
            Settings::Penalty(settings) => Method::Penalty(penalty::Penalty::new(settings, scratch())),
            Settings::TimeStepping(settings) => {
                Method::TimeStepping(Box::new(time_stepping::TimeStepping::new(settings, plan, start, scratch())))
            }
            Settings::EventDriven(settings) => {
                Method::EventDriven(Box::new(event_driven::EventDriven::new(settings, plan, model, start)))
            }
        };
        let driven = model.bodies.iter().zip(&start.bodies).enumerate().filter(|(_, (body, _))| body.driven);
        Stepper { method, approach: plan.approach, driven: driven.map(|(i, (_, at))| Driven(i, *at)).collect() }
    }

    /// Steps from now on have time until then: one that is not made by then is not made. Without a deadline they have
    /// all the time that they need.
    pub fn hurry(&mut self, deadline: Deadline) {
        match &mut self.method {
            Method::Free(method) => method.deadline = deadline,
            Method::Lecture(method) => method.deadline = deadline,
            Method::TimeStepping(method) => method.hurry(deadline),
            Method::EventDriven(method) => method.hurry(deadline),
            // It iterates nothing.
            Method::Penalty(_) => {}
        }
    }

    /// Steps from now on that leave bodies at rest as they are may be made all at once, up to this one.
    pub fn rest_to(&mut self, step: u64) {
        if let Method::TimeStepping(method) = &mut self.method {
            method.rests_to = step;
        }
    }

    pub fn step(&mut self, model: &Model, state: &mut State, clock: &Clock) {
        match &mut self.method {
            Method::Free(method) => method.step(model, state, clock),
            Method::Lecture(method) => method.step(model, state, clock),
            Method::Penalty(method) => method.step(model, state, clock),
            Method::TimeStepping(method) => method.step(model, state, clock),
            Method::EventDriven(method) => return method.step(model, state, clock.end_s),
        }
        self.driven.iter().for_each(|driven| driven.write(state));
    }

    /// The last step could not be made: the state is to be forgotten.
    pub fn stalled(&self) -> Option<Criterion> {
        match &self.method {
            Method::Free(method) => method.stalled,
            Method::EventDriven(method) => method.stalled,
            Method::Lecture(method) => method.is_cut.then_some(Criterion::Limit),
            Method::TimeStepping(method) => method.is_cut.then_some(Criterion::Limit),
            Method::Penalty(_) => None,
        }
    }

    pub fn is_done(&self, state: &State, clock: &Clock) -> bool {
        match &self.method {
            Method::EventDriven(_) => state.time_s >= clock.end_s,
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => {
                state.step >= clock.steps
            }
        }
    }

    /// Of a method that makes its own steps, their mean.
    pub fn step_used_s(&self, state: &State, clock: &Clock) -> f64 {
        match &self.method {
            Method::EventDriven(_) => state.time_s / state.step.max(1) as f64,
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => clock.step_s,
        }
    }

    /// What the contacts of the last step did, which began at `before`.
    pub fn acted<'a>(&'a self, before: &'a State, clock: &Clock) -> Acted<'a> {
        let kicked = match &self.method {
            Method::EventDriven(method) => return method.acted(),
            Method::Free(method) => match method.shown_way() {
                Some(way) => return Acted::Motion(way),
                None => None,
            },
            Method::TimeStepping(method) => method.kicked.as_ref(),
            Method::Lecture(_) | Method::Penalty(_) => None,
        };
        Acted::Kick {
            kicked: kicked.unwrap_or(before),
            contacts: self.contacts(),
            step_s: self.made_s(clock),
            approach: if let Method::TimeStepping(method) = &self.method { method.approach } else { self.approach },
        }
    }

    /// The way of the last step, of a method that follows events.
    pub fn way(&self) -> Option<&dyn Passage> {
        match &self.method {
            Method::EventDriven(method) => Some(&**method),
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => None,
        }
    }

    /// Forces of contact at the end of the last step.
    pub fn forces_at(&self, model: &Model, end: &State, clock: &Clock) -> Vec<ContactForce> {
        match self.way() {
            Some(way) => way.forces_at(model, end),
            None => self.contacts().iter().map(|solved| ContactForce::mean(solved, self.made_s(clock))).collect(),
        }
    }

    /// Length of the last step: of the clock's, or a part of it.
    fn made_s(&self, clock: &Clock) -> f64 {
        match &self.method {
            Method::TimeStepping(method) => method.made_s,
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::EventDriven(_) => clock.step_s,
        }
    }

    /// Contacts of the last step.
    pub fn contacts(&self) -> &[SolvedContact] {
        match &self.method {
            Method::Free(_) => &[],
            Method::Lecture(method) => &method.scratch.solved,
            Method::Penalty(method) => &method.scratch.solved,
            Method::TimeStepping(method) => &method.scratch.solved,
            Method::EventDriven(method) => &method.solved,
        }
    }

    pub fn work(&self) -> &Work {
        match &self.method {
            Method::Free(method) => &method.work,
            Method::Lecture(method) => &method.scratch.work,
            Method::Penalty(method) => &method.scratch.work,
            Method::TimeStepping(method) => &method.scratch.work,
            Method::EventDriven(method) => &method.work,
        }
    }
}

//! A method and its scratch, stepping a whole system.

use super::scratch::Scratch;
use super::{event_driven, free, lecture, penalty, time_stepping};
use crate::clock::Clock;
use crate::collide::SolvedContact;
use crate::experiment::types::{EventDriven as EventSettings, Method as Settings};
use crate::integrate::rotation::exponential;
use crate::model::Model;
use crate::outcome::Criterion;
use crate::plan::Plan;
use crate::shown::{Moment, Span};
use crate::state::{BodyState, State};
use crate::work::Work;

/// A method, and the bodies that move as they are told.
pub struct Stepper {
    method: Method,
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
            Settings::Auto(settings) => {
                let settings = EventSettings { tolerance: settings.tolerance, ..Default::default() };
                Method::EventDriven(Box::new(event_driven::EventDriven::new(&settings, plan, model, start)))
            }
        };
        let driven = model.bodies.iter().zip(&start.bodies).enumerate().filter(|(_, (body, _))| body.driven);
        Stepper { method, driven: driven.map(|(i, (_, at))| Driven(i, *at)).collect() }
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
            Method::Free(method) => method.stalled.then_some(Criterion::NotConverged),
            Method::EventDriven(method) => method.stalled,
            Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => None,
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

    pub fn span(&self) -> Span {
        match &self.method {
            Method::EventDriven(method) => method.span,
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => Span::Step,
        }
    }

    /// Puts the bodies where they were at the state's time, within the last step of a method that follows events.
    pub fn state_at(&mut self, model: &Model, state: &mut State) {
        match &mut self.method {
            Method::EventDriven(method) => method.state_at(model, state),
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => {}
        }
    }

    /// Forces of contact at a state within the last step of a method that follows events, as impulses of one second.
    pub fn forces_at(&mut self, model: &Model, state: &State) -> Vec<SolvedContact> {
        match &mut self.method {
            Method::EventDriven(method) => method.forces_at(model, state),
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => Vec::new(),
        }
    }

    /// States and forces of contact on the way of the last step, and the time that each of them stands for.
    pub fn moments(&mut self, model: &Model, span: [&State; 2]) -> Vec<Moment> {
        match &mut self.method {
            Method::EventDriven(method) => method.moments(model, span),
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) | Method::TimeStepping(_) => Vec::new(),
        }
    }

    /// Where the impulses of the last step acted; none: where it began.
    pub fn kicked(&self) -> Option<&State> {
        match &self.method {
            Method::TimeStepping(method) => method.kicked.as_ref(),
            Method::EventDriven(method) => method.kicked(),
            Method::Free(_) | Method::Lecture(_) | Method::Penalty(_) => None,
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

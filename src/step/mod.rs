//! The exchangeable unit: one step of the whole system, a page each.
//!
//! A `match` on the method picks it, once a run. A free product of integrators and contact solvers would permit
//! nonsense and forbid substeps and events.

mod blow;
mod drift;
mod event_driven;
mod free;
mod hold;
mod lecture;
mod penalty;
mod stretch;
mod time_stepping;

use crate::collide::{Contact, Detector, Reach, SolvedContact};
use crate::experiment::types::{EventDriven as EventSettings, Method as Settings, Rotation, Update};
use crate::integrate::rotation::{exponential, turn_at_momentum, turn_literally, w_from_momentum};
use crate::measure::Moment;
use crate::measure::divergence::Criterion;
use crate::measure::work::Work;
use crate::model::{Body, Model};
use crate::plan::Plan;
use crate::solve::problem::{ContactProblem, Twist};
use crate::solve::{Impulse, gauss_seidel};
use crate::state::{BodyState, State};

/// Equal steps up to an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    pub steps: u64,
    pub end_s: f64,
    pub step_s: f64,
}

impl Clock {
    /// n = max(1, round(end/step)) equal steps of end/n.
    pub fn new(step_s: f64, end_s: f64) -> Self {
        let steps = ((end_s / step_s).round() as u64).max(1);
        Clock { steps, end_s, step_s: end_s / steps as f64 }
    }

    /// From the count, so that no rounding adds up.
    fn advance(&self, state: &mut State) {
        state.step += 1;
        let passed_s = self.end_s * state.step as f64 / self.steps as f64;
        state.time_s = if state.step == self.steps { self.end_s } else { passed_s };
    }
}

/// What a method needs in every step and nobody outside does.
#[derive(Debug)]
struct Scratch {
    detector: Detector,
    found: Vec<Contact>,
    problem: ContactProblem,
    /// V[n] + M⁻¹ F_E Δt of every body.
    free: Vec<Twist>,
    impulses: Vec<Impulse>,
    solver: gauss_seidel::Scratch,
    /// M⁻¹ Jᵀ p of every body.
    response: Vec<Twist>,
    solved: Vec<SolvedContact>,
    work: Work,
}

/// A method, and the bodies that move as they are told.
pub struct Stepper {
    method: Method,
    driven: Vec<Driven>,
}

/// What the last step was, for those who judge it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// Of the clock, with impulses at its start or in its middle.
    Step,
    /// An impact, which takes no time.
    Blow,
    /// Of equal length, between events that were too many.
    Short { step_s: f64 },
    /// A smooth motion with forces of contact, which `moments` shows.
    Motion,
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
            _ => None,
        }
    }

    pub fn is_done(&self, state: &State, clock: &Clock) -> bool {
        match &self.method {
            Method::EventDriven(_) => state.time_s >= clock.end_s,
            _ => state.step >= clock.steps,
        }
    }

    /// Of a method that makes its own steps, their mean.
    pub fn step_used_s(&self, state: &State, clock: &Clock) -> f64 {
        match &self.method {
            Method::EventDriven(_) => state.time_s / state.step.max(1) as f64,
            _ => clock.step_s,
        }
    }

    pub fn span(&self) -> Span {
        match &self.method {
            Method::EventDriven(method) => method.span,
            _ => Span::Step,
        }
    }

    /// Puts the bodies where they were at the state's time, within the last step of a method that follows events.
    pub fn state_at(&mut self, model: &Model, state: &mut State) {
        if let Method::EventDriven(method) = &mut self.method {
            method.state_at(model, state);
        }
    }

    /// Forces of contact at a state within the last step of a method that follows events, as impulses of one second.
    pub fn forces_at(&mut self, model: &Model, state: &State) -> Vec<SolvedContact> {
        match &mut self.method {
            Method::EventDriven(method) => method.forces_at(model, state),
            _ => Vec::new(),
        }
    }

    /// States and forces of contact on the way of the last step, and the time that each of them stands for.
    pub fn moments(&mut self, model: &Model, span: [&State; 2]) -> Vec<Moment> {
        match &mut self.method {
            Method::EventDriven(method) => method.moments(model, span),
            _ => Vec::new(),
        }
    }

    /// Where the impulses of the last step acted; none: where it began.
    pub fn kicked(&self) -> Option<&State> {
        match &self.method {
            Method::TimeStepping(method) => method.kicked.as_ref(),
            Method::EventDriven(method) => method.kicked(),
            _ => None,
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

impl Scratch {
    /// With room for every point touching the three faces of a corner at once, so that no step allocates; beyond some
    /// thousand contacts it grows when they come.
    fn new(model: &Model, plan: &Plan) -> Self {
        const MOST: usize = 4096;
        let points: usize = model.bodies.iter().map(|body| body.geometry.points()).sum();
        let faces = model.container.as_ref().map_or(0, |container| container.faces.len());
        let contacts = if plan.contact { (points * faces.min(3)).min(MOST) } else { 0 };
        let bodies = model.bodies.len();
        Scratch {
            detector: Detector::default(),
            found: Vec::with_capacity(contacts),
            problem: ContactProblem::with_capacity(contacts, bodies),
            free: Vec::with_capacity(bodies),
            impulses: Vec::with_capacity(contacts),
            solver: gauss_seidel::Scratch::with_capacity(contacts, bodies),
            response: Vec::with_capacity(bodies),
            solved: Vec::with_capacity(contacts),
            work: Work::default(),
        }
    }

    /// Contacts that there is room for.
    fn contacts(&self) -> usize {
        self.found.capacity()
    }

    /// Step 1 of L21.
    fn detect(&mut self, model: &Model, state: &State, reach: &Reach) {
        self.detector.detect(model, state, reach, &mut self.found, &mut self.work);
    }

    /// V + M⁻¹ F_E Δt (L14).
    fn free_velocities(&mut self, model: &Model, state: &State, step_s: f64) {
        self.free.clear();
        self.free.extend(state.bodies.iter().enumerate().map(|(i, at)| {
            let (v, w) = model.gained(i, state.time_s, at, step_s);
            Twist { v: at.v_WB + v, w: at.w_WB + w }
        }));
    }

    /// Contacts of this step with their impulses in world axes, and the response M⁻¹ Jᵀ p to just these.
    fn take_solution(&mut self) {
        self.work.contacts += self.found.len() as u64;
        self.work.contact_solves += u64::from(!self.found.is_empty());
        self.solved.clear();
        let solved = self.found.iter().zip(&self.problem.blocks).zip(&self.impulses);
        self.solved.extend(
            solved.map(|((contact, block), p)| SolvedContact { contact: *contact, impulse_W: block.in_world(p) }),
        );
        self.problem.response(&self.impulses, &mut self.response);
    }
}

/// Position and attitude by the old or the new velocity; `new` becomes the body's velocity (steps 3 and 4 of L21).
fn move_body(
    body: &Body,
    at: &mut BodyState,
    new: &Twist,
    update: Update,
    rotation: Rotation,
    step_s: f64,
    work: &mut Work,
) {
    let old = Twist { v: at.v_WB, w: at.w_WB };
    let moving = match update {
        Update::Explicit => &old,
        Update::SemiImplicit => new,
    };
    at.p_WB += moving.v * step_s;
    at.v_WB = new.v;
    match rotation {
        Rotation::Literal => {
            turn_literally(at, &moving.w, step_s);
            at.w_WB = new.w;
        }
        Rotation::Momentum => {
            let I_W = body.I_W(at);
            turn_at_momentum(body, at, &(I_W * moving.w), step_s, work);
            at.w_WB = if body.isotropic { new.w } else { w_from_momentum(body, at, &(I_W * new.w)) };
        }
    }
}

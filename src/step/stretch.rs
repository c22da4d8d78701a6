//! Some steps of equal length by time-stepping, where events lead no further: they accumulate, or parts of bodies touch
//! whose forces of contact are not known in closed form.

use super::scratch::Scratch;
use super::time_stepping;
use crate::clock::Clock;
use crate::collide::SolvedContact;
use crate::deadline::Deadline;
use crate::event::patience::Patience;
use crate::event::slip::falls;
use crate::experiment::types::{Impact, Method, Scheme, Solver, TimeStepping};
use crate::model::Model;
use crate::plan::Plan;
use crate::state::State;

pub struct Stretch {
    stepper: Box<time_stepping::TimeStepping>,
    left: u32,
    step_s: f64,
}

/// Whole steps in one go; and shorter ones, which are to end what accumulates at one moment.
const STEPS: u32 = 32;
const FEW: u32 = 8;

/// Of a whole step: the first one that is tried; each level is so many times longer, up to a whole step, then there
/// are twice as many of them.
const FIRST: f64 = 1e-4;
const LONGER: f64 = 4.0;

/// Residual of a step that is solved: its length is what it is wrong by, and what is nearer than this takes most of the
/// work where many contacts are redundant (measured, in stacks of six bodies: 3 to 10 times as long to 1e-10).
const SOLVED: f64 = 1e-8;

impl Stretch {
    /// `level`: how often one has soon followed another.
    pub fn new(impact: Impact, model: &Model, start: &State, level: u32) -> Self {
        let settings = TimeStepping {
            solver: Solver::Newton,
            scheme: Scheme::Moreau,
            tolerance: Some(SOLVED),
            impact,
            ..Default::default()
        };
        let plan = Plan::new(model, &Method::TimeStepping(settings.clone()));
        let stepper = time_stepping::TimeStepping::new(&settings, &plan, start, Scratch::new(model, &plan));
        // A rocking whose events accumulate is to end: held in the mean of two velocities it would go on for ever.
        let (mut part, mut left) = (FIRST, FEW);
        for _ in 0..level {
            (part, left) = if part < 1.0 { (part * LONGER, FEW) } else { (part, STEPS.max(2 * left)) };
        }
        let step_s = part.min(1.0) * whole_s(model);
        Stretch { stepper: Box::new(stepper.without_lasting()), left, step_s }
    }

    /// One step, not beyond the end; its length.
    pub fn step(&mut self, model: &Model, state: &mut State, end_s: f64) -> f64 {
        /// A step that would leave less than this part of itself ends at the end.
        const REST: f64 = 1e-6;
        let (step, from_s, h) = (state.step, state.time_s, self.step_s);
        let until_s = if from_s + h * (1.0 + REST) >= end_s { end_s } else { from_s + h };
        // The clock of a stepper counts from zero; this one is told the time.
        self.stepper.step(model, state, &Clock { steps: u64::MAX, end_s, step_s: until_s - from_s });
        (state.step, state.time_s) = (step + 1, until_s);
        self.left -= 1;
        until_s - from_s
    }

    /// Steps from now on have time until then.
    pub fn hurry(&mut self, deadline: Deadline) {
        self.stepper.hurry(deadline);
    }

    pub fn is_over(&self) -> bool {
        self.left == 0
    }

    pub fn contacts(&self) -> &[SolvedContact] {
        &self.stepper.scratch.solved
    }

    pub fn unsolved(&self) -> u64 {
        self.stepper.scratch.work.unsolved
    }

    /// Where the last step had its impulses.
    pub fn kicked(&self) -> Option<&State> {
        self.stepper.kicked.as_ref()
    }
}

/// For how long events are followed, in the time of a stretch of whole steps.
pub fn patience(model: &Model, start: &State) -> Patience {
    let moving = model.bodies.iter().filter(|body| !body.driven).count();
    Patience::new(f64::from(STEPS) * whole_s(model), moving, start.time_s)
}

/// A thousandth of a fall by the size of the bodies.
fn whole_s(model: &Model) -> f64 {
    let (g, size_m) = falls(model);
    if g > 0.0 { 1e-3 * (size_m / g).sqrt() } else { 1e-4 }
}

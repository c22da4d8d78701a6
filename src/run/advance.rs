//! THE LOOP below every run: step after step, up to the end, a step that cannot be made, or a limit, which is kept
//! within a step as well: what is not made by then is not made.

use crate::clock::Clock;
use crate::deadline::Deadline;
use crate::experiment::types::{Limits, Method, SteppingMethod};
use crate::interrupt;
use crate::model::Model;
use crate::outcome::Criterion;
use crate::plan::Plan;
use crate::shown::{ContactForce, Shown};
use crate::state::State;
use crate::step::Stepper;
use crate::work::Work;
use std::time::{Duration, Instant};

/// A run on its way.
pub struct Advance<'a> {
    plan: Plan,
    stepper: Stepper,
    clock: Clock,
    limits: &'a Limits,
    before: State,
    state: State,
    is_timed: bool,
    /// Nobody looks at steps of rest one by one.
    pub(super) passes_rest: bool,
    stepping: Duration,
    stopped: Option<Criterion>,
}

impl<'a> Advance<'a> {
    /// Of a method, from a first state. The clock on the wall is read for a limit alone.
    pub fn new(method: &SteppingMethod, model: &Model, start: State, clock: Clock, limits: &'a Limits) -> Self {
        let plan = Plan::new(model, &Method::from(method.clone()));
        let stepper = Stepper::new(method, &plan, model, &start);
        Advance {
            plan,
            stepper,
            clock,
            limits,
            before: start.clone(),
            state: start,
            is_timed: limits.wall_s.is_some(),
            passes_rest: false,
            stepping: Duration::ZERO,
            stopped: None,
        }
    }

    /// With the time that its steps take.
    pub fn timed(self) -> Self {
        Advance { is_timed: true, ..self }
    }

    /// Makes a step and shows it; none: there is none left.
    pub fn next(&mut self, model: &Model) -> Option<Shown<'_>> {
        if self.has_ended() {
            return None;
        }
        self.before.copy_from(&self.state);
        let most = self.limits.steps.unwrap_or(u64::MAX).min(self.clock.steps);
        self.stepper.rest_to(if self.passes_rest { most } else { 0 });
        let started = self.is_timed.then(Instant::now);
        if let Some(most_s) = self.limits.wall_s {
            self.stepper.hurry(Deadline::after_s(most_s - self.stepping.as_secs_f64()));
        }
        self.stepper.step(model, &mut self.state, &self.clock);
        if self.limits.wall_s.is_some() {
            // Whoever looks into the step afterwards takes the time that it takes.
            self.stepper.hurry(Deadline::default());
        }
        self.stepping += started.map_or(Duration::ZERO, |started| started.elapsed());
        let stalled = self.stepper.stalled();
        if stalled.is_some() {
            self.state.copy_from(&self.before);
        }
        self.stopped = stalled.or_else(|| self.limit());
        Some(Shown {
            before: &self.before,
            after: &self.state,
            acted: self.stepper.acted(&self.before, &self.clock),
            way: self.stepper.way(),
            stalled,
            is_last: self.has_ended(),
        })
    }

    /// The same to the end, seen by nobody.
    pub fn run_out(&mut self, model: &Model) {
        while self.next(model).is_some() {}
    }

    fn has_ended(&self) -> bool {
        self.stopped.is_some() || self.stepper.is_done(&self.state, &self.clock)
    }

    /// What is not at its end may have used up what it is given, or be asked to end.
    fn limit(&self) -> Option<Criterion> {
        if interrupt::asked().is_some() && !self.stepper.is_done(&self.state, &self.clock) {
            return Some(Criterion::Interrupted);
        }
        let Limits { wall_s, steps, events } = self.limits;
        let is_used_up = steps.is_some_and(|most| self.state.step >= most)
            || events.is_some_and(|most| self.work().events > most)
            || wall_s.is_some_and(|most_s| self.stepping.as_secs_f64() > most_s);
        (is_used_up && !self.stepper.is_done(&self.state, &self.clock)).then_some(Criterion::Limit)
    }

    /// What its steps need and what is skipped.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    pub fn state(&self) -> &State {
        &self.state
    }

    pub fn work(&self) -> &Work {
        self.stepper.work()
    }

    /// Why it ended before its time.
    pub fn stopped(&self) -> Option<Criterion> {
        self.stopped
    }

    /// Time that the steps took, of a timed run.
    pub fn stepping(&self) -> Duration {
        self.stepping
    }

    /// Of a method that makes its own steps, their mean.
    pub fn step_used_s(&self) -> f64 {
        self.stepper.step_used_s(&self.state, &self.clock)
    }

    /// Forces of contact at the end of the last step.
    pub fn forces(&self, model: &Model) -> Vec<ContactForce> {
        self.stepper.forces_at(model, &self.state, &self.clock)
    }
}

/// Where a run came to that nobody watches.
pub struct Stepped {
    pub state: State,
    pub work: Work,
    /// Why it ended before its time.
    pub stopped: Option<Criterion>,
}

/// Only steps: no judge, no recorder.
pub fn only_step(method: &SteppingMethod, model: &Model, start: State, clock: &Clock, limits: &Limits) -> Stepped {
    let mut advance = Advance::new(method, model, start, *clock, limits);
    advance.passes_rest = true;
    advance.run_out(model);
    Stepped { work: *advance.work(), stopped: advance.stopped, state: advance.state }
}

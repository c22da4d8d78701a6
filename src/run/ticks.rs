//! States at times that mean nothing to a method that goes from event to event: the motion is the same without.

use crate::clock::Clock;
use crate::experiment::types::Experiment;
use crate::model::Model;
use crate::record::sampler::Sampler;
use crate::state::State;
use crate::step::Stepper;

/// States of a method that goes from event to event, at the times of a clock.
pub struct Due {
    clock: Clock,
    /// Times that have passed.
    count: u64,
    state: State,
}

/// After so many steps of the clock.
pub struct DueAt<'a> {
    pub part: u64,
    pub state: &'a State,
}

impl Due {
    pub fn new(clock: Clock, start: &State) -> Self {
        Due { clock, count: 0, state: start.clone() }
    }

    fn next_s(&self) -> f64 {
        self.clock.end_s * (self.count + 1) as f64 / self.clock.steps as f64
    }

    /// The next one in the last stretch of a run, which ends at `end`.
    pub fn next(&mut self, stepper: &mut Stepper, model: &Model, end: &State) -> Option<DueAt<'_>> {
        let due_s = self.next_s();
        if due_s > end.time_s {
            return None;
        }
        self.count += 1;
        self.state.copy_from(end);
        self.state.time_s = due_s;
        stepper.state_at(model, &mut self.state);
        Some(DueAt { part: self.count, state: &self.state })
    }
}

/// Samples for a recorder.
pub struct Samples {
    ticks: Due,
    every_event: bool,
}

impl Samples {
    pub fn new(experiment: &Experiment, start: &State) -> Self {
        let every_event = experiment.record.every_s == 0.0;
        Samples { ticks: Due::new(ticks(experiment), start), every_event }
    }

    /// What is due in the last stretch, and its end if that is wanted.
    pub fn show(&mut self, sampler: &mut Sampler, stepper: &mut Stepper, model: &Model, end: &State, last: bool) {
        while !(self.every_event || last && self.ticks.next_s() == end.time_s) {
            let Some(DueAt { state, .. }) = self.ticks.next(stepper, model, end) else { break };
            let forces = stepper.forces_at(model, state);
            sampler.sample(model, state, &forces, 1.0);
        }
        if last || self.every_event {
            let forces = stepper.forces_at(model, end);
            sampler.sample(model, end, &forces, 1.0);
        }
    }
}

/// When samples are due, of a method that makes no steps of the clock; else its steps.
pub fn ticks(experiment: &Experiment) -> Clock {
    let every_s = experiment.record.every_s;
    if experiment.method.follows_events() && every_s > 0.0 {
        return Clock::new(every_s, experiment.time.end_s);
    }
    experiment.clock()
}

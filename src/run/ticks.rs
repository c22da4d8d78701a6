//! When someone looks between two steps. A method that makes steps of the clock is looked at after some of them; one
//! that goes from event to event is asked where it was at a time: the motion is the same without.

use crate::clock::Clock;
use crate::experiment::types::Experiment;
use crate::measure::Judge;
use crate::model::Model;
use crate::record::sampler::Sampler;
use crate::shown::{Acted, ContactForce, Passage, Shown};
use crate::state::State;
use crate::work::Work;

/// The times of a clock, on the way of a run.
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

    /// The next one on a way that ends at `end`.
    pub fn next(&mut self, way: &dyn Passage, model: &Model, end: &State) -> Option<DueAt<'_>> {
        let due_s = self.next_s();
        if due_s > end.time_s {
            return None;
        }
        self.count += 1;
        self.state.copy_from(end);
        self.state.time_s = due_s;
        way.state_at(model, &mut self.state);
        Some(DueAt { part: self.count, state: &self.state })
    }
}

/// Shows equal parts of a run's time to whoever compares it with another one.
pub struct Parts {
    due: Due,
    steps: u64,
}

impl Parts {
    /// Of a run by this clock, in so many parts.
    pub fn new(parts: u64, clock: &Clock, start: &State) -> Self {
        Parts { due: Due::new(Clock::new(clock.end_s / parts as f64, clock.end_s), start), steps: clock.steps }
    }

    /// The parts that end in this step; those of a clock that end between two of its steps are left out.
    pub fn show(&mut self, model: &Model, shown: &Shown, mut to: impl FnMut(u64, &State)) {
        let (end, parts) = (shown.after, self.due.clock.steps);
        match shown.way {
            _ if shown.stalled.is_some() => {}
            None if shown.is_part() => {}
            Some(way) => {
                while let Some(at) = self.due.next(way, model, end) {
                    to(at.part, at.state);
                }
            }
            None if (end.step * parts).is_multiple_of(self.steps) => to(end.step * parts / self.steps, end),
            None => {}
        }
    }
}

/// Shows samples to a recorder.
pub struct Samples<'a> {
    sampler: &'a mut Sampler,
    ticks: Due,
    /// Every step is wanted, whatever its length.
    every_step: bool,
    step_s: f64,
}

impl<'a> Samples<'a> {
    /// The first of them is the start.
    pub fn new(sampler: &'a mut Sampler, experiment: &Experiment, model: &Model, start: &State) -> Self {
        sampler.start(model, start, experiment.method.facts().solves_contacts);
        let every_step = experiment.record.every_s == 0.0;
        Samples { sampler, ticks: Due::new(ticks(experiment), start), every_step, step_s: experiment.clock().step_s }
    }

    /// What is due in a step, and its end if it is wanted, decides, or is the `last` one. `judge` has seen it.
    pub fn show(&mut self, model: &Model, shown: &Shown, judge: &Judge, last: bool) {
        let decides = self.sampler.look(model, shown, judge);
        match shown.way {
            Some(way) => self.show_way(way, model, (shown.after, judge), decides || last),
            None => self.show_step(model, shown, judge, decides || last),
        }
    }

    /// What the steps so far have cost.
    pub fn count(&mut self, work: &Work, state: &State) {
        self.sampler.count(work, state);
    }

    fn show_way(&mut self, way: &dyn Passage, model: &Model, (end, judge): (&State, &Judge), end_is_wanted: bool) {
        while !(self.every_step || end_is_wanted && self.ticks.next_s() == end.time_s) {
            let Some(DueAt { state, .. }) = self.ticks.next(way, model, end) else { break };
            self.sampler.sample(model, [state, state], way.forces_at(model, state).into_iter(), true, None);
        }
        if end_is_wanted || self.every_step {
            let forces = way.forces_at(model, end).into_iter();
            self.sampler.sample(model, [end, end], forces, !end_is_wanted, Some(judge));
        }
    }

    fn show_step(&mut self, model: &Model, shown: &Shown, judge: &Judge, end_is_wanted: bool) {
        let due = self.sampler.is_due(shown.after.step) && (self.every_step || !shown.is_part());
        // A stalled run is back at a state that has been sampled if it was due.
        let wanted = if shown.stalled.is_some() { !due } else { due || end_is_wanted };
        let (acted, step_s) = match shown.acted {
            Acted::Kick { kicked, step_s, .. } => (kicked, step_s),
            Acted::Blow { .. } | Acted::Motion(_) => (shown.after, self.step_s),
        };
        let solved = shown.impulses();
        if wanted {
            let forces = solved.iter().map(|solved| ContactForce::mean(solved, step_s));
            self.sampler.note(forces.len(), judge);
            self.sampler.sample(model, [shown.after, acted], forces, due && !end_is_wanted, Some(judge));
        } else if shown.stalled.is_none() && !shown.is_part() {
            self.sampler.keep([shown.after, acted], (solved, step_s), judge);
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

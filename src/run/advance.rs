//! The bare loop: only steps, no judge, no recorder.

use crate::clock::Clock;
use crate::experiment::types::{Limits, Method};
use crate::model::Model;
use crate::outcome::Criterion;
use crate::plan::Plan;
use crate::state::State;
use crate::step::Stepper;
use crate::work::Work;
use std::time::{Duration, Instant};

/// Whether a run that is not at its end has to stop.
pub fn is_used_up(limits: &Limits, state: &State, work: &Work, stepping: Duration) -> bool {
    limits.steps.is_some_and(|most| state.step >= most)
        || limits.events.is_some_and(|most| work.events > most)
        || limits.wall_s.is_some_and(|most_s| stepping.as_secs_f64() > most_s)
}

/// Where a run came to that nobody watches.
pub struct Stepped {
    pub state: State,
    pub work: Work,
    /// Why it ended before its time.
    pub stopped: Option<Criterion>,
}

/// Only steps: no judge, no recorder.
pub fn only_step(method: &Method, model: &Model, start: State, clock: &Clock, limits: &Limits) -> Stepped {
    let mut stepper = Stepper::new(method, &Plan::new(model, method), model, &start);
    let (mut before, mut state) = (start.clone(), start);
    let started = Instant::now();
    let mut stopped = None;
    while !stepper.is_done(&state, clock) && stopped.is_none() {
        if is_used_up(limits, &state, stepper.work(), started.elapsed()) {
            stopped = Some(Criterion::Limit);
            break;
        }
        before.copy_from(&state);
        stepper.step(model, &mut state, clock);
        stopped = stepper.stalled();
        if stopped.is_some() {
            state.copy_from(&before);
        }
    }
    Stepped { state, work: *stepper.work(), stopped }
}

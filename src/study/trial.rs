//! Estimate of how long a case would take, from as many of its steps as fit in a moment.

use super::choose::first_tried;
use super::sensitivity;
use crate::experiment::types::{Experiment, Limits};
use crate::model::Model;
use crate::run::advance::Advance;
use crate::state::State;

/// Runs beside the one that is shown: three twins, and three more for what `auto` compares and has judged.
const TWINS: f64 = 3.0;
const TRIED_BY_AUTO: f64 = 3.0;
/// Least part of a case from which a moment says something.
const LEAST_PART: f64 = 1e-3;

/// Time that a case would take, in seconds, tried for `moment_s` at most (and one step).
pub fn seconds(experiment: &Experiment, model: &Model, start: State, moment_s: f64) -> f64 {
    let clock = experiment.clock();
    let limits = Limits { wall_s: Some(moment_s), ..Limits::default() };
    let mut advance = Advance::new(&first_tried(experiment), model, start, clock, &limits);
    advance.run_out(model);
    let state = advance.state();
    let part = match experiment.method.follows_events() {
        true => state.time_s / clock.end_s,
        false => state.step as f64 / clock.steps as f64,
    };
    let twins = if sensitivity::is_wanted(experiment) { TWINS } else { 0.0 };
    let tried = if experiment.method.stepping().is_err() { TRIED_BY_AUTO } else { 0.0 };
    advance.stepping().as_secs_f64() * (1.0 + twins + tried) / part.max(LEAST_PART)
}

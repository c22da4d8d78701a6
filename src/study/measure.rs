//! A case from its start to what was measured.

use super::choose::{self, Choice};
use super::{reference, sensitivity};
use crate::experiment::types::Experiment;
use crate::measure::reference::Reference;
use crate::model::Model;
use crate::record::sampler::Sampler;
use crate::run::{self, Ended};
use crate::state::State;

/// Runs one experiment from `start` to its end or its divergence; its reference, if it has one, is run before and lost.
pub fn run(experiment: &Experiment, model: &Model, start: State, sampler: Option<&mut Sampler>) -> Ended {
    let reference = reference::made(experiment, model, &start);
    run_against(experiment, model, start, sampler, reference.as_ref())
}

/// The same against a reference that is there.
pub fn run_against(
    experiment: &Experiment,
    model: &Model,
    start: State,
    sampler: Option<&mut Sampler>,
    reference: Option<&Reference>,
) -> Ended {
    let choice = choose::choose(experiment, model, &start);
    run_as(choice.as_ref(), experiment, model, start, sampler, reference)
}

/// The same as what `auto` has chosen, if the experiment leaves that to it.
pub fn run_as(
    choice: Option<&Choice>,
    experiment: &Experiment,
    model: &Model,
    start: State,
    sampler: Option<&mut Sampler>,
    reference: Option<&Reference>,
) -> Ended {
    let Some(choice) = choice else { return chosen(experiment, model, start, sampler, reference) };
    let mut ended = chosen(&choice.experiment, model, start, sampler, reference);
    choice.describe(&mut ended.measured);
    ended
}

fn chosen(
    experiment: &Experiment,
    model: &Model,
    start: State,
    sampler: Option<&mut Sampler>,
    reference: Option<&Reference>,
) -> Ended {
    let mut ended = run::run(experiment, model, start.clone(), sampler, reference);
    if sensitivity::is_wanted(experiment) {
        ended.measured.sensitivity = sensitivity::sensitivity(experiment, model, &start, &ended.state);
    }
    ended
}

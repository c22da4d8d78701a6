//! THE MAIN LOOP: advance the state, show every step to the judges and the recorders, end in an outcome.

use super::advance::Advance;
use super::ticks::{Parts, Samples};
use crate::exact::Closed;
use crate::experiment::types::{Experiment, SteppingMethod};
use crate::measure::Judge;
use crate::measure::error::Errors;
use crate::measure::more::{self, Watched};
use crate::measure::reference::{Against, PARTS, Reference};
use crate::model::Model;
use crate::outcome::{Criterion, Outcome};
use crate::record::sampler::Sampler;
use crate::rows::{Measured, finite};
use crate::shown::ContactForce;
use crate::state::State;

/// What a run leaves behind.
pub struct Ended {
    pub measured: Measured,
    pub state: State,
    /// Of the last step, at its end.
    pub forces: Vec<ContactForce>,
}

/// Runs one experiment by `method` from `start` to its end or its divergence.
pub fn run(
    experiment: &Experiment,
    method: &SteppingMethod,
    model: &Model,
    start: State,
    mut sampler: Option<&mut Sampler>,
    reference: Option<&Reference>,
) -> Ended {
    let clock = experiment.clock();
    // The plan has seen to it that the scene is one of the closed form's.
    let exact = experiment.exact.and_then(|exact| Closed::new(exact, model, &start).ok());
    let mut against = reference.map(|reference| (Against::new(reference), Parts::new(PARTS, &clock, &start)));
    let mut samples = sampler.as_deref_mut().map(|sampler| Samples::new(sampler, experiment, model, &start));
    let mut advance = Advance::new(method, model, start, clock, &experiment.limits).timed();
    let mut judge = Judge::new(model, advance.state(), &experiment.diverge, advance.plan());
    judge.watched = Watched::new(&experiment.measure);
    let is_looked_at = samples.is_some() || against.is_some() || !judge.watched.is_empty();
    let mut diverged = None;
    while diverged.is_none()
        && let Some(shown) = advance.next(model)
    {
        diverged = judge.observe(model, &shown);
        if let Some((against, parts)) = &mut against {
            parts.show(model, &shown, |part, state| against.observe(part, state));
        }
        if let Some(samples) = &mut samples {
            samples.show(model, &shown, &judge, diverged.is_some() || shown.is_last);
            samples.count(advance.work(), advance.state());
        }
        advance.passes_rest = !is_looked_at && judge.knows_rest();
    }
    let mut measured = summarize(model, &advance, &mut judge, diverged);
    let state = advance.state();
    if let Some(exact) = exact {
        Errors::between(state, &exact.state_at(state.time_s)).write(state.time_s, &mut measured);
    }
    if let Some((against, _)) = against {
        against.write(&mut measured);
    }
    measured.more = more::cells(experiment, model, state, &judge.watched);
    if let Some(sampler) = sampler {
        sampler.end(model, state, &measured, experiment.method.facts().solves_contacts);
    }
    Ended { measured, forces: advance.forces(model), state: state.clone() }
}

/// Divergence, which the judge sees, comes before what stops the steps.
fn summarize(model: &Model, advance: &Advance, judge: &mut Judge, diverged: Option<Criterion>) -> Measured {
    let diverged = diverged.map(|criterion| (Outcome::Diverged, criterion));
    let stopped = diverged.or_else(|| advance.stopped().map(|criterion| (Outcome::Stalled, criterion)));
    let state = advance.state();
    judge.end(model, state);
    let penetration_end_m = judge.geometry.penetration_m(model, state);
    Measured {
        outcome: stopped.map_or(Outcome::Finished, |(outcome, _)| outcome),
        criterion: stopped.map(|(_, criterion)| criterion.name().to_string()),
        end_time_s: finite(state.time_s),
        steps: state.step,
        step_used_s: finite(advance.step_used_s()),
        energy_start_j: finite(judge.energy.start_j()),
        energy_end_j: finite(judge.energy.end_j()),
        energy_drift_rel: finite(judge.energy.drift_rel()),
        energy_growth_max: judge.energy.growth_max().and_then(finite),
        energy_rise_max_rel: finite(judge.energy.rise_max_rel()),
        energy_balance_rel: finite(judge.energy.balance_rel()),
        linear_momentum_drift_rel: judge.momentum.linear_drift_rel(model, state).and_then(finite),
        angular_momentum_drift_rel: judge.momentum.angular_drift_rel(model, state).and_then(finite),
        penetration_max_m: judge.geometry.penetration_max_m.and_then(finite),
        penetration_end_m: penetration_end_m.and_then(finite),
        passed_through: judge.geometry.passed_through,
        ghost_impulse_max_rel: judge.geometry.ghost_impulse_max_rel.and_then(finite),
        pin_gap_max_m: judge.pin_gap_max_m.and_then(finite),
        // What has touched is judged: a force held against nothing is no missing number.
        residual_max: judge.residual.max.map(|residual| finite(residual).unwrap_or(f64::MAX)),
        contact_gain_max: judge.energy.contact_gain_max.and_then(finite),
        contacts_max: judge.contacts_max,
        work: *advance.work(),
        wall_s: finite(advance.stepping().as_secs_f64()),
        ..Measured::default()
    }
}

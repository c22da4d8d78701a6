//! THE MAIN LOOP: advance the state, show every step to the judges and the recorders, end in an outcome.

use super::advance::is_used_up;
use super::ticks::{Due, Samples};
use crate::clock::Clock;
use crate::collide::SolvedContact;
use crate::collide::approach::Approach;
use crate::exact::Closed;
use crate::experiment::types::Experiment;
use crate::measure::Judge;
use crate::measure::error::Errors;
use crate::measure::more::{self, Watched};
use crate::measure::reference::{Against, PARTS, Reference};
use crate::model::Model;
use crate::outcome::{Criterion, Outcome};
use crate::plan::Plan;
use crate::record::sampler::Sampler;
use crate::rows::{Measured, finite};
use crate::shown::Span;
use crate::state::State;
use crate::step::Stepper;
use std::time::{Duration, Instant};

/// What a run leaves behind.
pub struct Ended {
    pub measured: Measured,
    pub state: State,
    /// Of the last step.
    pub contacts: Vec<SolvedContact>,
    pub step_s: f64,
}

/// Runs one experiment from `start` to its end or its divergence, as its method says.
pub fn run(
    experiment: &Experiment,
    model: &Model,
    start: State,
    mut sampler: Option<&mut Sampler>,
    reference: Option<&Reference>,
) -> Ended {
    let clock = experiment.clock();
    let plan = Plan::new(model, &experiment.method);
    let mut stepper = Stepper::new(&experiment.method, &plan, model, &start);
    let mut judge = Judge::new(model, &start, &experiment.diverge, &plan);
    judge.watched = Watched::new(&experiment.measure);
    // The plan has seen to it that the scene is one of the closed form's.
    let exact = experiment.exact.and_then(|exact| Closed::new(exact, model, &start).ok());
    let (mut before, mut state) = (start.clone(), start.clone());
    let mut stepping = Duration::ZERO;
    let mut stopped = None;
    if let Some(sampler) = &mut sampler {
        sampler.sample(model, &state, &[], clock.step_s);
    }
    let mut shown = Samples::new(experiment, &state);
    let mut against = reference.map(Against::new);
    let mut parts = Due::new(Clock::new(clock.end_s / PARTS as f64, clock.end_s), &state);
    while !stepper.is_done(&state, &clock) && stopped.is_none() {
        before.copy_from(&state);
        let started = Instant::now();
        stepper.step(model, &mut state, &clock);
        stepping += started.elapsed();
        let stalled = stepper.stalled();
        stopped = if let Some(criterion) = stalled {
            state.copy_from(&before);
            Some((Outcome::Stalled, criterion))
        } else {
            let diverged = observe(&mut judge, &mut stepper, model, [&before, &state], &clock);
            diverged.map(|criterion| (Outcome::Diverged, criterion))
        };
        if stopped.is_none()
            && !stepper.is_done(&state, &clock)
            && is_used_up(&experiment.limits, &state, stepper.work(), stepping)
        {
            stopped = Some((Outcome::Stalled, Criterion::Limit));
        }
        if let (Some(against), None) = (&mut against, stalled) {
            if experiment.method.follows_events() {
                while let Some(at) = parts.next(&mut stepper, model, &state) {
                    against.observe(at.part, at.state);
                }
            } else if (state.step * PARTS).is_multiple_of(clock.steps) {
                against.observe(state.step * PARTS / clock.steps, &state);
            }
        }
        if let Some(sampler) = &mut sampler {
            let last = stopped.is_some() || stepper.is_done(&state, &clock);
            if experiment.method.follows_events() {
                shown.show(sampler, &mut stepper, model, &state, last);
                continue;
            }
            let due = sampler.is_due(state.step);
            // A stalled run is back at a state that has been sampled if it was due.
            let wanted = if stalled.is_some() { !due } else { due || last };
            if wanted {
                sampler.sample(model, &state, stepper.contacts(), clock.step_s);
            }
        }
    }
    let mut measured = summarize(model, &state, &mut judge, &stepper, &clock, stopped, stepping);
    if let Some(exact) = exact {
        Errors::between(&state, &exact.state_at(state.time_s)).write(state.time_s, &mut measured);
    }
    if let Some(against) = against {
        measured.reference_until_s = finite(against.until_s);
        if let Some(met) = against.last {
            met.errors.write(met.time_s, &mut measured);
            measured.reference_uncertainty_m = finite(met.uncertainty_m);
        }
    }
    measured.more = more::cells(experiment, model, &state, &judge.watched);
    if let Some(sampler) = &mut sampler {
        sampler.end(&state, &measured);
    }
    let (contacts, step_s) = if experiment.method.follows_events() {
        (stepper.forces_at(model, &state), 1.0)
    } else {
        (stepper.contacts().to_vec(), clock.step_s)
    };
    Ended { measured, contacts, state, step_s }
}

/// Shows a step to the judge.
fn observe(
    judge: &mut Judge,
    stepper: &mut Stepper,
    model: &Model,
    [before, after]: [&State; 2],
    clock: &Clock,
) -> Option<Criterion> {
    match stepper.span() {
        Span::Step => {
            let kicked = stepper.kicked().unwrap_or(before);
            judge.observe(model, [before, kicked, after], stepper.contacts(), clock.step_s)
        }
        Span::Short { step_s } => {
            let kicked = stepper.kicked().unwrap_or(before);
            judge.residual.steps_as(Approach::Middle);
            let stopped = judge.observe(model, [before, kicked, after], stepper.contacts(), step_s);
            judge.residual.steps_as(Approach::Inside);
            stopped
        }
        Span::Blow => judge.observe_blow(model, [before, after], stepper.contacts()),
        Span::Motion => judge.observe_motion(model, [before, after], &stepper.moments(model, [before, after])),
    }
}

fn summarize(
    model: &Model,
    state: &State,
    judge: &mut Judge,
    stepper: &Stepper,
    clock: &Clock,
    stopped: Option<(Outcome, Criterion)>,
    stepping: Duration,
) -> Measured {
    let penetration_end_m = judge.penetration_end_m(model, state);
    Measured {
        outcome: stopped.map_or(Outcome::Finished, |(outcome, _)| outcome),
        criterion: stopped.map(|(_, criterion)| criterion.name().to_string()),
        end_time_s: finite(state.time_s),
        steps: state.step,
        step_used_s: finite(stepper.step_used_s(state, clock)),
        energy_start_j: finite(judge.energy.start_j()),
        energy_end_j: finite(judge.energy.end_j()),
        energy_drift_rel: finite(judge.energy.drift_rel()),
        energy_rise_max_rel: finite(judge.energy.rise_max_rel()),
        linear_momentum_drift_rel: judge.momentum.linear_drift_rel().and_then(finite),
        angular_momentum_drift_rel: judge.momentum.angular_drift_rel().and_then(finite),
        penetration_max_m: judge.penetration_max_m.and_then(finite),
        penetration_end_m: penetration_end_m.and_then(finite),
        pin_gap_max_m: judge.pin_gap_max_m.and_then(finite),
        residual_max: judge.residual.max.and_then(finite),
        contact_gain_max: judge.energy.contact_gain_max.and_then(finite),
        contacts_max: judge.contacts_max,
        work: *stepper.work(),
        wall_s: finite(stepping.as_secs_f64()),
        ..Measured::default()
    }
}

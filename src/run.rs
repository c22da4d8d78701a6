//! THE MAIN LOOP: advance the state, show every step to the judges and the recorders, end in an outcome.

use crate::auto::{self, Choice};
use crate::collide::SolvedContact;
use crate::collide::approach::Approach;
use crate::due::{Due, Shown};
use crate::exact;
use crate::experiment::types::{Experiment, Limits, Method};
use crate::measure::Judge;
use crate::measure::divergence::Criterion;
use crate::measure::error::Errors;
use crate::measure::more::{self, Watched};
use crate::measure::reference::{Against, PARTS, Reference};
use crate::measure::work::Work;
use crate::model::Model;
use crate::plan::Plan;
use crate::record::sampler::Sampler;
use crate::row::{Measured, Outcome, finite};
use crate::state::State;
use crate::step::{Clock, Span, Stepper};
use crate::{reference, sensitivity};
use std::time::{Duration, Instant};

/// What a run leaves behind.
pub struct Ended {
    pub measured: Measured,
    pub state: State,
    /// Of the last step.
    pub contacts: Vec<SolvedContact>,
    pub step_s: f64,
}

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
    let choice = auto::choose(experiment, model, &start);
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
    let Some(choice) = choice else { return run_chosen(experiment, model, start, sampler, reference) };
    let mut ended = run_chosen(&choice.experiment, model, start, sampler, reference);
    choice.describe(&mut ended.measured);
    ended
}

fn run_chosen(
    experiment: &Experiment,
    model: &Model,
    start: State,
    mut sampler: Option<&mut Sampler>,
    reference: Option<&Reference>,
) -> Ended {
    let clock = clock(experiment);
    let plan = Plan::new(model, &experiment.method);
    let mut stepper = Stepper::new(&experiment.method, &plan, model, &start);
    let mut judge = Judge::new(model, &start, &experiment.diverge, &plan);
    judge.watched = Watched::new(&experiment.measure);
    // The plan has seen to it that the scene is one of the closed form's.
    let exact = experiment.exact.and_then(|exact| exact::Reference::new(exact, model, &start).ok());
    let (mut before, mut state) = (start.clone(), start.clone());
    let mut stepping = Duration::ZERO;
    let mut stopped = None;
    if let Some(sampler) = &mut sampler {
        sampler.sample(model, &state, &[], clock.step_s);
    }
    let mut shown = Shown::new(experiment, &state);
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
        measured.set_errors(&Errors::between(&state, &exact.state_at(state.time_s)), state.time_s);
    }
    if let Some(against) = against {
        measured.reference_until_s = finite(against.until_s);
        if let Some(met) = against.last {
            measured.set_errors(&met.errors, met.time_s);
            measured.reference_uncertainty_m = finite(met.uncertainty_m);
        }
    }
    if sensitivity::is_wanted(experiment) {
        measured.sensitivity = sensitivity::sensitivity(experiment, model, &start, &state);
    }
    measured.more = more::columns(experiment, model, &state, &judge.watched);
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

/// Without a step: one to the end, of a method that needs none.
pub fn clock(experiment: &Experiment) -> Clock {
    let end_s = experiment.time.end_s;
    Clock::new(experiment.time.step_s.unwrap_or(end_s), end_s)
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
    let mut measured = Measured {
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
        wall_s: finite(stepping.as_secs_f64()),
        ..Measured::nothing()
    };
    measured.count_work(stepper.work());
    measured
}

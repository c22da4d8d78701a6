//! `auto`: the method, and its step or tolerance, that follows this scene to the tolerance asked for.
//!
//! Two runs say how wrong the rougher of them is. `event-driven` comes first, at the tolerance and at a hundredth of
//! it, and so on until two runs agree; where a finer one stalls, a rougher one is asked. Where all of them stall, or
//! hand stretches over to equal steps, their tolerance means less: `time-stepping` of order 2 between impacts with the
//! exact solver is tried too, its step halved until two runs agree or the budget is used up; the more accurate of the
//! two is taken. The budget is counted in work and not in seconds, so that the choice is the same on every machine.
//!
//! An estimate is some times the largest distance of a body between the two runs, and some units of rounding of the
//! largest coordinate: of steps twice, whose error halves at least; of tolerances five times, as a rougher run may be
//! as lucky as the finer one. It sees positions at the end alone, and two runs may agree on what is wrong: what is to
//! be chosen is run once before the judges, and what they call wrong is chosen only where nothing else is left, without
//! an estimate.

use crate::clock::Clock;
use crate::experiment::tolerances::SMALLEST_GLOBAL;
use crate::experiment::types::{
    Auto, EventDriven, Experiment, Limits, Measure, Scheme, Solver, SteppingMethod, TimeStepping,
};
use crate::measure::error::Errors;
use crate::model::Model;
use crate::outcome::{Criterion, Outcome};
use crate::rows::doubts::are_raised;
use crate::rows::{Measured, finite};
use crate::run::advance::{Advance, Stepped, only_step};
use crate::run::run;
use crate::state::{BodyState, State};
use crate::work::Work;
use std::time::Instant;

/// Quotient of one tolerance and the next.
const FINER: f64 = 100.0;
/// Most tolerances above the one asked for, before `event-driven` is given up.
const ROUGHER: u32 = 4;
const SAFETY_OF_STEPS: f64 = 2.0;
const SAFETY_OF_TOLERANCES: f64 = 5.0;
/// Of the tolerance of a run that integrates: what it has in common with a finer one is not seen in their difference.
const COMMON: f64 = 1e-4;
/// Rounding of an estimate, of the largest coordinate.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Number of steps to begin with, where the file has none.
const FIRST_STEPS: f64 = 100.0;
pub const HALVINGS: u32 = 12;
/// Steps at which two runs agree and the judges do not, before no finer one is asked.
const MOST_WRONG: u32 = 3;
/// Most steps of one run times bodies.
const MOST_WORK: f64 = 1e6;
/// The same of one run by events, of which a step of the integrator counts as so many others.
const MOST_BY_EVENTS: f64 = 2e6;
const INTEGRATED: u64 = 20;
/// Work of a run at a finer tolerance over that of the rougher one, above which rounding takes the place of its error:
/// of order 8, a hundredth of the tolerance costs 1.8 times as much.
const PATIENCE: f64 = 10.0;
const FIRST_WORK: f64 = 1e4;
/// Energy made, of the energy scale, that is wrong however rough the tolerance is.
const MADE: f64 = 1e-6;

/// Experiment that runs: as it is, or as `auto` has chosen. Below there is no `auto`.
#[derive(Clone, Debug)]
pub struct Chosen {
    pub experiment: Experiment,
    pub method: SteppingMethod,
    /// Search of `auto`; None where the experiment said itself which method it wants.
    searched: Option<Searched>,
}

#[derive(Clone, Copy, Debug)]
struct Searched {
    /// Error of positions that was asked for.
    tolerance_m: f64,
    /// Estimate of the error of positions at the end; None where no two runs came there, or the judges do not believe
    /// them.
    error_estimate_m: Option<f64>,
    search_s: f64,
}

impl Chosen {
    /// Fills the columns that say what was chosen.
    pub fn describe(&self, measured: &mut Measured) {
        measured.solver_used =
            self.experiment.method.facts().solver.and_then(|solver| solver_used(solver, &measured.work));
        let Some(Searched { tolerance_m, error_estimate_m, search_s }) = self.searched else {
            if self.is_missed(measured) {
                measured.tolerance_met = Some("no".to_string());
            }
            return;
        };
        let is_met = measured.outcome == Outcome::Finished && error_estimate_m.is_some_and(|m| m <= tolerance_m);
        measured.tolerance_met = Some(if is_met { "yes" } else { "no" }.to_string());
        measured.method_used = Some(self.experiment.method.word().to_string());
        measured.tolerance_used = self.experiment.method.tolerance();
        measured.error_estimate_m = error_estimate_m;
        measured.wall_search_s = finite(search_s);
    }

    /// Whether a run from event to event has surely not met its tolerance: it did not come to its end, had steps of
    /// equal length in between, is in doubt, or has bodies deeper in each other than that.
    fn is_missed(&self, measured: &Measured) -> bool {
        let tolerance = self.experiment.method.tolerance().unwrap_or(f64::INFINITY);
        let is_deep = measured.penetration_max_m.is_some_and(|depth_m| depth_m > tolerance);
        let is_whole = measured.outcome == Outcome::Finished && measured.work.fallbacks == 0;
        self.experiment.method.follows_events() && (!is_whole || is_deep || are_raised(measured))
    }
}

/// Solvers that had contacts to solve.
fn solver_used(solver: Solver, work: &Work) -> Option<String> {
    let used = match solver {
        Solver::Auto => {
            let by = [(Solver::Newton, work.exact_solves), (Solver::Nncg, work.iterated_solves)];
            let used: Vec<&str> = by.into_iter().filter(|(_, times)| *times > 0).map(|(by, _)| by.word()).collect();
            used.join("+")
        }
        Solver::Pgs | Solver::Nncg | Solver::Newton if work.contact_solves > 0 => solver.word().to_string(),
        Solver::Pgs | Solver::Nncg | Solver::Newton => String::new(),
    };
    (!used.is_empty()).then_some(used)
}

/// The method of an experiment; where it leaves that to `auto`, the one that follows this scene to its tolerance.
pub fn method(experiment: &Experiment, model: &Model, start: &State) -> Chosen {
    match experiment.method.stepping() {
        Ok(method) => Chosen { experiment: experiment.clone(), method, searched: None },
        Err(auto) => search(experiment, auto, model, start),
    }
}

/// Method that runs first: the experiment's own, or the one that `auto` begins its search with.
pub fn first_tried(experiment: &Experiment) -> SteppingMethod {
    experiment.method.stepping().unwrap_or_else(|auto| by_events(auto.tolerance))
}

/// Search within the time that the experiment's limits leave for search and run together.
fn search(experiment: &Experiment, auto: &Auto, model: &Model, start: &State) -> Chosen {
    let asked = Asked { experiment, model, start, tolerance: auto.tolerance, started: Instant::now() };
    let Candidate { method, step_s, estimate_m } = asked.best();
    let mut chosen = Experiment { method: method.clone().into(), limits: asked.limits(), ..experiment.clone() };
    chosen.time.step_s = step_s.or(chosen.time.step_s);
    // `auto` promises it, whatever it chooses.
    if !chosen.measure.contains(&Measure::Sensitivity) {
        chosen.measure.push(Measure::Sensitivity);
    }
    let searched = Searched {
        tolerance_m: auto.tolerance,
        error_estimate_m: finite(estimate_m),
        search_s: asked.started.elapsed().as_secs_f64(),
    };
    Chosen { experiment: chosen, method, searched: Some(searched) }
}

/// Question that `auto` answers.
pub struct Asked<'a> {
    pub experiment: &'a Experiment,
    pub model: &'a Model,
    pub start: &'a State,
    /// Tolerance of positions at the end, in metres.
    pub tolerance: f64,
    /// Time at which the search began.
    pub started: Instant,
}

/// Method that may be chosen.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    pub method: SteppingMethod,
    pub step_s: Option<f64>,
    /// Estimate of the error of positions at the end; infinite where it is unknown.
    pub estimate_m: f64,
}

impl Asked<'_> {
    /// Limits of the experiment, less the time that is used up.
    fn limits(&self) -> Limits {
        let left_s = |wall_s: f64| (wall_s - self.started.elapsed().as_secs_f64()).max(0.0);
        let limits = &self.experiment.limits;
        Limits { wall_s: limits.wall_s.map(left_s), ..limits.clone() }
    }

    /// What the judges believe comes before what they do not; without one, what surely ends.
    fn best(&self) -> Candidate {
        let (by_events, is_whole) = self.by_events();
        if is_whole {
            return by_events;
        }
        let by_steps = self.by_steps();
        if by_events.estimate_m < by_steps.estimate_m { by_events } else { by_steps }
    }

    /// Candidate by events: the first tolerance at which two runs agree, else the one that agreed best; and whether
    /// both runs were by events to their end, and the judges believe it. What they do not has no estimate.
    pub fn by_events(&self) -> (Candidate, bool) {
        let (mut found, is_whole) = self.agreeing_by_events();
        if found.estimate_m.is_finite() && self.is_wrong(&found) {
            found.estimate_m = f64::INFINITY;
        }
        let is_believed = found.estimate_m.is_finite();
        (found, is_whole && is_believed)
    }

    fn agreeing_by_events(&self) -> (Candidate, bool) {
        let candidate = |tolerance, estimate_m| Candidate { method: by_events(tolerance), step_s: None, estimate_m };
        let is_whole = |run: &Stepped| run.stopped.is_none() && run.work.fallbacks == 0;
        let mut tolerance = self.tolerance;
        let mut run = self.follow(tolerance, f64::INFINITY);
        while is_whole(&run) && tolerance > SMALLEST_GLOBAL {
            let finer = (tolerance / FINER).max(SMALLEST_GLOBAL);
            let fine = self.follow(finer, PATIENCE * cost(&run.state, &run.work).max(FIRST_WORK));
            if !is_whole(&fine) {
                break;
            }
            let integrated = if run.work.inner_steps > 0 { COMMON * tolerance } else { 0.0 };
            let estimate_m = self.estimate_m(&run, &fine, SAFETY_OF_TOLERANCES) + integrated;
            // Or half of it is rounding, and there is no more to be had.
            if estimate_m <= self.tolerance.max(2.0 * rounding_m(&fine.state)) {
                return (candidate(tolerance, estimate_m), true);
            }
            (tolerance, run) = (finer, fine);
        }
        // Nothing finer is left, or it does not arrive: a rougher run says how wrong this one is.
        let mut best = candidate(tolerance, f64::INFINITY);
        for _ in 0..ROUGHER {
            let rougher = tolerance * FINER;
            let rough = self.follow(rougher, f64::INFINITY);
            best = candidate(tolerance, self.estimate_m(&rough, &run, SAFETY_OF_TOLERANCES));
            if best.estimate_m.is_finite() {
                return (best, is_whole(&rough) && is_whole(&run));
            }
            (tolerance, run) = (rougher, rough);
        }
        (best, false)
    }

    /// Candidate by steps: the first step at which two runs agree and that the judges believe, else the one that agreed
    /// best; without an estimate if they believe none.
    pub fn by_steps(&self) -> Candidate {
        let end_s = self.experiment.time.end_s;
        let mut step_s = self.experiment.time.step_s.unwrap_or(end_s / FIRST_STEPS);
        let candidate = |step_s, estimate_m| Candidate { method: by_steps(), step_s: Some(step_s), estimate_m };
        let mut best = candidate(step_s, f64::INFINITY);
        let mut wrong = 0;
        let mut rough = self.run(&by_steps(), step_s);
        for _ in 0..HALVINGS {
            step_s /= 2.0;
            if end_s / step_s * self.model.bodies.len() as f64 > MOST_WORK {
                break;
            }
            let fine = self.run(&by_steps(), step_s);
            let now = candidate(step_s, self.estimate_m(&rough, &fine, SAFETY_OF_STEPS));
            if now.estimate_m <= self.tolerance {
                if !self.is_wrong(&now) {
                    return now;
                }
                wrong += 1;
            } else if now.estimate_m < best.estimate_m {
                best = now;
            }
            // What all runs agree on is not mended by finer ones.
            if wrong == MOST_WRONG {
                break;
            }
            rough = fine;
        }
        if best.estimate_m.is_finite() && self.is_wrong(&best) {
            best.estimate_m = f64::INFINITY;
        }
        best
    }

    /// Whether the judges of its run call it wrong: not solved, pushed by nothing, passed through, energy made.
    fn is_wrong(&self, candidate: &Candidate) -> bool {
        let mut experiment = Experiment {
            method: candidate.method.clone().into(),
            limits: self.limits(),
            measure: Vec::new(),
            exact: None,
            reference: None,
            ..self.experiment.clone()
        };
        experiment.time.step_s = candidate.step_s.or(experiment.time.step_s);
        let measured = run(&experiment, &candidate.method, self.model, self.start.clone(), None, None).measured;
        let size_m = self.model.largest_radius_m();
        let most = if size_m > 0.0 { MADE.max(self.tolerance / size_m) } else { f64::INFINITY };
        let makes_energy = measured.energy_rise_max_rel.is_some_and(|rise| rise > most);
        measured.outcome != Outcome::Finished || makes_energy || are_raised(&measured)
    }

    /// A run by events, given up after so much work.
    fn follow(&self, tolerance: f64, most: f64) -> Stepped {
        let most = most.min(MOST_BY_EVENTS / self.model.bodies.len() as f64);
        let clock = Clock::new(self.experiment.time.end_s, self.experiment.time.end_s);
        let limits = self.limits();
        let mut advance = Advance::new(&by_events(tolerance), self.model, self.start.clone(), clock, &limits);
        while advance.next(self.model).is_some() {
            if cost(advance.state(), advance.work()) > most {
                break;
            }
        }
        let is_there = advance.state().time_s >= clock.end_s;
        let stopped = advance.stopped().or((!is_there).then_some(Criterion::Limit));
        Stepped { state: advance.state().clone(), work: *advance.work(), stopped }
    }

    fn run(&self, method: &SteppingMethod, step_s: f64) -> Stepped {
        let clock = Clock::new(step_s, self.experiment.time.end_s);
        only_step(method, self.model, self.start.clone(), &clock, &self.limits())
    }

    fn estimate_m(&self, rough: &Stepped, fine: &Stepped, safety: f64) -> f64 {
        let arrived = [rough, fine].iter().all(|run| run.stopped.is_none());
        if !arrived || !fine.state.bodies.iter().chain(&rough.state.bodies).all(BodyState::is_finite) {
            return f64::INFINITY;
        }
        safety * Errors::between(&rough.state, &fine.state).position_m + rounding_m(&fine.state)
    }
}

/// Of an estimate.
fn rounding_m(state: &State) -> f64 {
    ROUNDING * state.bodies.iter().map(|at| at.p_WB.amax()).fold(0.0, f64::max)
}

/// Of a run by events, in steps.
fn cost(state: &State, work: &Work) -> f64 {
    (state.step + INTEGRATED * work.inner_steps) as f64
}

fn by_events(tolerance: f64) -> SteppingMethod {
    SteppingMethod::EventDriven(EventDriven { tolerance, ..EventDriven::default() })
}

fn by_steps() -> SteppingMethod {
    SteppingMethod::TimeStepping(TimeStepping {
        scheme: Scheme::Moreau,
        solver: Solver::Newton,
        ..TimeStepping::default()
    })
}

//! `auto`: the method, and its step or tolerance, that follows this scene to the tolerance asked for.
//!
//! Two runs say how wrong the rougher of them is. `event-driven` comes first, at the tolerance and at a hundredth of
//! it, and so on until two runs agree; where a finer one stalls, a rougher one is asked. Where all of them stall, or
//! hand stretches over to equal steps, their tolerance means less: `time-stepping` of order 2 between impacts with the
//! exact solver is tried too, its step halved until two runs agree or the budget is used up; the more accurate of the
//! two is taken. The budget is counted in steps and not in seconds, so that the choice is the same on every machine.
//!
//! An estimate is some times the largest distance of a body between the two runs, and some units of rounding of the
//! largest coordinate: of steps twice, whose error halves at least; of tolerances five times, as a rougher run may be
//! as lucky as the finer one. It sees positions at the end alone.

use crate::clock::Clock;
use crate::experiment::tolerances::SMALLEST_GLOBAL;
use crate::experiment::types::{
    Auto, EventDriven, Experiment, Limits, Measure, Scheme, Solver, SteppingMethod, TimeStepping,
};
use crate::measure::error::Errors;
use crate::model::Model;
use crate::rows::{Measured, finite};
use crate::run::advance::{Stepped, only_step};
use crate::state::{BodyState, State};
use std::time::Instant;

/// Quotient of one tolerance and the next.
const FINER: f64 = 100.0;
/// Most tolerances above the one asked for, before `event-driven` is given up.
const ROUGHER: u32 = 4;
const SAFETY_OF_STEPS: f64 = 2.0;
const SAFETY_OF_TOLERANCES: f64 = 5.0;
/// Rounding of an estimate, of the largest coordinate.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Number of steps to begin with, where the file has none.
const FIRST_STEPS: f64 = 100.0;
pub const HALVINGS: u32 = 12;
/// Most steps of one run times bodies.
const MOST_WORK: f64 = 1e6;

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
    /// Estimate of the error of positions at the end; None where no two runs came there.
    error_estimate_m: Option<f64>,
    search_s: f64,
}

impl Chosen {
    /// Fills the columns that say what was chosen.
    pub fn describe(&self, measured: &mut Measured) {
        let Some(Searched { error_estimate_m, search_s }) = self.searched else { return };
        measured.method_used = Some(self.experiment.method.word().to_string());
        measured.tolerance_used = self.experiment.method.tolerance();
        measured.error_estimate_m = error_estimate_m;
        measured.wall_search_s = finite(search_s);
    }
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
    let searched = Searched { error_estimate_m: finite(estimate_m), search_s: asked.started.elapsed().as_secs_f64() };
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

    fn best(&self) -> Candidate {
        let (by_events, is_whole) = self.by_events();
        if is_whole {
            return by_events;
        }
        let by_steps = self.by_steps();
        if by_steps.estimate_m < by_events.estimate_m { by_steps } else { by_events }
    }

    /// Candidate by events: the first tolerance at which two runs agree, else the one that agreed best; and whether
    /// both runs were by events to their end.
    pub fn by_events(&self) -> (Candidate, bool) {
        let candidate = |tolerance, estimate_m| Candidate { method: by_events(tolerance), step_s: None, estimate_m };
        let is_whole = |run: &Stepped| run.stopped.is_none() && run.work.fallbacks == 0;
        let mut tolerance = self.tolerance;
        let mut run = self.follow(tolerance);
        while is_whole(&run) && tolerance > SMALLEST_GLOBAL {
            let finer = (tolerance / FINER).max(SMALLEST_GLOBAL);
            let fine = self.follow(finer);
            if !is_whole(&fine) {
                break;
            }
            let estimate_m = self.estimate_m(&run, &fine, SAFETY_OF_TOLERANCES);
            if estimate_m <= self.tolerance {
                return (candidate(tolerance, estimate_m), true);
            }
            (tolerance, run) = (finer, fine);
        }
        // Nothing finer is left, or it does not arrive: a rougher run says how wrong this one is.
        let mut best = candidate(tolerance, f64::INFINITY);
        for _ in 0..ROUGHER {
            let rougher = tolerance * FINER;
            let rough = self.follow(rougher);
            best = candidate(tolerance, self.estimate_m(&rough, &run, SAFETY_OF_TOLERANCES));
            if best.estimate_m.is_finite() {
                return (best, is_whole(&rough) && is_whole(&run));
            }
            (tolerance, run) = (rougher, rough);
        }
        (best, false)
    }

    /// Candidate by steps: the first step at which two runs agree, else the one that agreed best.
    pub fn by_steps(&self) -> Candidate {
        let end_s = self.experiment.time.end_s;
        let mut step_s = self.experiment.time.step_s.unwrap_or(end_s / FIRST_STEPS);
        let candidate = |step_s, estimate_m| Candidate { method: by_steps(), step_s: Some(step_s), estimate_m };
        let mut best = candidate(step_s, f64::INFINITY);
        let mut rough = self.run(&by_steps(), step_s);
        for _ in 0..HALVINGS {
            step_s /= 2.0;
            if end_s / step_s * self.model.bodies.len() as f64 > MOST_WORK {
                break;
            }
            let fine = self.run(&by_steps(), step_s);
            let estimate_m = self.estimate_m(&rough, &fine, SAFETY_OF_STEPS);
            if estimate_m < best.estimate_m {
                best = candidate(step_s, estimate_m);
            }
            if estimate_m <= self.tolerance {
                break;
            }
            rough = fine;
        }
        best
    }

    fn follow(&self, tolerance: f64) -> Stepped {
        self.run(&by_events(tolerance), self.experiment.time.end_s)
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
        let largest_m = fine.state.bodies.iter().map(|at| at.p_WB.amax()).fold(0.0, f64::max);
        safety * Errors::between(&rough.state, &fine.state).position_m + ROUNDING * largest_m
    }
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

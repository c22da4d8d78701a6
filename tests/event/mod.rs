//! `event-driven`: held against closed forms, against itself at other tolerances, and against what mechanics keeps.

mod balls;
mod borders;
mod cans;
mod closed_forms;
mod crowds;
mod cube;
mod edges;
mod never_hangs;
mod painleve;
mod rims;
mod round_parts;
mod same;
mod seams;
mod sharing;
mod spinning;
mod squeezed;
mod stacks;
mod symmetries;
mod tolerance;

use crate::yaml::{experiment, run};
use gotai::clock::Clock;
use gotai::experiment::types::Experiment;
use gotai::measure::error::Errors;
use gotai::outcome::Outcome;
use gotai::plan::Plan;
use gotai::rows::Measured;
use gotai::run::Ended;
use gotai::shown::Acted;
use gotai::state::State;
use gotai::step::Stepper;

/// The largest of the errors of position, orientation and velocities against the closed form.
fn worst_error(measured: &Measured) -> f64 {
    let Measured { error_position_m, error_orientation_rad, error_velocity_m_s, error_angular_velocity_rad_s, .. } =
        measured;
    assert_eq!(measured.outcome, Outcome::Finished);
    let all = [error_position_m, error_orientation_rad, error_velocity_m_s, error_angular_velocity_rad_s];
    all.iter().map(|error| error.unwrap()).fold(0.0, f64::max)
}

/// A run that ends, every event of which was followed: no steps of equal length.
fn followed(text: &str, sets: &[&str]) -> Measured {
    followed_to(text, sets).measured
}

/// The same, and where it led.
fn followed_to(text: &str, sets: &[&str]) -> Ended {
    let ended = run(&experiment(text, sets));
    assert_eq!((ended.measured.outcome, ended.measured.work.fallbacks), (Outcome::Finished, 0));
    ended
}

/// The same at tolerances of 1e-6 and 1e-8, each without ghosts and right by `judge`; and how far apart they end.
fn followed_alike(text: &str, judge: impl Fn(&Measured)) -> f64 {
    let ended = ["1e-6", "1e-8"].map(|tolerance| {
        let ended = followed_to(text, &[&format!("method.event-driven.tolerance={tolerance}")]);
        assert_eq!(ended.measured.ghost_impulse_max_rel, Some(0.0), "{text}");
        judge(&ended.measured);
        ended.state
    });
    apart_m(&ended[0], &ended[1])
}

fn apart_m(a: &State, b: &State) -> f64 {
    Errors::between(a, b).position_m
}

/// The states right after each of the first impacts, up to the end.
fn impacts(experiment: &Experiment, most: usize) -> Vec<State> {
    let (model, mut state) = gotai::scene::build(experiment).unwrap();
    let clock = Clock::new(experiment.time.end_s, experiment.time.end_s);
    let mut stepper =
        Stepper::new(&experiment.method.stepping().unwrap(), &Plan::new(&model, &experiment.method), &model, &state);
    let mut found = Vec::new();
    while !stepper.is_done(&state, &clock) && stepper.stalled().is_none() && found.len() < most {
        stepper.step(&model, &mut state, &clock);
        if matches!(stepper.acted(&state, &clock), Acted::Blow { .. }) {
            found.push(state.clone());
        }
    }
    found
}

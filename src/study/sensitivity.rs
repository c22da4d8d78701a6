//! Growth of an error of the start until the end of a run, from twin runs whose start is displaced a little.
//!
//! κ = max |p′(T) − p(T)| / ε over bodies and twins. Three twins displace every body by ε along the three axes of a
//! frame that no scene has, each body along another one, and give it ε/T of velocity along the same line: a body in
//! free flight has κ = 2. Below one something has forgotten its start; far above one no method can follow the motion,
//! and errors at its end say nothing about the method.
//!
//! A displacement is along what a body touches, never into it: ε is to be small against the motion, not against a
//! closed gap. Bodies on pins, or driven ones, stay where they are.

use super::choose::Chosen;
use crate::clock::Clock;
use crate::collide::{Contact, Detector, Reach};
use crate::experiment::types::{Experiment, Limits, Measure};
use crate::model::Model;
use crate::rows::finite;
use crate::run::Ended;
use crate::run::advance::only_step;
use crate::state::State;
use crate::work::Work;
use nalgebra::Vector3;
use std::time::Instant;

/// Displacement, of the largest bounding radius: above the tolerances of methods that control their error, below what
/// bends a motion.
const PART: f64 = 1e-6;
/// Times the steps of the run after which a twin is given up.
const PATIENCE: u64 = 10;
/// Normals closer to a plane of others than this say nothing new, and directions shorter than it are none.
const SHORT: f64 = 1e-3;

/// A frame of fractions, askew to every axis and diagonal.
const FRAME: [Vector3<f64>; 3] = [
    Vector3::new(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0),
    Vector3::new(3.0 / 7.0, -6.0 / 7.0, 2.0 / 7.0),
    Vector3::new(6.0 / 7.0, 2.0 / 7.0, -3.0 / 7.0),
];

/// Whether the growth is measured. It costs three more runs: who asks is told, whatever the method, and who compares
/// ends (`auto`, `reference:`), to whom an error says little without it.
pub fn is_wanted(experiment: &Experiment) -> bool {
    experiment.measure.contains(&Measure::Sensitivity)
        || experiment.reference.is_some()
        || experiment.method.facts().chooses
}

/// Writes the growth of errors into what was measured, if it is wanted.
pub fn fill(chosen: &Chosen, model: &Model, start: &State, ended: &mut Ended) {
    if is_wanted(&chosen.experiment) {
        ended.measured.sensitivity = sensitivity(chosen, model, start, &ended.state);
    }
}

/// Growth of the error of the run from `start` to `end`; None if nothing can be displaced or no twin arrives.
pub fn sensitivity(chosen: &Chosen, model: &Model, start: &State, end: &State) -> Option<f64> {
    if end.step == 0 || end.time_s <= start.time_s {
        return None;
    }
    let size_m = perturbation_m(model);
    let held = held(model, start, size_m);
    let started = Instant::now();
    let arrived = (0..FRAME.len()).filter_map(|k| {
        let twin = displaced(start, |i| along(&held[i], &FRAME[(i + k) % 3]), size_m, end.time_s);
        let apart_m = apart_m(&twin_end(chosen, model, twin?, end, started)?, end);
        finite(apart_m / size_m)
    });
    arrived.reduce(f64::max)
}

/// Displacement in metres; for points without size a part of a metre.
fn perturbation_m(model: &Model) -> f64 {
    let largest_m = model.largest_radius_m();
    if largest_m > 0.0 { PART * largest_m } else { PART }
}

/// Orthonormal basis, for every body, of the directions in which it is held by what it touches; None where it is not to
/// be moved at all.
fn held(model: &Model, start: &State, size_m: f64) -> Vec<Option<Vec<Vector3<f64>>>> {
    let is_free = |i: usize| !model.bodies[i].driven && !model.pins.iter().any(|pin| pin.holds(i));
    let mut held: Vec<_> = (0..model.bodies.len()).map(|i| is_free(i).then(Vec::new)).collect();
    for contact in closed(model, start, size_m) {
        for (i, ..) in contact.ends() {
            if let Some(basis) = &mut held[i] {
                let new = rest(&contact.normal, basis);
                if new.norm() > SHORT {
                    basis.push(new.normalize());
                }
            }
        }
    }
    held
}

/// Contacts that would be inside after a displacement.
fn closed(model: &Model, start: &State, size_m: f64) -> Vec<Contact> {
    let radii = model.bodies.iter().map(|body| body.bounding_radius_m).filter(|radius| *radius > 0.0);
    let margin = 4.0 * size_m / radii.fold(f64::INFINITY, f64::min);
    let mut contacts = Vec::new();
    Detector::default().detect(model, start, &Reach { margin }, &mut contacts, &mut Work::default());
    contacts
}

/// Part of the direction along what the body touches, of length one; None where there is no such part.
fn along(held: &Option<Vec<Vector3<f64>>>, direction: &Vector3<f64>) -> Option<Vector3<f64>> {
    let free = rest(direction, held.as_ref()?);
    (free.norm() > SHORT).then(|| free.normalize())
}

/// Part of a vector that no vector of an orthonormal basis spans.
fn rest(v: &Vector3<f64>, basis: &[Vector3<f64>]) -> Vector3<f64> {
    basis.iter().fold(*v, |rest, b| rest - b * b.dot(&rest))
}

/// Start of a twin; None where no body moves.
fn displaced(
    start: &State,
    direction: impl Fn(usize) -> Option<Vector3<f64>>,
    size_m: f64,
    end_s: f64,
) -> Option<State> {
    let mut twin = start.clone();
    let mut moved = false;
    for (i, at) in twin.bodies.iter_mut().enumerate() {
        if let Some(direction) = direction(i) {
            at.p_WB += direction * size_m;
            at.v_WB += direction * (size_m / end_s);
            moved = true;
        }
    }
    moved.then_some(twin)
}

/// State of a twin at the time of the run's end, however the run has come to it. The twins together have the wall time
/// of the run.
fn twin_end(chosen: &Chosen, model: &Model, twin: State, end: &State, started: Instant) -> Option<State> {
    let Chosen { experiment, method, .. } = chosen;
    let follows_events = experiment.method.follows_events();
    let clock = if follows_events { Clock::new(end.time_s, end.time_s) } else { experiment.clock() };
    let most = if follows_events { end.step.saturating_mul(PATIENCE) } else { end.step };
    let left_s = |wall_s: f64| wall_s - started.elapsed().as_secs_f64();
    let limits = Limits { steps: Some(most), wall_s: experiment.limits.wall_s.map(left_s), ..Limits::default() };
    let twin = only_step(method, model, twin, &clock, &limits).state;
    let arrived = if follows_events { twin.time_s >= end.time_s } else { twin.step == end.step };
    arrived.then_some(twin)
}

/// The largest distance of a body from its twin; not finite if a position is not.
fn apart_m(twin: &State, end: &State) -> f64 {
    let distances = twin.bodies.iter().zip(&end.bodies).map(|(twin, at)| (twin.p_WB - at.p_WB).norm());
    distances.fold(0.0, |worst: f64, distance| if distance <= worst { worst } else { distance })
}

//! Reference runs: `event-driven` at a tight tolerance, twice, kept as a file for all cases of the same motion.
//!
//! A reference depends on the physics alone (scene, seed, end, law of impact), its tolerance and the program: cases
//! that differ by method, step or what is recorded share one.

use crate::build_info::BUILD;
use crate::case;
use crate::clock::Clock;
use crate::digest::{sealed, unsealed};
use crate::experiment::tolerances::SMALLEST_GLOBAL;
use crate::experiment::types::{
    EventDriven, Experiment, Limits, Method, Planning, Record, ReferenceRun, SteppingMethod, Time,
};
use crate::files::{self, FileError, make_folder, write_whole};
use crate::measure::error::Errors;
use crate::measure::reference::{PARTS, Reference, Sample};
use crate::model::Model;
use crate::outcome::Criterion;
use crate::run::advance::Advance;
use crate::run::ticks::Parts;
use crate::state::{BodyState, State};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Instant;

/// Quotient of the tolerances of the two runs.
const SECOND: f64 = 10.0;
/// Distance beyond which runs have parted: this part of the largest bounding radius, or so many times the tolerance.
const PARTED: f64 = 1e-6;
const PARTED_TOLERANCES: f64 = 1000.0;

/// Name that cases of the same motion share; None where the experiment asks for no reference.
pub fn id(experiment: &Experiment) -> Option<String> {
    let ReferenceRun { tolerance } = experiment.reference.clone()?;
    let random = experiment.scene.random.as_ref();
    let decisive = Experiment {
        question: None,
        scene: experiment.scene.clone(),
        seed: if random.is_some() { experiment.seed } else { 0 },
        method: Method::EventDriven(by_events(experiment, tolerance)),
        time: Time {
            // Where it decides the start.
            step_s: experiment.time.step_s.filter(|_| random.is_some_and(|random| random.place.is_some())),
            end_s: experiment.time.end_s,
        },
        diverge: Default::default(),
        limits: Limits::default(),
        plan: Planning::default(),
        record: Record::default(),
        measure: Vec::new(),
        exact: None,
        reference: None,
    };
    Some(case::id(&[case::canonical(&decisive), BUILD.as_bytes().to_vec()]))
}

/// Path of the reference in a folder of results; None where the experiment asks for none.
pub fn path(dir: &Path, experiment: &Experiment) -> Option<PathBuf> {
    Some(dir.join(format!("reference-{}.json", id(experiment)?)))
}

/// Reference of an experiment, read from its file, which is made if it is not there; None where it asks for none.
///
/// # Errors
/// The file cannot be written.
pub fn of(dir: &Path, experiment: &Experiment, model: &Model, start: &State) -> Result<Option<Reference>, FileError> {
    static WRITING: Mutex<()> = Mutex::new(());
    let Some(path) = path(dir, experiment) else { return Ok(None) };
    let is_it = |reference: &Reference| reference.build == BUILD && Some(&reference.id) == id(experiment).as_ref();
    if let Some(reference) = read(&path).filter(is_it) {
        return Ok(Some(reference));
    }
    let made = made(experiment, model, start);
    // How far one comes in a given time is another thing every time: nobody else is to find it.
    let is_lasting = |reference: &&Reference| reference.criterion.as_deref() != Some(Criterion::Limit.name());
    if let Some(reference) = made.as_ref().filter(is_lasting) {
        // The name says of what it is: whoever writes last writes the same.
        let _one = WRITING.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        make_folder(dir)?;
        write_whole(&path, sealed(reference).as_bytes())?;
    }
    Ok(made)
}

/// Reference of an experiment, read from its file or made for it; where no file can be written, for this case alone.
pub fn of_or_made(dir: &Path, experiment: &Experiment, model: &Model, start: &State) -> Option<Reference> {
    of(dir, experiment, model, start).unwrap_or_else(|_| made(experiment, model, start))
}

/// Whether a file is a reference that this very program has made.
pub fn is_current(path: &Path) -> bool {
    read(path).is_some_and(|reference| reference.build == BUILD)
}

/// A file that is torn or changed counts as missing.
fn read(path: &Path) -> Option<Reference> {
    serde_json::from_str(&unsealed(&files::read(path).ok()?)?).ok()
}

/// Reference of an experiment, from its two runs; None where the experiment asks for none.
pub fn made(experiment: &Experiment, model: &Model, start: &State) -> Option<Reference> {
    let ReferenceRun { tolerance } = experiment.reference.clone()?;
    let second_tolerance = second(tolerance);
    let started = Instant::now();
    let [first, second] = [tolerance, second_tolerance].map(|tolerance| {
        // Both together have the wall time of a run.
        let left_s = |wall_s: f64| (wall_s - started.elapsed().as_secs_f64()).max(0.0);
        let limits = Limits { wall_s: experiment.limits.wall_s.map(left_s), ..Limits::default() };
        follow(by_events(experiment, tolerance), &limits, experiment, model, start)
    });
    let apart_m = |(a, b): (&State, &State)| Errors::between(a, b).position_m;
    let samples: Vec<Sample> =
        first.states.iter().zip(&second.states).map(|pair| Sample::new(pair.0, apart_m(pair))).collect();
    let parting_m = (PARTED * model.largest_radius_m()).max(PARTED_TOLERANCES * tolerance);
    Some(Reference {
        id: id(experiment)?,
        build: BUILD.to_string(),
        tolerance,
        second_tolerance,
        parting_m,
        parted_s: samples.iter().find(|sample| sample.uncertainty_m > parting_m).map(|sample| sample.time_s),
        criterion: first.criterion.or(second.criterion),
        samples,
    })
}

/// Finer, or rougher where no finer one is left.
fn second(tolerance: f64) -> f64 {
    if tolerance <= 2.0 * SMALLEST_GLOBAL { tolerance * SECOND } else { (tolerance / SECOND).max(SMALLEST_GLOBAL) }
}

/// The law of impact belongs to the physics.
fn by_events(experiment: &Experiment, tolerance: f64) -> EventDriven {
    EventDriven { tolerance, impact: experiment.method.impact() }
}

/// States after equal parts of the time, as far as the run comes.
struct Followed {
    states: Vec<State>,
    criterion: Option<String>,
}

fn follow(settings: EventDriven, limits: &Limits, experiment: &Experiment, model: &Model, start: &State) -> Followed {
    let end_s = experiment.time.end_s;
    let clock = Clock::new(end_s, end_s);
    let mut parts = Parts::new(PARTS, &clock, start);
    let mut advance = Advance::new(&SteppingMethod::EventDriven(settings), model, start.clone(), clock, limits);
    let mut states = vec![start.clone()];
    while let Some(shown) = advance.next(model) {
        parts.show(model, &shown, |_, state| states.push(state.clone()));
        if !shown.after.bodies.iter().all(BodyState::is_finite) {
            break;
        }
    }
    let finite = states.iter().take_while(|state| state.bodies.iter().all(BodyState::is_finite)).count();
    states.truncate(finite);
    Followed { states, criterion: advance.stopped().map(|criterion| criterion.name().to_string()) }
}

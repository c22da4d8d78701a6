//! Run time of the steps of a run, and of nothing but the steps: no judge, no recorder, no allocation.

use crate::experiment::types::Limits;
use crate::model::Model;
use crate::run::advance::Advance;
use crate::state::State;
use crate::study::choose::Chosen;
use std::time::{Duration, Instant};

/// Best and median time of a run's steps (s), and the state in which it ends.
pub struct Timed {
    pub best_s: f64,
    pub median_s: f64,
    pub end: State,
}

/// Time that repeats go on for, if ten times those asked for do not take as much.
const ENOUGH: Duration = Duration::from_millis(50);
/// Least time of the runs that are timed together: thousands of times the clock's resolution.
const READABLE: Duration = Duration::from_micros(200);
const MOST_TOGETHER: usize = 1 << 12;

/// Times of a run that reaches its end, from at least `repeats` repeats.
pub fn time(chosen: &Chosen, model: &Model, start: &State, repeats: u32) -> Timed {
    let (clock, limits) = (chosen.experiment.clock(), Limits::default());
    let fresh = || Advance::new(&chosen.method, model, start.clone(), clock, &limits);
    let together = |n: usize| {
        let mut runs: Vec<_> = (0..n).map(|_| fresh()).collect();
        (all_steps(&mut runs, model), runs)
    };
    // The first ones also warm the caches and are not counted.
    let mut batch = 1;
    let (mut took, mut runs) = together(batch);
    while took < READABLE && batch < MOST_TOGETHER {
        batch *= 2;
        (took, runs) = together(batch);
    }
    let (mut samples, mut spent) = (Vec::new(), Duration::ZERO);
    let (least, most) = (repeats as usize, 10 * repeats as usize);
    while samples.len() < least || (spent < ENOUGH && samples.len() < most) {
        (took, runs) = together(batch);
        spent += took;
        samples.push(took.as_secs_f64() / batch as f64);
    }
    samples.sort_by(f64::total_cmp);
    Timed { best_s: samples[0], median_s: median(&samples), end: runs.swap_remove(0).state().clone() }
}

/// Time of the runs, each from its start to its end, one after another.
fn all_steps(runs: &mut [Advance], model: &Model) -> Duration {
    let started = Instant::now();
    runs.iter_mut().for_each(|run| run.run_out(model));
    started.elapsed()
}

/// Median of sorted numbers, of which there is at least one.
fn median(sorted: &[f64]) -> f64 {
    let middle = sorted.len() / 2;
    if sorted.len() % 2 == 1 { sorted[middle] } else { 0.5 * (sorted[middle - 1] + sorted[middle]) }
}

/// Keeps this thread on one core, the last that it may use. False where the system does not let it.
pub fn pin() -> bool {
    let core = core_affinity::get_core_ids().and_then(|cores| cores.last().copied());
    core.is_some_and(core_affinity::set_for_current)
}

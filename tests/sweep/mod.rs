//! Sweeps: resume, threads, panics, tables, recordings.

mod likes;
mod names;
mod recordings;
mod stopped;
mod store;
mod threads;

use gotai::record::writer::Target;
use gotai::sweep::plan::SweepPlan;
use gotai::sweep::runner::{Job, Make, Progress, build_and_run, lock};
use gotai::sweep::store::Store;
use std::path::Path;
use std::sync::Mutex;

/// 2 methods × 2 steps × 6 seeds; the second step explodes now and then.
pub const SWEEP: &str = "
question: test
scene:
  friction: 0.3
  container: { box: { size_m: [4, 4, 4] } }
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 5 }
      mass_kg: 1.0
      inertia_from: lumped
      position_m: [0, 2, 0]
  random: { speed_m_s: 4, spin_rad_s: 6, attitude: true }
time: { step_s: 0.01, end_s: 2.0 }
record: { every_s: 0.05, cases: few }
sweep:
  axes:
    method: [lecture, time-stepping]
    time.step_s: [0.01, 0.05]
    seed: { range: { from: 0, to: 5 } }
";

pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: usize) {}
    fn one_done(&self) {}
    fn end(&self) {}
}

pub fn planned(text: &str, sets: &[&str]) -> SweepPlan {
    SweepPlan::new(&crate::yaml::file(text, sets)).unwrap()
}

/// Sweeps as the program does; how many cases were run, and the folder's rows.
pub fn sweep(plan: &SweepPlan, dir: &Path, targets: &[Target]) -> (usize, Vec<gotai::rows::Row>) {
    sweep_with(plan, dir, targets, &|case, targets| build_and_run(case, dir, targets))
}

pub fn sweep_with(plan: &SweepPlan, dir: &Path, targets: &[Target], work: &Make) -> (usize, Vec<gotai::rows::Row>) {
    let store = Mutex::new(Store::open(dir, plan, false).unwrap());
    let job = Job { dir, targets, csv: false, work, progress: &Silent };
    let ran = job.sweep(&plan.cases, &store).unwrap();
    let rows = lock(&store).rows();
    (ran, rows)
}

//! A sweep that somebody stops, and recordings that somebody chooses by what all rows say.

use super::{SWEEP, Silent, planned, sweep};
use crate::scratch;
use gotai::outcome::Outcome;
use gotai::record::writer::Target;
use gotai::sweep::runner::{Job, Progress, build_and_run, lock};
use gotai::sweep::store::Store;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// Lets no further case begin once one has failed.
struct Careful(AtomicBool);

impl Progress for Careful {
    fn begin(&self, _: &str, _: usize) {}
    fn one_done(&self) {}
    fn case_ended(&self, _: &str, outcome: Outcome) {
        self.0.fetch_or(outcome == Outcome::Failed, Ordering::Relaxed);
    }
    fn is_stopped(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
    fn end(&self) {}
}

#[test]
fn a_stopped_sweep_keeps_its_rows_and_records_nothing_that_is_chosen_of_all() {
    let folder = scratch::folder();
    let plan = planned(SWEEP, &["sweep.axes.seed=[0, 1]", "time.end_s=0.1", "record.cases=diverged"]);
    let store = Mutex::new(Store::open(folder.path(), &plan, false).unwrap());
    let work: &gotai::sweep::runner::Make = &|case, targets| {
        assert!(case.case.experiment.seed != 1, "seed 1 is not liked here");
        build_and_run(case, folder.path(), targets)
    };
    let careful = Careful(AtomicBool::new(false));
    let job = Job { dir: folder.path(), targets: &[Target::Mcap], csv: false, work, progress: &careful };
    // One after the other: seed 0, then seed 1, which fails.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let ran = pool.install(|| job.sweep(&plan.cases, &store)).unwrap();
    let rows = lock(&store).rows();
    assert!((1..8).contains(&ran) && rows.len() == ran, "{ran} {}", rows.len());
    assert_eq!(rows.iter().filter(|row| row.measured.outcome == Outcome::Failed).count(), 1);
    assert!(rows.iter().all(|row| row.recording.is_none()) && folder.path().join("rows.csv").is_file());
    drop(store);
    // The rest, later; what has failed is a row.
    assert_eq!(sweep(&plan, folder.path(), &[]).0, 8 - ran);
}

#[test]
fn chosen_cases_are_recorded_once_and_their_rows_say_so() {
    let folder = scratch::folder();
    let plan = planned(SWEEP, &["sweep.axes.seed=[0, 1]", "time.end_s=0.1", "record.cases=failing"]);
    let targets = [Target::Mcap];
    let (_, rows) = sweep(&plan, folder.path(), &targets);
    assert!(rows.iter().all(|row| row.recording.is_none()));
    let store = Mutex::new(Store::open(folder.path(), &plan, false).unwrap());
    let work: &gotai::sweep::runner::Make = &|case, targets| build_and_run(case, folder.path(), targets);
    let job = Job { dir: folder.path(), targets: &targets, csv: false, work, progress: &Silent };
    let ids = [rows[5].case.clone(), rows[2].case.clone(), "0000".to_string()];
    for _ in 0..2 {
        job.record(&ids, &plan.cases, &store).unwrap();
        let rows = lock(&store).rows();
        let recorded: Vec<usize> = (0..8).filter(|i| rows[*i].recording.is_some()).collect();
        assert_eq!(recorded, [2, 5]);
    }
    let csv = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    assert_eq!(csv.matches("_finished.").count(), 2);
}

//! Recordings in a folder of results: named for people, whole, and made again when they are not.

use super::{SWEEP, planned, sweep, sweep_with};
use crate::scratch;
use gotai::record::writer::Target;
use gotai::rows::Row;
use gotai::rows::table::Table;
use gotai::sweep::plan::SweepPlan;
use gotai::sweep::runner::build_and_run;
use gotai::sweep::store::Store;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::SystemTime;

const MCAP: &[Target] = &[Target::Mcap];

/// Contents of a folder's recordings, by their names.
fn recordings(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
    let files = files.filter(|path| path.extension().is_some_and(|ending| ending == "mcap" || ending == "rrd"));
    files.map(|path| (path.file_name().unwrap().to_str().unwrap().to_string(), std::fs::read(path).unwrap())).collect()
}

fn short(sets: &[&str]) -> SweepPlan {
    planned(SWEEP, &[&["sweep.axes.seed=[0, 3]", "time.end_s=0.2"], sets].concat())
}

/// How many recordings a sweep has made; its rows.
fn recorded(plan: &SweepPlan, dir: &Path, targets: &[Target]) -> (usize, Vec<Row>) {
    let made = AtomicUsize::new(0);
    let (_, rows) = sweep_with(plan, dir, targets, &|planned, targets| {
        made.fetch_add(usize::from(!targets.is_empty()), Ordering::Relaxed);
        build_and_run(planned, dir, targets)
    });
    (made.into_inner(), rows)
}

#[test]
fn a_row_says_which_file_shows_it() {
    let folder = scratch::folder();
    let plan = planned(SWEEP, &["sweep.axes.seed=[0, 3]"]);
    let (_, rows) = sweep(&plan, folder.path(), MCAP);
    let names: Vec<_> = rows.iter().map(|row| row.recording.clone().unwrap()).collect();
    let expected: Vec<_> = rows
        .iter()
        .map(|row| {
            let [method, step, seed] = ["method", "time.step_s", "seed"].map(|axis| &row.axes[axis]);
            let outcome = row.measured.outcome.name();
            format!("{}_{step}_{seed}_{outcome}.{}", method.as_str().unwrap(), &row.case[..8])
        })
        .collect();
    assert_eq!(names, expected);
    assert!(names.iter().any(|name| name.contains("_diverged.")), "{names:?}");
    let files = recordings(folder.path());
    assert_eq!(files.len(), 8);
    for name in &names {
        assert!(files.contains_key(&format!("{name}.mcap")), "{name}");
    }
}

#[test]
fn whether_it_is_recorded_changes_no_row() {
    let hash = |targets: &[Target]| {
        let (folder, plan) = (scratch::folder(), short(&[]));
        Table::new(&plan.file.axes, &sweep(&plan, folder.path(), targets).1).hash()
    };
    assert_eq!(hash(&[]), hash(MCAP));
}

#[test]
fn a_recording_that_is_not_what_was_written_is_made_again_and_the_others_left_alone() {
    let folder = scratch::folder();
    let plan = short(&[]);
    sweep(&plan, folder.path(), MCAP);
    let before = recordings(folder.path());
    let names: Vec<String> = before.keys().cloned().collect();
    let path = |i: usize| folder.path().join(&names[i]);
    let changed = |i: usize| -> SystemTime { std::fs::metadata(path(i)).unwrap().modified().unwrap() };
    let untouched = changed(4);
    // Gone, empty, cut, one bit flipped.
    std::fs::remove_file(path(0)).unwrap();
    std::fs::write(path(1), "").unwrap();
    std::fs::write(path(2), &before[&names[2]][..1000]).unwrap();
    let mut flipped = before[&names[3]].clone();
    flipped[2000] ^= 4;
    std::fs::write(path(3), flipped).unwrap();
    let (made, rows) = recorded(&plan, folder.path(), MCAP);
    assert_eq!((made, rows.len()), (4, 8));
    assert!(recordings(folder.path()) == before);
    assert_eq!(changed(4), untouched);
    assert_eq!(recorded(&plan, folder.path(), MCAP).0, 0);
}

#[test]
fn another_record_another_name_or_another_kind_is_made_again() {
    let folder = scratch::folder();
    sweep(&short(&[]), folder.path(), MCAP);
    let before = recordings(folder.path());
    // Every fifth sample of those.
    let plan = short(&["record.every_s=0.1"]);
    assert_eq!(recorded(&plan, folder.path(), MCAP).0, 8);
    let after = recordings(folder.path());
    assert!(after.keys().eq(before.keys()) && after.iter().all(|(name, file)| file.len() < before[name].len()));
    // An axis has one value less: its values stand in no name any more, and the old files are gone.
    let plan = short(&["record.every_s=0.1", "sweep.axes.seed=[3]"]);
    assert_eq!(recorded(&plan, folder.path(), MCAP).0, 4);
    let names: Vec<_> = recordings(folder.path()).into_keys().collect();
    let (four, eight) = (names.iter().filter(|name| name.matches('_').count() == 2), names.len());
    assert_eq!((four.count(), eight), (4, 8), "four of cases that are no longer planned stay: {names:?}");
    // The other kind is added; what is there is kept.
    #[cfg(feature = "rerun")]
    {
        assert_eq!(recorded(&plan, folder.path(), Target::AVAILABLE).0, 4);
        assert_eq!(recordings(folder.path()).len(), 12);
        assert_eq!(recorded(&plan, folder.path(), Target::AVAILABLE).0, 0);
    }
}

#[test]
fn a_row_that_is_made_again_has_its_recording_made_again() {
    let folder = scratch::folder();
    let plan = short(&[]);
    sweep(&plan, folder.path(), MCAP);
    let before = recordings(folder.path());
    // As a kill between the file and its line leaves it.
    let journal = folder.path().join("journal.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap();
    let rows: String = text.lines().filter(|line| !line.contains("recorded")).map(|line| format!("{line}\n")).collect();
    std::fs::write(&journal, rows).unwrap();
    std::fs::write(folder.path().join("0123456789abcdef.partial.mcap"), "half").unwrap();
    assert_eq!(recorded(&plan, folder.path(), MCAP).0, 8);
    assert!(recordings(folder.path()) == before);
}

/// A panic leaves half a file, and no recording.
#[test]
fn what_a_failed_case_has_begun_is_taken_away() {
    let folder = scratch::folder();
    let plan = short(&[]);
    let (_, rows) = sweep_with(&plan, folder.path(), MCAP, &|planned, targets| {
        if planned.case.experiment.seed == 3 && !targets.is_empty() {
            let half = format!("{}.partial.mcap", planned.case.id);
            std::fs::write(folder.path().join(half), "half").unwrap();
            panic!("seed 3 is not liked here");
        }
        build_and_run(planned, folder.path(), targets)
    });
    assert_eq!(recordings(folder.path()).len(), 4);
    assert!(rows.iter().all(|row| row.recording.is_some() == (row.axes["seed"] == 0)));
}

/// `record.every_s` decides no motion: two values of it are one case.
#[test]
fn equal_cases_are_recorded_once() {
    let folder = scratch::folder();
    let plan = planned(SWEEP, &["sweep.axes={record.every_s: [0.05, 0.1]}", "seed=3", "time.end_s=0.2"]);
    assert_eq!(plan.cases[0].case.id, plan.cases[1].case.id);
    assert_eq!(recorded(&plan, folder.path(), MCAP).0, 1);
    assert_eq!(recorded(&plan, folder.path(), MCAP).0, 0);
    let more = planned(SWEEP, &["sweep.axes={record.every_s: [0.05, 0.1, 0.02]}", "seed=3", "time.end_s=0.2"]);
    let edited = Store::open(folder.path(), &more, false).unwrap().edited().unwrap();
    assert_eq!((edited.held, edited.planned, edited.unplanned), (3, 3, 0));
}

use super::{SWEEP, planned, sweep, sweep_with};
use crate::scratch;
use gotai::experiment::types::RecordCases;
use gotai::outcome::Outcome;
use gotai::rows::columns::OF_A_CLOCK;
use gotai::rows::{Measured, Row, cells};
use gotai::sweep::journal::{Entry, Journal, line};
use gotai::sweep::planned::Planned;
use gotai::sweep::recordings::known_after;
use gotai::sweep::runner::build_and_run;
use gotai::sweep::store::Store;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use std::fs::File;

#[test]
fn run_again_a_sweep_does_only_what_is_missing() {
    let folder = scratch::folder();
    let few = planned(SWEEP, &["sweep.axes.seed=[0, 1]"]);
    assert_eq!(sweep(&few, folder.path(), &[]).0, 8);
    assert_eq!(sweep(&few, folder.path(), &[]).0, 0);
    // The axes have grown: 24 cases, 8 of them done.
    let more = planned(SWEEP, &[]);
    let (ran, rows) = sweep(&more, folder.path(), &[]);
    assert_eq!((ran, rows.len()), (16, 24));
    assert!(
        rows.iter().zip(&more.cases).all(|(row, Planned { case, .. })| row.case == case.id && row.axes == case.axes)
    );
}

#[test]
fn a_journal_torn_by_a_kill_costs_one_row() {
    let folder = scratch::folder();
    let cases = planned(SWEEP, &["sweep.axes.seed=[0, 1]"]);
    let (_, whole) = sweep(&cases, folder.path(), &[]);
    let journal = folder.path().join("journal.jsonl");
    let text = std::fs::read(&journal).unwrap();
    std::fs::write(&journal, &text[..text.len() - 25]).unwrap();
    let (ran, rows) = sweep(&cases, folder.path(), &[]);
    assert_eq!((ran, rows.len()), (1, 8));
    let same = |a: &Measured, b: &Measured| a.without_wall_time() == b.without_wall_time();
    assert!(rows.iter().zip(&whole).all(|(a, b)| same(&a.measured, &b.measured)));
    // Also the line after the torn one was kept whole.
    assert_eq!(sweep(&cases, folder.path(), &[]).0, 0);
}

/// Wherever it is: in a number, a name, a checksum, the end of a line.
#[test]
fn a_flipped_bit_in_the_journal_costs_its_rows_and_changes_none() {
    let folder = scratch::folder();
    let cases = planned(SWEEP, &["sweep.axes.seed=[0, 1]", "time.end_s=0.2"]);
    let blank = |rows: Vec<Row>| rows.iter().map(|row| row.measured.without_wall_time()).collect::<Vec<_>>();
    let whole = blank(sweep(&cases, folder.path(), &[]).1);
    let journal = folder.path().join("journal.jsonl");
    let text = std::fs::read(&journal).unwrap();
    for i in 0..60 {
        let mut flipped = text.clone();
        let at = (i * 7919 + 13) % text.len();
        flipped[at] ^= 1 << (i % 8);
        std::fs::write(&journal, &flipped).unwrap();
        let (ran, rows) = sweep(&cases, folder.path(), &[]);
        // The end of a line stands between two of them.
        assert!((1..=2).contains(&ran), "bit {} of byte {at}: {ran} rows made again", i % 8);
        assert_eq!(blank(rows), whole, "bit {} of byte {at}", i % 8);
    }
}

#[test]
fn an_edited_plan_goes_on_and_what_failed_can_be_tried_again() {
    let folder = scratch::folder();
    let few = planned(SWEEP, &["sweep.axes.seed=[0, 1]", "time.end_s=0.2"]);
    sweep_with(&few, folder.path(), &[], &|planned, targets| {
        assert!(planned.case.experiment.seed != 1, "seed 1 is not liked here");
        build_and_run(planned, folder.path(), targets)
    });
    assert_eq!(Store::open(folder.path(), &few, false).unwrap().edited(), None);
    let more = planned(SWEEP, &["sweep.axes.seed=[0, 1, 2]", "time.end_s=0.2"]);
    let mut store = Store::open(folder.path(), &more, false).unwrap();
    let said = |store: &Store| store.edited().unwrap().to_string();
    assert_eq!(said(&store), "the plan has changed (seed has grown by 1 to 3 values); 8 of 12 rows still hold");
    store.forget_failed();
    assert!(said(&store).ends_with("; 4 of 12 rows still hold"), "{}", said(&store));
    drop(store);
    let fewer = planned(SWEEP, &["method=lecture", "sweep.axes.seed=[2, 0]", "time.end_s=0.2"]);
    let shrunk = "the plan has changed (seed has shrunk by 1 to 2 values; method is no axis any more); 2 of 4 rows still \
                  hold, 6 that are no longer planned stay in the store";
    assert_eq!(said(&Store::open(folder.path(), &fewer, false).unwrap()), shrunk);
}

/// What is left out of a row's hash is what two runs of one case may differ in.
#[test]
fn columns_of_a_clock_are_those_that_are_taken_off() {
    let timed = Measured { wall_s: Some(1.0), wall_search_s: Some(1.0), ..Measured::default() };
    let (with, without) = (cells(&timed), cells(&timed.without_wall_time()));
    let differing: Vec<&String> = with.keys().filter(|name| with[*name] != without[*name]).collect();
    assert_eq!(differing, OF_A_CLOCK);
    assert!(with.iter().all(|(name, value)| !name.starts_with("wall_") || !value.is_null()), "every clock is set here");
}

#[test]
fn two_sweeps_at_once_are_refused() {
    let folder = scratch::folder();
    let cases = planned(SWEEP, &["sweep.axes.seed=[0]", "time.end_s=0.2"]);
    let one = Store::open(folder.path(), &cases, false).unwrap();
    let Err(error) = Store::open(folder.path(), &cases, false) else { panic!("opened twice") };
    assert!(error.to_string().contains("another gotai is at work here"), "{error}");
    // Reading does not wait for it.
    assert!(Journal::read(folder.path()).unwrap().rows.is_empty());
    drop(one);
    assert_eq!(sweep(&cases, folder.path(), &[]).0, 4);
}

#[test]
fn rows_of_another_build_count_as_missing() {
    let folder = scratch::folder();
    let cases = planned(SWEEP, &["sweep.axes.seed=[0]"]);
    sweep(&cases, folder.path(), &[]);
    let done = Journal::read(folder.path()).unwrap();
    let others = done.rows.into_values().map(|entry| line(&Entry { build: "another".into(), ..entry }));
    std::fs::write(folder.path().join("journal.jsonl"), others.collect::<String>()).unwrap();
    let kept = Store::open(folder.path(), &cases, true).unwrap();
    assert!(cases.cases.iter().all(|planned| kept.measured(&planned.case.id).is_some()));
    assert!(cases.cases.iter().all(|planned| kept.measured_by_this_build(&planned.case.id).is_none()));
    drop(kept);
    assert_eq!(sweep(&cases, folder.path(), &[]).0, 4);
}

#[test]
fn a_case_that_panics_is_a_failed_row_and_the_sweep_goes_on() {
    let folder = scratch::folder();
    let cases = planned(SWEEP, &["sweep.axes.seed=[0, 1, 2]"]);
    let (ran, rows) = sweep_with(&cases, folder.path(), &[], &|planned, targets| {
        assert!(planned.case.experiment.seed != 1, "seed 1 is not liked here");
        build_and_run(planned, folder.path(), targets)
    });
    assert_eq!((ran, rows.len()), (12, 12));
    for row in &rows {
        let disliked = row.axes["seed"] == 1;
        assert_eq!(row.measured.outcome == Outcome::Failed, disliked);
        assert_eq!(row.measured.criterion.as_deref() == Some("seed 1 is not liked here"), disliked);
    }
}

#[test]
fn both_tables_hold_the_rows_in_plan_order() {
    let folder = scratch::folder();
    let cases = planned(SWEEP, &[]);
    let (_, rows) = sweep(&cases, folder.path(), &[]);
    let mut csv = csv::Reader::from_path(folder.path().join("rows.csv")).unwrap();
    let header: Vec<String> = csv.headers().unwrap().iter().map(str::to_string).collect();
    assert_eq!(header[..6], ["case", "method", "time.step_s", "seed", "outcome", "criterion"]);
    let column = |name: &str| header.iter().position(|h| h == name).unwrap();
    let (case, energy) = (column("case"), column("energy_end_j"));
    let read: Vec<_> = csv.records().map(|record| record.unwrap()).collect();
    let parquet = SerializedFileReader::new(File::open(folder.path().join("rows.parquet")).unwrap()).unwrap();
    let parquet: Vec<_> = parquet.get_row_iter(None).unwrap().map(|row| row.unwrap()).collect();
    assert_eq!((read.len(), parquet.len()), (24, 24));
    for ((row, csv), parquet) in rows.iter().zip(&read).zip(&parquet) {
        assert_eq!((&csv[case], parquet.get_string(case).unwrap().as_str()), (row.case.as_str(), row.case.as_str()));
        // To the last bit, in both.
        let energy_j = row.measured.energy_end_j.unwrap();
        assert_eq!((csv[energy].parse(), parquet.get_double(energy).unwrap()), (Ok(energy_j), energy_j));
        assert_eq!(parquet.get_long(column("seed")).unwrap(), row.axes["seed"].as_i64().unwrap());
    }
}

#[test]
fn few_recordings_show_both_outcomes() {
    let with = |outcome| Measured { outcome, ..Measured::default() };
    let (finished, diverged) = (with(Outcome::Finished), with(Outcome::Diverged));
    let all: Vec<Option<&Measured>> =
        (0..1000).map(|i| Some(if i % 100 == 7 { &diverged } else { &finished })).collect();
    let chosen = known_after(RecordCases::Few, &all);
    let exploded = chosen.iter().filter(|i| *i % 100 == 7).count();
    assert_eq!((chosen.len(), exploded), (24, 10));
    assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]));
    assert_eq!(known_after(RecordCases::Diverged, &all).len(), 10);
    assert_eq!(known_after(RecordCases::Sample(20), &all).len(), 20);
    assert_eq!(known_after(RecordCases::First, &all), [0]);
    assert_eq!(known_after(RecordCases::Few, &all[..5]).len(), 5);
}

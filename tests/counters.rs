//! Work is counted in integers and held exactly: a change that makes more of it shows here.
//!
//! `GOTAI_BLESS=1 cargo test --locked --release counters::` writes `counters.csv` anew.

use crate::yaml::{CUBE_IN_BOX, measured};
use gotai::experiment::ExperimentFile;
use gotai::heading::{Datum, Headings};
use gotai::study::{self, Place};
use gotai::sweep::build::build;
use rayon::prelude::*;
use std::path::Path;

#[test]
fn the_work_of_a_run_is_known() {
    let counters = |sets: &[&str]| {
        let m = measured(CUBE_IN_BOX, &[sets, &["diverge.escape=false"]].concat());
        [m.work.contact_tests, m.work.contacts, m.work.contact_solves, m.work.sweeps, m.work.gyroscopic]
    };
    assert_eq!(counters(&["method=free"]), [0, 0, 0, 0, 200]);
    assert_eq!(counters(&["method=free", "method.free.integrator=rk4"]), [0, 0, 0, 0, 800]);
    assert_eq!(counters(&["method=lecture"]), [7371, 179, 80, 2398, 0]);
    assert_eq!(counters(&["method={time-stepping: {solver: pgs}}"]), [3807, 524, 67, 3709, 261]);
    assert_eq!(counters(&["method=time-stepping"]), [3321, 413, 58, 256, 251]);
    let m = measured(CUBE_IN_BOX, &["method=time-stepping", "diverge.escape=false"]);
    assert_eq!([m.work.kept_solves, m.work.exact_solves, m.work.newton_steps], [5, 138, 1296]);
}

/// Standard scenes: a config, by the first values of its axes, and what is set. All together take some seconds.
const SCENES: [(&str, &str); 30] = [
    ("projectile", "method=free"),
    ("projectile", "method={free: {integrator: rk4}}"),
    ("free/tennis-racket", "method={free: {integrator: implicit-midpoint}} time.step_s=0.01 time.end_s=2"),
    ("free/heavy-top", "time.end_s=0.5"),
    ("free/pendulum", "time.end_s=1"),
    ("free/chain", "time.end_s=0.2"),
    ("free/drag", "time.end_s=1"),
    ("lecture/demo", "time.end_s=1"),
    ("lecture/demo", "method={penalty: {stiffness_n_m: 1e4}} time.step_s=1e-3 time.end_s=1"),
    ("lecture/demo", "method=time-stepping time.end_s=2"),
    ("lecture/demo", "method={time-stepping: {solver: pgs}} time.end_s=2"),
    ("lecture/demo", "method={time-stepping: {solver: nncg}} time.end_s=2"),
    ("lecture/demo", "method={time-stepping: {solver: newton}} time.end_s=1"),
    ("lecture/demo", "method={time-stepping: {scheme: moreau}} time.end_s=2"),
    ("lecture/friction", "method=time-stepping time.step_s=0.01 time.end_s=1"),
    ("contact/ball", "method=time-stepping time.step_s=0.01"),
    ("contact/slide-stop", "method=time-stepping time.step_s=0.01"),
    ("contact/slope", "method=time-stepping time.step_s=0.01"),
    ("contact/rocking-block", "method=time-stepping time.step_s=0.01"),
    ("contact/falling-rod", "method=time-stepping time.step_s=0.01"),
    ("contact/balls-in-a-row", "method=time-stepping time.step_s=0.01"),
    ("contact/seam-crate", "time.end_s=0.5"),
    ("contact/isolated", "time.end_s=0.5"),
    ("stack/stack", "method=time-stepping time.step_s=0.01 time.end_s=0.5"),
    ("stack/pile", "method=time-stepping time.step_s=0.01 time.end_s=0.5"),
    ("event/bounce", "method=event-driven"),
    ("event/slip-to-roll", "method=event-driven"),
    ("event/slide-and-stick", "method=event-driven"),
    ("event/lecture-cube", "method=event-driven time.end_s=2"),
    ("event/cans", "method=event-driven time.end_s=1"),
];

/// Line of a scene in the table: its name, what is set, and the counters that are not zero.
fn line((config, sets): &(&str, &str)) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs").join(config).with_extension("yaml");
    let sets = settings(sets);
    let first = ExperimentFile::load(&path, &sets).unwrap_or_else(|error| panic!("{config}: {error}"));
    // Of every axis that is left its first value.
    let point = vec![0; first.axes().axes.len()];
    let experiment = first.case(&point).unwrap_or_else(|error| panic!("{config}: {error}"));
    let (model, start) = build(&first, &point, &experiment).unwrap_or_else(|error| panic!("{config}: {error}"));
    let measured = study::measure(&experiment, &model, start, &Place::default()).ended.measured;
    let mut counted = vec![format!("steps={}", measured.steps)];
    measured.work.each_cell(&mut |name, cell| {
        if let Datum::Count(count @ 1..) = cell {
            counted.push(format!("{}={count}", name.trim_start_matches("work_")));
        }
    });
    format!("{config},{},{}", sets.join(" "), counted.join(" "))
}

/// Settings of a scene: words apart, but within braces.
fn settings(sets: &str) -> Vec<String> {
    let mut settings: Vec<String> = Vec::new();
    let mut depth = 0;
    for word in sets.split(' ') {
        match settings.last_mut().filter(|_| depth > 0) {
            Some(last) => *last += &format!(" {word}"),
            None => settings.push(word.to_string()),
        }
        depth += word.matches('{').count();
        depth -= word.matches('}').count();
    }
    settings
}

#[test]
fn standard_scenes_make_no_more_work_than_they_did() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/counters.csv");
    let lines: Vec<String> = SCENES.par_iter().map(line).collect();
    let made = format!("scene,set,counters\n{}\n", lines.join("\n"));
    if std::env::var_os("GOTAI_BLESS").is_some() {
        std::fs::write(&path, &made).unwrap();
    }
    let there = std::fs::read_to_string(&path).unwrap_or_default();
    let differing: Vec<_> = there.lines().zip(made.lines()).filter(|(there, made)| there != made).collect();
    assert!(there == made, "tests/counters.csv (GOTAI_BLESS=1 writes it): {differing:#?}");
}

//! `reference`: a run that errors are measured against, made once for all cases of a motion.

use crate::scratch;
use crate::sweep::{planned, sweep};
use crate::yaml::{experiment, measured, run};
use gotai::digest::{sealed, unsealed};
use gotai::measure::reference::Reference;
use gotai::rows::Measured;
use gotai::scene;
use gotai::study::reference::{id, made, of};
use gotai::sweep::planned::Planned;

/// A body that turns about all its axes and falls: what a reference says of it can be held against the closed form.
const SPIN: &str = "
scene:
  bodies:
    - { name: top, shape: none, mass_kg: 1, inertia_kg_m2: [1, 2, 3], velocity_m_s: [1, 2, 0], angular_velocity_body_rad_s: [1, 2, 0.5] }
method: { free: { integrator: explicit-euler } }
time: { step_s: 0.1, end_s: 2 }
reference: { tolerance: 1e-12 }
";

fn errors(measured: &Measured) -> [Option<f64>; 5] {
    let Measured { error_position_m, error_orientation_rad, error_velocity_m_s, error_angular_velocity_rad_s, .. } =
        measured;
    [
        *error_position_m,
        *error_orientation_rad,
        *error_velocity_m_s,
        *error_angular_velocity_rad_s,
        measured.error_time_s,
    ]
}

#[test]
fn errors_against_a_reference_are_those_against_the_closed_form() {
    let text = SPIN.replace("reference: { tolerance: 1e-12 }", "exact: free-motion");
    for method in ["free", "{free: {integrator: rk4}}", "time-stepping", "event-driven"] {
        let method = format!("method={method}");
        let (by_run, by_form) = (measured(SPIN, &[&method]), measured(&text, &[&method]));
        for (a, b) in errors(&by_run).iter().zip(errors(&by_form)) {
            // measured: 0
            assert!((a.unwrap() - b.unwrap()).abs() < 1e-12, "{method}: {a:?} {b:?}");
        }
        assert_eq!(by_run.reference_until_s, Some(2.0), "{method}");
        assert!(by_run.reference_uncertainty_m.unwrap() < 1e-12, "{method}");
        assert_eq!((by_form.reference_until_s, by_form.reference_uncertainty_m), (None, None));
    }
}

#[test]
fn cases_of_one_motion_share_a_reference() {
    let id_of = |sets: &[&str]| id(&experiment(SPIN, sets)).unwrap();
    let own = id_of(&[]);
    for same in
        ["method=event-driven", "time.step_s=0.05", "record.every_s=0", "measure=[state]", "seed=3", "limits.steps=9"]
    {
        assert_eq!(own, id_of(&[same]), "{same}");
    }
    let others = [
        "scene.bodies.top.mass_kg=2",
        "time.end_s=3",
        "reference.tolerance=1e-11",
        "method={time-stepping: {impact: poisson}}",
    ];
    for other in others {
        assert_ne!(own, id_of(&[other]), "{other}");
    }
    assert_eq!(id(&experiment(&SPIN.replace("reference: { tolerance: 1e-12 }", ""), &[])), None);
}

#[test]
fn a_sweep_makes_a_reference_once_and_reads_it_back_to_the_bit() {
    let text = format!("{SPIN}sweep: {{ axes: {{ scene.bodies.top.mass_kg: [1, 2], time.step_s: [0.1, 0.05] }} }}\n");
    let folder = scratch::folder();
    let cases = planned(&text, &[]);
    let files = || -> Vec<_> {
        let all = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
        let mut files: Vec<_> = all.filter(|path| path.display().to_string().contains("/reference-")).collect();
        files.sort();
        files
    };
    let (ran, rows) = sweep(&cases, folder.path(), &[]);
    assert_eq!((ran, files().len()), (4, 2));
    for (Planned { case, .. }, row) in cases.cases.iter().zip(&rows) {
        let (model, start) = scene::build(&case.experiment).unwrap();
        let kept = of(folder.path(), &case.experiment, &model, &start).unwrap().unwrap();
        assert_eq!(kept, made(&case.experiment, &model, &start).unwrap());
        assert_eq!(row.measured.without_wall_time(), run(&case.experiment).measured.without_wall_time());
    }
    // What is there is read, and not made again.
    let path = &files()[0];
    let mut changed: Reference = serde_json::from_str(&unsealed(&std::fs::read(path).unwrap()).unwrap()).unwrap();
    changed.parted_s = Some(0.5);
    std::fs::write(path, sealed(&changed)).unwrap();
    std::fs::remove_file(folder.path().join("journal.jsonl")).unwrap();
    let (ran, rows) = sweep(&cases, folder.path(), &[]);
    let until: Vec<f64> = rows.iter().map(|row| row.measured.reference_until_s.unwrap()).collect();
    assert_eq!((ran, until.iter().filter(|until| **until == 2.0 * 15.0 / 64.0).count()), (4, 2));
    // A file that somebody has changed is made again.
    let text = std::fs::read_to_string(path).unwrap();
    std::fs::write(path, text.replacen("0.5", "0.6", 1)).unwrap();
    std::fs::remove_file(folder.path().join("journal.jsonl")).unwrap();
    let (_, rows) = sweep(&cases, folder.path(), &[]);
    assert!(rows.iter().all(|row| row.measured.reference_until_s == Some(2.0)));
}

/// A run whose reference is good to the 16th of 64 parts alone.
fn until_part(part: u64, sets: &[&str]) -> Measured {
    let experiment = experiment(SPIN, sets);
    let (model, start) = scene::build(&experiment).unwrap();
    let mut reference = made(&experiment, &model, &start).unwrap();
    reference.parted_s = Some(2.0 * (part + 1) as f64 / 64.0);
    let method = experiment.method.stepping().unwrap();
    gotai::run::run(&experiment, &method, &model, start, None, Some(&reference)).measured
}

#[test]
fn where_the_reference_has_parted_errors_are_those_of_the_last_time_before() {
    // 20 steps meet every 16th of the 64 parts.
    let parted = until_part(17, &[]);
    assert_eq!((parted.error_time_s, parted.reference_until_s), (Some(0.5), Some(2.0 * 17.0 / 64.0)));
    let short = measured(SPIN, &["time.end_s=0.5"]);
    // Roundings of the first five times alone. measured: 2e-15
    assert!((parted.error_position_m.unwrap() - short.error_position_m.unwrap()).abs() < 1e-12);
    // Who follows events meets every part.
    assert_eq!(until_part(17, &["method=event-driven"]).error_time_s, Some(2.0 * 17.0 / 64.0));
    // Nothing was met before.
    let none = until_part(3, &[]);
    assert_eq!((none.error_position_m, none.error_time_s), (None, None));
}

#[test]
fn a_run_that_ends_early_is_measured_where_it_was() {
    // 14 of 20 steps: the last part that it has met is after 10.
    let limited = measured(SPIN, &["limits.steps=14"]);
    assert_eq!((limited.end_time_s, limited.error_time_s), (Some(1.4), Some(1.0)));
}

#[test]
fn through_impacts_a_reference_says_what_the_closed_form_says() {
    let bouncing = "
scene:
  restitution: 0.8
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 1.5, 0], velocity_m_s: [1, 0, 0] }]
method: { time-stepping: { scheme: moreau, solver: newton } }
time: { step_s: 0.01, end_s: 2 }
";
    let by_run = measured(&format!("{bouncing}reference: {{}}\n"), &[]);
    let by_form = measured(&format!("{bouncing}exact: ball\n"), &[]);
    for (a, b) in errors(&by_run).iter().zip(errors(&by_form)) {
        // measured: 1.1e-16 of positions
        assert!((a.unwrap() - b.unwrap()).abs() < 1e-11, "{a:?} {b:?}");
    }
    assert!(by_run.error_position_m.unwrap() > 1e-4, "{:?}", by_run.error_position_m);
}

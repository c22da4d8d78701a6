//! `gotai bench`: run time against error. No test looks at how long anything takes.

mod bad;
mod peer;

use crate::cli::run;
use crate::{scratch, yaml};
use gotai::bench::{self, timing};
use gotai::cli::bench_table::bench_table;
use gotai::rows::trials::{Trial, order, pareto};
use gotai::study;
use serde_json::Value;

/// A body that turns about all its axes, and falls.
pub const SPIN: &str = "\
scene:
  bodies:
    - { name: top, shape: none, mass_kg: 1, inertia_kg_m2: [1, 2, 3], angular_velocity_body_rad_s: [1, 2, 0.5] }
method: free
time: { step_s: 0.1, end_s: 2 }
exact: free-motion
sweep: { axes: { method.free.integrator: [rk4, dop853], time.step_s: [0.1, 0.05] } }
bench:
  methods: [{ free: { integrator: explicit-euler } }, { free: { integrator: rk4 } }, { free: { integrator: dop853 } }, { label: closed form, value: { free: { integrator: exact } } }]
  steps_s: [4e-2, 2e-2, 1e-2]
  tolerances: [1e-6, 1e-9]
  error: error_orientation_rad
  repeats: 2
";

fn rows(text: &str, sets: &[&str]) -> Vec<Trial> {
    let file = yaml::file(text, sets);
    let bench = file.bench().unwrap();
    let trials = bench::plan(&file, bench).unwrap();
    trials.iter().map(|trial| bench::run(trial, bench, "spin", None).unwrap().row).collect()
}

#[test]
fn every_method_has_a_row_at_each_of_its_steps_or_tolerances() {
    let rows = rows(SPIN, &[]);
    let shown: Vec<_> =
        rows.iter().map(|row| (row.method.as_str(), row.step_s, row.tolerance, row.outcome.as_str())).collect();
    let by_step = |method| [0.04, 0.02, 0.01].map(|step_s| (method, Some(step_s), None, "finished"));
    let by_tolerance = [1e-6, 1e-9].map(|tolerance| ("free dop853", None, Some(tolerance), "finished"));
    let mut expected = [by_step("free explicit-euler"), by_step("free rk4")].concat();
    expected.extend(by_tolerance);
    expected.push(("closed form", None, None, "finished"));
    assert_eq!(shown, expected);
    let steps: Vec<u64> = rows.iter().map(|row| row.steps).collect();
    // Those of dop853 are its own.
    assert_eq!(steps, [50, 100, 200, 50, 100, 200, 3, 7, 1]);
    for row in &rows {
        assert_eq!((row.engine.as_str(), row.error_kind.as_str()), ("gotai", "error_orientation_rad"));
        assert!(row.wall_s.unwrap() > 0.0 && row.wall_s <= row.wall_median_s, "{row:?}");
    }
}

#[test]
fn the_fitted_orders_are_those_that_are_claimed() {
    let rows = rows(SPIN, &[]);
    let slope = |method| order(&rows, method, 0.0).unwrap().slope;
    // measured: 0.98, 4.00
    assert!((slope("free explicit-euler") - 1.0).abs() < 0.1, "{}", slope("free explicit-euler"));
    assert!((slope("free rk4") - 4.0).abs() < 0.1, "{}", slope("free rk4"));
    // In its own mean step, from two tolerances. measured: 7.02
    assert!((6.0..10.0).contains(&slope("free dop853")), "{}", slope("free dop853"));
    assert!(order(&rows, "closed form", 0.0).is_none());
    // The same closed form, once a step. measured: 8.2e-18
    assert!(rows.last().unwrap().error.unwrap() < 1e-15, "{:?}", rows.last());
}

#[test]
fn the_timed_loop_ends_in_the_bits_of_the_judged_run() {
    let file = yaml::file(SPIN, &[]);
    for trial in bench::plan(&file, file.bench().unwrap()).unwrap() {
        let start = trial.start.clone();
        let judged = study::measure(&trial.experiment, &trial.model, start, &study::Place::default());
        let timed = timing::time(&judged.chosen, &trial.model, &trial.start, 1).end;
        let judged = judged.ended.state;
        let bits = |state: &gotai::state::State| -> Vec<u64> {
            let at = &state.bodies[0];
            let numbers = [at.p_WB.as_slice(), at.q_WB.coords.as_slice(), at.v_WB.as_slice(), at.w_WB.as_slice()];
            numbers.concat().into_iter().chain([state.time_s]).map(f64::to_bits).collect()
        };
        assert_eq!(bits(&timed), bits(&judged), "{}", trial.method);
    }
}

#[test]
fn without_lists_the_files_own_method_and_step_are_one_row() {
    let text = SPIN.split("bench:").next().unwrap();
    let rows = rows(&format!("{text}bench:\n"), &[]);
    let shown: Vec<_> = rows.iter().map(|row| (row.method.as_str(), row.step_s, row.error_kind.as_str())).collect();
    assert_eq!(shown, [("free semi-implicit-euler", Some(0.1), "error_position_m")]);
}

#[test]
fn a_run_that_does_not_finish_has_neither_error_nor_time() {
    let rows = rows(SPIN, &["diverge.speed_m_s=5", "bench.error=energy_drift_rel"]);
    // The fall reaches 5 m/s after half a second; one step of the clock only sees its end.
    for row in rows {
        assert_eq!((row.outcome.as_str(), row.criterion.as_deref()), ("diverged", Some("speed")), "{row:?}");
        assert_eq!((row.error, row.wall_s, row.wall_median_s), (None, None, None));
    }
}

#[test]
fn a_limited_run_is_stalled_and_not_timed() {
    let rows = rows(SPIN, &["limits.steps=60"]);
    let stalled: Vec<_> = rows.iter().map(|row| row.criterion.as_deref() == Some("limit")).collect();
    // Of 100 and 200 steps; of 50, and of one to the end, nothing is missing.
    assert_eq!(stalled, [false, true, true, false, true, true, false, false, false]);
    assert!(rows.iter().all(|row| (row.outcome == "stalled") == row.wall_s.is_none()));
}

#[test]
fn a_bench_does_not_change_the_id_of_a_case() {
    let id = |text: &str| {
        let sets = ["method.free.integrator=rk4", "time.step_s=0.1"];
        gotai::sweep::plan::single_case(&yaml::file(text, &sets)).unwrap().id
    };
    assert_eq!(id(SPIN), id(SPIN.split("bench:").next().unwrap()));
}

fn row(error: f64, wall_s: f64, step_s: Option<f64>) -> Trial {
    let mut row = rows(&format!("{}bench:\n", SPIN.split("bench:").next().unwrap()), &[]).remove(0);
    (row.error, row.wall_s, row.step_s) = (Some(error), Some(wall_s), step_s);
    row
}

#[test]
fn the_pareto_front_is_what_nothing_beats_and_no_closed_form() {
    let at = |error, wall_s| row(error, wall_s, Some(0.1));
    let rows = [at(1.0, 1.0), at(0.5, 2.0), at(0.6, 2.0), at(0.5, 3.0), at(0.5, 2.0), row(0.0, 0.1, None)];
    assert_eq!(pareto(&rows, 0.0), [true, true, false, false, true, false]);
}

#[test]
fn a_user_gets_a_table_orders_json_and_files() {
    let folder = scratch::folder();
    let config = folder.path().join("spin.yaml");
    std::fs::write(&config, SPIN).unwrap();
    let (config, out) = (config.to_str().unwrap(), folder.path().join("out"));
    let (code, text, err) = run(&["bench", config, "--out", out.to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    for part in ["spin.yaml: 9 rows", "free rk4", "closed form", "◆", "free rk4: order 4.0", "in its own mean step"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let (code, text, err) = run(&["bench", config, "--out", out.to_str().unwrap(), "--json"]);
    assert_eq!(code, 0, "{err}");
    assert_eq!(text, std::fs::read_to_string(out.join("bench.json")).unwrap());
    let rows: Value = serde_json::from_str(&text).unwrap();
    let keys: Vec<&str> = rows[0].as_object().unwrap().keys().map(String::as_str).collect();
    let columns = "scene,engine,method,step_s,tolerance,steps,error,error_kind,wall_s,wall_median_s,outcome,criterion";
    assert_eq!(keys.join(","), columns);
    assert_eq!(rows[0]["scene"].as_str(), config.strip_suffix(".yaml"));
    let csv = std::fs::read_to_string(out.join("bench.csv")).unwrap();
    assert!(csv.starts_with(columns) && csv.lines().count() == 10, "{csv}");
}

/// Labels as long as they come, an error with a long name, a run that does not finish: all in 80 letters.
#[test]
fn the_table_fits_a_terminal() {
    let rows = |labels: &[&str]| -> Vec<Trial> {
        let mut all = Vec::new();
        for label in labels {
            for step_s in [0.02, 0.01, 0.005] {
                let mut trial = row(step_s * step_s, 1e-3 / step_s, Some(step_s));
                trial.method = label.to_string();
                trial.error_kind = "error_angular_velocity_rad_s".to_string();
                all.push(trial);
            }
        }
        all
    };
    let unbroken = "x".repeat(200);
    let mut all = rows(&["rk4", "a label in many words that says all that there is to say of a method", &unbroken]);
    (all[1].outcome, all[1].criterion) =
        ("failed".to_string(), Some("a panic with a long message of its own".repeat(3)));
    let text = bench_table(&all, &[], 80);
    assert!(text.lines().all(|line| line.chars().count() <= 80), "{text}");
    for part in ["rk4: order 2.00", "error_ang", "failed (a p", "1.00e-4", "◆"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn of_a_folder_the_files_with_a_bench_are_run() {
    let folder = scratch::folder();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("none.yaml", SPIN.split("bench:").next().unwrap());
    let (given, out) = (folder.path().to_str().unwrap(), folder.path().join("out"));
    let args = ["bench", given, "--out", out.to_str().unwrap(), "--set", "time.end_s=0.1", "--json"];
    let (code, text, err) = run(&args);
    let said: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((code, said["exit_code"].as_u64()), (2, Some(2)), "{err}");
    for said in [said["error"].as_str().unwrap(), &err] {
        assert!(said.contains("no file in it has a `bench:`"), "{said}");
    }
    write("a.yaml", SPIN);
    write("b.yaml", SPIN);
    let (code, text, err) = run(&args);
    assert_eq!(code, 0, "{err}");
    assert_eq!(serde_json::from_str::<Value>(&text).unwrap().as_array().unwrap().len(), 18);
    assert!(out.join("a/bench.png").exists() && out.join("b/bench.svg").exists() && !out.join("none").exists());
}

#[test]
fn other_engines_stand_beside_the_rows_in_table_and_diagram() {
    let folder = scratch::folder();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_string()
    };
    let config = file("my-spin.yaml", SPIN);
    let head = "scene,engine,method,dt,steps,error,error_kind,wall_s,wall_per_sim_second";
    let others = file(
        "others.csv",
        &format!(
            "{head}\nmy_spin,tops,RK4,0.01,200,1e-12,angle_rad,1e-9,1e-9\nmy_spin,tops,Euler,0.01,200,1e-2,angle_rad,1,1\n\
             my_spin,tops,slow,0.01,,,failed: timeout,,\nelsewhere,tops,RK4,0.01,200,1e-3,angle_rad,1,1\n"
        ),
    );
    let out = folder.path().join("out").to_str().unwrap().to_string();
    let (code, text, err) = run(&["bench", &config, "--with", &others, "--out", &out]);
    assert_eq!(code, 0, "{err}");
    // The one that its own rows beat is left out, and nothing here is as fast as the other.
    assert!(text.contains("tops: RK4") && !text.contains("Euler") && text.matches('◆').count() <= 3, "{text}");
    let svg = std::fs::read_to_string(folder.path().join("out/bench.svg")).unwrap();
    assert!(svg.contains("tops") && svg.contains("free rk4, order"));
    // Files keep to the rows of this program.
    assert!(!std::fs::read_to_string(folder.path().join("out/bench.csv")).unwrap().contains("tops"));
    let wrong = |text: &str, says: &str| {
        let others = file("wrong.csv", text);
        let (code, _, err) = run(&["bench", &config, "--with", &others, "--out", &out]);
        assert!(code == 2 && err.contains(says), "{code} {err}");
    };
    wrong(
        &format!("{head}\nelsewhere,tops,RK4,0.01,200,1e-3,angle_rad,1,1\n"),
        "no rows of this scene; it has elsewhere",
    );
    wrong(&format!("{head}\nmy_spin,tops,RK4,0.01,200,1e-3,position_m,1,1\n"), "another unit (`position_m`)");
    wrong("scene,engine\nmy_spin,tops\n", "expected rows of a bench");
}

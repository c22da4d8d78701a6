//! Cases that differ by seed or step alone: one scene, built once, and nothing else than each would be by itself.

use super::{SWEEP, planned, sweep};
use crate::scratch;
use crate::yaml::file;
use gotai::experiment::ExperimentFile;
use gotai::scene::build;
use std::path::Path;

#[test]
fn cases_are_what_each_is_by_itself() {
    for axes in ["seed: [0, 7, 18446744073709551615]", "time.step_s: [1, 0.5, 1e-3]", "time.step_s: [1e-2, null]"] {
        let method = if axes.contains("null") { "event-driven" } else { "time-stepping" };
        let text = SWEEP.split("sweep:").next().unwrap().to_string() + &format!("sweep: {{ axes: {{ {axes} }} }}\n");
        let sets = [format!("method={method}")];
        let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
        let (file, plan) = (file(&text, &sets), planned(&text, &sets));
        for case in &plan.cases {
            assert_eq!(case.case.experiment, file.case(&case.point).unwrap(), "{axes}");
        }
    }
}

#[test]
fn cases_of_one_scene_share_it_and_its_bodies() {
    let plan = planned(SWEEP, &[]);
    // 2 methods × 2 steps × 6 seeds, of which a method's are alike.
    let scene = |i: usize| &plan.cases[i].case.experiment.scene;
    assert!((1..12).all(|i| scene(i).is_one_with(scene(0))) && !scene(12).is_one_with(scene(0)));
    let bodies = |i: usize| build(&plan.cases[i].case.experiment).unwrap().0.bodies;
    assert!(bodies(0).is_one_with(&bodies(5)));
    assert!(!bodies(0).is_one_with(&bodies(12)) && bodies(0).len() == bodies(12).len());
}

#[test]
fn what_is_wrong_on_an_axis_is_said_as_ever() {
    let refused = |axes: &str| {
        let text = SWEEP.split("sweep:").next().unwrap().to_string() + &format!("sweep: {{ axes: {{ {axes} }} }}\n");
        let file = ExperimentFile::from_text(Path::new("test.yaml"), &text, &[]).unwrap();
        gotai::sweep::plan::SweepPlan::new(&file).unwrap_err().to_string()
    };
    assert!(refused("seed: [0, 1, -1]").contains("seed = -1"));
    assert!(refused("time.step_s: [0.1, 0]").contains("expected a number greater than 0, found 0"));
    assert!(refused("time.step_s: [0.1, 1e-13]").contains("a step that needs at most"));
}

#[test]
fn the_longest_are_run_first_and_rows_stay_in_plan_order() {
    let folder = scratch::folder();
    let text =
        SWEEP.split("sweep:").next().unwrap().to_string() + "sweep: { axes: { time.step_s: [0.1, 0.02, 0.05] } }\n";
    let plan = planned(&text, &[]);
    let costs: Vec<f64> = plan.cases.iter().map(|planned| planned.likely_cost()).collect();
    assert_eq!(costs, [20.0, 100.0, 40.0]);
    let (ran, rows) = sweep(&plan, folder.path(), &[]);
    let steps: Vec<&serde_json::Value> = rows.iter().map(|row| &row.axes["time.step_s"]).collect();
    assert_eq!((ran, format!("{steps:?}")), (3, "[Number(0.1), Number(0.02), Number(0.05)]".to_string()));
}

//! Axes and labels on the command line.

use super::{BASE, file, flagged, swept};
use crate::cli::run;
use crate::scratch;
use gotai::case::Case;
use gotai::experiment::ExperimentFile;
use gotai::experiment::types::NodesPerEdge;
use serde_json::Map;

const MESHES: &str = "    scene.bodies.cube.mesh:
      - { label: fine, value: { nodes_per_edge: 9 } }
      - { label: '5', value: { nodes_per_edge: 4 } }
      - { label: lecture, value: { nodes_per_edge: 2 } }
    seed: [1, 2]
";

fn shown(file: &ExperimentFile) -> Vec<(String, Vec<String>)> {
    let axes = file.axes().axes.iter();
    axes.map(|axis| (axis.path.clone(), axis.values.iter().map(|value| value.shown()).collect())).collect()
}

fn axis(path: &str, values: &[&str]) -> (String, Vec<String>) {
    (path.to_string(), values.iter().map(|value| value.to_string()).collect())
}

fn message(text: &str, flags: &[&str]) -> String {
    let file = match flagged(text, flags) {
        Ok(file) => file,
        Err(error) => return error.to_string(),
    };
    let case = file.case(&file.axes().point(0));
    case.expect_err("nothing is wrong").to_string()
}

fn nodes(file: &ExperimentFile, point: &[usize]) -> Option<NodesPerEdge> {
    file.case(point).unwrap().scene.bodies[0].mesh.clone().unwrap().nodes_per_edge
}

#[test]
fn an_axis_is_replaced_in_its_place_and_a_new_one_is_the_last() {
    let text = swept("    seed: [1, 2]\n    scene.friction: [0.1]\n");
    let file = flagged(&text, &["--axis time.step_s={ log: { from: 1e-3, to: 1e-1, count: 3 } }", "--axis seed=0..2"]);
    let axes = [
        axis("seed", &["0", "1", "2"]),
        axis("scene.friction", &["0.1"]),
        axis("time.step_s", &["0.001", "0.01", "0.1"]),
    ];
    assert_eq!(shown(&file.unwrap()), axes);
    assert_eq!(shown(&flagged(BASE, &["--axis seed=[4, 6]"]).unwrap()), [axis("seed", &["4", "6"])]);
}

#[test]
fn an_axis_is_the_set_of_its_values() {
    let text = swept(MESHES);
    for spec in ["seed=[4, 5]", "scene.bodies.cube.mesh=[fine]", "method.lecture.sweeps=1..4", "scene.friction=[0]"] {
        let [a, s] = ["--axis ", "sweep.axes."].map(|flag| flagged(&text, &[&format!("{flag}{spec}")]).unwrap());
        assert_eq!((a.axes(), a.written()), (s.axes(), s.written()), "{spec}");
    }
}

/// The name of a column stays what the file calls it.
#[test]
fn an_axis_of_an_index_replaces_that_of_the_name() {
    let text = swept("    scene.bodies.cube.mass_kg: [1]\n");
    let file = flagged(&text, &["--axis scene.bodies.0.mass_kg=[2, 3]"]).unwrap();
    assert_eq!(shown(&file), [axis("scene.bodies.cube.mass_kg", &["2", "3"])]);
}

#[test]
fn one_axis_by_two_flags_is_refused() {
    let text = swept("    seed: [1, 2]\n    scene.bodies.cube.mass_kg: [1]\n");
    for (flags, named) in [
        (["--axis seed=[1]", "--axis seed=[2]"], ["--axis seed=[2]: seed: ", "`--axis seed=[1]`"]),
        (["--axis seed=[1]", "sweep.axes.seed=[2]"], ["--set sweep.axes.seed=[2]: seed: ", "`--axis seed=[1]`"]),
        (["sweep.axes.seed=[2]", "--axis seed=[1]"], ["--axis seed=[1]: seed: ", "`--set sweep.axes.seed=[2]`"]),
        (["seed=2", "--axis seed=[1]"], ["--axis seed=[1]: seed: ", "`--set seed=2`"]),
        (["--axis seed=[1]", "seed=2"], ["--set seed=2: seed: ", "`--axis seed=[1]`"]),
        (["--axis seed=[1]", "sweep=null"], ["--set sweep=null: sweep: ", "`--axis seed=[1]`"]),
        (["--axis seed=[1]", "sweep.axes={}"], ["--set sweep.axes={}: sweep.axes: ", "`--axis seed=[1]`"]),
        (
            ["--axis scene.bodies.0.mass_kg=[1]", "scene.bodies.cube.mass_kg=2"],
            ["--set scene.bodies.cube.mass_kg=2: ", "`--axis scene.bodies.0.mass_kg=[1]`"],
        ),
    ] {
        let error = message(&text, &flags);
        assert!(error.starts_with(named[0]), "{error}");
        assert!(error.ends_with(&format!("also given by {}: expected one of the two", named[1])), "{error}");
    }
    // The file's axes away, then another: nothing is lost.
    assert_eq!(shown(&flagged(&text, &["sweep=null", "--axis seed=[7]"]).unwrap()), [axis("seed", &["7"])]);
}

#[test]
fn a_bad_axis_on_the_command_line_says_so_with_its_flag() {
    for (flag, begin, fragments) in [
        ("--axis seed=3", "--axis seed=3: sweep.axes.seed: expected a list", &["[a, b]", "0..39", "{ log: "][..]),
        ("--axis method=free", "--axis method=free: sweep.axes.method: ", &["[a, b]", "found the text `free`"]),
        ("--axis seed=", "--axis seed=: sweep.axes.seed: ", &["found nothing"]),
        ("--axis seed=5..2", "--axis seed=5..2: sweep.axes.seed: ", &["from ≤ to", "found `5..2`"]),
        ("--axis seed", "--axis seed: expected PATH=VALUE", &[]),
        ("--axis =[1]", "--axis =[1]: expected a path such as ", &[]),
        ("--axis seed=[1", "--axis seed=[1: seed: the value is not valid YAML", &[]),
        ("--axis seed={ rnge: 1 }", "--axis seed={ rnge: 1 }: sweep.axes.seed.rnge: ", &["did you mean `range`?"]),
        (
            "--axis time.stp_s=[1]",
            "--axis time.stp_s=[1]: time.stp_s: unknown key",
            &["did you mean `step_s`?", "known here: step_s, end_s"],
        ),
        (
            "--axis scene.bodies.cubo.mass_kg=[1]",
            "--axis scene.bodies.cubo.mass_kg=[1]: scene.bodies.cubo: no such item",
            &["did you mean `cube`?", "known here: cube, point"],
        ),
        (
            "--axis scene.friction=[-1]",
            "--axis scene.friction=[-1]: scene.friction: expected a number of at least",
            &[],
        ),
        ("--axis expect.0=[1]", "--axis expect.0=[1]: sweep.axes.expect.0: ", &["outside of `sweep`, `expect`"]),
        ("--axis extends=[a]", "--axis extends=[a]: extends: expected only in a file", &[]),
        ("extends=b.yaml", "--set extends=b.yaml: extends: expected only in a file", &[]),
    ] {
        let error = message(BASE, &[flag]);
        assert!(error.starts_with(begin) && !error.contains('\n'), "{error}");
        fragments.iter().for_each(|fragment| assert!(error.contains(fragment), "{fragment}: {error}"));
    }
    let text = swept(
        "    scene.friction: [0.1]\n  search: { critical: time.step_s, between: [1e-3, 1], until: { outcome: diverged } }\n",
    );
    let searched = message(&text, &["--axis time.step_s=[1]"]);
    assert!(searched.contains("`time.step_s` is searched and an axis"), "{searched}");
    let error = flagged(BASE, &["--axis seed=3"]).unwrap_err();
    assert_eq!((error.details().flag, error.details().set.as_deref()), (Some("--axis"), Some("seed=3")));
}

#[test]
fn a_set_below_an_axis_of_the_command_line_is_refused() {
    let error = message(BASE, &["--axis method=[lecture, free]", "method.lecture.sweeps=3"]);
    assert!(error.starts_with("--set method.lecture.sweeps=3: method: is an axis"), "{error}");
}

#[test]
fn a_label_stands_for_its_value() {
    let text = swept(MESHES);
    let at = |set: &str| {
        let file = flagged(&text, &[&format!("scene.bodies.cube.mesh={set}")]).unwrap();
        assert_eq!(shown(&file), [axis("seed", &["1", "2"])], "{set}");
        nodes(&file, &[0])
    };
    assert_eq!(at("fine"), Some(NodesPerEdge::Shortest(9)));
    assert_eq!(at(" fine "), Some(NodesPerEdge::Shortest(9)));
    assert_eq!(at("\"fine\""), Some(NodesPerEdge::Shortest(9)));
    assert_eq!(at("5"), Some(NodesPerEdge::Shortest(4)));
    assert_eq!(at("{ nodes_per_edge: 3 }"), Some(NodesPerEdge::Shortest(3)));
    let by_index = flagged(&text, &["scene.bodies.0.mesh=fine"]).unwrap();
    assert_eq!(nodes(&by_index, &[0]), Some(NodesPerEdge::Shortest(9)));
}

#[test]
fn labels_on_an_axis_of_the_command_line_stand_for_the_files_values() {
    for flag in ["--axis ", "sweep.axes."] {
        let flags = format!("{flag}scene.bodies.cube.mesh=[5, {{ nodes_per_edge: 3 }}, fine]");
        let file = flagged(&swept(MESHES), &[&flags]).unwrap();
        assert_eq!(shown(&file)[0].1, ["5", r#"{"nodes_per_edge":3}"#, "fine"]);
        assert_eq!(nodes(&file, &[2, 0]), Some(NodesPerEdge::Shortest(9)));
    }
}

#[test]
fn a_label_goes_before_a_word_of_the_vocabulary() {
    let text = swept("    method: [{ label: free, value: { lecture: { sweeps: 7 } } }, lecture]\n");
    let method = flagged(&text, &["method=free"]).unwrap().experiment().unwrap().method;
    assert_eq!(method.word(), "lecture");
    let swept = flagged(&text, &["--axis method=[free]"]).unwrap().case(&[0]).unwrap().method;
    assert_eq!(swept, method);
}

#[test]
fn an_unknown_word_is_answered_with_the_labels_too() {
    for flag in ["scene.bodies.cube.mesh=fin", "--axis scene.bodies.cube.mesh=[fin]"] {
        let error = message(&swept(MESHES), &[flag]);
        assert!(error.contains("labels of this axis: fine, 5, lecture"), "{error}");
    }
    let number = message(&swept(MESHES), &["scene.bodies.cube.mesh={ nodes_per_edge: 0 }"]);
    assert!(!number.contains("labels"), "{number}");
}

#[test]
fn an_id_knows_no_labels() {
    let id = |spec: &str| {
        let file = file(&swept(&format!("    scene.bodies.cube.mesh: [{spec}]\n")), &[]).unwrap();
        Case::new(file.case(&[0]).unwrap(), Map::new()).id
    };
    let plain = id("{ nodes_per_edge: 9 }");
    assert_eq!(id("{ label: fine, value: { nodes_per_edge: 9 } }"), plain);
    assert_eq!(id("{ label: coarse, value: { nodes_per_edge: 9 } }"), plain);
    assert_ne!(id("{ nodes_per_edge: 8 }"), plain);
}

#[test]
fn a_sweep_takes_axes_and_names_its_folder_by_all_flags_in_their_order() {
    let folder = scratch::folder();
    let path = folder.path().join("a.yaml");
    std::fs::write(&path, BASE).unwrap();
    let config = path.to_str().unwrap();
    let flags = ["--axis", "seed=0..2", "--set", "time.end_s=0.02", "--axis", "scene.friction=[0, 0.5]"];
    let command = [&["sweep", config, "--record", "none", "--json"], &flags[..]].concat();
    let output =
        std::process::Command::new(env!("CARGO_BIN_EXE_gotai")).args(command).current_dir(folder.path()).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let out = folder.path().join("recordings/a+seed=0..2+time.end-s=0.02+scene.friction=-0--0.5-");
    assert_eq!(std::fs::read_to_string(out.join("rows.csv")).unwrap().lines().count(), 1 + 3 * 2);
}

#[test]
fn a_run_takes_axes_of_as_many_cases_as_one_picture_shows() {
    let (code, _, err) = run(&["run", "configs/lecture/demo.yaml", "--axis", "seed=0..12"]);
    assert_eq!(code, 2);
    assert!(err.contains("--axis seed=0..12: expected at most 12 cases"), "{err}");
    let (code, _, err) = run(&["sweep", "configs/lecture/demo.yaml", "--axis", "seed=3"]);
    assert!(code == 2 && err.contains("--axis seed=3: sweep.axes.seed: expected a list"), "{err}");
}

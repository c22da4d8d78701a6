//! Axes: their forms, the grid, and what is said about bad ones.

use super::{BASE, experiment, file, swept};
use gotai::experiment::axes::Axes;
use gotai::experiment::error::Kind;
use gotai::experiment::types::*;
use serde_json::json;

fn axes(lines: &str) -> Axes {
    file(&swept(lines), &[]).unwrap().axes().clone()
}

fn shown(spec: &str) -> Vec<String> {
    axes(&format!("    time.end_s: {spec}\n")).axes[0].values.iter().map(|value| value.shown()).collect()
}

#[test]
fn a_list_is_taken_in_its_order() {
    assert_eq!(shown("[3, 1.5, 2e-3]"), ["3", "1.5", "0.002"]);
}

#[test]
fn a_range_includes_both_ends_and_integers_stay_integers() {
    assert_eq!(shown("{ range: { from: 2, to: 6 } }"), ["2", "3", "4", "5", "6"]);
    assert_eq!(shown("{ range: { from: 0, to: 7, step: 3 } }"), ["0", "3", "6"]);
    assert_eq!(shown("{ range: { from: 3, to: 1, step: -1 } }"), ["3", "2", "1"]);
    assert_eq!(shown("{ range: { from: 4, to: 4 } }"), ["4"]);
}

#[test]
fn whole_numbers_from_to_are_a_range() {
    assert_eq!(shown("0..3"), ["0", "1", "2", "3"]);
    assert_eq!(shown("-2..1"), ["-2", "-1", "0", "1"]);
    assert_eq!(shown("'7 .. 7'"), ["7"]);
    assert_eq!(shown("-4..-3"), ["-4", "-3"]);
    let [short, long] = ["0..39", "{ range: { from: 0, to: 39 } }"].map(|spec| axes(&format!("    seed: {spec}\n")));
    assert_eq!(short, long);
}

#[test]
fn a_range_of_decimals_has_decimal_values() {
    let tenths = ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9", "1.0"];
    assert_eq!(shown("{ range: { from: 0.1, to: 1, step: 0.1 } }"), tenths);
    assert_eq!(shown("{ range: { from: 0, to: 0.35, step: 0.1 } }"), ["0.0", "0.1", "0.2", "0.3"]);
}

#[test]
fn logarithmic_and_linear_axes_meet_both_ends() {
    assert_eq!(shown("{ log: { from: 1e-3, to: 1e-1, count: 5 } }")[..3], ["0.001", "0.00316227766016838", "0.01"]);
    assert_eq!(shown("{ log: { from: 0.1, to: 1e-3, count: 3 } }"), ["0.1", "0.01", "0.001"]);
    assert_eq!(shown("{ log: { from: 2, to: 32, count: 5 } }"), ["2", "4", "8", "16", "32"]);
    assert_eq!(shown("{ log: { from: 1e-300, to: 1e300, count: 3 } }")[1], "1.0");
    assert_eq!(shown("{ linear: { from: 0, to: 1, count: 5 } }"), ["0.0", "0.25", "0.5", "0.75", "1.0"]);
    assert_eq!(shown("{ linear: { from: 3, to: 1, count: 3 } }"), ["3", "2", "1"]);
    assert_eq!(shown("{ linear: { from: 3, to: 3, count: 1 } }"), ["3"]);
    let ends = axes("    time.step_s: { log: { from: 1e-3, to: 5e-2, count: 8 } }\n").axes.remove(0).values;
    assert_eq!((ends[0].value.as_f64(), ends[7].value.as_f64()), (Some(1e-3), Some(5e-2)));
}

#[test]
fn the_grid_is_in_the_order_written_and_its_first_axis_is_slowest() {
    let axes = axes("    seed: [5, 6]\n    scene.friction: [0, 0.1, 0.2]\n");
    let points: Vec<Vec<usize>> = (0..axes.len()).map(|i| axes.point(i)).collect();
    assert_eq!(points, [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]]);
}

#[test]
fn axes_together_advance_side_by_side_in_the_place_of_the_first() {
    let lines = "    seed: [5, 6]\n    scene.friction: [0, 0.1, 0.2]\n    time.end_s: [1, 2]\n";
    let axes = axes(&format!("{lines}  together: [[time.end_s, seed]]\n"));
    assert_eq!((axes.len(), axes.groups.clone()), (6, vec![vec![0, 2], vec![1]]));
    let points: Vec<Vec<usize>> = (0..axes.len()).map(|i| axes.point(i)).collect();
    assert_eq!(points, [[0, 0, 0], [0, 1, 0], [0, 2, 0], [1, 0, 1], [1, 1, 1], [1, 2, 1]]);
}

#[test]
fn a_case_has_the_values_of_its_point() {
    let text = swept(
        "    seed: [5, 6]\n    scene.bodies.cube.mesh.nodes_per_edge: [3, [2, 3, 4]]\n    scene.bodies.1.mass_kg: [3]\n",
    );
    let case = file(&text, &[]).unwrap().case(&[1, 1, 0]).unwrap();
    let nodes = case.scene.bodies[0].mesh.clone().unwrap().nodes_per_edge;
    assert_eq!((case.seed, nodes), (6, Some(NodesPerEdge::Each([2, 3, 4]))));
    assert_eq!(case.scene.bodies[1].mass_kg, Some(3.0));
}

#[test]
fn a_method_is_an_axis_like_any_other() {
    let text = swept("    method.lecture.sweeps: [5]\n    method: [lecture, { lecture: { start: direct } }]\n");
    let method = file(&text, &[]).unwrap().case(&[0, 1]).unwrap().method;
    assert_eq!(method, Method::Lecture(Lecture { sweeps: 5, start: Start::Direct, ..Lecture::default() }));
}

#[test]
fn an_axis_may_fill_in_what_the_file_lacks() {
    let text = swept("    time.step_s: [0.5]\n    diverge.speed_m_s: [7]\n").replace("  step_s: 0.01\n", "");
    let case = file(&text, &[]).unwrap().case(&[0, 0]).unwrap();
    assert_eq!((case.time.step_s, case.diverge.speed_m_s), (Some(0.5), Some(7.0)));
}

#[test]
fn a_labelled_value_is_a_whole_subtree_and_shows_its_label() {
    let text = swept(
        "    scene.bodies.cube.mesh:\n      - { label: fine, value: { nodes_per_edge: 9 } }\n      - { nodes_per_edge: 2 }\n",
    );
    let file = file(&text, &[]).unwrap();
    let values = &file.axes().axes[0].values;
    assert_eq!((values[0].shown(), values[0].cell()), ("fine".to_string(), json!("fine")));
    assert_eq!(
        (values[1].shown(), values[1].cell()),
        (r#"{"nodes_per_edge":2}"#.to_string(), json!(r#"{"nodes_per_edge":2}"#))
    );
    let nodes = file.case(&[0]).unwrap().scene.bodies[0].mesh.clone().unwrap().nodes_per_edge;
    assert_eq!(nodes, Some(NodesPerEdge::Shortest(9)));
}

#[test]
fn numbers_and_flags_stay_what_they_are_in_a_column() {
    let cells = |path: &str, spec: &str| -> Vec<serde_json::Value> {
        axes(&format!("    {path}: {spec}\n")).axes[0].values.iter().map(|value| value.cell()).collect()
    };
    assert_eq!(cells("seed", "[1, { label: two, value: 2 }]"), [json!(1), json!("two")]);
    assert_eq!(cells("diverge.escape", "[true, false]"), [json!(true), json!(false)]);
    assert_eq!(cells("method", "[lecture]"), [json!("lecture")]);
    assert_eq!(cells("scene.friction", "[0.25]"), [json!(0.25)]);
}

#[test]
fn a_file_without_axes_is_a_grid_of_one_point() {
    let file = file(BASE, &[]).unwrap();
    assert_eq!((file.axes().len(), file.axes().point(0)), (1, vec![]));
    assert_eq!(file.case(&[]).unwrap(), file.experiment().unwrap());
}

#[test]
fn a_single_run_names_the_axes_that_are_left() {
    let error = experiment(&swept("    seed: [1]\n    scene.friction: [0]\n"), &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.yaml:21: sweep.axes: axes are left: seed, scene.friction; fix each of them with --set PATH=VALUE, or run \
         all cases with `gotai sweep`"
    );
    assert_eq!(error.details().kind, Kind::AxesLeft);
    assert_eq!(error.details().known, ["seed", "scene.friction"]);
}

/// What is wrong, the lines below `axes:`, the line and key path of the message, and a part of it.
type Row = (&'static str, &'static str, usize, &'static str, &'static str);

#[rustfmt::skip]
const BAD: &[Row] = &[
    ("no values", "    seed: []\n", 22, "sweep.axes.seed", "at least one value"),
    ("one value", "    seed: 3\n", 22, "sweep.axes.seed", "expected a list of values ([a, b]), whole numbers from..to (0..39), or one of range, log, linear ({ log: { from: 1e-3, to: 1, count: 4 } }), found 3"),
    ("a range that falls", "    seed: 5..2\n", 22, "sweep.axes.seed", "expected whole numbers from..to with from ≤ to, such as 0..39, found `5..2`"),
    ("a range of decimals", "    time.end_s: 0.5..2\n", 22, "sweep.axes.time.end_s", "found `0.5..2`"),
    ("a range without an end", "    seed: 0..\n", 22, "sweep.axes.seed", "found `0..`"),
    ("a long range", "    seed: 0..9999999999\n", 22, "sweep.axes.seed", "at most 1000000 values, found 10000000000"),
    ("a word alone", "    method: lecture\n", 22, "sweep.axes.method", "found the text `lecture`"),
    ("a path of the base", "    extends: [a.yaml]\n", 22, "sweep.axes.extends", "`bench`, `extends`, found `extends`"),
    ("an unknown form", "    seed: { rnge: { from: 0, to: 1 } }\n", 22, "sweep.axes.seed.rnge", "did you mean `range`?"),
    ("an unknown key of a form", "    seed: [1]\n    time.end_s:\n      range: { from: 0, to: 1, stp: 1 }\n", 24, "sweep.axes.time.end_s.range.stp", "did you mean `step`?"),
    ("no end", "    seed: { range: { from: 0 } }\n", 22, "sweep.axes.seed.range.to", "missing"),
    ("a step of zero", "    seed: { range: { from: 0, to: 1, step: 0 } }\n", 22, "sweep.axes.seed.range.step", "other than 0"),
    ("a step the wrong way", "    seed: { range: { from: 3, to: 1 } }\n", 22, "sweep.axes.seed.range.step", "a step that leads from 3 to 1, found 1"),
    ("a range without end", "    seed: { range: { from: 0, to: 1e300 } }\n", 22, "sweep.axes.seed.range", "at most 1000000 values"),
    ("text in a range", "    seed: { range: { from: a, to: 1 } }\n", 22, "sweep.axes.seed.range.from", "a number"),
    ("infinity in a range", "    seed: { range: { from: 0, to: .inf } }\n", 22, "sweep.axes.seed.range.to", "finite"),
    ("a logarithm of zero", "    time.end_s: { log: { from: 0, to: 1, count: 3 } }\n", 22, "sweep.axes.time.end_s.log.from", "greater than 0, found 0"),
    ("no count", "    time.end_s: { log: { from: 1, to: 2 } }\n", 22, "sweep.axes.time.end_s.log.count", "missing"),
    ("a count of zero", "    time.end_s: { linear: { from: 1, to: 2, count: 0 } }\n", 22, "sweep.axes.time.end_s.linear.count", "at least 1"),
    ("one value for two ends", "    time.end_s: { linear: { from: 1, to: 2, count: 1 } }\n", 22, "sweep.axes.time.end_s.linear.count", "at least 2"),
    ("a value twice", "    seed:\n      - 1\n      - 2\n      - 1.0\n", 25, "sweep.axes.seed.2", "`1.0` is on this axis twice (items 0 and 2)"),
    ("a label twice", "    seed:\n      - { label: a, value: 1 }\n      - { label: a, value: 2 }\n", 24, "sweep.axes.seed.1", "`a` is on this axis twice"),
    ("a label without value", "    seed: [{ label: a }]\n", 22, "sweep.axes.seed.0.value", "missing"),
    ("a label and more", "    seed: [{ label: a, value: 1, colour: 2 }]\n", 22, "sweep.axes.seed.0.colour", "unknown key"),
    ("a path of the sweep", "    sweep.axes: [1]\n", 22, "sweep.axes.sweep.axes", "outside of `sweep`, `expect`, `bench`"),
    ("a path of the expectations", "    expect.0: [1]\n", 22, "sweep.axes.expect.0", "outside of `sweep`, `expect`, `bench`"),
    ("a path of the bench", "    bench: [1]\n", 22, "sweep.axes.bench", "outside of `sweep`, `expect`, `bench`"),
    ("an empty segment", "    scene..friction: [1]\n", 22, "sweep.axes.scene..friction", "expected a path such as"),
    ("one value, two axes", "    scene.bodies.0.mass_kg: [1]\n    scene.bodies.cube.mass_kg: [1]\n", 23, "sweep.axes.scene.bodies.cube.mass_kg", "the axis `scene.bodies.0.mass_kg` varies the same value"),
    ("a group of unequal lengths", "    seed: [1, 2]\n    time.end_s: [1, 2, 3]\n  together: [[seed, time.end_s]]\n", 24, "sweep.together.0", "axes of the same length, found 2 of seed, 3 of time.end_s"),
    ("a group of an unknown axis", "    seed: [1, 2]\n    time.end_s: [1, 2]\n  together:\n    - [seed, time.end]\n", 25, "sweep.together.0.1", "did you mean `time.end_s`?"),
    ("an axis in two groups", "    seed: [1, 2]\n  together: [[seed], [seed]]\n", 23, "sweep.together.1.0", "`seed` is named twice"),
    ("too many cases", "    seed: { range: { from: 1, to: 100000 } }\n    time.end_s: { range: { from: 1, to: 100000 } }\n", 21, "sweep.axes", "at most 1000000000 cases, found 100000 × 100000"),
];

#[test]
fn a_bad_axis_is_refused_with_its_line_and_what_was_expected() {
    for (what, lines, line, path, fragment) in BAD {
        let error = file(&swept(lines), &[]).expect_err(what);
        let text = error.to_string();
        assert_eq!(
            (error.details().line, error.details().path.to_string().as_str()),
            (Some(*line), *path),
            "{what}: {text}"
        );
        assert!(text.contains(fragment), "{what}: {text}");
    }
}

/// What is wrong, the lines below `axes:`, the point of the case, and the whole message.
const BAD_CASES: &[(&str, &str, &[usize], &str)] = &[
    (
        "a bad value in a list",
        "    scene.friction:\n      - 0\n      - -1\n",
        &[1],
        "a.yaml:24: scene.friction: expected a number of at least 0, found -1 (from the axis scene.friction = -1)",
    ),
    (
        "a bad value in a range",
        "    seed: [1]\n    method.lecture.sweeps: { range: { from: 0, to: 3 } }\n",
        &[0, 0],
        "a.yaml:23: method.lecture.sweeps: expected a whole number of at least 1, found 0 \
         (from the axis method.lecture.sweeps = 0)",
    ),
    (
        "an unknown key",
        "    scene.fricton: [0]\n",
        &[0],
        "a.yaml:22: scene.fricton: unknown key; did you mean `friction`? (known here: gravity_m_s2, friction, \
         restitution, container, bodies, pairs, pins, forces, air, random, allow_overlap) (from the axis scene.fricton = 0)",
    ),
    (
        "an unknown body",
        "    scene.bodies.cubo.mass_kg: [1]\n",
        &[0],
        "a.yaml:22: scene.bodies.cubo: no such item; did you mean `cube`? (known here: cube, point) \
         (from the axis scene.bodies.cubo.mass_kg = 1)",
    ),
    (
        "a slip in a labelled subtree",
        "    scene.bodies.cube.mesh: [{ label: fine, value: { nodes_per_edg: 9 } }]\n",
        &[0],
        "a.yaml:22: scene.bodies.cube.mesh.nodes_per_edg: unknown key; did you mean `nodes_per_edge`? \
         (known here: nodes_per_edge, subdivisions) (from the axis scene.bodies.cube.mesh = fine)",
    ),
    (
        "a value that does not fit the rest",
        "    seed: [4]\n    scene.restitution: [0.5]\n    method: [lecture, { penalty: { stiffness_n_m: 1 } }]\n",
        &[0, 0, 1],
        "a.yaml:23: scene.restitution: expected 0, as the method `penalty` has no restitution \
         (`damping_n_s_m` dissipates), found 0.5 (from the axis scene.restitution = 0.5)",
    ),
];

#[test]
fn a_bad_case_names_the_axis_its_value_and_its_line() {
    for (what, lines, point, message) in BAD_CASES {
        let error = file(&swept(lines), &[]).unwrap().case(point).expect_err(what);
        assert_eq!(error.to_string(), *message, "{what}");
        assert!(error.details().axis.is_some(), "{what}");
    }
}

#[test]
fn an_error_that_only_some_cases_have_names_the_case() {
    let text = swept("    seed: [4]\n    method: [free, lecture]\n").replace("      mesh: { nodes_per_edge: 3 }\n", "");
    let text = text.replace("method: lecture", "method: free");
    let file = file(&text, &[]).unwrap();
    file.case(&[0, 0]).unwrap();
    let error = file.case(&[0, 1]).unwrap_err().to_string();
    assert!(error.starts_with("a.yaml:7: scene.bodies.cube.mesh: missing"), "{error}");
    assert!(error.ends_with(" (in the case seed = 4, method = lecture)"), "{error}");
}

#[test]
fn an_error_that_all_cases_have_names_none() {
    let text = swept("    seed: [4]\n").replace("mass_kg: 1.0", "mass_kg: 0");
    let error = file(&text, &[]).unwrap().case(&[0]).unwrap_err();
    assert_eq!(error.to_string(), "a.yaml:10: scene.bodies.cube.mass_kg: expected a number greater than 0, found 0");
}

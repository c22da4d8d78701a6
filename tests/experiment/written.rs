//! What was read is written, and read as the same.

use super::{BASE, file, flagged, swept};
use crate::tidy::files;
use gotai::case::Case;
use gotai::experiment::types::Experiment;
use gotai::experiment::{ExperimentFile, to_yaml};
use proptest::prelude::*;
use serde_json::Map;
use std::path::Path;

fn read(text: &str) -> ExperimentFile {
    ExperimentFile::from_text(Path::new("b.yaml"), text, &[]).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// All bits: −0 and 0 differ.
fn bits(experiment: &Experiment) -> String {
    serde_json::to_string(experiment).unwrap()
}

/// At most so many, evenly through the grid.
fn cases(file: &ExperimentFile, most: usize) -> Vec<Experiment> {
    let len = file.axes().len();
    let every = len.div_ceil(most);
    let case = |i| {
        let point = file.axes().point(i);
        match file.search() {
            None => file.case(&point).unwrap(),
            Some(search) => file.searched_case(&point, &search.between[1]).unwrap(),
        }
    };
    (0..len).step_by(every).map(case).collect()
}

fn assert_written(file: &ExperimentFile, what: &str) {
    let text = file.written();
    let again = read(&text);
    assert_eq!(again.axes(), file.axes(), "{what}");
    assert_eq!(again.search(), file.search(), "{what}");
    assert_eq!(again.expect(), file.expect(), "{what}");
    assert_eq!(again.bench(), file.bench(), "{what}");
    assert_eq!(again.written(), text, "{what}");
    let [old, new] = [file, &again].map(|file| cases(file, 300));
    assert_eq!(old.len(), new.len());
    for (old, new) in old.iter().zip(&new) {
        assert_eq!(bits(old), bits(new), "{what}");
        let [old, new] = [old, new].map(|case| Case::new(case.clone(), Map::new()).id);
        assert_eq!(old, new, "{what}");
    }
    numbers_are_numbers(&text);
}

fn assert_resolved(experiment: &Experiment, what: &str) {
    let text = to_yaml(experiment);
    let again = read(&text).experiment().unwrap_or_else(|error| panic!("{what}: {error}\n{text}"));
    assert_eq!(bits(&again), bits(experiment), "{what}");
    numbers_are_numbers(&text);
}

/// A float of YAML 1.1: with a dot, and a sign before its exponent.
fn is_plain_float(text: &str) -> bool {
    let (digits, exponent) = text.split_once('e').unwrap_or((text, "+1"));
    let is_number = |text: &str| !text.is_empty() && text.chars().all(|c| c.is_ascii_digit());
    let is_mantissa = digits.trim_start_matches('-').split_once('.').is_some_and(|(a, b)| is_number(a) && is_number(b));
    is_mantissa && exponent.starts_with(['+', '-']) && is_number(&exponent[1..])
}

fn numbers_are_numbers(text: &str) {
    let scalars = text.lines().map(|line| line.rsplit_once(": ").map_or(line, |(_, value)| value));
    for scalar in scalars.map(|scalar| scalar.trim_start_matches(['-', ' '])) {
        let is_whole = scalar.parse::<i128>().is_ok();
        let is_number = scalar.starts_with(|c: char| c.is_ascii_digit()) && scalar.parse::<f64>().is_ok();
        assert!(!is_number || is_whole || is_plain_float(scalar), "{scalar}");
    }
}

#[test]
fn every_config_is_written_and_read_as_the_same() {
    for config in files("configs", "yaml") {
        let file = ExperimentFile::load(&config, &[]).unwrap();
        assert_written(&file, &config.display().to_string());
    }
}

#[test]
fn every_case_of_every_config_is_written_and_read_as_the_same() {
    for config in files("configs", "yaml") {
        let file = ExperimentFile::load(&config, &[]).unwrap();
        cases(&file, 200).iter().for_each(|case| assert_resolved(case, &config.display().to_string()));
    }
}

#[test]
fn what_flags_change_is_written_too() {
    let text = swept("    seed: [1, 2]\n    scene.friction: [0.1, 0.2]\n  together: [[seed, scene.friction]]\n")
        + "expect: [{ column: steps, min: 1 }]\nbench: { repeats: 2 }\nquestion: why?\n";
    for flags in [
        &["seed=3"][..],
        &["--axis seed=0..1", "--axis time.step_s={ log: { from: 1e-5, to: 1e-1, count: 4 } }"],
        &["sweep.together=[]", "--axis seed=0..4", "scene.friction=1e-7"],
        &["sweep=null"],
        &["scene.container={ plane: { normal: [0, 1, 0] } }", "diverge.speed_m_s=1e20", "expect=[]"],
        &["sweep.axes.scene.bodies.cube.mesh=[{ label: 1e-5, value: { nodes_per_edge: 4 } }]"],
        &["sweep.axes.scene.bodies.cube.mesh=[{ label: '1e-5', value: { nodes_per_edge: 4 } }, { nodes_per_edge: 5 }]"],
        &["method={ penalty: { stiffness_n_m: 1e16 } }", "record.cases={ sample: 3 }", "seed=18446744073709551615"],
    ] {
        match flagged(&text, flags) {
            Ok(file) => assert_written(&file, &flags.join(" ")),
            Err(error) => assert!(error.to_string().contains("text (in quotes)"), "{error}"),
        }
    }
    let file = flagged(&text, &["seed=3", "limits.steps=9"]).unwrap();
    assert!(!file.written().contains("- seed"), "{}", file.written());
    assert!(file.written().ends_with("limits:\n  steps: 9\n"), "keys that are new come last: {}", file.written());
}

#[test]
fn merges_are_written_out() {
    let text = BASE.replace("mass_kg: 0.5", "<<: { mass_kg: 0.5, position_m: [0, 3, 0] }");
    let file = file(&text, &[]).unwrap();
    assert!(!file.written().contains("<<"), "{}", file.written());
    assert_written(&file, "a merge");
}

#[test]
fn numbers_are_numbers_to_every_reader_and_texts_stay_texts() {
    let question = "as is:\n- 1e-5\n- [2e16, scalar0q]\n\n  scalar1q1e-5: 3e300\n";
    let json = serde_json::to_string(question).unwrap();
    let text = format!("{BASE}diverge: {{ speed_m_s: 1e-7, penetration_m: 2.5e300 }}\nquestion: {json}\n");
    let file = file(&text, &["limits={ wall_s: 1e16 }"]).unwrap();
    for written in [file.written(), to_yaml(&file.experiment().unwrap())] {
        let part = |part: &str| assert!(written.contains(part), "{part}\n{written}");
        ["speed_m_s: 1.0e-7\n", "penetration_m: 2.5e+300\n", "wall_s: 1.0e+16\n"].into_iter().for_each(part);
        ["  - 1e-5\n", "  - [2e16, scalar0q]\n", "    scalar1q1e-5: 3e300\n"].into_iter().for_each(part);
        assert_eq!(read(&written).experiment().unwrap().question.as_deref(), Some(question));
    }
    for name in ["1e-5", "1.0e-5", "12", "1_000", "1:30", "0x1F", "0o7", "012", "2024-01-02", "yes", "Off", "+1", "-.5"]
    {
        // A dot is no part of a body's name.
        let text = format!("{BASE}question: '{name}'\n");
        let file = super::file(&text, &[]).unwrap();
        assert!(file.written().contains(&format!("question: '{name}'")), "{}", file.written());
        assert_written(&file, name);
        assert_resolved(&file.experiment().unwrap(), name);
    }
}

#[test]
fn copies_are_read_by_the_names_they_have() {
    let copies = |copies: &str| BASE.replace("shape: none", &format!("shape: none\n      copies: {copies}"));
    for (form, last) in [
        ("{ count: 11, step_m: [0, 0.1, 0] }", "point[10]"),
        ("{ grid: [2, 1, 3], step_m: [0.1, 1, -0.7] }", "point[1,0,2]"),
    ] {
        let text = copies(form) + "diverge: { speed_m_s: 1 }\n";
        let experiment = file(&text, &[]).unwrap().experiment().unwrap();
        assert_eq!(experiment.scene.bodies.last().unwrap().name, last);
        assert_resolved(&experiment, form);
    }
    let loaded = copies("{ count: 2, step_m: [1, 0, 0] }").replace(
        "seed: 7",
        "  pairs: [{ between: [cube, 'point[1]'], friction: 0.5 }]\n  forces: [{ body: 'point[0]', force_n: [1, 0, 0] }]\nseed: 7",
    );
    assert_resolved(&file(&loaded, &[]).unwrap().experiment().unwrap(), "names elsewhere");
}

#[test]
fn a_number_behind_a_name_is_that_of_a_copy() {
    let named = |name: &str, more: &str| {
        let text = BASE.replace("name: point", &format!("name: '{name}'{more}"));
        file(&text, &[]).unwrap().experiment().map(|_| ())
    };
    for name in ["stack[0]", "pile[0,0,1]", "a b[12]"] {
        named(name, "").unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    for name in
        ["stack[]", "stack[00]", "stack[-1]", "stack[0,1]", "[0]", "stack[0", "stack[0][1]", "container[0]", "s.t[0]"]
    {
        assert!(named(name, "").unwrap_err().details().path.to_string().ends_with(".name"), "{name}");
    }
    let copies = "\n      copies: { count: 2, step_m: [1, 0, 0] }";
    assert!(named("stack[0]", copies).is_err(), "copies of a copy");
    // What a copy is called is taken.
    let twin = BASE.replace("name: cube", &format!("name: cube{copies}")).replace("name: point", "name: 'cube[1]'");
    let error = file(&twin, &[]).unwrap().experiment().unwrap_err().to_string();
    assert!(error.contains("expected a name of its own, found `cube[1]`, which item 0"), "{error}");
}

#[test]
fn a_normalised_quaternion_is_read_bit_for_bit() {
    let mut state = 7_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut bodies = Vec::new();
    for i in 0..20_000 {
        let scale = [1.0, 3e7, 1e-300, 1e300, 1e-8][i % 5];
        let small = [1.0, 1e-4, 1e-9, 1e-160][i / 5 % 4];
        let q = [draw() * scale, draw() * small * scale, draw() * scale, draw() * small * scale];
        bodies.push(format!("{{ name: b{i}, shape: none, mass_kg: 1, orientation: {{ quaternion_xyzw: {q:?} }} }}"));
    }
    let text =
        format!("scene: {{ bodies: [{}] }}\ntime: {{ step_s: 0.1, end_s: 1 }}\nmethod: free\n", bodies.join(", "));
    let first = read(&text).experiment().unwrap();
    assert_resolved(&first, "quaternions");
    for body in &first.scene.bodies {
        let q = body.orientation.unwrap().quaternion_xyzw.unwrap();
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((length - 1.0).abs() < 4.0 * f64::EPSILON, "{q:?}");
    }
}

/// What YAML is made of, numbers, and anything else.
fn piece() -> impl Strategy<Value = String> {
    let pieces = [
        "- ", ": ", "#", "'", "\"", "\n", " ", "1e-5", "scalar0q", "2", ".", "0x", "|", "\t", "e", "+", "&a", "~", "é",
    ];
    prop_oneof![prop::sample::select(pieces.to_vec()).prop_map(String::from), any::<char>().prop_map(String::from)]
}

proptest! {
    #[test]
    fn any_text_and_number_is_read_as_it_was(
        pieces in prop::collection::vec(piece(), 0..9),
        x in any::<f64>().prop_filter("finite", |x| x.is_finite()),
    ) {
        let question = serde_json::to_string(&pieces.concat()).unwrap();
        // What no file can hold is not asked for.
        let gravity = format!("scene.gravity_m_s2=[{x:?}, 1, 2]");
        if let Ok(file) = file(&format!("{BASE}question: {question}\n"), &[&gravity]) {
            let experiment = file.experiment().unwrap();
            prop_assert_eq!(bits(&read(&file.written()).experiment().unwrap()), bits(&experiment));
            prop_assert_eq!(bits(&read(&to_yaml(&experiment)).experiment().unwrap()), bits(&experiment));
            prop_assert_eq!(experiment.scene.gravity_m_s2[0].to_bits(), x.to_bits());
        }
    }
}

//! What cannot be compared is refused before the first run, with its line and key.

use super::SPIN;
use gotai::bench;
use gotai::experiment::{ExperimentError, ExperimentFile};
use std::path::Path;

fn error(text: &str, sets: &[String]) -> ExperimentError {
    match ExperimentFile::from_text(Path::new("test.yaml"), text, sets) {
        Ok(file) => bench::plan(&file, file.bench().unwrap()).err().unwrap(),
        Err(error) => error,
    }
}

/// From, to, line, path, what the message says.
const ROWS: &[(&str, &str, usize, &str, &str)] = &[
    ("2e-2, 1e-2", "0, 1e-2", 10, "bench.steps_s.1", "expected a number greater than 0, found 0"),
    ("2e-2, 1e-2", "4e-2, 1e-2", 10, "bench.steps_s.1", "expected every number once, found 0.04"),
    ("2e-2, 1e-2", "1e-14", 10, "bench.steps_s.1", "a step that needs at most"),
    ("[1e-6, 1e-9]", "[1e-6, 1e-16]", 11, "bench.tolerances.1", "at least 1e-15"),
    ("[1e-6, 1e-9]", "[-1]", 11, "bench.tolerances.0", "greater than 0, found -1"),
    ("repeats: 2", "repeats: 0", 13, "bench.repeats", "at least 1, found 0"),
    ("repeats: 2", "repeat: 2", 13, "bench.repeat", "did you mean `repeats`?"),
    ("error_orientation_rad", "error_orientatoin_rad", 12, "bench.error", "did you mean `error_orientation_rad`?"),
    ("error_orientation_rad", "outcome", 12, "bench.error", "which is text"),
    ("exact: free-motion\n", "", 11, "bench.error", "expected `exact:` or `reference:` in the experiment"),
    ("integrator: rk4 }", "integrator: rk5 }", 9, "bench.methods.1.free.integrator", "did you mean `rk4`?"),
    (
        "integrator: exact",
        "integrater: exact",
        9,
        "bench.methods.3.value.free.integrater",
        "did you mean `integrator`?",
    ),
    (
        "integrator: rk4 }",
        "integrator: rk4, tolerance: 1 }",
        9,
        "bench.methods.1.free.tolerance",
        "does not control its error",
    ),
    (
        "integrator: rk4 }",
        "integrator: dop853 }",
        9,
        "bench.methods.2",
        "a label of its own, found `free dop853`, which item 1",
    ),
    ("time.step_s: [", "seed: [", 7, "sweep.axes", "axes are left: seed; fix each of them"),
];

#[test]
fn a_bad_bench_is_refused_with_its_line_its_key_path_and_what_was_expected() {
    for (from, to, line, path, fragment) in ROWS {
        assert!(SPIN.contains(from), "{from}");
        let error = error(&SPIN.replacen(from, to, 1), &[]);
        let (details, text) = (error.details(), error.to_string());
        assert_eq!((details.line, details.path.to_string().as_str()), (Some(*line), *path), "{text}");
        assert!(text.contains(fragment) && !error.is_machine(), "{text}");
    }
}

#[test]
fn nothing_to_compare_is_an_error_of_the_set() {
    let error = error(SPIN, &["bench.methods=[]".to_string()]);
    assert_eq!(
        error.to_string(),
        "--set bench.methods=[]: bench.methods: expected at least one method, found an empty list"
    );
}

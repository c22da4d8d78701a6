//! Warnings and notes: one line a command on stderr, the same in JSON and in recordings, and no other exit code.

use super::{json, run};
use crate::scratch;
use gotai::rows::doubts::{doubt, signs};
use serde_json::{Value, json};
use std::path::Path;

/// A heavy box slides on a light one; one sweep a step does not solve that.
const PILE: &str = "
question: Is a heavy box on a light one solved?
scene:
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: low, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0] }
    - name: top
      shape: { box: { size_m: [1, 1, 1] } }
      mass_kg: 30
      position_m: [0.2, 1.5, 0]
      velocity_m_s: [1, 0, 0]
method: { time-stepping: { solver: pgs, sweeps: 1 } }
time: { step_s: 0.01, end_s: 0.1 }
";

/// A cube with a mesh, which `lecture` and `penalty` need, falls a little.
const CUBE: &str = "
question: What does a method that claims nothing say?
scene:
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - name: cube
      shape: { box: { size_m: [1, 1, 1] } }
      mesh: { nodes_per_edge: 3 }
      mass_kg: 1
      position_m: [0, 0.51, 0]
      velocity_m_s: [2, -1, 0]
method: lecture
time: { step_s: 0.01, end_s: 0.2 }
";

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_string()
}

/// Lines of stderr that begin with this word.
fn lines<'a>(err: &'a str, word: &str) -> Vec<&'a str> {
    err.lines().filter(|line| line.starts_with(word)).collect()
}

fn row(cells: Value) -> serde_json::Map<String, Value> {
    cells.as_object().unwrap().clone()
}

#[test]
fn a_doubt_is_said_of_one_case_and_of_many() {
    let one = [row(json!({ "work_unsolved": 300, "residual_max": 0.8123, "passed_through": 0 }))];
    let said = doubt(&one, 1).unwrap();
    assert_eq!(said.said, "the run is not solved (work_unsolved 300, residual_max 0.81)");
    assert_eq!(said.columns, ["work_unsolved", "residual_max"]);
    let many = [
        one[0].clone(),
        row(json!({ "work_unsolved": 2, "residual_max": 1e-9, "passed_through": 2, "ghost_impulse_max_rel": 0.5 })),
        row(json!({ "work_unsolved": 0, "residual_max": 3.14e-6, "passed_through": 1 })),
    ];
    assert_eq!(
        doubt(&many, 40).unwrap().said,
        "3 of 40 cases are not solved (work_unsolved up to 300, residual_max up to 0.81), 1 has impulses where nothing \
         touches (ghost_impulse_max_rel up to 0.5), 2 pass through bodies (passed_through up to 2)"
    );
    let ghost = [row(json!({ "ghost_impulse_max_rel": 2e-6 }))];
    assert_eq!(
        doubt(&ghost, 1).unwrap().said,
        "the run has impulses where nothing touches (ghost_impulse_max_rel 2e-6)"
    );
    let through = [row(json!({ "passed_through": 1, "residual_max": 1e-3 }))];
    let said = doubt(&through, 1).unwrap().said;
    assert_eq!(said, "the run is not solved (residual_max 0.001), passes through bodies (passed_through 1)");
}

#[test]
fn what_is_small_null_or_not_there_is_no_doubt() {
    let sound = json!({ "work_unsolved": 0, "residual_max": 1e-6, "ghost_impulse_max_rel": null, "steps": 10 });
    for cells in [sound, json!({}), json!({ "residual_max": null, "passed_through": 0, "ghost_impulse_max_rel": 1e-6 })]
    {
        assert!(signs(&row(cells.clone())).is_empty(), "{cells}");
        assert_eq!(doubt(&[row(cells)], 1), None);
    }
}

#[test]
fn a_run_that_is_not_solved_warns_in_one_line_and_exits_with_0() {
    let folder = scratch::folder();
    let config = write(folder.path(), "pile.yaml", PILE);
    let out = folder.path().join("out");
    let args = ["run", &config, "--record", "none", "--out", out.to_str().unwrap()];
    let (code, text, err) = run(&args);
    assert_eq!(code, 0, "{text}{err}");
    let said = lines(&err, "warning: ");
    assert_eq!((said.len(), lines(&err, "note: ").len()), (1, 0), "{err}");
    assert!(said[0].starts_with("warning: the run is not solved (work_unsolved "), "{err}");
    let rows = out.join("rows.csv");
    let place = format!("): see the columns work_unsolved, residual_max in {}", rows.display());
    assert!(said[0].ends_with(&place), "{err}");
    // Quiet, and beside a document, which has the same line.
    let (code, text, quiet) = run(&[&args[..], &["--quiet", "--json"]].concat());
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((code, &document["notes"]), (0, &json!([])));
    assert_eq!(document["warnings"], json!([said[0].strip_prefix("warning: ").unwrap()]));
    assert_eq!(lines(&quiet, "warning: "), said);
    // A row once more.
    let case = document["case"].as_str().unwrap();
    let (code, _, err) = run(&["run", out.to_str().unwrap(), "--case", case, "--record", "none"]);
    assert_eq!((code, lines(&err, "warning: the run is not solved (work_unsolved ").len()), (0, 1), "{err}");
    // The same scene, solved.
    let solved = json(&[&args[..], &["--json", "--set", "method.time-stepping={ solver: newton }"]].concat());
    assert_eq!((&solved["warnings"], &solved["notes"]), (&json!([]), &json!([])), "{solved}");
}

#[test]
fn a_method_that_does_not_claim_to_solve_gives_a_note_that_quiet_silences() {
    let folder = scratch::folder();
    let config = write(folder.path(), "cube.yaml", CUBE);
    let args = ["run", &config, "--record", "none", "--out", folder.path().to_str().unwrap()];
    let (code, _, err) = run(&args);
    assert_eq!(
        (code, lines(&err, "warning: ").len(), lines(&err, "note: the run is not solved").len()),
        (0, 0, 1),
        "{err}"
    );
    let (code, text, err) = run(&[&args[..], &["--quiet", "--json"]].concat());
    assert_eq!((code, err.as_str()), (0, ""));
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["warnings"], json!([]));
    assert!(document["notes"][0].as_str().unwrap().starts_with("the run is not solved (residual_max "), "{document}");
}

#[test]
fn a_sweep_warns_once_for_all_its_cases_and_counts_them() {
    let folder = scratch::folder();
    let axes =
        "sweep: { axes: { method: [lecture, { time-stepping: { solver: pgs, sweeps: 1 } }], seed: [0, 1, 2] } }\n";
    let text = CUBE.replace("method: lecture\n", "") + axes;
    write(folder.path(), "a.yaml", &text);
    write(folder.path(), "b.yaml", &(PILE.to_string() + "sweep: { axes: { seed: [0, 1] } }\n"));
    let out = folder.path().join("out");
    let args = ["sweep", folder.path().to_str().unwrap(), "--record", "none", "--out", out.to_str().unwrap()];
    let (code, text, err) = run(&args);
    assert_eq!(code, 0, "{text}{err}");
    let (warnings, notes) = (lines(&err, "warning: "), lines(&err, "note: "));
    assert_eq!((warnings.len(), notes.len()), (1, 1), "{err}");
    assert!(notes[0].starts_with("note: 3 of 8 cases are not solved (residual_max up to "), "{err}");
    assert!(warnings[0].contains(" of 8 cases are not solved (work_unsolved up to "), "{err}");
    assert!(warnings[0].contains(&format!(" in {}", out.join("a/rows.csv").display())), "{err}");
    // Rows that are there already are looked at again; each file's document has its own.
    let (code, text, again) = run(&[&args[..], &["--json"]].concat());
    assert_eq!((code, again.as_str()), (0, err.as_str()));
    let documents: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(documents[0]["notes"].as_array().unwrap().len(), 1, "{documents}");
    assert_eq!(documents[1]["notes"], json!([]));
    let pile = documents[1]["warnings"][0].as_str().unwrap();
    assert!(pile.starts_with("2 of 2 cases are not solved (work_unsolved up to "), "{pile}");
    assert!(pile.ends_with(&out.join("b/rows.csv").display().to_string()), "{pile}");
}

#[test]
fn a_check_warns_of_cases_and_of_bounds_on_one_side_and_judges_as_before() {
    let folder = scratch::folder();
    let expect = "expect:
  - column: energy_drift_rel
    max: 1e3
  - { column: energy_balance_rel, quantile: 0.5, above: -1e3 }
  - { fraction: { column: energy_drift_rel, below: 1e3 }, min: 1 }
  # None of these is on one side of a signed column by mistake.
  - { column: energy_drift_rel, within: 1e3 }
  - { column: energy_drift_rel, min: -1e3, max: 1e3 }
  - { column: energy_drift_rel, quantile: 0, max: 1e3, min: -1e3 }
  - { column: energy_rise_max_rel, max: 1e3 }
  - { column: steps, min: 0 }
";
    let config = write(folder.path(), "pile.yaml", &(PILE.to_string() + expect));
    let (out, junit) = (folder.path().join("out"), folder.path().join("junit.xml"));
    let args = ["check", &config, "--out", out.to_str().unwrap(), "--junit", junit.to_str().unwrap()];
    let (code, text, err) = run(&args);
    assert_eq!(code, 0, "{text}{err}");
    let said = lines(&err, "warning: ");
    assert_eq!(said.len(), 2, "{err}");
    assert!(said[0].starts_with("warning: the run is not solved"), "{err}");
    // Of the key, whose item may begin above it.
    let places = [3, 4, 5].map(|below| format!("{config}:{}", PILE.lines().count() + below));
    let expected = format!(
        "warning: energy_drift_rel and energy_balance_rel are signed: `max` alone passes any loss, `above` alone \
         passes any gain, `below` alone passes any loss; `within:` bounds both sides ({})",
        places.join(", ")
    );
    assert_eq!(said[1], expected);
    assert!(text.contains("pile.yaml: 1 case, 1 run now") && text.contains(": 8 met\n"), "{text}");
    assert!(!std::fs::read_to_string(&junit).unwrap().contains("warning"));
    let document = json(&[&args[..], &["--json", "--quiet"]].concat());
    assert_eq!((&document["met"], document["warnings"].as_array().unwrap().len()), (&json!(true), 2));
    assert_eq!(document["warnings"][1].as_str(), expected.strip_prefix("warning: "));
}

#[test]
fn a_bound_that_says_something_is_gained_or_lost_is_no_mistake() {
    let folder = scratch::folder();
    let expect = "expect:
  - { column: energy_drift_rel, min: 1e-3, why: nothing is lost here }
  - { column: energy_drift_rel, max: -1e-3 }
  - { difference: energy_drift_rel, of: { steps: 10 }, to: { steps: 10 }, max: 1 }
";
    let config = write(folder.path(), "pile.yaml", &(PILE.to_string() + expect));
    let (code, _, err) = run(&["check", &config, "--out", folder.path().to_str().unwrap()]);
    assert_eq!((code, err.contains("signed")), (1, false), "{err}");
    // What was set is named as the flag, and many are counted.
    let set = "expect=[{ column: energy_drift_rel, max: 1e3 }]";
    let (code, _, err) = run(&["check", &config, "--out", folder.path().to_str().unwrap(), "--set", set]);
    assert_eq!(code, 0, "{err}");
    assert!(err.contains(&format!("bounds both sides (--set {set})")), "{err}");
    let many = "  - { column: energy_drift_rel, max: 1e3 }\n".repeat(8);
    let config = write(folder.path(), "many.yaml", &format!("{PILE}expect:\n{many}"));
    let (_, _, err) = run(&["check", &config, "--out", folder.path().join("many").to_str().unwrap()]);
    assert!(err.contains("`max` alone passes any loss; `within:`") && err.contains(" and 2 more)"), "{err}");
}

#[test]
fn a_bench_warns_once_and_each_row_of_its_document_has_its_own() {
    let folder = scratch::folder();
    let bench = "bench:
  methods:
    - { label: one, value: { time-stepping: { solver: pgs, sweeps: 1 } } }
    - { label: exact, value: { time-stepping: { solver: newton } } }
  steps_s: [0.01]
  error: energy_drift_rel
  repeats: 1
";
    let config = write(folder.path(), "pile.yaml", &(PILE.to_string() + bench));
    let (code, text, err) = run(&["bench", &config, "--json", "--out", folder.path().to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    let said = lines(&err, "warning: ");
    assert!(
        said.len() == 1 && said[0].starts_with("warning: 1 of 2 cases is not solved (work_unsolved up to "),
        "{err}"
    );
    let rows: Value = serde_json::from_str(&text).unwrap();
    assert!(rows[0]["warnings"][0].as_str().unwrap().starts_with("the run is not solved"), "{rows}");
    // A sound row has the columns alone.
    assert!(rows[1].get("warnings").is_none() && rows[1].get("notes").is_none(), "{rows}");
}

#[test]
fn a_recording_says_what_is_in_doubt() {
    let folder = scratch::folder();
    for (name, text, field, other) in [("pile", PILE, "warnings", "notes"), ("cube", CUBE, "notes", "warnings")] {
        let config = write(folder.path(), &format!("{name}.yaml"), text);
        let out = folder.path().join(name);
        let d = json(&["run", &config, "--record", "mcap", "--out", out.to_str().unwrap(), "--json"]);
        let said = d[field][0].as_str().unwrap().split(": see").next().unwrap();
        let file = out.join(format!("{}.mcap", d["recording"].as_str().unwrap()));
        let bytes = std::fs::read(file).unwrap();
        let summary = mcap::read::Summary::read(&bytes).unwrap().unwrap();
        let metadata = mcap::read::metadata(&bytes, summary.metadata_indexes.last().unwrap()).unwrap();
        assert_eq!((metadata.name.as_str(), metadata.metadata[field].as_str()), ("gotai", said));
        assert!(!metadata.metadata.contains_key(other));
        let logged = mcap::MessageStream::new(&bytes).unwrap().map(Result::unwrap);
        let logged = logged.filter(|message| message.channel.topic == "/log");
        assert!(logged.last().unwrap().data.windows(said.len()).any(|part| part == said.as_bytes()));
    }
}

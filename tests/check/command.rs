//! `gotai check` as a CI meets it.

use crate::cli::run;
use crate::scratch;
use serde_json::Value;
use std::path::Path;

const FALL: &str = "
question: How far does a ball fall?
scene:
  bodies: [{ name: ball, shape: none, mass_kg: 1, position_m: [0, 0, 0] }]
method: free
time: { step_s: 0.01, end_s: 1 }
measure: [state]
sweep: { axes: { time.step_s: [0.1, 0.05, 0.025], scene.bodies.ball.mass_kg: [1, 2] } }
expect:
  - { column: ball.position_m.y, max: -4.9, why: semi-implicit Euler falls farther }
  - { equal: ball.position_m, across: scene.bodies.ball.mass_kg, why: Galilei }
";

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_string()
}

#[test]
fn all_met_is_exit_code_0_and_a_table() {
    let folder = scratch::folder();
    let config = write(folder.path(), "fall.yaml", FALL);
    let out = folder.path().join("out");
    let (code, text, err) = run(&["check", &config, "--out", out.to_str().unwrap()]);
    assert_eq!(code, 0, "{text}{err}");
    for part in
        ["fall.yaml: 6 cases, 6 run now", "met", "≤ -4.9", "Galilei", "2 of 2 expectations met in 1 experiments"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    // Rows are kept, nothing is recorded, and nothing is done twice.
    assert!(out.join("rows.csv").exists());
    let recorded = std::fs::read_dir(&out).unwrap().any(|e| e.unwrap().path().extension().is_some_and(|e| e == "mcap"));
    assert!(!recorded);
    let (_, text, _) = run(&["check", &config, "--out", out.to_str().unwrap()]);
    assert!(text.contains("6 cases, 0 run now"), "{text}");
}

#[test]
fn one_not_met_is_exit_code_1_in_json_and_junit() {
    let folder = scratch::folder();
    let config = write(folder.path(), "fall.yaml", &format!("{FALL}  - {{ column: ball.position_m.y, min: -5.0 }}\n"));
    let (out, junit) = (folder.path().join("out"), folder.path().join("junit.xml"));
    let args = ["check", &config, "--json", "--junit", junit.to_str().unwrap(), "--out", out.to_str().unwrap()];
    let (code, text, err) = run(&args);
    assert_eq!(code, 1, "{err}");
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(document["met"], false);
    let verdicts = document["expectations"].as_array().unwrap();
    let keys = ["experiment", "expectation", "bound", "measured", "verdict", "why"];
    assert!(verdicts.iter().all(|verdict| keys.iter().all(|key| verdict.get(key).is_some())));
    let said: Vec<_> = verdicts.iter().map(|verdict| verdict["verdict"].as_str().unwrap()).collect();
    assert_eq!(said, ["met", "met", "not met"]);
    // −½ g t² − ½ g Δt t: −5.39 … −5.0225
    assert!(verdicts[2]["measured"].as_str().unwrap().starts_with("-5.39 … -5.023"), "{}", verdicts[2]);
    let junit = std::fs::read_to_string(junit).unwrap();
    assert!(junit.contains("tests=\"3\"") && junit.contains("failures=\"1\""), "{junit}");
    assert!(junit.contains("<failure message=\"expected ≥ -5, measured -5.39"), "{junit}");
}

#[test]
fn a_folder_is_checked_but_for_files_without_expectations() {
    let folder = scratch::folder();
    write(folder.path(), "a.yaml", FALL);
    write(folder.path(), "b.yaml", &FALL.replace("-4.9", "-4.8"));
    let none = write(folder.path(), "none.yaml", FALL.split("expect:").next().unwrap());
    let out = folder.path().join("out");
    let (code, text, err) = run(&["check", folder.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    assert!(text.contains("4 of 4 expectations met in 2 experiments") && !text.contains("none.yaml"), "{text}");
    assert!(out.join("a/rows.csv").exists() && out.join("b/rows.csv").exists());
    let (code, text, err) = run(&["check", &none]);
    assert_eq!((code, text.as_str()), (2, ""), "{err}");
    assert!(err.contains("none.yaml: expect: missing: nothing to check"), "{err}");
}

#[test]
fn several_files_do_not_share_a_folder_of_results() {
    let folder = scratch::folder();
    let a = write(folder.path(), "a.yaml", FALL);
    let b = write(folder.path(), "b.yaml", &FALL.replace("-4.9", "-4.8"));
    let out = folder.path().join("out");
    let (code, _, err) = run(&["check", &a, &b, "--out", out.to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    assert!(out.join("a/rows.csv").exists() && out.join("b/rows.csv").exists());
}

#[test]
fn an_unknown_name_is_exit_code_2_before_anything_runs() {
    let folder = scratch::folder();
    write(folder.path(), "a.yaml", FALL);
    let config = write(folder.path(), "b.yaml", &FALL.replace("across: scene.bodies.ball.mass_kg", "across: mass"));
    let out = folder.path().join("out");
    let (code, text, err) = run(&["check", folder.path().to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!((code, text.as_str()), (2, ""), "{err}");
    assert!(err.contains(&format!("{config}:11: expect.1.across: expected one of time.step_s")), "{err}");
    assert!(!out.exists());
}

#[test]
fn a_search_is_checked_like_any_other_sweep() {
    let folder = scratch::folder();
    let axes = "sweep: { axes: { time.step_s: [0.1, 0.05, 0.025], scene.bodies.ball.mass_kg: [1, 2] } }";
    let search = "sweep: { axes: { scene.bodies.ball.mass_kg: [1, 2] }, search: { critical: time.end_s, between: [0.5, 5], until: { column: ball.position_m.y, below: -10 }, relative_width: 1e-4 } }";
    // ½ g t (t + Δt) = 10 at t = 1.4236 s, to the whole step that has passed it.
    let text = FALL.split("expect:").next().unwrap().replace(axes, search);
    let text = format!(
        "{text}expect:\n  - {{ column: search_high, min: 1.42, max: 1.44 }}\n  - {{ fraction: {{ column: search_runs, above: 2 }}, min: 1 }}\n"
    );
    let config = write(folder.path(), "search.yaml", &text);
    let (code, text, err) = run(&["check", &config, "--out", folder.path().join("out").to_str().unwrap()]);
    assert_eq!(code, 0, "{text}{err}");
    let rows = std::fs::read_to_string(folder.path().join("out/rows.csv")).unwrap();
    assert!(rows.lines().next().unwrap().contains("search_low,search_high,search_runs,search_verdict"), "{rows}");
    assert_eq!(rows.matches(",found,").count(), 2, "{rows}");
    let (code, text, _) = run(&["explain", &config]);
    assert!(code == 0 && text.starts_with("2 cases, at most "), "{text}");
}

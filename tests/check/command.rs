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
    // A line an experiment, and the sum.
    assert_eq!(text.lines().count(), 2, "{text}");
    assert!(text.starts_with("met      ") && text.contains("fall.yaml: 6 cases, 6 run now, "), "{text}");
    assert!(text.ends_with(" s: 2 met\n2 of 2 expectations met in 1 experiment\n"), "{text}");
    // All verdicts, if one wants to see them; nothing where all is well and nobody does.
    let (_, text, _) = run(&["check", &config, "--out", out.to_str().unwrap(), "-v"]);
    for part in ["met", "≤ -4.9", "Galilei"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let (code, text, err) = run(&["check", &config, "--out", out.to_str().unwrap(), "--quiet"]);
    assert_eq!((code, text.as_str(), err.as_str()), (0, "", ""));
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
    assert!(text.contains("; 1 file without `expect:` left out\n"), "{text}");
    let (code, text, err) = run(&["check", &none]);
    assert_eq!((code, text.as_str()), (2, ""), "{err}");
    assert!(err.contains("none.yaml: expect: missing: nothing to check"), "{err}");
    // A slip in the word leaves nothing out in silence; what lacks what its heirs bring is no slip.
    write(folder.path(), "base.yaml", "question: What is common?\nmethod: free\n");
    let slip = write(folder.path(), "slip.yaml", &FALL.replace("expect:", "expects:"));
    let given = folder.path().to_str().unwrap();
    for args in [["check", given, "--out", out.to_str().unwrap()], ["check", &slip, "--out", out.to_str().unwrap()]] {
        let (code, text, err) = run(&args);
        assert!(code == 2 && err.contains("slip.yaml:9: expects: unknown key") && err.lines().count() == 1, "{err}");
        assert_eq!(text.contains("2 files without `expect:` left out"), args[1] == given, "{text}");
    }
}

#[test]
fn words_of_a_file_turn_no_terminal_around() {
    let folder = scratch::folder();
    // Conceal, clear, a bell, a title, the other way round; a control of one byte.
    let why = r#""\e[8mhid\e[2J\a\e]0;title\a \u202e back \x9b1A end""#;
    let text = FALL.replace("max: -4.9", "max: -40").replace("semi-implicit Euler falls farther", why);
    let config = write(folder.path(), "fall.yaml", &text);
    let out = folder.path().join("out");
    for flags in [&[][..], &["-v"], &["--color", "always"]] {
        let (code, text, err) = run(&[&["check", &config, "--out", out.to_str().unwrap()], flags].concat());
        assert_eq!(code, 1, "{err}");
        // The colours of the program, if they are asked for, are all that is left.
        let own =
            ["\u{1b}[1;31m", "\u{1b}[2m", "\u{1b}[0m"].iter().fold(text.clone(), |text, own| text.replace(own, ""));
        assert!(!own.chars().any(|c| (c.is_control() && c != '\n') || c == '\u{202e}'), "{own:?}");
        assert_eq!(text.contains('\u{1b}'), flags.contains(&"always"), "{text:?}");
        assert!(text.contains("why: [8mhid[2J]0;title  back 1A end") || flags.contains(&"-v"), "{text:?}");
    }
    // Data are whole, and escaped.
    let (_, text, _) = run(&["check", &config, "--out", out.to_str().unwrap(), "--json"]);
    assert!(!text.trim_end().chars().any(|c| c.is_control() || c == '\u{202e}'), "{text:?}");
    let document: Value = serde_json::from_str(&text).unwrap();
    let kept = document["expectations"][0]["why"].as_str().unwrap();
    assert_eq!(kept, "\u{1b}[8mhid\u{1b}[2J\u{7}\u{1b}]0;title\u{7} \u{202e} back \u{9b}1A end");
    // So are errors.
    let wrong = write(folder.path(), "wrong.yaml", "\"\\e[2Jkey\": 1\n");
    let (code, _, err) = run(&["check", &wrong]);
    assert!(code == 2 && err.contains("key") && !err.contains('\u{1b}'), "{err:?}");
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
    let config = write(folder.path(), "b.yaml", &FALL.replace("across: scene.bodies.ball.mass_kg", "across: mass"));
    let (out, junit) = (folder.path().join("out"), folder.path().join("junit.xml"));
    let args = ["check", &config, "--out", out.to_str().unwrap(), "--junit", junit.to_str().unwrap()];
    let (code, text, err) = run(&args);
    assert_eq!((code, text.as_str()), (2, ""), "{err}");
    assert!(err.contains(&format!("{config}:11: expect.1.across: expected one of time.step_s")), "{err}");
    assert!(!out.exists());
    // A CI sees why, too.
    let junit = std::fs::read_to_string(junit).unwrap();
    assert!(junit.contains("errors=\"1\"") && junit.contains("expect.1.across: expected one of"), "{junit}");
}

/// The exit code is that of the file that went worst.
#[test]
fn one_bad_file_does_not_stop_the_others() {
    let folder = scratch::folder();
    write(folder.path(), "a.yaml", FALL);
    write(folder.path(), "b.yaml", &FALL.replace("across: scene.bodies.ball.mass_kg", "across: mass"));
    write(folder.path(), "c.yaml", &FALL.replace("max: -4.9", "max: -5.3"));
    let (out, junit) = (folder.path().join("out"), folder.path().join("junit.xml"));
    let of = |more: &[&str]| {
        let args = ["check", folder.path().to_str().unwrap(), "--out", out.to_str().unwrap()];
        run(&[&args[..], more].concat())
    };
    let (code, text, err) = of(&["--junit", junit.to_str().unwrap()]);
    assert_eq!(code, 2, "{err}");
    assert!(text.contains("3 of 4 expectations met in 2 experiments; 1 file could not be checked"), "{text}");
    assert!(err.contains("b.yaml:11: expect.1.across") && !err.contains("c.yaml"), "{err}");
    let junit = std::fs::read_to_string(junit).unwrap();
    assert_eq!(junit.matches("<testsuite ").count(), 3, "{junit}");
    assert!(junit.contains("tests=\"5\"") && junit.contains("failures=\"1\" errors=\"1\""), "{junit}");
    let (_, text, _) = of(&["--json"]);
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&document["met"], &document["exit_code"]), (&Value::from(false), &Value::from(2)));
    assert!(document["errors"][0]["error"].as_str().unwrap().contains("expect.1.across"), "{document}");
    // A machine that fails is worse still, and a path that is not there is wrong input.
    let lock = std::fs::File::open(out.join("a/journal.jsonl")).unwrap();
    lock.lock().unwrap();
    let (code, text, err) = of(&[]);
    assert_eq!(code, 3, "{err}");
    assert!(err.contains("another gotai is at work here") && text.contains("c.yaml: 6 cases"), "{text}{err}");
    drop(lock);
    let a = folder.path().join("a.yaml");
    let (code, text, _) = run(&["check", a.to_str().unwrap(), "no/such.yaml", "--out", out.to_str().unwrap()]);
    assert!(code == 2 && text.contains("a.yaml: 6 cases"), "{text}");
    // One after the other, no file after one that went wrong.
    let (code, text, _) = of(&["--fail-fast", "--json"]);
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((code, document["left_out"].as_array().unwrap().len()), (2, 2), "{document}");
}

/// What is not met says of which cases, what was measured there, and how to see it.
#[test]
fn what_is_not_met_points_at_its_cases() {
    let folder = scratch::folder();
    let unmet = "  - { column: ball.position_m.y, min: -5.2, where: { scene.bodies.ball.mass_kg: 2 } }\n";
    let config = write(folder.path(), "fall.yaml", &format!("{FALL}{unmet}record: {{ cases: failing }}\n"));
    let (out, junit) = (folder.path().join("out dir"), folder.path().join("junit.xml"));
    let dir = out.to_str().unwrap();
    let args = ["check", &config, "--out", dir, "--junit", junit.to_str().unwrap()];
    let document = |more: &[&str]| -> Value {
        let (code, text, err) = run(&[&args[..], &["--json"], more].concat());
        assert_eq!(code, 1, "{err}");
        serde_json::from_str(&text).unwrap()
    };
    let recordings = || {
        let names = std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.filter(|name| name.ends_with(".mcap")).collect::<Vec<_>>()
    };
    let found = document(&[]);
    let named = &found["expectations"][2];
    // −½ g (t² + Δt t): −5.39, −5.145, −5.0225
    assert_eq!((named["failing_count"].as_u64(), recordings().len()), (Some(1), 0), "{named}");
    let case = &named["failing"][0];
    assert_eq!((case["axes"]["time.step_s"].as_f64(), case["column"].as_str()), (Some(0.1), Some("ball.position_m.y")));
    assert!((case["value"].as_f64().unwrap() + 5.39).abs() < 1e-12, "{case}");
    assert!(found["expectations"][0]["failing"].as_array().unwrap().is_empty());
    // The command that is said runs it again, bit for bit.
    let id = case["case"].as_str().unwrap();
    assert_eq!(case["command"], format!("gotai run '{dir}' --case {}", &id[..8]), "{case}");
    let (code, _, err) = run(&["run", dir, "--case", &id[..8], "--record", "none"]);
    assert!(code == 0 && err.contains("the same as the row, bit for bit"), "{err}");
    // It alone is recorded, after all rows are there, and the words on the screen and in JUnit say where.
    let kept = document(&["--record", "mcap"]);
    let files = recordings();
    assert!(files.len() == 1 && files[0].contains(&id[..8]), "{files:?}");
    let said = kept["expectations"][2]["failing"][0]["recordings"][0].as_str().unwrap().to_string();
    assert!(said.ends_with(&files[0]), "{said}: {files:?}");
    assert_eq!(kept["experiments"][0]["ran"], 0);
    let (_, text, _) = run(&args);
    let place = format!("{}  ball.position_m.y = -5.39, at time.step_s = 0.1, ", &id[..8]);
    for part in ["expected ≥ -5.2, measured -5.39", &place, &format!("gotai run '{dir}' --case"), &files[0]] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let junit = std::fs::read_to_string(junit).unwrap();
    for part in ["ball.position_m.y = -5.39, at time.step_s = 0.1", &files[0], "timestamp=\"20", "time=\""] {
        assert!(junit.contains(part), "{part}: {junit}");
    }
    assert_eq!(junit.matches("<testcase ").count(), 3);
}

/// 24 cases of an expectation are named, the worst first, and as many recorded.
#[test]
fn of_many_failing_cases_the_worst_are_named() {
    let folder = scratch::folder();
    let config = write(
        folder.path(),
        "fall.yaml",
        &FALL
            .replace("time.step_s: [0.1, 0.05, 0.025]", "seed: { range: { from: 0, to: 39 } }")
            .replace("max: -4.9", "max: -9, quantile: 0.5"),
    );
    let out = folder.path().join("out");
    let sets = ["--set", "record.cases=failing", "--record", "mcap", "--jobs", "2"];
    let args = ["check", &config, "--out", out.to_str().unwrap(), "--json", "--progress", "json"];
    let (code, text, err) = run(&[&args[..], &sets].concat());
    assert_eq!(code, 1, "{err}");
    let document: Value = serde_json::from_str(&text).unwrap();
    let unmet = &document["expectations"][0];
    assert_eq!((unmet["failing_count"].as_u64(), unmet["failing"].as_array().unwrap().len()), (Some(80), 24));
    let recordings = std::fs::read_dir(&out)
        .unwrap()
        .filter(|e| e.as_ref().unwrap().path().extension().is_some_and(|e| e == "mcap"));
    assert_eq!(recordings.count(), 24);
    // What a program reads of the progress.
    let events: Vec<Value> = err.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
    let of = |event: &str| events.iter().filter(|e| e["event"] == event).count();
    assert_eq!((of("begin"), of("case"), of("end")), (2, 80, 2), "{err}");
    let last = events.iter().rfind(|e| e["event"] == "case").unwrap();
    assert_eq!((&last["total"], &last["finished"], &last["failed"]), (&80.into(), &80.into(), &0.into()), "{last}");
    // On the screen six, and how many more.
    let (_, text, _) = run(&["check", &config, "--out", out.to_str().unwrap(), "--set", "record.cases=failing"]);
    assert!(text.contains("… and 74 more"), "{text}");
}

/// Colour where it is asked for, and no letter more or less.
#[test]
fn colour_is_asked_for_and_lines_fit_80_columns() {
    let folder = scratch::folder();
    let config = write(folder.path(), "fall.yaml", &FALL.replace("max: -4.9", "max: -5.2"));
    let out = folder.path().join("out");
    let of = |more: &[&str], columns: &str| {
        let mut command = crate::cli::gotai(&["check", "fall.yaml", "--out", "out", "-v"]);
        let output = command.args(more).current_dir(folder.path()).env("COLUMNS", columns).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{config} {out:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    assert!(of(&["--color", "always"], "80").contains("\u{1b}[1;31mNOT MET\u{1b}[0m"));
    for never in [&["--color", "never"][..], &["--color", "auto"], &[]] {
        let text = of(never, "80");
        assert!(!text.contains('\u{1b}'), "{text}");
        let widest = text.lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(80), "{text}");
    }
    assert!(of(&[], "120").lines().any(|line| line.chars().count() > 80));
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

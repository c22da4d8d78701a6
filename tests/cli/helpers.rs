//! Commands that help: `new`, `schema`, `completions`, `doctor`.

use super::{gotai, json, run};
use crate::scratch;
use crate::tidy::files;
use serde_json::Value;
use std::process::Command;

#[test]
fn a_new_experiment_is_one_that_is_checked() {
    let folder = scratch::folder();
    let of = |args: &[&str]| {
        let output = gotai(args).current_dir(folder.path()).output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    let (code, said, err) = of(&["new", "mine"]);
    assert_eq!((code, err.as_str()), (Some(0), ""));
    assert!(said.contains("wrote mine.yaml") && said.contains("gotai check mine.yaml"), "{said}");
    let (code, said, err) = of(&["check", "mine.yaml", "--set", "time.end_s=0.1"]);
    assert!(code == Some(0) && said.contains("3 met"), "{said}{err}");
    assert!(err.is_empty(), "{err}");
    // Nothing is written over, and a template that is not there is named beside those that are.
    let (code, _, err) = of(&["new", "mine.yaml"]);
    assert!(code == Some(2) && err.contains("mine.yaml: expected a new name, found a file"), "{err}");
    let (code, _, err) = of(&["new", "other", "--from", "pille"]);
    assert!(code == Some(2) && err.contains("did you mean `pile`?"), "{err}");
    let known = err.split_once("(known: ").unwrap().1.trim_end().trim_end_matches(')').to_string();
    for template in known.split(", ") {
        let name = format!("deep/{template}");
        let (code, _, err) = of(&["new", &name, "--from", template]);
        assert_eq!(code, Some(0), "{err}");
        let (code, _, err) = of(&["explain", &format!("{name}.yaml")]);
        assert_eq!(code, Some(0), "{template}: {err}");
    }
}

#[test]
fn every_shell_has_completions_of_every_command() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let (code, said, err) = run(&["completions", shell]);
        assert_eq!((code, err.as_str()), (0, ""), "{shell}");
        for word in ["sweep", "check", "compare", "--junit", "--fail-on-regression"] {
            let word = if shell == "fish" { word.trim_start_matches('-') } else { word };
            assert!(said.contains(word), "{shell}: {word}");
        }
    }
    assert_eq!(run(&["completions", "nonsense"]).0, 2);
    // A shell takes them.
    let folder = scratch::folder();
    let script = folder.path().join("gotai.bash");
    std::fs::write(&script, run(&["completions", "bash"]).1).unwrap();
    let line = format!(
        "source {}; COMP_WORDS=(gotai com); COMP_CWORD=1; _gotai gotai com gotai; echo \"${{COMPREPLY[@]}}\"",
        script.display()
    );
    let output = Command::new("bash").args(["-c", &line]).output().unwrap();
    assert_eq!(String::from_utf8(output.stdout).unwrap().trim(), "compare completions");
}

#[test]
fn the_doctor_says_what_is_there_and_what_is_not() {
    let folder = scratch::folder();
    std::fs::write(folder.path().join("file"), vec![0; 4321]).unwrap();
    let dir = folder.path().to_str().unwrap();
    let found = json(&["doctor", dir, "--json"]);
    assert_eq!(found["used_bytes"], 4321);
    assert!(found["free_bytes"].as_u64().unwrap() > 0 && found["cores"].as_u64().unwrap() > 0, "{found}");
    assert_eq!(found["writes"].as_array().unwrap().len(), if cfg!(feature = "rerun") { 2 } else { 1 });
    // Without any program on the PATH neither viewer nor Slurm, and no error.
    let output = gotai(&["doctor", "no/such/folder"]).env("PATH", dir).env_remove("GOTAI_VIEWER").output().unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success());
    assert!(said.contains("viewer  no Rerun Viewer") && said.contains("slurm   no Slurm"), "{said}");
}

/// The part of a schema that a value has to hold to, for the few words that ours has.
fn faults(schema: &Value, value: &Value, at: &str) -> Vec<String> {
    if let Some(kinds) = schema["anyOf"].as_array() {
        let all: Vec<Vec<String>> = kinds.iter().map(|kind| faults(kind, value, at)).collect();
        return all.into_iter().min_by_key(Vec::len).unwrap();
    }
    let mut found = Vec::new();
    let is_kind = match schema["type"].as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("number") => value.is_number(),
        Some("integer") => value.as_f64().is_some_and(|x| x.fract() == 0.0),
        Some("boolean") => value.is_boolean(),
        Some("null") => value.is_null(),
        Some(other) => panic!("{other}"),
        None => true,
    };
    if !is_kind || schema["enum"].as_array().is_some_and(|words| !words.contains(value)) {
        found.push(format!("{at}: {value} is not {}", schema["type"]));
    }
    for (key, value) in value.as_object().into_iter().flatten() {
        match schema["properties"].get(key) {
            Some(below) => found.extend(faults(below, value, &format!("{at}.{key}"))),
            None if schema["additionalProperties"] == false => found.push(format!("{at}.{key}: unknown key")),
            None => {}
        }
    }
    for (i, item) in value.as_array().into_iter().flatten().enumerate() {
        found.extend(faults(&schema["items"], item, &format!("{at}[{i}]")));
    }
    let items = value.as_array().map_or(0, Vec::len) as u64;
    if schema["minItems"].as_u64().is_some_and(|n| items < n) || schema["maxItems"].as_u64().is_some_and(|n| items > n)
    {
        found.push(format!("{at}: {items} items"));
    }
    found
}

fn read(text: &str) -> Value {
    let mut value: serde_yaml::Value = serde_yaml::from_str(text).unwrap();
    value.apply_merge().unwrap();
    serde_json::to_value(value).unwrap()
}

#[test]
fn the_schema_takes_every_experiment_and_no_slip() {
    let schema = json(&["schema"]);
    for key in ["scene", "method", "time", "sweep", "expect", "bench", "record", "extends"] {
        assert!(schema["properties"].get(key).is_some(), "{key}");
    }
    for config in files("configs", "yaml") {
        let found = faults(&schema, &read(&std::fs::read_to_string(&config).unwrap()), "");
        assert!(found.is_empty(), "{}: {found:#?}", config.display());
    }
    let good = std::fs::read_to_string(format!("{}/configs/start.yaml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    for (from, to) in [
        ("friction: 0.3", "fricton: 0.3"),
        ("friction: 0.3", "friction: much"),
        ("method: time-stepping", "method: time-steping"),
        ("method: time-stepping", "method: { lecture: { sweep: 3 } }"),
        ("size_m: [0.6, 0.4, 0.5]", "size_m: [0.6, 0.4]"),
        ("cases: few", "cases: fewer"),
        ("end_s: 2", "end: 2"),
        ("{ fraction: {", "{ fractions: {"),
    ] {
        assert!(good.contains(from), "{from}");
        let found = faults(&schema, &read(&good.replace(from, to)), "");
        assert!(!found.is_empty(), "{to} passes");
    }
    let settings = read(&good.replace("method: time-stepping", "method: { lecture: { sweeps: 3, start: direct } }"));
    assert!(faults(&schema, &settings, "").is_empty());
}

//! The program as a user meets it: output, files, exit codes.

mod helpers;
mod left;
mod remarks;
mod results;
mod slips;

use crate::scratch;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

pub fn gotai(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_gotai"));
    command.args(args).current_dir(ROOT).env("NO_COLOR", "1");
    command
}

pub fn run(args: &[&str]) -> (i32, String, String) {
    let Output { status, stdout, stderr } = gotai(args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (status.code().unwrap(), text(stdout), text(stderr))
}

pub fn json(args: &[&str]) -> Value {
    let (code, out, err) = run(args);
    assert_eq!(code, 0, "{err}");
    serde_json::from_str(&out).unwrap_or_else(|error| panic!("{error}: {out}"))
}

#[test]
fn a_run_prints_its_columns_bodies_and_contacts() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let d = json(&["run", "configs/lecture/demo.yaml", "--out", out, "--json", "--set", "time.end_s=3"]);
    assert_eq!(
        (d["outcome"].as_str(), d["steps"].as_u64(), &d["criterion"]),
        (Some("finished"), Some(1500), &Value::Null)
    );
    let body = &d["bodies"][0];
    assert_eq!(body["name"], "cube");
    for key in ["position_m", "origin_m", "velocity_m_s", "angular_velocity_rad_s", "contact_force_n"] {
        assert_eq!(body[key].as_array().unwrap().len(), 3, "{key}");
    }
    // At rest on its face: the contacts carry the weight.
    let force = |c: &Value| c["force_n"][1].as_f64().unwrap();
    let contacts = d["contacts"].as_array().unwrap();
    assert_eq!(contacts[0]["bodies"], serde_json::json!(["cube", "container"]));
    let carried: f64 = contacts.iter().map(force).sum();
    assert!((carried - 9.8).abs() < 1e-6 && (body["contact_force_n"][1].as_f64().unwrap() - carried).abs() < 1e-9);
    // One file a target, called after the configuration, the outcome and the id.
    let name = d["recording"].as_str().unwrap();
    assert_eq!(name, format!("demo_finished.{}", &d["case"].as_str().unwrap()[..8]));
    assert!(folder.path().join(format!("{name}.mcap")).exists());
    assert_eq!(folder.path().join(format!("{name}.rrd")).exists(), cfg!(feature = "rerun"));
}

#[test]
fn nothing_is_recorded_when_nothing_is_asked_for() {
    let folder = scratch::folder();
    let out = folder.path().join("none");
    run(&["run", "configs/lecture/demo.yaml", "--record", "none", "--out", out.to_str().unwrap()]);
    let mut files: Vec<_> =
        std::fs::read_dir(out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    files.sort();
    assert_eq!(files, ["experiment.yaml", "journal.jsonl", "plan.json", "rows.csv", "rows.parquet"]);
}

#[test]
fn wrong_input_is_exit_code_2_and_one_clear_line() {
    let folder = scratch::folder();
    let bad = folder.path().join("bad.yaml");
    std::fs::write(&bad, "scene:\n  fricton: 0.3\n  bodies: []\n").unwrap();
    let bad = bad.to_str().unwrap();
    let demo = "configs/lecture/demo.yaml";
    let cases: [(&[&str], &str); 10] = [
        (&["run", bad], "bad.yaml:2: scene.fricton: unknown key; did you mean `friction`?"),
        (&["run", "no/such.yaml"], "no/such.yaml: "),
        (&["run", demo, "--set", "scene.bodies.cube.mass_kg=-1"], "--set scene.bodies.cube.mass_kg=-1: "),
        (&["run", demo, "--set", "time.step_s=0"], "expected"),
        (&["run", "configs/lecture/stability.yaml"], "axes are left: scene.bodies.body, time.step_s, seed"),
        (&["sweep", demo, "--jobs", "0"], "--jobs: expected at least 1, found 0"),
        (&["status", folder.path().to_str().unwrap()], "found no plan.json in it"),
        (&["check", demo], "expect: missing: nothing to check"),
        (&["bench", demo], "bench: missing: nothing to compare"),
        (&["sweep", demo, "--shard", "0/2"], "`--shard` is not available in this version"),
    ];
    for (args, message) in cases {
        let (code, out, err) = run(args);
        assert_eq!((code, out.as_str()), (2, ""), "{args:?}: {err}");
        assert!(err.contains(message) && err.trim_end().lines().count() == 1, "{args:?}: {err}");
        assert!(!err.contains("panicked"), "{err}");
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_exit_code_3() {
    let folder = scratch::folder();
    let file = folder.path().join("file");
    std::fs::write(&file, "").unwrap();
    let below = file.join("below");
    let (code, _, err) = run(&["sweep", "configs/smoke.yaml", "--out", below.to_str().unwrap()]);
    assert_eq!(code, 3, "{err}");
    assert!(err.contains("below"), "{err}");
}

#[test]
fn a_sweep_writes_rows_and_recordings_and_status_counts_them() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let args = ["sweep", "configs/smoke.yaml", "--out", out, "--json", "--set", "time.end_s=0.2"];
    let d = json(&args);
    assert_eq!((d["cases"].as_u64(), d["ran"].as_u64()), (Some(4), Some(4)));
    for row in d["rows"].as_array().unwrap() {
        let (name, case) = (row["recording"].as_str().unwrap(), row["case"].as_str().unwrap());
        let values = format!("{}_finished.{}", row["method"].as_str().unwrap(), &case[..8]);
        assert!(name == values && folder.path().join(format!("{name}.mcap")).exists(), "{name}: {values}");
    }
    for name in ["plan.json", "rows.csv", "rows.parquet"] {
        assert!(folder.path().join(name).exists(), "{name}");
    }
    assert_eq!(json(&args)["ran"], 0);
    let status = json(&["status", out, "--json"]);
    assert_eq!(status["missing"], 0);
    // The same rows somewhere else, another time; and other rows.
    let again = scratch::folder();
    let hash = |sets: &[&str]| {
        let out = again.path().join(sets.len().to_string());
        let out = out.to_str().unwrap();
        let args: Vec<_> = [&args[..3], &[out, "--set", "time.end_s=0.2"], sets].concat();
        assert_eq!(run(&args).0, 0);
        json(&["status", out, "--json"])["rows_hash"].clone()
    };
    assert_eq!(hash(&[]), status["rows_hash"]);
    assert_ne!(hash(&["--set", "scene.friction=0.31"]), status["rows_hash"]);
    // A row taken away is missing: exit code 1.
    let journal = folder.path().join("journal.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap();
    std::fs::write(&journal, text.lines().skip(1).map(|line| format!("{line}\n")).collect::<String>()).unwrap();
    let (code, said, _) = run(&["status", out]);
    assert_eq!(code, 1);
    assert!(said.contains("\n3 of 4 done, 1 missing, 0 failed\n"), "{said}");
}

/// Two methods, say, leave two tables.
#[test]
fn what_is_set_is_in_the_name_of_the_folder() {
    let folder = scratch::folder();
    let config = format!("{ROOT}/configs/smoke.yaml");
    let long = format!("time.end_s=0.1{}", "0".repeat(90));
    for sets in [
        &[][..],
        &["time.end_s=0.1"],
        &["time.end_s=0.1", "question=why?", "record.every_s=0", "method={lecture: {sweeps: 9}}"],
        &[&long],
    ] {
        let mut command = gotai(&["sweep", &config, "--record", "none", "--quiet"]);
        for set in sets {
            command.args(["--set", set]);
        }
        let output = command.current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{sets:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let made = std::fs::read_dir(folder.path().join("recordings")).unwrap();
    let mut made: Vec<_> = made.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    made.sort();
    let long = made.pop().unwrap();
    assert_eq!(made, ["smoke", "smoke+time.end-s=0.1", "smoke+time.end-s=0.1+method=-lecture---sweeps--9--"]);
    let (kept, hash) = long.split_once('~').unwrap();
    assert!(kept.starts_with("smoke+time.end-s=0.1000") && (kept.len(), hash.len()) == (65, 8), "{long}");
}

#[test]
fn a_folder_of_configs_is_swept_file_by_file() {
    let folder = scratch::folder();
    let configs = folder.path().join("configs/deep");
    std::fs::create_dir_all(&configs).unwrap();
    for name in ["a.yaml", "b.yaml"] {
        std::fs::copy(Path::new(ROOT).join("configs/smoke.yaml"), configs.join(name)).unwrap();
    }
    let mut command = gotai(&["sweep", "configs", "--record", "none", "--set", "time.end_s=0.1"]);
    let output = command.current_dir(folder.path()).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    for name in ["a", "b"] {
        let rows = format!("recordings/deep/{name}+time.end-s=0.1/rows.csv");
        assert!(folder.path().join(&rows).exists(), "{rows}");
    }
}

#[test]
fn an_interrupted_sweep_keeps_what_is_finished_and_goes_on_later() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    const SEEDS: &str = "sweep.axes.seed=[0, 1]";
    let long = [
        "sweep",
        "configs/lecture/friction.yaml",
        "--out",
        out,
        "--record",
        "none",
        "--set",
        "time.step_s=2e-4",
        "--set",
        "time.end_s=1",
        "--set",
        SEEDS,
    ];
    let mut child = gotai(&long).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    let journal = folder.path().join("journal.jsonl");
    let started = Instant::now();
    let lines = || std::fs::read_to_string(&journal).map_or(0, |text| text.lines().count());
    while lines() < 3 && started.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let kept = lines();
    assert!((3..84).contains(&kept), "{kept}");
    let rows = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    assert_eq!(rows.lines().count(), kept + 1);
    let rest = json(&[&long[..], &["--json"]].concat());
    assert_eq!(rest["ran"].as_u64(), Some(84 - kept as u64));
}

#[test]
fn explain_says_what_runs_and_what_it_costs() {
    let d = json(&["explain", "configs/lecture/stability.yaml", "--json"]);
    assert_eq!(
        (d["cases"].as_u64(), d["steps"].as_u64()),
        (Some(840), Some(140 * (4000 + 2000 + 800 + 400 + 200 + 80)))
    );
    assert!(d["estimated_cpu_s"].as_f64().unwrap() > 0.0);
    let (_, text, _) = run(&["explain", "configs/projectile.yaml"]);
    assert!(text.contains("contact test: skipped — `free` is motion without contact"), "{text}");
}

#[test]
fn lists_are_the_parsers_own() {
    // From its error message.
    let known = |set: &str| -> Vec<String> {
        let said = run(&["run", "configs/lecture/demo.yaml", "--set", set]).2;
        let (_, words) = said.split_once("expected one of ").unwrap_or_else(|| panic!("{said}"));
        words.split(", found").next().unwrap().split(", ").map(str::to_string).collect()
    };
    for (what, set) in [
        ("methods", "method=nonsense"),
        ("shapes", "scene.bodies.cube.shape=nonsense"),
        ("exact", "exact=nonsense"),
        ("measures", "measure=[nonsense]"),
    ] {
        let lines = json(&["list", what, "--json"]);
        let names: Vec<&str> = lines.as_array().unwrap().iter().map(|line| line["name"].as_str().unwrap()).collect();
        assert_eq!(names, known(set), "{what}");
    }
}

#[test]
fn listed_settings_and_defaults_are_those_of_the_method() {
    let methods = json(&["list", "methods", "--json"]);
    let setting = |method: &str, name: &str| -> Value {
        let of =
            |list: &Value, name: &str| list.as_array().unwrap().iter().find(|l| l["name"] == name).unwrap().clone();
        of(&of(&methods, method)["settings"], name)
    };
    assert_eq!(setting("lecture", "sweeps")["default"]["is"], 50);
    assert_eq!(setting("lecture", "cone")["default"]["is"], "disc");
    assert_eq!(setting("lecture", "start")["takes"]["words"].as_array().unwrap().len(), 4);
    assert_eq!(setting("penalty", "stiffness_n_m")["default"], "needed");
    assert_eq!(setting("penalty", "slip_speed_m_s")["default"]["is"], 0.01);
    assert_eq!(setting("time-stepping", "relaxation")["default"]["is"], 1.0);
    assert_eq!(setting("time-stepping", "sweeps")["default"]["is"], "its own (pgs: 50, nncg: 50, newton: 500)");
}

#[test]
fn listed_columns_are_those_of_a_table() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let args = ["sweep", "configs/smoke.yaml", "--out", out, "--record", "none", "--quiet", "--set", "time.end_s=0.01"];
    assert_eq!(run(&args).0, 0);
    let rows = std::fs::read_to_string(folder.path().join("rows.csv")).unwrap();
    let (head, axis) = (rows.lines().next().unwrap(), "method");
    let lines = json(&["list", "columns", "--json"]);
    let every = lines.as_array().unwrap().iter().filter(|line| line["of"].is_null());
    let every: Vec<&str> = every.map(|line| line["name"].as_str().unwrap()).collect();
    assert_eq!(head.split(',').filter(|name| *name != axis).collect::<Vec<_>>(), every);
}

#[test]
fn a_reference_is_kept_beside_the_results_even_if_nothing_is_recorded() {
    let folder = scratch::folder();
    let config = folder.path().join("spin.yaml");
    let text = "
scene: { bodies: [{ name: top, shape: none, mass_kg: 1, velocity_m_s: [1, 2, 0] }] }
method: free
time: { step_s: 0.1, end_s: 1 }
reference: {}
bench: { methods: [free, event-driven], steps_s: [0.1, 0.05], repeats: 1 }
expect: [{ column: error_position_m, max: 0.5 }]
";
    std::fs::write(&config, text).unwrap();
    let (config, out) = (config.to_str().unwrap(), folder.path().join("out"));
    let out = out.to_str().unwrap();
    let references = || -> Vec<_> {
        let all = std::fs::read_dir(out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        all.filter(|name| name.starts_with("reference-")).collect()
    };
    let d = json(&["run", config, "--out", out, "--record", "none", "--json"]);
    let made = references();
    assert_eq!(made.len(), 1);
    // Semi-implicit Euler in a fall of a second: ½ g h. measured: 0.49
    assert!((d["error_position_m"].as_f64().unwrap() - 0.49).abs() < 1e-9 && d["reference_until_s"] == 1.0, "{d}");
    assert_eq!(json(&["explain", config, "--json"])["references"], 1);
    // Sweep, check and bench read the same one.
    json(&["sweep", config, "--out", out, "--record", "none", "--json"]);
    json(&["check", config, "--out", out, "--json"]);
    let rows = json(&["bench", config, "--out", out, "--json"]);
    assert!((rows[1]["error"].as_f64().unwrap() - 0.245).abs() < 1e-9, "{rows}");
    assert_eq!(references(), made);
}

//! Slips of who types a command, and what the program says of them and of itself.

use super::{gotai, json, run};
use crate::scratch;
use std::path::Path;

const FALL: &str = "
question: How far does a ball fall?
scene:
  bodies: [{ name: ball, shape: none, mass_kg: 1, position_m: [0, 1, 0] }]
method: free
time: { step_s: 0.01, end_s: 1 }
measure: [state]
sweep: { axes: { time.step_s: [0.1, 0.05, 0.025], scene.bodies.ball.mass_kg: [1, 2] } }
expect:
  - { column: ball.position_m.y, max: 0, where: { time.step_s: 0.05 } }
  - { equal: ball.position_m, across: scene.bodies.ball.mass_kg }
";

fn write(folder: &Path, name: &str, text: &str) -> String {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_string()
}

/// Without --out too, of files and of a folder; and where endings alone tell two files apart.
#[test]
fn files_of_one_name_have_folders_of_their_own() {
    let folder = scratch::folder();
    let config = |name: &str, mass: &str| write(folder.path(), name, &FALL.replace("mass_kg: [1, 2]", mass));
    let of = [("sd/a/box.yaml", "mass_kg: [3, 4]"), ("sd/b/box.yaml", "mass_kg: [5, 6]")];
    let files = of.map(|(name, mass)| config(name, mass));
    let has = |dir: &str, mass: &str| {
        let rows = std::fs::read_to_string(folder.path().join(dir).join("rows.csv")).unwrap_or_default();
        assert!(rows.contains(&format!(",{mass},")) && rows.lines().count() == 7, "{dir}: {rows}");
    };
    let runs = |args: &[&str]| {
        let output = gotai(args).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{args:?}: {}", String::from_utf8_lossy(&output.stderr));
    };
    runs(&["check", &files[0], &files[1], "--out", "out"]);
    runs(&["check", &files[0], &files[1]]);
    runs(&["sweep", "sd", "--record", "none"]);
    for dir in ["out/a/box", "recordings/a/box"] {
        has(dir, "3");
        has(&dir.replace("a/", "b/"), "5");
    }
    // One file twice is one question.
    runs(&["check", &files[0], "sd/../sd/a/box.yaml", "--out", "twice"]);
    has("twice/box", "3");
    config("ends/box.yaml", of[0].1);
    config("ends/box.yml", of[1].1);
    runs(&["sweep", "ends", "--record", "none", "--out", "both"]);
    let found: Vec<String> = ["yaml", "yml"]
        .map(|ending| {
            let mut dirs = vec![folder.path().join("both")];
            while let Some(dir) = dirs.pop() {
                if dir.ends_with(format!("box.{ending}")) {
                    return dir.strip_prefix(folder.path()).unwrap().to_str().unwrap().to_string();
                }
                dirs.extend(std::fs::read_dir(dir).unwrap().map(|e| e.unwrap().path()).filter(|path| path.is_dir()));
            }
            panic!("no folder of box.{ending}")
        })
        .to_vec();
    has(&found[0], "3");
    has(&found[1], "5");
}

/// Who only runs it would find out at the end that nothing is judged.
#[test]
fn whoever_runs_an_expectation_of_nothing_is_told_before() {
    let folder = scratch::folder();
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    let wrong = write(folder.path(), "wrong.yaml", &FALL.replace("column: ball.position_m.y", "column: nosuch"));
    let value =
        write(folder.path(), "value.yaml", &FALL.replace("where: { time.step_s: 0.05", "where: { time.step_s: 7"));
    let fixed = ["--set", "time.step_s=0.1", "--set", "scene.bodies.ball.mass_kg=1"];
    for (args, said) in [
        (vec!["sweep", &wrong], "wrong.yaml:10: expect.0.column: "),
        (vec!["sweep", &value], "value.yaml:10: expect.0.where.time.step_s: "),
        ([&["run", &wrong][..], &fixed].concat(), "wrong.yaml:10: expect.0."),
        (vec!["run", &wrong, "--set", "time.step_s=0.1", "--axis", "scene.bodies.ball.mass_kg=[1,2]"], "expect.0."),
    ] {
        let (code, text, err) = run(&[&args[..], &["--out", out, "--record", "none"]].concat());
        assert!(code == 2 && text.is_empty() && err.contains(said), "{args:?}: {err}");
        assert!(!Path::new(out).exists(), "{args:?}");
    }
    // What a flag has left of the axes is no slip of the file, there and in what the folder keeps.
    let good = write(folder.path(), "good.yaml", FALL);
    for args in [
        vec!["sweep", &good, "--set", "time.step_s=0.1"],
        vec!["sweep", &format!("{out}/experiment.yaml")],
        [&["run", &good][..], &fixed].concat(),
        vec!["sweep", &good, "--axis", "time.step_s=[0.1]"],
    ] {
        let (code, _, err) = run(&[&args[..], &["--out", out, "--record", "none"]].concat());
        assert_eq!(code, 0, "{args:?}: {err}");
    }
}

#[test]
fn a_slip_is_said_before_the_axes_that_are_left() {
    let (code, _, err) = run(&["run", "configs/lecture/stability.yaml", "--set", "tme.end_s=1"]);
    assert!(code == 2 && err.contains("tme") && !err.contains("axes are left"), "{err}");
}

#[test]
fn commands_to_copy_hold_for_every_folder() {
    let folder = scratch::folder();
    let config = write(folder.path(), "fall.yaml", FALL.split("expect:").next().unwrap());
    let out = folder.path().join("my out & x");
    let (code, text, err) = run(&["sweep", &config, "--record", "mcap", "--out", out.to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    let command = text.lines().find(|line| line.contains("gotai view ")).unwrap_or_else(|| panic!("{text}"));
    assert!(command.contains("my out & x") && command.contains("gotai view '") && command.ends_with('\''), "{text}");
}

#[test]
fn a_search_counts_its_verdicts() {
    let folder = scratch::folder();
    let sweep = "sweep: { axes: { scene.bodies.ball.mass_kg: [1, 2] }, search: { critical: time.end_s, between: [0.5, \
                 5], until: { column: ball.position_m.y, below: -10 }, relative_width: 1e-2 } }\n";
    let config = write(folder.path(), "search.yaml", &(FALL.split("sweep:").next().unwrap().to_string() + sweep));
    let out = folder.path().join("out");
    let (code, text, err) = run(&["sweep", &config, "--record", "none", "--out", out.to_str().unwrap()]);
    let first = text.lines().next().unwrap_or_default();
    assert!(code == 0 && first.contains(" · 2 found") && !first.contains("finished"), "{text}{err}");
}

#[test]
fn small_energies_have_digits_and_one_of_a_thing_no_s() {
    let folder = scratch::folder();
    let config =
        write(folder.path(), "tiny.yaml", &FALL.split("sweep:").next().unwrap().replace("mass_kg: 1", "mass_kg: 1e-8"));
    let out = folder.path().join("out");
    let one = ["--set", "time.step_s=1"];
    let (code, text, err) =
        run(&[&["run", &config, "--record", "none", "--out", out.to_str().unwrap()][..], &one].concat());
    assert_eq!(code, 0, "{err}");
    let energy = text.lines().find(|line| line.trim_start().starts_with("energy ")).unwrap();
    assert!(energy.contains("e-7 J") && !energy.contains("0.000000 J → 0.000000 J"), "{text}");
    assert!(text.contains("after 1 step\n"), "{text}");
    let (_, text, _) = run(&[&["explain", &config][..], &one].concat());
    assert!(text.starts_with("1 case, 1 step\n"), "{text}");
}

#[test]
fn a_quiet_report_draws_nothing_on_the_screen() {
    let folder = scratch::folder();
    let config = write(folder.path(), "fall.yaml", FALL);
    let out = folder.path().join("out");
    let out = out.to_str().unwrap();
    json(&["sweep", &config, "--record", "none", "--out", out, "--json"]);
    let (code, text, err) = run(&["report", out, "--quiet"]);
    assert!(code == 0 && err.is_empty(), "{err}");
    assert!(text.lines().all(|line| line.starts_with("report: ") || line.starts_with("figures: ")), "{text}");
    // Rows with an outcome that there is not are no rows of ours.
    let rows = std::fs::read_to_string(folder.path().join("out/rows.csv")).unwrap();
    let other = write(folder.path(), "other.csv", &rows.replacen(",finished,", ",exploded,", 1));
    let (code, _, err) = run(&["report", &other]);
    assert!(code == 2 && err.contains("`exploded`"), "{err}");
}

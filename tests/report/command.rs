//! `gotai report`, and the reports that `sweep` and `bench` leave, as a user meets them.

use crate::bench::SPIN;
use crate::cli::{json, run};
use crate::scratch;
use std::path::Path;

fn sweep(folder: &Path, more: &[&str]) -> (i32, String, String) {
    let config = folder.join("spin.yaml");
    std::fs::write(&config, SPIN).unwrap();
    let (config, out) = (config.display().to_string(), folder.join("out").display().to_string());
    run(&[&["sweep", &config, "--out", &out, "--record", "none"], more].concat())
}

#[test]
fn a_sweep_ends_with_its_map_and_leaves_a_report() {
    let folder = scratch::folder();
    let (code, text, err) = sweep(folder.path(), &[]);
    assert_eq!(code, 0, "{err}");
    let page = folder.path().join("out/report.html");
    assert!(text.contains(&format!("report: {}", page.display())), "{text}");
    let map = text.split("\n\n").nth(2).unwrap();
    assert!(map.contains("rk4") && map.contains("dop853") && map.contains("0.05"), "{text}");
    assert!(!text.contains('\u{1b}'));
    let html = std::fs::read_to_string(&page).unwrap();
    for part in ["Run time against error", "method.free.integrator", "gotai sweep", "free-motion"] {
        assert!(html.contains(part), "{part}");
    }
    // Nothing of this machine.
    assert!(!html.contains(&folder.path().display().to_string()));
    // No file but the page: pictures are `report`'s.
    assert!(!folder.path().join("out/plots").exists());
    let (_, quiet, _) = sweep(folder.path(), &["--quiet"]);
    assert!(!quiet.contains("\n\n"), "{quiet}");
    let (_, coloured, _) = sweep(folder.path(), &["--color", "always"]);
    assert!(coloured.contains("\u{1b}[38;5;"), "{coloured}");
    let (_, text, _) = sweep(folder.path(), &["--json"]);
    assert!(serde_json::from_str::<serde_json::Value>(&text).is_ok(), "{text}");
}

#[test]
fn a_report_is_not_written_where_none_is_wanted_or_can_be() {
    let folder = scratch::folder();
    let (code, text, _) = sweep(folder.path(), &["--no-report"]);
    let page = folder.path().join("out/report.html");
    assert!(code == 0 && !page.exists() && !text.contains("report:") && text.contains("dop853"), "{text}");
    // Without an axis there is nothing to compare.
    let (code, text, _) = sweep(folder.path(), &["--set", "method.free.integrator=rk4", "--set", "time.step_s=0.1"]);
    assert!(code == 0 && !page.exists() && !text.contains("report:"), "{text}");
    let dir = folder.path().join("out").display().to_string();
    let (code, text, err) = run(&["report", &dir]);
    assert!(code == 0 && text.contains("No axis has several values") && page.exists(), "{text}{err}");
    assert!(std::fs::read_to_string(&page).unwrap().contains("No axis has several values"));
    std::fs::remove_file(&page).unwrap();
    // A folder of that name: the rows are there all the same.
    std::fs::create_dir(&page).unwrap();
    let (code, text, err) = sweep(folder.path(), &[]);
    assert!(code == 0 && err.contains("warning: no report is written") && text.contains("rows:"), "{err}");
}

#[test]
fn a_bench_leaves_a_report_and_peers_are_drawn_into_it() {
    let folder = scratch::folder();
    let config = folder.path().join("spin.yaml");
    std::fs::write(&config, SPIN).unwrap();
    let out = folder.path().join("out");
    let dir = out.to_str().unwrap();
    let (code, text, err) = run(&["bench", config.to_str().unwrap(), "--out", dir]);
    assert_eq!(code, 0, "{err}");
    assert!(text.contains("report.html") && out.join("report.html").is_file(), "{text}");
    let peers = folder.path().join("peers.csv");
    let head = "scene,engine,method,dt,steps,error,error_kind,wall_s\n";
    let rows = "top,other,euler <b>,0.01,200,1e-3,error_orientation_rad,1e-4\ntop,other,euler <b>,0.02,100,diverged,error_orientation_rad,1e-5\n";
    std::fs::write(&peers, format!("{head}{rows}")).unwrap();
    let d = json(&["report", dir, "--with", peers.to_str().unwrap(), "--json"]);
    assert_eq!(d["figures"][0]["name"], "pareto");
    let svg = std::fs::read_to_string(out.join("plots/pareto.svg")).unwrap();
    assert!(svg.contains("other euler &lt;b&gt;") && svg.contains("without an end"), "{svg}");
    // The same bytes, whoever draws them.
    let png = std::fs::read(out.join("plots/pareto.png")).unwrap();
    json(&["report", dir, "--with", peers.to_str().unwrap(), "--json"]);
    assert!(png == std::fs::read(out.join("plots/pareto.png")).unwrap());
    assert_eq!(svg, std::fs::read_to_string(out.join("plots/pareto.svg")).unwrap());
    for (text, said) in [
        ("a,b\n1,2\n".to_string(), "expected rows of a bench"),
        (
            format!("{head}{rows}a,b,c,1,1,1,error_orientation_rad,1\n"),
            "expected rows of one scene (FILE:SCENE chooses one), found top, a",
        ),
        (format!("{head}a,b,c,1,1,1,error_position_m,1\n"), "expected rows of the error error_orientation_rad"),
    ] {
        std::fs::write(&peers, text).unwrap();
        let (code, _, err) = run(&["report", dir, "--with", peers.to_str().unwrap()]);
        assert!(code == 2 && err.contains(said), "{err}");
    }
    // A file alone.
    let d = json(&["report", out.join("bench.csv").to_str().unwrap(), "--json"]);
    assert!(Path::new(d["report"].as_str().unwrap()).ends_with("out/bench-report.html"), "{d}");
}

#[test]
fn what_holds_no_rows_is_one_clear_line() {
    let folder = scratch::folder();
    let at = |name: &str| folder.path().join(name).display().to_string();
    std::fs::create_dir(at("empty")).unwrap();
    for (name, text) in
        [("a.csv", "a,b\n1,2\n"), ("b.csv", "\u{0}\u{1}\u{2}"), ("c.parquet", "none"), ("d.json", "{}"), ("e.txt", "")]
    {
        std::fs::write(at(name), text).unwrap();
    }
    for name in ["empty", "a.csv", "b.csv", "c.parquet", "d.json", "e.txt", "missing"] {
        let (code, out, err) = run(&["report", &at(name)]);
        assert!(code == 2 && out.is_empty() && err.lines().count() == 1 && err.contains(name), "{name}: {err}");
    }
    std::fs::write(at("rows.csv"), "case,a,outcome\n").unwrap();
    let (code, _, err) = run(&["report", &at("rows.csv")]);
    assert!(code == 2 && err.contains("it has none"), "{err}");
}

#[test]
fn rows_of_an_older_format_are_shown_with_a_warning() {
    let folder = scratch::folder();
    sweep(folder.path(), &["--no-report"]);
    let out = folder.path().join("out");
    let plan = std::fs::read_to_string(out.join("plan.json")).unwrap();
    let older = plan.replace("\"format\": 3", "\"format\": 2");
    assert_ne!(plan, older);
    std::fs::write(out.join("plan.json"), older).unwrap();
    let (code, _, err) = run(&["report", out.to_str().unwrap()]);
    assert!(code == 0 && err.contains("warning: ") && err.contains("format 2"), "{err}");
    let d = json(&["report", out.to_str().unwrap(), "--json"]);
    assert!(d["warnings"][0].as_str().unwrap().contains("format 2"), "{d}");
    // Nothing but a table.
    for name in ["plan.json", "journal.jsonl", "rows.parquet", "experiment.yaml"] {
        std::fs::remove_file(out.join(name)).unwrap();
    }
    let d = json(&["report", out.to_str().unwrap(), "--json"]);
    assert_eq!((d["rows"].as_u64(), d["figures"][0]["name"].as_str()), (Some(4), Some("map")));
}

#[test]
fn the_map_is_of_the_column_that_is_asked_for() {
    let folder = scratch::folder();
    sweep(folder.path(), &["--no-report"]);
    let dir = folder.path().join("out").display().to_string();
    let (code, text, err) = run(&["report", &dir, "--map", "energy_drift_rel"]);
    assert!(code == 0 && text.contains("|energy_drift_rel|"), "{text}{err}");
    let (code, _, err) = run(&["report", &dir, "--map", "no_such"]);
    assert!(code == 2 && err.contains("--map: expected finished, diverged, stalled, or a column"), "{err}");
    // In characters, all of them.
    let (_, all, _) = run(&["report", &dir, "-v"]);
    assert!(all.contains("Error against step") && all.contains(" |") && all.contains("a  "), "{all}");
}

/// The error that is shown is one, and not what rounding leaves of another.
#[test]
fn an_error_that_is_rounding_has_no_order() {
    let folder = scratch::folder();
    let slide = "question: q
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.3
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: b, shape: { box: { size_m: [0.4, 0.2, 0.4] } }, mass_kg: 1, position_m: [0, 0.1, 0], velocity_m_s: [2, 0, 1] }]
exact: sliding
method: time-stepping
time: { end_s: 0.5 }
sweep:
  axes:
    time.step_s: [0.02, 0.01, 0.005]
    method.time-stepping.scheme: [semi-implicit, moreau]
";
    let config = folder.path().join("slide.yaml");
    std::fs::write(&config, slide).unwrap();
    let out = folder.path().join("out").display().to_string();
    let (code, _, err) = run(&["sweep", config.to_str().unwrap(), "--out", &out, "--record", "none", "--quiet"]);
    assert_eq!(code, 0, "{err}");
    let (_, text, _) = run(&["report", &out]);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("slopes of the position error in the step: semi-implicit 1.0"), "{text}");
}

/// A step of equal length or many orders of magnitude: some ticks.
#[test]
fn numbers_of_any_size_have_ticks() {
    let folder = scratch::folder();
    let mut rows = "case,seed,time.step_s,outcome,energy_drift_rel\n".to_string();
    for seed in 0..6 {
        for (k, step) in ["0.1", "0.2"].iter().enumerate() {
            let drift = ["1e308", "1e-320", "0", "1", "2", "-3"][(seed + k) % 6];
            rows += &format!("{seed}{k},{seed},{step},finished,{drift}\n");
        }
    }
    let file = folder.path().join("rows.csv");
    std::fs::write(&file, rows).unwrap();
    let (code, text, err) = run(&["report", file.to_str().unwrap()]);
    assert!(code == 0 && text.contains("rows-report.html"), "{text}{err}");
}

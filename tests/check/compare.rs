//! Two folders of results against each other.

use crate::cli::{gotai, json, run};
use crate::scratch;
use gotai::check::{Cells, CompareBy, FactorBound, Incomparable, Side, compare};
use gotai::math::interval::{of_mean, of_share};
use gotai::rows::plan_file::PlanAxis;
use serde_json::{Value, json};
use std::path::Path;

const DROP: &str = "
question: How deep does a ball sink?
scene:
  container: { box: { size_m: [4, 4, 4] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.2 } }, mesh: { subdivisions: 1 }, mass_kg: 1, position_m: [0, 1, 0] }]
method: { penalty: { stiffness_n_m: 1e4 } }
time: { step_s: 1e-3, end_s: 1 }
sweep: { axes: { time.step_s: [1e-3, 5e-4], scene.bodies.ball.mass_kg: [1, 2] } }
";

fn row(step: f64, mass: f64, outcome: &str, drift: Option<f64>, wall: f64) -> Cells {
    let cells = json!({
        "case": format!("{step}-{mass}"), "step": step, "mass": mass, "outcome": outcome, "end_time_s": 1.0,
        "energy_drift_rel": drift, "contacts_max": 4, "passed_through": 0, "penetration_max_m": 1e-3, "wall_s": wall,
        "build": "b",
    });
    cells.as_object().unwrap().clone()
}

fn side(name: &str, rows: Vec<Cells>) -> Side {
    let axis = |path: &str| PlanAxis { path: path.into(), values: vec![json!(0.1), json!(0.2)] };
    Side {
        name: name.into(),
        program: "gotai".into(),
        build: "b".into(),
        format: 3,
        planned: rows.len(),
        axes: vec![axis("step"), axis("mass")],
        together: Vec::new(),
        rows,
        size_m: Some(1.0),
    }
}

fn grid(drift: impl Fn(f64, f64) -> f64) -> Vec<Cells> {
    let points = [0.1, 0.2].into_iter().flat_map(|step| [1.0, 2.0].map(|mass| (step, mass)));
    points.map(|(step, mass)| row(step, mass, "finished", Some(drift(step, mass)), 1.0)).collect()
}

#[test]
fn what_is_better_and_worse_is_counted_and_measured() {
    let a = side("a", grid(|step, _| 1e-3 * step));
    // Of 0.1 the double, with the other sign; of 0.2 five per cent more, which is no worse.
    let b = side("b", grid(|step, _| if step < 0.15 { -2e-3 * step } else { 1.05e-3 * step }));
    let found = compare(&a, &b, &CompareBy::default()).unwrap();
    assert_eq!((found.cells, found.finished, found.regression_count), (4, 4, 2));
    let drift = found.columns.iter().find(|change| change.column == "energy_drift_rel").unwrap();
    assert_eq!((drift.better, drift.worse, drift.cells), (0, 2, 4));
    // √(2 · 1.05)
    assert!((drift.factor.unwrap() - 1.449137674618944).abs() < 1e-12, "{drift:?}");
    let interval = drift.interval.unwrap();
    assert!(interval.low >= 1.05 - 1e-12 && interval.high <= 2.0 + 1e-12 && interval.low < interval.high);
    assert_eq!(found.regressions[0].axes, json!({ "step": 0.1, "mass": 1.0 }).as_object().unwrap().clone());
    assert_eq!((&found.regressions[0].a, &found.regressions[0].b), (&json!(1e-4), &json!(2e-4)));
    // The other way round it is better, and twice asked the same.
    let back = compare(&b, &a, &CompareBy::default()).unwrap();
    assert_eq!((back.regression_count, back.columns.iter().map(|c| c.better).sum::<usize>()), (0, 2));
    let again = compare(&a, &b, &CompareBy::default()).unwrap();
    assert_eq!(serde_json::to_value(&found).unwrap(), serde_json::to_value(&again).unwrap());
}

#[test]
fn rounding_is_no_regression_and_time_only_if_asked_for() {
    let a = side("a", grid(|_, _| 1e-16));
    let mut b = side("b", grid(|_, _| 9e-13));
    assert_eq!(compare(&a, &b, &CompareBy::default()).unwrap().regression_count, 0);
    for row in &mut b.rows {
        row["wall_s"] = json!(2.0);
        // Of a body of 1 m: below 1e-12 m.
        row["penetration_max_m"] = json!(1e-3 + 5e-13);
    }
    assert_eq!(compare(&a, &b, &CompareBy::default()).unwrap().regression_count, 0);
    let with_cost = CompareBy { with_cost: true, ..CompareBy::default() };
    assert_eq!(compare(&a, &b, &with_cost).unwrap().regression_count, 4);
    let named = CompareBy { columns: vec!["wall_s".into()], ..CompareBy::default() };
    assert_eq!(compare(&a, &b, &named).unwrap().regression_count, 4);
    // A floor of lengths is of the bodies' size: nothing changes if the scene is another size.
    for scale in [1e-3, 1e3] {
        let scaled = |depth: f64| {
            let rows = grid(|_, _| 0.0).into_iter().map(|mut row| {
                row["penetration_max_m"] = json!(depth * scale);
                row
            });
            Side { size_m: Some(scale), ..side("s", rows.collect()) }
        };
        let count = |a, b| compare(&scaled(a), &scaled(b), &CompareBy::default()).unwrap().regression_count;
        assert_eq!((count(1e-13, 9e-13), count(1e-12, 2e-12)), (0, 4), "{scale}");
    }
}

#[test]
fn finished_there_and_not_here_is_a_regression() {
    let a = side("a", grid(|_, _| 1e-3));
    let mut rows = grid(|_, _| 1e-3);
    rows[3] = row(0.2, 2.0, "diverged", Some(40.0), 0.1);
    let b = side("b", rows);
    let found = compare(&a, &b, &CompareBy::default()).unwrap();
    assert_eq!((found.regression_count, found.finished, found.moved.len()), (1, 3, 1));
    assert_eq!(found.regressions[0].column, "outcome");
    // What has diverged is not compared in numbers, and the way back is none.
    assert_eq!(compare(&b, &a, &CompareBy::default()).unwrap().regression_count, 0);
    let finished = &found.outcomes[0];
    assert_eq!((finished.a, finished.b, finished.of_b), (4, 3, 4));
    // Wilson: 3 of 4.
    assert!((finished.interval_b.low - 0.300642).abs() < 1e-6 && (finished.interval_b.high - 0.954413).abs() < 1e-6);
}

/// A side whose plan has the whole grid, whatever rows it has.
fn planned(name: &str, rows: Vec<Cells>) -> Side {
    let mut side = side(name, rows);
    side.planned = 4;
    side.axes[1].values = vec![json!(1.0), json!(2.0)];
    side
}

#[test]
fn what_is_planned_and_missing_is_a_regression() {
    let a = planned("a", grid(|_, _| 1e-3));
    let b = planned("b", grid(|_, _| 1e-3).into_iter().take(3).collect());
    let found = compare(&a, &b, &CompareBy::default()).unwrap();
    assert_eq!((found.missing, found.cells_of_a, found.regression_count), (1, 0, 1));
    let missing = &found.regressions[0];
    assert_eq!((missing.column.as_str(), &missing.a, &missing.b), ("outcome", &json!("finished"), &json!("missing")));
    assert_eq!(missing.axes, json!({ "step": 0.2, "mass": 2.0 }).as_object().unwrap().clone());
    // The way back none is, and what had not finished is no loss.
    let back = compare(&b, &a, &CompareBy::default()).unwrap();
    assert_eq!((back.missing, back.cells_of_b, back.regression_count), (0, 1, 0));
    let mut rows = grid(|_, _| 1e-3);
    rows[3] = row(0.2, 2.0, "diverged", None, 0.1);
    let found = compare(&planned("a", rows), &b, &CompareBy::default()).unwrap();
    assert_eq!((found.missing, found.regression_count), (1, 0));
    // A value that the other plan does not have was never asked for there.
    let mut fewer = b.clone();
    fewer.rows.truncate(2);
    fewer.axes[0].values = vec![json!(0.1)];
    fewer.planned = 2;
    let found = compare(&a, &fewer, &CompareBy::default()).unwrap();
    assert_eq!((found.missing, found.cells_of_a, found.regression_count), (0, 2, 0));
    // Pooled over an axis of its own: two seeds a cell, one row of them missing.
    let mut rows: Vec<Cells> = grid(|_, _| 1e-3).into_iter().flat_map(|row| [row.clone(), row]).collect();
    rows.pop();
    let mut seeds = planned("b", rows);
    seeds.axes.push(PlanAxis { path: "seed".into(), values: vec![json!(0), json!(1)] });
    seeds.planned = 8;
    let found = compare(&a, &seeds, &CompareBy::default()).unwrap();
    assert_eq!((found.missing, found.regression_count), (1, 1));
    assert_eq!(found.regressions[0].b, json!("1 of 2 missing"));
}

#[test]
fn a_column_that_has_no_number_any_more_is_a_regression() {
    let with = |error: Value, wall: Value| {
        grid(|_, _| 1e-3).into_iter().map(move |mut row| {
            row.insert("error_position_m".into(), error.clone());
            row["wall_s"] = wall.clone();
            row
        })
    };
    let a = side("a", with(json!(1e-3), json!(1.0)).collect());
    let b = side("b", with(Value::Null, Value::Null).collect());
    let found = compare(&a, &b, &CompareBy::default()).unwrap();
    let mut names: Vec<&str> = found.missing_in_b.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["error_position_m", "wall_s"]);
    // A cost counts if it is asked for.
    assert_eq!((found.regression_count, found.regressions[0].column.as_str()), (1, "error_position_m"));
    assert!(found.differing.is_empty(), "{:?}", found.differing);
    let timed = CompareBy { with_cost: true, ..CompareBy::default() };
    assert_eq!(compare(&a, &b, &timed).unwrap().regression_count, 2);
    let back = compare(&b, &a, &CompareBy::default()).unwrap();
    assert_eq!((back.regression_count, back.missing_in_a.len(), back.missing_in_b.len()), (0, 2, 0));
}

#[test]
fn a_factor_that_a_floor_has_decided_is_a_bound() {
    let change = |a: &dyn Fn(f64) -> f64, b: &dyn Fn(f64) -> f64| {
        let (a, b) = (side("a", grid(|step, _| a(step))), side("b", grid(|step, _| b(step))));
        let found = compare(&a, &b, &CompareBy::default()).unwrap();
        found.columns.into_iter().find(|change| change.column == "energy_drift_rel").unwrap()
    };
    let half = |low: f64, high: f64| move |step: f64| if step < 0.15 { low } else { high };
    let plain = change(&|_| 1e-3, &|_| 2e-3);
    assert!(plain.bound.is_none() && plain.interval.is_some());
    let below = change(&|_| 1e-3, &half(0.0, 2e-3));
    assert_eq!((below.bound, below.interval), (Some(FactorBound::Below), None));
    // √(floor / 1e-3 · 2): the floor in place of zero.
    let expected = (below.floor / 1e-3 * 2.0).sqrt();
    assert!((below.factor.unwrap() / expected - 1.0).abs() < 1e-12, "{below:?}");
    assert_eq!(change(&half(0.0, 2e-3), &|_| 1e-3).bound, Some(FactorBound::Above));
    // Bounds to both sides, and rounding on both, are no ratio.
    for found in [change(&half(0.0, 1e-3), &half(1e-3, 0.0)), change(&|_| 1e-17, &|_| 3e-17)] {
        assert_eq!((found.factor, found.interval, found.bound), (None, None, None), "{found:?}");
    }
}

#[test]
fn folders_are_joined_by_the_axes_that_both_have() {
    let a = side("a", grid(|_, mass| 1e-3 * mass));
    let axis = |path: &str| PlanAxis { path: path.into(), values: vec![json!(0.1)] };
    let only = |row: &Cells| row["mass"] == json!(1.0);
    let b = Side {
        axes: vec![axis("step")],
        rows: grid(|_, _| 1.5e-3).into_iter().filter(only).collect(),
        ..side("b", vec![])
    };
    let found = compare(&a, &b, &CompareBy::default()).unwrap();
    // The mean of both masses, 1.5e-3, is what the other has.
    assert_eq!((found.axes, found.axes_of_a, found.cells), (vec!["step".to_string()], vec!["mass".to_string()], 2));
    assert_eq!(found.regression_count, 0);
    // Cases that one alone has are named; numbers match within 1e-9.
    let mut rows = grid(|_, _| 1e-3);
    rows[0]["step"] = json!(0.1 * (1.0 + 1e-12));
    rows[3]["step"] = json!(0.3);
    let found = compare(&a, &side("b", rows), &CompareBy::default()).unwrap();
    assert_eq!((found.cells, found.missing, found.cells_of_a, found.cells_of_b), (3, 1, 0, 1));
    assert_eq!(found.places_of_b[0]["step"], json!(0.3));
    // None in common.
    let none = Side { axes: vec![axis("other")], ..side("b", grid(|_, _| 1e-3)) };
    let error = compare(&a, &none, &CompareBy::default()).unwrap_err();
    assert!(matches!(error, Incomparable::NoAxis { .. }));
    assert_eq!(
        error.to_string(),
        "a and b have no axis in common (step, mass; other): no row of one stands for a row of the other"
    );
    let far: Vec<Cells> = grid(|_, _| 1e-3)
        .into_iter()
        .map(|mut row| {
            row["mass"] = json!(7.0);
            row
        })
        .collect();
    let error = compare(&a, &side("b", far), &CompareBy::default()).unwrap_err().to_string();
    assert!(error.contains("no case in common") && error.contains("mass is 0.1, 0.2 in A"), "{error}");
    let error = compare(&a, &side("b", vec![]), &CompareBy::default()).unwrap_err();
    assert!(matches!(error, Incomparable::NoRow(_)));
}

#[test]
fn a_column_is_not_compared_across_a_change_of_its_meaning() {
    let a = Side { format: 2, ..side("a", grid(|_, _| 1e-3)) };
    let b = side("b", grid(|_, _| 1.0));
    let found = compare(&a, &b, &CompareBy::default()).unwrap();
    assert_eq!(found.refused, [("energy_drift_rel".to_string(), 3)]);
    assert_eq!(found.regression_count, 0);
    assert!(found.columns.iter().any(|change| change.column == "penetration_max_m"));
    let named = CompareBy { columns: vec!["energy_drift_rel".into()], ..CompareBy::default() };
    let error = compare(&a, &b, &named).unwrap_err().to_string();
    assert!(error.contains("a is of format 2, b of format 3"), "{error}");
    let unknown = CompareBy { columns: vec!["nonsense".into()], ..CompareBy::default() };
    assert!(matches!(compare(&a, &b, &unknown), Err(Incomparable::Column(_))));
}

/// Known numbers of another origin.
#[test]
fn intervals_are_those_of_the_literature() {
    // Newcombe, Stat. Med. 17 (1998) 857, table I, method 3: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
    for (k, n, low, high) in
        [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)]
    {
        let found = of_share(k, n);
        assert!((found.low - low).abs() < 5e-5 && (found.high - high).abs() < 5e-5, "{k} of {n}: {found:?}");
    }
    // Of 400 numbers 0 and 1 in turn: mean ½, standard error 0.025. measured: 0.4525 … 0.55
    let found = of_mean(&(0..400).map(|i| f64::from(i % 2)).collect::<Vec<_>>()).unwrap();
    assert!((found.low - 0.451).abs() < 0.006 && (found.high - 0.549).abs() < 0.006, "{found:?}");
    let many = of_mean(&(0..4000).map(|i| f64::from(i % 2)).collect::<Vec<_>>()).unwrap();
    assert!((many.low - (0.5 - 1.959964 * 0.5 / 3999f64.sqrt())).abs() < 1e-9, "{many:?}");
    assert_eq!((of_mean(&[1.0]), of_mean(&[])), (None, None));
}

#[test]
fn the_command_compares_folders_as_they_were_written() {
    let folder = scratch::folder();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    std::fs::write(path("drop.yaml"), DROP).unwrap();
    let sweep =
        |out: &str, more: &[&str]| {
            let (config, out) = (path("drop.yaml"), path(out));
            let (code, _, err) =
                run(&[&["sweep", config.as_str(), "--out", out.as_str(), "--record", "none", "--quiet"][..], more]
                    .concat());
            assert_eq!(code, 0, "{err}");
        };
    sweep("stiff", &[]);
    sweep("soft", &["--set", "method.penalty.stiffness_n_m=2e3"]);
    let (stiff, soft) = (path("stiff"), path("soft"));
    let (code, text, err) = run(&["compare", &stiff, &stiff, "--fail-on-regression", "--time"]);
    assert!(code == 0 && text.contains("nothing is worse") && text.contains("4 cases in both"), "{text}{err}");
    // Springs of a fifth: by √5 deeper with one node that touches, by less with the more that do.
    let page = path("page.html");
    let args = ["compare", &stiff, &soft, "--fail-on-regression", "--html", &page];
    let (code, text, _) = run(&args);
    assert!(code == 1 && text.contains("penetration_max_m"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 140), "{text}");
    // A line a column in 80 letters too, the interval in it; and what the ratio is.
    let output = gotai(&["compare", &stiff, &soft]).env("COLUMNS", "80").output().unwrap();
    let narrow = String::from_utf8(output.stdout).unwrap();
    let is_command = |line: &str| line.trim_start().starts_with("gotai run ");
    let (first, last) = (narrow.find("\nin 4 cases").unwrap(), narrow.find("B / A: geometric mean").unwrap());
    let table = &narrow[first..last];
    assert!(table.lines().filter(|line| line.contains('…')).all(|line| line.contains('_')), "{table}");
    let fits =
        |line: &str| line.chars().count() <= 80 || is_command(line) || line.contains(&stiff) || line.contains(&soft);
    assert!(table.lines().all(|line| line.chars().count() <= 80) && narrow.lines().all(fits), "{narrow}");
    let (code, text, _) = run(&[&args[..], &["--json"]].concat());
    let found: Value = serde_json::from_str(&text).unwrap();
    let change = found["columns"].as_array().unwrap().iter().find(|c| c["column"] == "penetration_max_m").unwrap();
    assert_eq!((code, &change["worse"], &change["unit"]), (1, &json!(4), &json!("m")));
    // measured: 1.63
    assert!((1.3..5f64.sqrt()).contains(&change["factor"].as_f64().unwrap()), "{change}");
    let worst = &found["regressions"][0];
    assert!(worst["command_b"].as_str().unwrap().starts_with(&format!("gotai run {soft} --case ")), "{worst}");
    let html = std::fs::read_to_string(&page).unwrap();
    assert!(html.contains("geometric mean over the cases that finished in both"), "{html}");
    assert!(html.contains("penetration_max_m") && !html.contains("http"), "{html}");
    assert_eq!(html.matches("<table>").count(), html.matches("</table>").count());
    // A page that cannot be written is called as it was asked for.
    let nowhere = path("nowhere/page.html");
    let (code, _, err) = run(&["compare", &stiff, &soft, "--html", &nowhere]);
    assert!(code == 3 && err.contains(&nowhere) && !err.contains("partial"), "{err}");
    // Without the flag it is a result.
    assert_eq!(run(&["compare", &stiff, &soft]).0, 0);
    // What cannot be compared is one clear line.
    let plan = Path::new(&soft).join("plan.json");
    let kept = std::fs::read_to_string(&plan).unwrap();
    for (format, message) in [("1", "expected format 2 to 3, found 1"), ("99", "expected format 2 to 3, found 99")] {
        std::fs::write(&plan, kept.replace("\"format\": 3", &format!("\"format\": {format}"))).unwrap();
        let (code, text, err) = run(&["compare", &stiff, &soft]);
        assert!(code == 2 && text.is_empty() && err.contains(message) && err.lines().count() == 1, "{err}");
    }
    std::fs::write(&plan, kept.replace("\"format\": 3", "\"format\": 2")).unwrap();
    let (_, text, _) = run(&["compare", &stiff, &soft]);
    assert!(
        text.contains("their meaning has changed: energy_drift_rel (format 3)") || text.contains("energy_drift_rel")
    );
    let found = json(&["compare", &stiff, &soft, "--json"]);
    assert!(found["refused"].as_array().unwrap().iter().any(|column| column[0] == "residual_max" || column[1] == 3));
    let (code, _, err) = run(&["compare", &stiff, folder.path().to_str().unwrap()]);
    assert!(code == 2 && err.contains("expected a folder of results"), "{err}");
}

/// Sweeps that advance with the step are no axis of their own: neither are their rows pooled, nor is a combination that
/// no plan has missing.
#[test]
fn axes_that_advance_side_by_side_are_one() {
    let with = |name: &str, sweeps: [i64; 2], full: bool| {
        let steps = [0.1, 0.2];
        let mut rows = Vec::new();
        for (i, step) in steps.iter().enumerate() {
            for (j, count) in sweeps.iter().enumerate().filter(|(j, _)| full || *j == i) {
                let mut cells = row(*step, 1.0, "finished", Some(1e-3 * (1 + i + j) as f64), 1.0);
                cells.remove("mass");
                cells.insert("sweeps".into(), json!(count));
                rows.push(cells);
            }
        }
        let axis =
            |path: &str, values: Value| PlanAxis { path: path.into(), values: values.as_array().unwrap().clone() };
        let together = if full { Vec::new() } else { vec![vec!["step".to_string(), "sweeps".to_string()]] };
        let axes = vec![axis("step", json!(steps)), axis("sweeps", json!(sweeps))];
        Side { axes, together, ..side(name, rows) }
    };
    // A full grid against the diagonal: what the second plan does not have is no loss.
    let (grid, diagonal) = (with("a", [50, 100], true), with("b", [50, 100], false));
    let found = compare(&grid, &diagonal, &CompareBy::default()).unwrap();
    assert_eq!((found.cells, found.cells_of_a, found.missing, found.regression_count), (2, 2, 0, 0));
    // An interrupted diagonal is one.
    let mut cut = diagonal.clone();
    cut.rows.pop();
    let found = compare(&diagonal, &cut, &CompareBy::default()).unwrap();
    assert_eq!((found.missing, found.regression_count), (1, 1));
    // Other sweeps at the same steps: joined by the step, and said.
    let other = with("b", [80, 160], false);
    let found = compare(&diagonal, &other, &CompareBy::default()).unwrap();
    assert_eq!((found.axes.clone(), found.cells, found.missing), (vec!["step".to_string()], 2, 0));
    assert_eq!(found.following, [("sweeps".to_string(), "step".to_string())]);
    // A side that has the step alone pools nothing.
    let mut alone = other.clone();
    alone.axes.pop();
    alone.together.clear();
    let found = compare(&diagonal, &alone, &CompareBy::default()).unwrap();
    assert!(found.axes_of_a.is_empty() && found.cells == 2 && found.following.len() == 1);
}

#[test]
fn benches_are_compared_by_method_and_step() {
    let folder = scratch::folder();
    let trial = |method: &str, step_s: f64, error: Option<f64>, wall_s: f64| {
        json!({
            "scene": "s", "engine": "gotai", "method": method, "step_s": step_s, "tolerance": null, "steps": (1.0 / step_s) as u64,
            "error": error, "error_kind": "error_position_m", "wall_s": error.map(|_| wall_s), "wall_median_s": null,
            "outcome": if error.is_some() { "finished" } else { "diverged" }, "criterion": null,
        })
    };
    let write = |name: &str, trials: Vec<Value>| {
        let dir = folder.path().join(name);
        std::fs::create_dir(&dir).unwrap();
        std::fs::write(dir.join("bench.json"), serde_json::to_string(&trials).unwrap()).unwrap();
        dir.display().to_string()
    };
    let a = write("a", vec![trial("moreau", 0.1, Some(1e-2), 1.0), trial("pgs", 0.1, Some(1e-1), 1.0)]);
    let b = write("b", vec![trial("moreau", 0.1, Some(4e-2), 3.0), trial("pgs", 0.1, None, 1.0)]);
    let d = json(&["compare", &a, &b, "--json"]);
    assert_eq!(
        (d["cells"].as_u64(), d["finished"].as_u64(), d["regression_count"].as_u64()),
        (Some(2), Some(1), Some(2))
    );
    assert_eq!(d["regressions"][0]["column"], "outcome");
    assert_eq!(
        (d["regressions"][1]["column"].as_str(), d["regressions"][1]["b"].as_f64()),
        (Some("error_position_m"), Some(4e-2))
    );
    let d = json(&["compare", &a, &b, "--json", "--time"]);
    assert_eq!(d["regression_count"].as_u64(), Some(3));
    let (code, text, err) = run(&["compare", &a, &b, "--fail-on-regression"]);
    assert!(
        code == 1 && text.contains("at method = moreau, step_s = 0.1") && !text.contains("tolerance = null"),
        "{text}{err}"
    );
}

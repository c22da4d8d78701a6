//! Bisection where the critical value is known.

use crate::yaml;
use gotai::rows::Measured;
use gotai::sweep::plan::cases;
use gotai::sweep::runner::build_and_run;
use serde_json::{Value, json};
use std::path::Path;

const BALL: &str = "
scene:
  gravity_m_s2: [0, -9.8, 0]
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [0, 20, 0] }]
time: { step_s: 0.01, end_s: 0.1 }
sweep:
";

fn searched(text: &str, sets: &[&str]) -> Vec<Measured> {
    let cases = cases(&yaml::file(text, sets)).unwrap_or_else(|error| panic!("{error}"));
    cases.iter().map(|case| build_and_run(case, Path::new("."), &[]).0).collect()
}

fn bracket(row: &Measured) -> (f64, f64, u64, String) {
    let number = |name: &str| row.more[name].as_f64().unwrap_or(f64::NAN);
    let runs = row.more["search_runs"].as_u64().unwrap();
    (number("search_low"), number("search_high"), runs, row.more["search_verdict"].as_str().unwrap().to_string())
}

/// n = round(end/step) steps are made: more than 99 from an end of 0.995 s on.
#[test]
fn a_number_is_bracketed_to_the_width_asked_for() {
    let search = "search: { critical: time.end_s, between: [0.1, 10], until: { column: steps, above: 99 }, relative_width: 1e-6 }";
    let rows = searched(&format!("{BALL}  {search}\n"), &[]);
    let (low, high, runs, verdict) = bracket(&rows[0]);
    assert!(low < 0.995 && high >= 0.995 && high - low <= 1e-6 * high, "{low} {high}");
    // Both ends and log₂(ln 100 / 1e-6) halvings.
    assert_eq!((runs, verdict.as_str()), (25, "found"));
    // The row is of the run at `search_low`.
    assert_eq!((rows[0].steps, rows[0].end_time_s), (99, Some(low)));
}

/// A face of n² nodes has more than 20 from n = 5 on.
#[test]
fn a_key_of_whole_numbers_is_searched_in_whole_numbers() {
    let text = format!(
        "{BALL}  search: {{ critical: scene.bodies.ball.mesh.nodes_per_edge, between: [2, 64], until: {{ column: contacts_max, above: 20 }} }}\n"
    )
    .replace("sphere: { radius_m: 0.1 }", "box: { size_m: [1, 1, 1] }")
    .replace("[0, 20, 0]", "[0, 0.5, 0]")
    .replace("end_s: 0.1", "end_s: 0.01");
    let (low, high, _, verdict) = bracket(&searched(&text, &[])[0]);
    assert_eq!((low, high, verdict.as_str()), (4.0, 5.0, "found"));
}

/// m g h > 98 J where h > 10/m: with masses of 1 … 4 kg half of them do from h = 10/3 on.
#[test]
fn a_fraction_over_an_axis_is_searched_in_every_cell_of_the_others() {
    let text = format!(
        "{BALL}  axes:
    scene.bodies.ball.mass_kg: [1, 2, 3, 4]
    scene.gravity_m_s2.1: [-9.8, -4.9]
  search:
    critical: scene.bodies.ball.position_m.1
    between: [1, 100]
    until: {{ column: energy_start_j, above: 98 }}
    fraction: 0.5
    over: scene.bodies.ball.mass_kg
    relative_width: 1e-4
"
    );
    let file = yaml::file(&text, &[]);
    let planned = cases(&file).unwrap();
    assert_eq!(planned.len(), 2);
    assert_eq!(planned[0].case.axes.keys().collect::<Vec<_>>(), ["scene.gravity_m_s2.1"]);
    let rows = searched(&text, &[]);
    for (row, critical) in rows.iter().zip([10.0 / 3.0, 20.0 / 3.0]) {
        let (low, high, runs, _) = bracket(row);
        assert!(low <= critical && critical <= high && high - low <= 1e-4 * high, "{low} {high}");
        assert_eq!(runs % 4, 0);
    }
    // One mass is enough: 10/4.
    let (low, high, ..) = bracket(&searched(&text, &["sweep.search.fraction=0.2"])[0]);
    assert!(low <= 2.5 && 2.5 <= high, "{low} {high}");
    // A --set leaves a single value to try.
    let (low, high, ..) = bracket(&searched(&text, &["scene.bodies.ball.mass_kg=1"])[0]);
    assert!(low <= 10.0 && 10.0 <= high, "{low} {high}");
}

#[test]
fn a_cell_that_does_not_straddle_is_a_result() {
    let row = |bound: f64| {
        let search = format!(
            "search: {{ critical: time.end_s, between: [0.1, 1], until: {{ column: steps, above: {bound} }} }}"
        );
        searched(&format!("{BALL}  {search}\n"), &[]).remove(0)
    };
    let ends = |row: &Measured| [row.more["search_low"].clone(), row.more["search_high"].clone()];
    let (below, above) = (row(5.0), row(500.0));
    assert_eq!((bracket(&below).3.as_str(), ends(&below)), ("below", [Value::Null, json!(0.1)]));
    assert_eq!((bracket(&above).3.as_str(), ends(&above)), ("above", [json!(1), Value::Null]));
    assert_eq!((bracket(&below).2, bracket(&above).2), (2, 2));
}

/// Where the condition holds at the lower end and not at the upper one, the bracket closes all the same.
#[test]
fn a_condition_that_ends_is_found_too() {
    let search = "search: { critical: time.end_s, between: [0.1, 10], until: { column: steps, below: 100 }, relative_width: 1e-3 }";
    let (low, high, ..) = bracket(&searched(&format!("{BALL}  {search}\n"), &[])[0]);
    assert!(low < 0.995 && high >= 0.995, "{low} {high}");
}

#[test]
fn a_search_has_an_id_of_its_own_and_the_same_bits_every_time() {
    let text = |width: &str| {
        format!(
            "{BALL}  search: {{ critical: time.end_s, between: [0.1, 1], until: {{ column: steps, above: 50 }}, relative_width: {width} }}\n"
        )
    };
    let id = |text: &str, sets: &[&str]| cases(&yaml::file(text, sets)).unwrap()[0].case.id.clone();
    assert_eq!(id(&text("0.1"), &[]), id(&text("0.1"), &["question=why?"]));
    assert_ne!(id(&text("0.1"), &[]), id(&text("0.01"), &[]));
    assert_ne!(id(&text("0.1"), &[]), id(&text("0.1"), &["scene.bodies.ball.mass_kg=2"]));
    assert_ne!(id(&text("0.1"), &[]), id(&text("0.1"), &["time.end_s=0.1"]), "fixed, it is a single run");
    let twice = [0, 1].map(|_| searched(&text("0.01"), &[])[0].without_wall_time());
    assert_eq!(twice[0], twice[1]);
}

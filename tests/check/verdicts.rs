//! One expectation, a few rows written by hand, one verdict.

use crate::yaml;
use gotai::check::{Cells, Judged, Schema, judge, refuse_unknown};
use serde_json::{Value, json};

const AXES: &str = "
scene: { bodies: [{ name: ball, shape: none, mass_kg: 1 }] }
method: free
time: { step_s: 0.1, end_s: 1 }
measure: [state]
sweep:
  axes:
    time.step_s: [0.1, 0.05, 0.025]
    scene.gravity_m_s2: [{ label: earth, value: [0, -9.8, 0] }, { label: moon, value: [0, -1.6, 0] }]
    seed: [0, 1]
expect:
";

/// Twelve rows; `of` gives what a row measures, from its step, place and seed.
fn rows(of: impl Fn(f64, &str, u64) -> Value) -> Vec<Cells> {
    let mut rows = Vec::new();
    for step in [0.1, 0.05, 0.025] {
        for place in ["earth", "moon"] {
            for seed in [0, 1] {
                let mut row = json!({
                    "case": format!("{step} {place} {seed}"), "time.step_s": step, "scene.gravity_m_s2": place,
                    "seed": seed, "step_used_s": step, "outcome": "finished", "criterion": null,
                });
                row.as_object_mut().unwrap().extend(of(step, place, seed).as_object().unwrap().clone());
                rows.push(row.as_object().unwrap().clone());
            }
        }
    }
    rows
}

fn judged(expectation: &str, rows: &[Cells]) -> Judged {
    let file = yaml::file(&format!("{AXES}  - {expectation}\n"), &[]);
    let names: Vec<String> = ["x", "y", "z"].map(|part| format!("ball.position_m.{part}")).to_vec();
    let schema = Schema::new(file.axes(), None, &names);
    refuse_unknown(&schema, file.expect(), None).unwrap_or_else(|error| panic!("{expectation}: {error}"));
    judge(&file.expect()[0], &schema, rows)
}

#[track_caller]
fn check(expectation: &str, rows: &[Cells], met: bool, measured: &str) {
    let judged = judged(expectation, rows);
    assert_eq!(judged.met, met, "{expectation}: {}", judged.measured);
    assert!(judged.measured.contains(measured), "{expectation}: {}", judged.measured);
}

#[test]
fn a_column_is_bounded_in_every_row() {
    let rows = rows(|step, _, seed| json!({ "energy_end_j": step + seed as f64 }));
    check("{ column: energy_end_j, min: 0.025, max: 1.1 }", &rows, true, "0.025 … 1.1");
    check("{ column: energy_end_j, max: 1.09 }", &rows, false, "2 of 12 rows outside");
    check("{ column: energy_end_j, between: [0.025, 1.1] }", &rows, true, "0.025 … 1.1");
    check("{ column: energy_end_j, below: 1.1 }", &rows, false, "outside");
    check("{ column: energy_end_j, quantile: 0.5, max: 0.6 }", &rows, true, "0.5625");
    check("{ column: energy_end_j / step_used_s, where: { seed: 0 }, min: 1, max: 1 }", &rows, true, "1");
}

#[test]
fn what_is_not_there_is_never_met() {
    let rows = rows(|step, _, _| json!({ "energy_end_j": if step < 0.04 { Value::Null } else { json!(1.0) } }));
    check("{ column: energy_end_j, max: 2 }", &rows, false, "energy_end_j is null in case 0.025 earth 0");
    check("{ column: energy_end_j, max: 2, where: { time.step_s: '> 0.04' } }", &rows, true, "1");
    check("{ column: energy_end_j, max: 2, where: { steps: 7 } }", &rows, false, "no row is selected");
    check("{ column: penetration_max_m, max: 2 }", &rows, false, "is null");
    check("{ fraction: { column: energy_end_j, above: 0 }, max: 1 }", &rows, false, "is null");
    check("{ equal: energy_end_j, across: seed }", &rows, false, "is null");
    check("{ order: energy_end_j, against: time.step_s, between: [-9, 9] }", &rows, false, "is null");
    check("{ trend: energy_end_j, along: time.step_s, rising: true, p_max: 0.9 }", &rows, false, "is null");
    check("{ column: energy_end_j, max: 2 }", &[], false, "no row is selected");
    let zero = "{ ratio: energy_end_j, of: { time.step_s: 0.1 }, to: { steps: 7 }, min: 0 }";
    check(zero, &rows, false, "to: no row is selected");
}

#[test]
fn within_bounds_the_absolute_value() {
    // -0.5, 0.5, -0.25, 0.25, -0.125, 0.125, of each twice.
    let rows =
        rows(|step, place, _| json!({ "energy_drift_rel": 5.0 * step * if place == "moon" { 1.0 } else { -1.0 } }));
    check("{ column: energy_drift_rel, within: 0.5 }", &rows, true, "-0.5 … 0.5");
    check("{ column: energy_drift_rel, within: 0.3 }", &rows, false, "-0.5 … 0.5; 4 of 12 rows outside");
    check("{ column: energy_drift_rel, within: 0 }", &rows, false, "12 of 12 rows outside");
    // A loss that `max` alone lets pass.
    let losses = "where: { scene.gravity_m_s2: earth }";
    check(&format!("{{ column: energy_drift_rel, max: 1e-3, {losses} }}"), &rows, true, "-0.5 … -0.125");
    check(&format!("{{ column: energy_drift_rel, within: 1e-3, {losses} }}"), &rows, false, "6 of 6 rows outside");
    // A quantile is one of absolute values.
    check("{ column: energy_drift_rel, quantile: 0.5, within: 0.25 }", &rows, true, "0.25");
    check("{ column: energy_drift_rel, quantile: 0, within: 0.1 }", &rows, false, "0.125");
    check("{ fraction: { column: energy_drift_rel, within: 0.3 }, min: 0.6, max: 0.7 }", &rows, true, "8 of 12");
    check("{ column: energy_drift_rel, max: 1, where: { energy_drift_rel: { within: 0.2 } } }", &rows, true, "0.125");
    let cells = "of: { scene.gravity_m_s2: earth }, to: { scene.gravity_m_s2: moon }";
    check(
        &format!("{{ difference: energy_drift_rel, {cells}, within: 0.6 }}"),
        &rows,
        true,
        "-0.5833 (-0.2917 − 0.2917)",
    );
    check(&format!("{{ difference: energy_drift_rel, {cells}, within: 0.5 }}"), &rows, false, "-0.5833");
}

#[test]
fn within_is_said_in_words_and_never_met_by_nothing() {
    let none = rows(|_, _, seed| json!({ "energy_drift_rel": if seed == 0 { json!(0.0) } else { Value::Null } }));
    let verdict = judged("{ column: energy_drift_rel, within: 1e-9 }", &none);
    assert_eq!((verdict.expectation.as_str(), verdict.bound.as_str()), ("energy_drift_rel", "|…| ≤ 1e-9"));
    assert!(!verdict.met && verdict.measured.contains("is null"), "{}", verdict.measured);
    let verdict = judged("{ column: energy_drift_rel, quantile: 0.9, within: 2 }", &none);
    assert_eq!(
        (verdict.expectation.as_str(), verdict.bound.as_str()),
        ("0.9 quantile of |energy_drift_rel|", "|…| ≤ 2")
    );
    assert!(!verdict.met);
    let quotient = rows(|_, _, _| json!({ "energy_drift_rel": 1.0, "energy_start_j": 0.0 }));
    check("{ column: energy_drift_rel / energy_start_j, within: 1e300 }", &quotient, false, "is null");
}

#[test]
fn a_filter_knows_values_labels_lists_and_inequalities() {
    let rows = rows(|_, _, seed| json!({ "energy_end_j": 1.0, "steps": 10 * seed }));
    for (filter, count) in [
        ("{ time.step_s: 0.1 }", 4),
        ("{ time.step_s: 0.10000000001 }", 4),
        ("{ time.step_s: [0.1, 0.05] }", 8),
        ("{ time.step_s: '<= 0.05' }", 8),
        ("{ time.step_s: '< 0.05', seed: 1 }", 2),
        ("{ time.step_s: { min: 0.04, below: 0.1 } }", 4),
        ("{ time.step_s: { within: 0.05 } }", 8),
        ("{ scene.gravity_m_s2: moon }", 6),
        ("{ scene.gravity_m_s2: '!= moon', steps: 10 }", 3),
        ("{ outcome: finished }", 12),
        ("[time.step_s <= 0.05, { seed: 1 }]", 4),
        ("['steps > 5', 'scene.gravity_m_s2 != moon']", 3),
        ("'seed = 1'", 6),
    ] {
        let judged = judged(&format!("{{ column: energy_end_j, max: 2, where: {filter} }}"), &rows);
        assert_eq!((judged.rows, judged.met), (count, true), "{filter}");
    }
}

#[test]
fn a_fraction_is_of_the_selected_rows() {
    let rows =
        rows(|step, _, seed| json!({ "outcome": if step > 0.06 && seed == 0 { "diverged" } else { "finished" } }));
    check("{ fraction: { outcome: diverged }, min: 0.16, max: 0.17 }", &rows, true, "0.1667 (2 of 12)");
    check("{ fraction: { outcome: diverged }, max: 0.1 }", &rows, false, "2 of 12");
    check("{ fraction: { outcome: diverged }, where: { seed: 0, time.step_s: 0.1 }, min: 1 }", &rows, true, "2 of 2");
    check("{ fraction: { criterion: energy }, max: 0 }", &rows, true, "0 of 12");
}

#[test]
fn a_trend_is_judged_within_the_cells_of_the_other_axes() {
    // The places differ by far more than the steps: pooled as they are, the numbers would show nothing.
    let offset = |place: &str| if place == "moon" { 100.0 } else { 0.0 };
    let numbers = rows(|step, place, seed| json!({ "energy_end_j": offset(place) * (1.0 + seed as f64) + step }));
    check("{ trend: energy_end_j, along: time.step_s, rising: true }", &numbers, true, "p = 7.716e-4");
    check("{ trend: energy_end_j, along: time.step_s, falling: true }", &numbers, false, "p = 1");
    check(
        "{ trend: energy_end_j, along: seed, rising: true, where: { scene.gravity_m_s2: moon } }",
        &numbers,
        false,
        "p = 0.125",
    );
    let shares = rows(|step, _, _| json!({ "outcome": if step > 0.03 { "diverged" } else { "finished" } }));
    check("{ trend: { outcome: diverged }, along: time.step_s, rising: true }", &shares, true, "0 → 1 → 1");
    check("{ trend: { outcome: diverged }, along: seed, rising: true, p_max: 0.4 }", &shares, false, "0.6667 → 0.6667");
    // A text axis goes in the order written.
    let places = rows(|_, place, _| json!({ "outcome": if place == "moon" { "diverged" } else { "finished" } }));
    check("{ trend: { outcome: diverged }, along: scene.gravity_m_s2, rising: true }", &places, true, "0 → 1");
    check(
        "{ trend: energy_end_j, along: time.step_s, rising: true, where: { time.step_s: 0.1 } }",
        &numbers,
        false,
        "single level",
    );
}

#[test]
fn an_order_is_fitted_in_every_cell() {
    let second =
        rows(|step, place, _| json!({ "energy_drift_rel": -step * step * if place == "moon" { 7.0 } else { 1.0 } }));
    check("{ order: energy_drift_rel, against: time.step_s, between: [1.9, 2.1] }", &second, true, "2 in 4 cells");
    check("{ order: energy_drift_rel, against: time.step_s, max: 1.9 }", &second, false, "2 in 4 cells");
    let one = "{ order: energy_drift_rel, against: time.step_s, between: [1.9, 2.1], where: { seed: 0, scene.gravity_m_s2: moon } }";
    check(one, &second, true, "pairwise 2.00 2.00");
    let mixed = rows(|step, place, _| json!({ "energy_drift_rel": if place == "moon" { step } else { step * step } }));
    check("{ order: energy_drift_rel, against: time.step_s, between: [1.9, 2.1] }", &mixed, false, "1 … 2 in 4 cells");
    // Errors of 1e-15 rise and fall as chance has it: no bound is met by them.
    let rounding = rows(|step, _, _| json!({ "error_position_m": 1e-16 / step }));
    let any = "{ order: error_position_m, against: time.step_s, between: [-9, 9] }";
    check(any, &rounding, false, "nothing but rounding: at most ");
    let above = rows(|step, _, _| json!({ "error_position_m": 1e-6 / step }));
    check(any, &above, true, "-1 in 4 cells");
}

#[test]
fn equality_is_bit_for_bit_or_relative_to_the_vector() {
    let at = |x: f64| json!({ "ball.position_m.x": x, "ball.position_m.y": 100.0, "ball.position_m.z": 0.0 });
    let same = rows(|_, place, _| at(if place == "moon" { 1.0 } else { 2.0 }));
    check("{ equal: ball.position_m, across: seed }", &same, true, "the same in 6 cells");
    check("{ equal: state, across: time.step_s }", &same, true, "the same in 4 cells");
    check("{ equal: ball.position_m.x, across: scene.gravity_m_s2 }", &same, false, "differs by 0.5 rel");
    // A component near zero is measured by its vector.
    let near = rows(|_, _, seed| at(1e-12 * seed as f64));
    check("{ equal: ball.position_m, across: seed }", &near, false, "differs by 1.000e-14 rel");
    check("{ equal: ball.position_m, across: seed, within_rel: 1e-13 }", &near, true, "differs by");
    check("{ equal: ball.position_m.x, across: seed, within_rel: 1e-13 }", &near, false, "differs by 1 rel");
    check("{ equal: outcome, across: seed }", &same, true, "the same");
    check("{ equal: ball.position_m, across: seed, where: { seed: 0 } }", &same, false, "a single row");
}

#[test]
fn cells_are_compared_by_ratio_or_difference() {
    let rows = rows(
        |step, _, seed| json!({ "energy_end_j": step * 100.0 + seed as f64, "outcome": if step > 0.06 { "diverged" } else { "finished" } }),
    );
    let cells = "of: { time.step_s: 0.1 }, to: { time.step_s: 0.025 }";
    check(&format!("{{ difference: energy_end_j, {cells}, min: 7.4, max: 7.6 }}"), &rows, true, "7.5 (10.5 − 3)");
    check(&format!("{{ ratio: energy_end_j, {cells}, min: 3.4, max: 3.6 }}"), &rows, true, "3.5 (10.5 / 3)");
    check(
        &format!("{{ ratio: energy_end_j, {cells}, where: {{ seed: 0 }}, min: 4, max: 4 }}"),
        &rows,
        true,
        "4 (10 / 2.5)",
    );
    check(&format!("{{ difference: {{ outcome: diverged }}, {cells}, min: 1 }}"), &rows, true, "1 (1 − 0)");
    let fraction = format!("{{ difference: {{ fraction: {{ outcome: diverged }} }}, {cells}, min: 1 }}");
    check(&fraction, &rows, true, "1 (1 − 0)");
    check(&format!("{{ ratio: {{ outcome: diverged }}, {cells}, min: 5 }}"), &rows, false, "inf (1 / 0)");
}

//! What is said of a comparison, on the screen and on a page.

use super::output::counted;
use crate::check::{Change, Compared, FactorBound, Side, short};
use crate::math::interval::Interval;
use serde_json::{Map, Value};

/// What one side is, in words.
pub(super) fn described(side: &Side) -> String {
    let missing = match side.planned - side.rows.len().min(side.planned) {
        0 => String::new(),
        n => format!(", {n} missing"),
    };
    let Side { name, program, build, rows, .. } = side;
    let build = if build.is_empty() { String::new() } else { format!(", build {build}") };
    format!("{name} ({program}{build}, {}{missing})", counted(rows.len(), "row"))
}

/// What was joined, and what could not be, in sentences.
pub(super) fn joined(compared: &Compared) -> Vec<String> {
    let Compared { axes, axes_of_a, axes_of_b, cells, cells_of_a, cells_of_b, .. } = compared;
    let mut lines = vec![match axes.is_empty() {
        true => "one run each".to_string(),
        false => format!("joined by {}: {} in both", axes.join(", "), counted(*cells, "case")),
    }];
    let following: Vec<String> =
        compared.following.iter().map(|(path, leader)| format!("{path} (with {leader})")).collect();
    if !following.is_empty() {
        lines.push(format!("advance side by side with what they are joined by: {}", following.join(", ")));
    }
    for (name, alone, count, places) in
        [("A", axes_of_a, cells_of_a, &compared.places_of_a), ("B", axes_of_b, cells_of_b, &compared.places_of_b)]
    {
        if !alone.is_empty() {
            let axes = if alone.len() == 1 { "axis" } else { "axes" };
            lines.push(format!("{name} alone has the {axes} {}: its rows are pooled", alone.join(", ")));
        }
        if *count > 0 {
            let shown: Vec<String> = places.iter().take(3).map(at).collect();
            let more = if *count > shown.len() { "; …" } else { "" };
            lines.push(format!("only in {name}: {} ({}{more})", counted(*count, "case"), shown.join("; ")));
        }
    }
    if compared.missing > 0 {
        let shown: Vec<String> = compared.places_missing.iter().take(3).map(at).collect();
        let more = if compared.missing > shown.len() { "; …" } else { "" };
        lines.push(format!(
            "missing in B, whose plan has their values: {} of A ({}{more})",
            counted(compared.missing, "case"),
            shown.join("; ")
        ));
    }
    lines
}

/// A place on the axes.
pub(super) fn at(axes: &Map<String, Value>) -> String {
    // A method of a bench has a step or a tolerance.
    let given = axes.iter().filter(|(_, value)| !value.is_null());
    given.map(|(path, value)| format!("{path} = {}", cell(value))).collect::<Vec<_>>().join(", ")
}

/// A cell for people.
pub(super) fn cell(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) if number.is_f64() => short(number.as_f64().unwrap_or(f64::NAN)),
        other => other.to_string(),
    }
}

/// What is worse, or that nothing is.
pub(super) fn finding(compared: &Compared) -> String {
    match compared.regression_count {
        0 => "nothing is worse by more than 10 % and above rounding".to_string(),
        n => format!("{} worse in B", counted(n, "number")),
    }
}

/// Columns that differ, or are better or worse somewhere.
pub(super) fn changed(compared: &Compared) -> Vec<&Change> {
    compared.columns.iter().filter(|change| !is_same(change)).collect()
}

fn is_same(change: &Change) -> bool {
    change.median_a == change.median_b && change.better + change.worse == 0
}

/// Factor from A to B; on one side of it where a floor has decided it, empty where floors leave none.
pub(super) fn factor(change: &Change) -> String {
    let bound = match change.bound {
        None => "",
        Some(FactorBound::Below) => "< ",
        Some(FactorBound::Above) => "> ",
    };
    change.factor.map(|factor| format!("{bound}{}", brief(factor))).unwrap_or_default()
}

/// What the factor is.
pub(super) const FACTOR: &str = "B / A: geometric mean over the cases that finished in both and have a number in both, \
                                 with its 95 % interval; what is at or below the column's floor (rounding, zero) is \
                                 taken for the floor: then `<` or `>`, or nothing where floors are on both sides";

/// Interval of the factor, in brackets.
pub(super) fn interval(change: &Change) -> String {
    change.interval.map(|i: Interval| format!("({}…{})", brief(i.low), brief(i.high))).unwrap_or_default()
}

/// A number to three digits; a very large or small one to two.
pub(super) fn brief(x: f64) -> String {
    let is_plain = x == 0.0 || (1e-3..1e5).contains(&x.abs());
    if is_plain { short(format!("{x:.2e}").parse().unwrap_or(x)) } else { format!("{x:.1e}") }
}

/// Columns that are the same everywhere, cannot be compared, or differ without a better, in sentences.
pub(super) fn others(compared: &Compared) -> Vec<String> {
    let same: Vec<&str> = compared.columns.iter().filter(|c| is_same(c)).map(|c| c.column.as_str()).collect();
    let counts = |all: &[(String, usize)]| {
        all.iter().map(|(name, count)| format!("{name} ({count})")).collect::<Vec<_>>().join(", ")
    };
    let refused = compared.refused.iter();
    let refused: Vec<String> = refused.map(|(name, format)| format!("{name} (format {format})")).collect();
    let mut lines = Vec::new();
    for (said, names) in [
        ("missing in B (numbers in A in so many cases)", counts(&compared.missing_in_b)),
        ("missing in A (numbers in B in so many cases)", counts(&compared.missing_in_a)),
        ("the same to 10 % or rounding", same.join(", ")),
        ("differ, and nothing says what is better (in so many cases)", counts(&compared.differing)),
        ("not compared, because their meaning has changed", refused.join(", ")),
    ] {
        if !names.is_empty() {
            lines.push(format!("{said}: {names}"));
        }
    }
    lines
}

/// Shares of outcomes with their intervals, and how many cells have another one.
pub(super) fn outcomes(compared: &Compared) -> Vec<String> {
    let percent = |x: f64| format!("{:.0}", 100.0 * x);
    let mut lines: Vec<String> = compared
        .outcomes
        .iter()
        .map(|s| {
            let side =
                |k: usize, n: usize, i: Interval| format!("{k} of {n} ({} … {} %)", percent(i.low), percent(i.high));
            let (a, b) = (side(s.a, s.of_a, s.interval_a), side(s.b, s.of_b, s.interval_b));
            format!("{:9} A {a}, B {b}", s.outcome)
        })
        .collect();
    for moved in &compared.moved {
        lines.push(format!("  {} → {}: {}", moved.from, moved.to, counted(moved.cells, "case")));
    }
    lines
}

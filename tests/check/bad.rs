//! What cannot be judged or searched is refused before the first run, with its line and key.

use crate::yaml;
use gotai::check::{Schema, refuse_unknown};
use gotai::experiment::{ExperimentError, ExperimentFile};
use gotai::measure::more;
use gotai::sweep::plan::cases;
use std::path::Path;

/// Ends on line 13.
const BASE: &str = "scene:
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - name: ball
      shape: { sphere: { radius_m: 0.1 } }
      mass_kg: 1
      position_m: [0, 2, 0]
method: time-stepping
time: { step_s: 0.01, end_s: 0.1 }
sweep:
  axes:
    time.step_s: [0.01, 0.005]
    seed: [0, 1]
";

fn error(tail: &str) -> ExperimentError {
    let file = match ExperimentFile::from_text(Path::new("test.yaml"), &format!("{BASE}{tail}"), &[]) {
        Ok(file) => file,
        Err(error) => return error,
    };
    let cases = match cases(&file) {
        Ok(cases) => cases,
        Err(error) => return error,
    };
    let schema = Schema::new(file.axes(), None, &more::names(&cases[0].case.experiment));
    refuse_unknown(&schema, file.expect(), file.search()).expect_err(tail)
}

/// What is added, path, what the message says.
const EXPECT: &[(&str, &str, &str)] = &[
    ("{ column: energy_drft_rel, max: 1 }", "expect.0.column", "did you mean `energy_drift_rel`?"),
    ("{ column: energy_end_j / stps, max: 1 }", "expect.0.column", "did you mean `steps`?"),
    ("{ column: outcome, max: 1 }", "expect.0.column", "expected a column of numbers, found `outcome`, which is text"),
    ("{ column: steps }", "expect.0", "missing: a bound (min, max, above, below, between, within)"),
    ("{ ratio: steps, of: { seed: 0 }, to: { seed: 1 } }", "expect.0", "a bound (min, max, above, below, between)"),
    ("{ column: steps, within: -1 }", "expect.0.within", "expected a finite number of at least 0, found -1"),
    ("{ column: steps, within: .inf }", "expect.0.within", "expected a finite number, found .inf"),
    ("{ column: steps, within: .nan }", "expect.0.within", "expected a finite number, found .nan"),
    ("{ column: steps, within: 1, max: 2 }", "expect.0.within", "found `within` and `max`"),
    ("{ column: steps, min: 1, within: 1 }", "expect.0.within", "found `within` and `min`"),
    ("{ column: steps, within: 1, above: 2 }", "expect.0.within", "found `within` and `above`"),
    ("{ column: steps, within: 1, below: 2 }", "expect.0.within", "found `within` and `below`"),
    ("{ column: steps, within: 1, between: [0, 1] }", "expect.0.between", "found [0, 1] and `within`"),
    ("{ ratio: steps, of: { seed: 0 }, to: { seed: 1 }, within: 1 }", "expect.0.within", "only keys of `ratio`"),
    ("{ order: steps, against: time.step_s, within: 1 }", "expect.0.within", "only keys of `order`"),
    ("{ fraction: { outcome: diverged }, within: 1 }", "expect.0.within", "only keys of `fraction`"),
    ("{ fraction: { column: steps, within: 1, max: 1 }, min: 1 }", "expect.0.fraction.within", "`within` and `max`"),
    ("{ column: steps, min: 2, max: 1 }", "expect.0.max", "an upper bound that some number above 2 meets, found 1"),
    ("{ column: steps, above: 2, max: 2 }", "expect.0.max", "found 2"),
    ("{ column: steps, max: 1, where: { sed: 0 } }", "expect.0.where.sed", "did you mean `seed`?"),
    ("{ column: steps, max: 1, where: { seed: 5 } }", "expect.0.where.seed", "expected one of 0, 1, found `5`"),
    ("{ column: steps, max: 1, where: { time.step_s: [0.01, 0.02] } }", "expect.0.where.time.step_s", "found `0.02`"),
    ("{ column: steps, max: 1, where: { seed: '<= one' } }", "expect.0.where.seed", "expected a number after the sign"),
    ("{ column: steps, max: 1, where: { outcome: '< 1' } }", "expect.0.where.outcome", "which is text"),
    ("{ column: steps, max: 1, between: [0, 1] }", "expect.0.between", "without other bounds beside it"),
    ("{ column: steps, max: 1, where: seed }", "expect.0.where", "axes or columns with their values"),
    ("{ column: steps, max: 1, where: ['sed < 1'] }", "expect.0.where.sed", "did you mean `seed`?"),
    ("{ column: steps, max: 1, along: seed }", "expect.0.along", "expected only keys of `column`"),
    (
        "{ fraction: { outcome: exploded }, max: 1 }",
        "expect.0.fraction.outcome",
        "expected one of finished, diverged, stalled, failed",
    ),
    ("{ fraction: { criterion: escpe }, max: 1 }", "expect.0.fraction.criterion", "did you mean `escape`?"),
    ("{ fraction: { column: steps }, max: 1 }", "expect.0.fraction", "missing: a bound"),
    ("{ fraction: { outcome: diverged }, max: 2 }", "expect.0.max", "expected a share from 0 to 1, found 2"),
    ("{ fraction: {}, max: 1 }", "expect.0.fraction", "missing: one of outcome, criterion, or column"),
    ("{ trend: { outcome: diverged }, rising: true }", "expect.0.along", "missing"),
    ("{ trend: { outcome: diverged }, along: mass, rising: true }", "expect.0.along", "found `mass`"),
    ("{ trend: { outcome: diverged }, along: seed }", "expect.0", "missing: `rising: true` or `falling: true`"),
    (
        "{ trend: steps, along: seed, rising: true, falling: true }",
        "expect.0.rising",
        "one of `rising: true` and `falling: true`",
    ),
    (
        "{ trend: steps, along: seed, rising: true, p_max: 0 }",
        "expect.0.p_max",
        "a probability between 0 and 1, found 0",
    ),
    ("{ order: steps, against: time.stp_s, between: [1, 2] }", "expect.0.against", "did you mean `time.step_s`?"),
    ("{ order: steps, against: time.step_s, between: [2, 1] }", "expect.0.between", "found [2, 1]"),
    ("{ equal: steps, across: steps }", "expect.0.across", "expected one of time.step_s, seed, found `steps`"),
    ("{ equal: state, across: seed }", "expect.0.equal", "found `state`"),
    ("{ equal: steps, across: seed, within_rel: -1 }", "expect.0.within_rel", "at least 0"),
    ("{ ratio: steps, of: { seed: 0 }, min: 1 }", "expect.0.to", "missing"),
    ("{ difference: steps, of: { seed: 0 }, to: { seed: 2 }, min: 1 }", "expect.0.to.seed", "found `2`"),
    ("{ colum: steps, max: 1 }", "expect.0.colum", "did you mean `column`?"),
    ("{ why: because }", "expect.0", "missing: one of column, fraction, trend, order, equal, ratio, difference"),
    ("{ column: steps, fraction: { outcome: diverged }, max: 1 }", "expect.0.fraction", "only keys of `column`"),
];

fn all_are_refused(rows: &[(&str, &str, &str)], tail: impl Fn(&str) -> String) {
    for (text, path, message) in rows {
        let error = error(&tail(text));
        let (details, shown) = (error.details(), error.to_string());
        assert_eq!(details.path.to_string(), *path, "{text}: {shown}");
        assert!(shown.contains(message), "{text}: {shown}");
    }
}

#[test]
fn an_expectation_that_cannot_be_judged_is_refused() {
    all_are_refused(EXPECT, |text| format!("expect:\n  - {text}\n"));
}

const SEARCH: &[(&str, &str, &str)] = &[
    (
        "critical: time.step_s, between: [1, 2], until: { outcome: diverged }",
        "sweep.search.critical",
        "`time.step_s` is searched and an axis",
    ),
    (
        "critical: time.end_s, between: [2, 1], until: { outcome: diverged }",
        "sweep.search.between",
        "expected [low, high] with low < high, found [2, 1]",
    ),
    ("critical: time.end_s, between: [1, 1], until: { outcome: diverged }", "sweep.search.between", "found [1, 1]"),
    ("critical: time.end_s, between: [1], until: { outcome: diverged }", "sweep.search.between", "a list of 2"),
    (
        "critical: time.end_s, between: [0, 1], until: { outcome: diverged }",
        "time.end_s",
        "greater than 0, found 0 (from the axis time.end_s = 0)",
    ),
    ("critical: time.end, between: [1, 2], until: { outcome: diverged }", "time.end", "did you mean `end_s`?"),
    ("critical: time.end_s, between: [1, 2]", "sweep.search.until", "missing"),
    (
        "critical: time.end_s, between: [1, 2], until: { outcome: divergd }",
        "sweep.search.until.outcome",
        "found `divergd`",
    ),
    (
        "critical: time.end_s, between: [1, 2], until: { column: stps, above: 1 }",
        "sweep.search.until.column",
        "did you mean `steps`?",
    ),
    ("critical: time.end_s, between: [1, 2], until: { column: steps }", "sweep.search.until", "missing: a bound"),
    (
        "critical: time.end_s, between: [1, 2], until: { outcome: diverged }, over: sed",
        "sweep.search.over",
        "did you mean `seed`?",
    ),
    (
        "critical: time.end_s, between: [1, 2], until: { outcome: diverged }, fraction: 0.5",
        "sweep.search.over",
        "missing: the axis of the `fraction`",
    ),
    (
        "critical: time.end_s, between: [1, 2], until: { outcome: diverged }, over: seed, fraction: 0",
        "sweep.search.fraction",
        "found 0",
    ),
    (
        "critical: time.end_s, between: [1, 2], until: { outcome: diverged }, relative_width: 0",
        "sweep.search.relative_width",
        "found 0",
    ),
];

#[test]
fn a_search_that_cannot_be_made_is_refused() {
    all_are_refused(SEARCH, |text| format!("  search: {{ {text} }}\n"));
}

#[test]
fn the_searched_key_is_refused_as_an_axis_under_any_name() {
    let text = BASE.replace("time.step_s: [0.01, 0.005]", "scene.bodies.0.mass_kg: [1, 2]");
    let text = format!(
        "{text}  search: {{ critical: scene.bodies.ball.mass_kg, between: [1, 2], until: {{ outcome: diverged }} }}\n"
    );
    let error = ExperimentFile::from_text(Path::new("test.yaml"), &text, &[]).unwrap_err().to_string();
    assert!(error.contains("`scene.bodies.0.mass_kg` is searched and an axis"), "{error}");
}

#[test]
fn a_single_run_of_a_search_names_the_searched_key() {
    let text = format!("{BASE}  search: {{ critical: time.end_s, between: [1, 2], until: {{ outcome: diverged }} }}\n");
    let error = yaml::file(&text, &["seed=0", "time.step_s=0.01"]).experiment().unwrap_err().to_string();
    assert!(error.contains("axes are left: time.end_s"), "{error}");
    let fixed = yaml::file(&text, &["seed=0", "time.step_s=0.01", "time.end_s=1"]);
    assert_eq!(fixed.experiment().unwrap().time.end_s, 1.0);
}

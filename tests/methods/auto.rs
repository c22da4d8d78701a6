//! `auto`: what it chooses, and whether that is what is run.

use crate::scratch;
use crate::sweep::{planned, sweep};
use crate::yaml::{experiment, file, measured, run};
use gotai::bench;
use gotai::outcome::Outcome;
use gotai::plan::Plan;
use gotai::record::writer::Target;
use gotai::rows::Measured;
use gotai::study::choose::{Asked, HALVINGS};
use std::time::Instant;

/// Nothing to hit: one closed form from start to end.
const THROWN: &str = "
scene:
  bodies:
    - { name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 3, 0], velocity_m_s: [1, 0, 0] }
method: { auto: { tolerance: 1e-8 } }
time: { end_s: 0.5 }
exact: free-motion
";

#[test]
fn without_contact_auto_is_event_driven_and_says_how_accurate() {
    let Measured { outcome, method_used, tolerance_used, error_estimate_m, error_position_m, sensitivity, .. } =
        measured(THROWN, &[]);
    assert_eq!((outcome, method_used.as_deref()), (Outcome::Finished, Some("event-driven")));
    assert_eq!(tolerance_used, Some(1e-8));
    // Two closed forms agree: what is left is the rounding of some metres.
    let (estimate_m, error_m) = (error_estimate_m.unwrap(), error_position_m.unwrap());
    assert!(error_m <= estimate_m && estimate_m < 1e-12, "{error_m:e} {estimate_m:e}");
    assert!(sensitivity.is_some());
}

#[test]
fn the_run_is_that_of_the_chosen_method_to_the_bit() {
    let auto = run(&experiment(THROWN, &[]));
    let named = run(&experiment(THROWN, &["method={event-driven: {tolerance: 1e-8}}", "measure=[sensitivity]"]));
    assert_eq!(auto.state, named.state);
    let blank = |measured: &Measured| Measured {
        method_used: None,
        tolerance_used: None,
        error_estimate_m: None,
        tolerance_met: None,
        ..measured.without_wall_time()
    };
    assert_eq!(blank(&auto.measured), blank(&named.measured));
}

#[test]
fn the_smallest_tolerance_is_compared_with_a_larger_one() {
    let all = [1e-13, 1e-12, 3e-13].map(|tolerance| {
        let set = format!("method.auto.tolerance={tolerance:e}");
        measured(THROWN, &[&set]).error_estimate_m.unwrap()
    });
    // measured: 2.5e-14, of rounding alone
    assert!(all.iter().all(|estimate_m| *estimate_m > 0.0 && *estimate_m < 1e-13), "{all:?}");
}

const SLIDING: &str = "
scene:
  friction: 0.3
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: slab, shape: { box: { size_m: [1, 0.2, 1] } }, mass_kg: 1, position_m: [0, 0.1, 0], velocity_m_s: [5, 0, 0] }]
method: { auto: { tolerance: 1e-4 } }
time: { end_s: 3 }
exact: sliding
";

/// What takes over where events do not lead to the end.
#[test]
fn a_step_is_halved_until_two_runs_agree() {
    let mut experiment = experiment(SLIDING, &[]);
    let (model, start) = gotai::scene::build(&experiment).unwrap();
    let scene = Asked {
        experiment: &experiment.clone(),
        model: &model,
        start: &start,
        tolerance: 1e-4,
        started: Instant::now(),
    };
    let found = scene.by_steps();
    (experiment.method, experiment.time.step_s) = (found.method.clone().into(), found.step_s);
    let error_m = run(&experiment).measured.error_position_m.unwrap();
    // measured: an error of 5.2e-6 at steps of 3.75 ms
    assert!(error_m <= found.estimate_m && found.estimate_m <= 1e-4, "{error_m:e} {:e}", found.estimate_m);
    // Of steps of the end over 100 · 2ⁿ, no shorter than it needs.
    let halvings = (3.0 / 100.0 / found.step_s.unwrap()).log2();
    assert!(halvings == halvings.round() && (1.0..=f64::from(HALVINGS)).contains(&halvings), "{halvings}");
}

#[test]
fn a_limit_ends_the_search_as_it_ends_a_run() {
    let experiment = experiment(SLIDING, &["limits.steps=150"]);
    let (model, start) = gotai::scene::build(&experiment).unwrap();
    let scene =
        Asked { experiment: &experiment, model: &model, start: &start, tolerance: 1e-4, started: Instant::now() };
    // 100 steps arrive, 200 do not: nothing to compare.
    assert_eq!(scene.by_steps().estimate_m, f64::INFINITY);
}

#[test]
fn a_bench_times_what_was_chosen() {
    let text = format!("{THROWN}bench: {{ methods: [auto], tolerances: [1e-6, 1e-9], repeats: 1 }}\n");
    let file = file(&text, &[]);
    let given = file.bench().unwrap();
    let rows: Vec<_> = bench::plan(&file, given)
        .unwrap()
        .iter()
        .map(|trial| bench::run(trial, given, "a", None).unwrap().row)
        .collect();
    let shown: Vec<_> = rows.iter().map(|row| (row.method.as_str(), row.tolerance, row.outcome.as_str())).collect();
    assert_eq!(shown, [("auto", Some(1e-6), "finished"), ("auto", Some(1e-9), "finished")]);
    assert!(rows.iter().all(|row| row.error.unwrap() < 1e-12 && row.wall_s.unwrap() > 0.0));
}

#[test]
fn a_recorded_run_is_the_same_run() {
    let folder = scratch::folder();
    let cases = planned(THROWN, &["record.every_s=0.1"]);
    let (_, rows) = sweep(&cases, folder.path(), Target::AVAILABLE);
    assert_eq!(rows[0].measured.without_wall_time(), measured(THROWN, &[]).without_wall_time());
    assert!(rows[0].measured.wall_search_s.is_some());
}

#[test]
fn explain_says_what_auto_considers() {
    let (model, _) = gotai::scene::build(&experiment(THROWN, &[])).unwrap();
    let of = |set: &str| Plan::new(&model, &experiment(THROWN, &[set]).method).stages;
    let choice = of("seed=0").pop().unwrap();
    assert!(
        choice.runs && choice.name == "choice of method" && choice.why.starts_with("event-driven at 1e-8"),
        "{choice:?}"
    );
    assert!(of("method=event-driven").iter().all(|stage| stage.name != choice.name));
}

/// Three bounces of a ball that comes to roll.
const BOUNCING: &str = "
scene:
  restitution: 0.8
  friction: 0.3
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 1.5, 0], velocity_m_s: [1, 0, 0] }]
method: { auto: { tolerance: 1e-8 } }
time: { end_s: 2 }
exact: ball
";

#[test]
fn through_impacts_the_estimate_is_not_below_the_error() {
    for tolerance in ["1e-4", "1e-8", "1e-12"] {
        let set = format!("method.auto.tolerance={tolerance}");
        let Measured { method_used, error_estimate_m, error_position_m, .. } = measured(BOUNCING, &[&set]);
        assert_eq!(method_used.as_deref(), Some("event-driven"));
        let (estimate_m, error_m) = (error_estimate_m.unwrap(), error_position_m.unwrap());
        // measured: 6.8e-16, 2.2e-14
        assert!(error_m <= estimate_m && estimate_m <= 1e-12, "{tolerance}: {error_m:e} {estimate_m:e}");
    }
}

#[test]
fn where_the_answer_is_known_the_estimate_is_not_below_the_error() {
    for scene in
        ["superball", "ladder", "rimless-wheel", "dome", "stick-slip", "falling-rod", "rocking-block", "turntable"]
    {
        let path = format!("{}/configs/contact/{scene}.yaml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        let (base, _) = text.split_once("\nsweep:").unwrap();
        let Measured { error_estimate_m, error_position_m, .. } = measured(base, &["method=auto"]);
        let (estimate_m, error_m) = (error_estimate_m.unwrap(), error_position_m.unwrap());
        // measured: the estimate is 1.9 (the rocking block) to 22 times the error, and 1.2e-7 at most
        assert!(error_m <= estimate_m && estimate_m <= 1e-6, "{scene}: {error_m:e} {estimate_m:e}");
    }
}

/// A tilted crate falls on a floor 10⁸ m from the origin, where rounding is 1.5e-8 m.
const FAR_AWAY: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.4
  container: { plane: { normal: [0, 1, 0], offset_m: 1e8 } }
  bodies: [{ name: crate, shape: { box: { size_m: [0.5, 0.5, 0.5] } }, mass_kg: 1, position_m: [0, 100000001, 0], orientation: { axis: [0, 0, 1], angle_deg: 20 }, velocity_m_s: [1, 0, 0] }]
method: auto
time: { end_s: 1 }
";

#[test]
fn where_rounding_is_more_than_the_tolerance_auto_ends_and_says_so() {
    let of = |set: &str| measured(FAR_AWAY, &[set]);
    let far = of("seed=0");
    assert_eq!((far.outcome, far.tolerance_met.as_deref()), (Outcome::Finished, Some("no")));
    // measured: 1.5e-6 (2853 steps); half of it is rounding
    assert!((1e-6..1e-5).contains(&far.error_estimate_m.unwrap()), "{far:?}");
    assert!(far.steps < 10_000, "{}", far.steps);
    // A push there is no ghost.
    assert!(far.ghost_impulse_max_rel.unwrap() < 1e-6, "{far:?}");
    assert_eq!(of("method.auto.tolerance=1e-4").tolerance_met.as_deref(), Some("yes"));
}

#[test]
fn who_chooses_himself_is_told_of_no_tolerance() {
    assert_eq!(measured(THROWN, &["method=event-driven"]).tolerance_met, None);
    assert_eq!(measured(THROWN, &[]).tolerance_met.as_deref(), Some("yes"));
}

//! When a run counts as diverged: each criterion by its name, at its time.

use crate::yaml::{CUBE_IN_BOX, measured};
use gotai::outcome::Outcome;
use gotai::rows::Measured;

const FALLING: &str = "
scene:
  container: { box: { size_m: [4, 4, 4] } }
  bodies:
    - { name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 2, 0] }
method: free
time: { step_s: 0.001, end_s: 2 }
";

fn stopped(sets: &[&str]) -> (Outcome, Option<String>, f64) {
    let Measured { outcome, criterion, end_time_s, .. } = measured(FALLING, sets);
    (outcome, criterion, end_time_s.unwrap())
}

fn diverged(sets: &[&str], criterion: &str, time_s: f64) {
    let (outcome, found, at) = stopped(sets);
    assert_eq!((outcome, found.as_deref()), (Outcome::Diverged, Some(criterion)), "{sets:?}");
    assert!((at - time_s).abs() < 2.5e-3, "{sets:?}: {at} instead of {time_s}");
}

/// `free` does not see the floor: the centre falls through it and leaves by more than the radius at −0.5 m.
#[test]
fn a_body_outside_its_container_has_escaped() {
    diverged(&[], "escape", (2.0_f64 * 2.5 / 9.8).sqrt());
    assert_eq!(stopped(&["diverge.escape=false"]).0, Outcome::Finished);
    // Without a container there is nowhere to escape from; a point is held by nothing.
    assert_eq!(stopped(&["scene.container=null"]).0, Outcome::Finished);
    assert_eq!(stopped(&["scene.bodies.ball.shape=none"]).0, Outcome::Finished);
}

#[test]
fn speed_and_penetration_are_limits_only_when_given() {
    diverged(&["diverge.speed_m_s=4.9"], "speed", 0.5);
    // The middle of a step sees a ball inside that bounces.
    let deep = [
        "method={time-stepping: {scheme: moreau}}",
        "scene.restitution=0.5",
        "scene.bodies.ball.velocity_m_s=[0, -10, 0]",
    ];
    assert_eq!(stopped(&deep).0, Outcome::Finished);
    let limited = [&deep[..], &["time.step_s=0.01", "diverge.penetration_m=1e-3"]].concat();
    let (outcome, criterion, _) = stopped(&limited);
    assert_eq!((outcome, criterion.as_deref()), (Outcome::Diverged, Some("penetration")));
}

#[test]
fn energy_is_held_against_its_start_value_unless_that_is_zero() {
    let exploded = (0..20).find_map(|seed| {
        let seed = format!("seed={seed}");
        let sets = ["method=lecture", "scene.bodies.cube.mesh.nodes_per_edge=5", "time.step_s=0.02", seed.as_str()];
        Some(measured(CUBE_IN_BOX, &sets)).filter(|m| m.criterion.as_deref() == Some("energy"))
    });
    let m = exploded.expect("half of these explode");
    assert_eq!(m.outcome, Outcome::Diverged);
    let (start, end) = (m.energy_start_j.unwrap(), m.energy_end_j.unwrap());
    assert!(end > 1000.0 * start && m.steps < 100, "{start} {end}");
    // Without a container the potential is zero at the start: nothing to hold it against.
    let m = measured(FALLING, &["scene.container=null", "diverge.energy_factor=1.5"]);
    assert_eq!((m.energy_start_j, m.outcome), (Some(0.0), Outcome::Finished));
}

#[test]
fn numbers_that_are_not_finite_stop_a_run_always() {
    let off =
        ["diverge={energy_factor: null, escape: false}", "scene.bodies.cube.mesh.nodes_per_edge=5", "time.end_s=20"];
    let m = measured(CUBE_IN_BOX, &[&off[..], &["method={lecture: {iteration: jacobi}}"]].concat());
    assert_eq!((m.outcome, m.criterion.as_deref()), (Outcome::Diverged, Some("not-finite")));
    assert_eq!(m.energy_end_j, None);
}

#[test]
fn a_run_that_needs_more_than_its_limit_stalls_and_keeps_what_it_has() {
    let limited = |sets: &[&str]| {
        let Measured { outcome, criterion, end_time_s, steps, energy_drift_rel, .. } = measured(FALLING, sets);
        (outcome, criterion, end_time_s.unwrap(), steps, energy_drift_rel.is_some())
    };
    let no_floor = "scene.container=null";
    let limit = || Some("limit".to_string());
    assert_eq!(limited(&[no_floor, "limits.steps=500"]), (Outcome::Stalled, limit(), 0.5, 500, true));
    // Just enough is enough, and nothing of a step is lost.
    assert_eq!(limited(&[no_floor, "limits.steps=2000"]), (Outcome::Finished, None, 2.0, 2000, true));
    let (outcome, criterion, end_s, steps, _) = limited(&[no_floor, "limits.wall_s=1e-9"]);
    assert_eq!((outcome, criterion, steps), (Outcome::Stalled, limit(), 1));
    assert_eq!(end_s, 1e-3);
    // What the method does not count does not limit it.
    assert_eq!(limited(&[no_floor, "limits.events=1"]).0, Outcome::Finished);
}

#[test]
fn limits_belong_to_what_a_case_is() {
    let id = |sets: &[&str]| gotai::sweep::plan::single_case(&crate::yaml::file(FALLING, sets)).unwrap().id;
    assert_eq!(id(&[]), id(&["limits={}"]));
    assert_ne!(id(&[]), id(&["limits.steps=5"]));
}

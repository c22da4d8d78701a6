//! Steps that are not worked out change no bit of the motion.

use crate::yaml::{CUBE_IN_BOX, experiment};
use gotai::experiment::types::{Skip, Skips};
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::state::State;
use gotai::step::Stepper;
use gotai::work::Work;

/// Neither flight nor rest is skipped.
fn worked_out() -> Skips {
    Skips::default().without(Skip::Flight).without(Skip::Rest)
}

/// All states on the way of a scene, and the work.
fn way(yaml: &str, sets: &[&str], skips: Skips) -> (Vec<State>, Work) {
    let experiment = experiment(yaml, sets);
    let (model, start) = build(&experiment).unwrap();
    let clock = experiment.clock();
    let plan = Plan { skips, ..Plan::new(&model, &experiment.method) };
    let mut stepper = Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &start);
    let (mut state, mut way) = (start, Vec::new());
    while state.step < clock.steps {
        stepper.step(&model, &mut state, &clock);
        way.push(state.clone());
    }
    (way, *stepper.work())
}

fn bits(way: &[State]) -> Vec<u64> {
    let of = |state: &State| {
        let bodies = state.bodies.iter().flat_map(|at| {
            let q = at.q_WB.coords;
            at.p_WB.iter().chain(q.iter()).chain(at.v_WB.iter()).chain(at.w_WB.iter()).copied().collect::<Vec<_>>()
        });
        bodies.chain([state.time_s]).map(f64::to_bits).collect::<Vec<_>>()
    };
    way.iter().flat_map(of).collect()
}

#[test]
fn flight_and_rest_are_skipped_to_the_same_bits() {
    for solver in ["auto", "pgs", "newton", "nncg"] {
        let method = format!("method={{time-stepping: {{solver: {solver}}}}}");
        for mesh in ["nodes_per_edge: 2", "nodes_per_edge: 3"] {
            for seed in [1, 2] {
                let mesh = format!("scene.bodies.cube.mesh={{ {mesh} }}");
                let seed = format!("seed={seed}");
                let sets = [method.as_str(), mesh.as_str(), seed.as_str(), "time.end_s=4", "time.step_s=0.004"];
                let (skipped, work) = way(CUBE_IN_BOX, &sets, Skips::default());
                let (full, all) = way(CUBE_IN_BOX, &sets, worked_out());
                assert!(bits(&skipped) == bits(&full), "{sets:?}");
                assert!(work.flight_steps > 50, "{sets:?}: {work:?}");
                assert_eq!([all.flight_steps, all.rest_steps], [0, 0]);
            }
        }
    }
}

const RESTING: &str = "
scene:
  friction: 0.5
  container: { plane: { normal: [0, 1, 0], offset_m: 0 } }
  bodies:
    - { name: crate, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 2, position_m: [0.3, 0.5, -0.7] }
    - { name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [3, 0.6, 0] }
method: time-stepping
time: { step_s: 0.002, end_s: 4 }
";

#[test]
fn what_rests_is_not_worked_out_again() {
    let (skipped, work) = way(RESTING, &[], Skips::default());
    let (full, _) = way(RESTING, &[], worked_out());
    assert!(bits(&skipped) == bits(&full));
    // measured: 1926 of 2000
    assert!(work.rest_steps > 1000, "{work:?}");
}

#[test]
fn what_changes_with_time_wakes_what_rests() {
    let force =
        "scene.forces=[{ body: crate, force_n: [30, 0, 0], as: { cosine: { frequency_rad_s: 2, phase_rad: 1.5 } } }]";
    let (skipped, work) = way(RESTING, &[force], Skips::default());
    let (full, _) = way(RESTING, &[force], worked_out());
    assert!(bits(&skipped) == bits(&full));
    assert_eq!(work.rest_steps, 0);
    let moved_m = full.last().unwrap().bodies[0].p_WB.x - 0.3;
    assert!(moved_m.abs() > 0.1, "{moved_m}");
}

#[test]
fn what_falls_slowly_does_not_rest() {
    // A step in which a body falls by less than the last bit of its height.
    let sets = ["time={ step_s: 1e-9, end_s: 1e-6 }", "scene.bodies.ball.position_m=[3, 1000, 0]"];
    let (full, _) = way(RESTING, &sets, Skips::default());
    let v = full.last().unwrap().bodies[1].v_WB.y;
    assert!((v + 9.8e-6).abs() < 1e-12, "{v}");
}

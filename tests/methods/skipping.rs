//! What a scene does not need is skipped, and skipping changes nothing.

use crate::yaml::{CUBE_IN_BOX, FREE_BAR, experiment, measured};
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::state::State;
use gotai::step::Stepper;

/// Steps without the judges, with the model and plan as given.
fn end(text: &str, sets: &[&str], change: impl Fn(&mut gotai::model::Model, &mut Plan)) -> (State, u64) {
    let experiment = experiment(text, sets);
    let (mut model, mut state) = build(&experiment).unwrap();
    let mut plan = Plan::new(&model, &experiment.method);
    change(&mut model, &mut plan);
    let mut stepper = Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &state);
    let clock = experiment.clock();
    while state.step < clock.steps {
        stepper.step(&model, &mut state, &clock);
    }
    (state, stepper.work().gyroscopic)
}

#[test]
fn normal_rows_alone_are_the_whole_frictionless_motion() {
    let sets = ["scene.friction=0", "scene.bodies.cube.mesh.nodes_per_edge=4"];
    let skipping = end(CUBE_IN_BOX, &sets, |_, plan| assert!(!plan.friction));
    let full = end(CUBE_IN_BOX, &sets, |_, plan| plan.friction = true);
    assert_eq!(skipping, full);
}

#[test]
fn equal_moments_need_no_gyroscopic_term() {
    let ball = ["scene.bodies.bar.shape={sphere: {radius_m: 0.5}}", "time.end_s=2"];
    let (skipping, none) = end(FREE_BAR, &ball, |model, _| assert!(model.bodies[0].isotropic));
    let (full, some) = end(FREE_BAR, &ball, |model, _| model.bodies[0].isotropic = false);
    assert_eq!((none, some), (0, 200));
    // measured: 1.1e-3 after 200 steps, (ωΔt)³/12 in each: the midpoint rule's own; what is skipped is exact
    assert!(skipping.bodies[0].q_WB.angle_to(&full.bodies[0].q_WB) < 1.2e-3);
    assert!((skipping.bodies[0].w_WB - full.bodies[0].w_WB).norm() < 1e-12);
    let (_, bar) = end(FREE_BAR, &["time.end_s=2"], |model, _| assert!(!model.bodies[0].isotropic));
    // Three iterations a step.
    assert_eq!(bar, 600);
}

/// A face beyond the bounding radius is skipped: only steps near a face hold nodes against it.
#[test]
fn a_far_face_is_not_tested() {
    let falling = measured(CUBE_IN_BOX, &["scene.random=null", "time.end_s=0.3"]);
    assert_eq!((falling.work.contact_tests, falling.contacts_max), (0, 0));
    let landed = measured(CUBE_IN_BOX, &["scene.random=null", "time.end_s=1"]);
    // 27 nodes against the floor alone, in fewer than 100 steps.
    assert!(landed.work.contact_tests > 0 && landed.work.contact_tests <= 27 * 100);
    assert!(landed.work.contact_tests.is_multiple_of(27));
}

#[test]
fn a_scene_without_container_does_no_contact_work() {
    let m = measured(FREE_BAR, &[]);
    assert_eq!((m.work.contact_tests, m.work.contacts, m.work.sweeps), (0, 0, 0));
    assert_eq!(m.penetration_max_m, None);
    let stages = |text: &str, sets: &[&str]| {
        let experiment = experiment(text, sets);
        Plan::new(&build(&experiment).unwrap().0, &experiment.method).stages
    };
    assert!(
        stages(FREE_BAR, &[]).iter().any(|s| s.name == "contact test" && !s.runs && s.why.contains("no container"))
    );
    let skipped: Vec<&str> = stages(CUBE_IN_BOX, &[]).iter().filter(|s| !s.runs).map(|s| s.name).collect();
    assert_eq!(skipped, ["forces and air", "pins"]);
}

//! The judge of geometry sees what a step did to bodies, whatever contacts the step has seen: faults made by hand, and
//! runs that are either right or told of.

use crate::yaml::{experiment, measured};
use gotai::collide::approach::Approach;
use gotai::collide::{Contact, SolvedContact};
use gotai::exact::free_rotation::FreeRotation;
use gotai::measure::geometry::{GeometryLedger, overlap};
use gotai::model::Model;
use gotai::scene::build;
use gotai::shape::solid::Pose;
use gotai::shown::{Acted, Shown};
use gotai::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};

const H: f64 = 0.01;

const BALL_ON_FLOOR: &str = "
scene:
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 2, position_m: [0, 0.5, 0] }
time: { step_s: 0.01, end_s: 1 }
";

const TWO_BOXES: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies:
    - { name: plate, shape: { box: { size_m: [0.02, 2, 2] } }, mass_kg: 1, fixed: true }
    - { name: box, shape: { box: { size_m: [0.2, 0.2, 0.2] } }, mass_kg: 1, position_m: [0.5, 0, 0] }
time: { step_s: 0.01, end_s: 1 }
";

/// What the judge says of one step: penetration, ghost, passages.
fn judged(model: &Model, before: &State, after: &State, contacts: &[SolvedContact]) -> (f64, f64, u64) {
    let mut ledger = GeometryLedger::new(model, before, true);
    let acted = Acted::Kick { kicked: before, contacts, step_s: H, approach: Approach::Start };
    ledger.observe(model, &Shown { before, after, acted, way: None, stalled: None, is_last: false });
    let seen = (ledger.penetration_max_m, ledger.ghost_impulse_max_rel, ledger.passed_through);
    (seen.0.unwrap(), seen.1.unwrap(), seen.2.unwrap())
}

fn scene(text: &str) -> (Model, State) {
    build(&experiment(text, &[])).unwrap()
}

/// Of the ball's lowest point with the floor.
fn on_floor(at: &State, impulse_n_s: f64) -> SolvedContact {
    let p_WC = at.bodies[0].p_WB - Vector3::y() * 0.5;
    let contact = Contact {
        body: 0,
        other: None,
        feature: (0, 0),
        r_BC_W: p_WC - at.bodies[0].p_WB,
        r_OC_W: Vector3::zeros(),
        p_WC,
        normal: Vector3::y(),
        gap_m: p_WC.y,
        friction: 0.0,
        restitution: 0.0,
        tangential_restitution: 0.0,
    };
    SolvedContact { contact, impulse_W: Vector3::y() * impulse_n_s }
}

/// A step of the ball on the floor with an impulse along the normal: gravity and the impulse, then the way.
fn kicked(model: &Model, before: &State, impulse_n_s: f64) -> State {
    let mut after = before.clone();
    let ball = &mut after.bodies[0];
    ball.v_WB += model.gravity_m_s2 * H + Vector3::y() * (impulse_n_s / 2.0);
    ball.p_WB += ball.v_WB * H;
    after.time_s += H;
    after
}

#[test]
fn what_holds_a_resting_ball_is_no_ghost() {
    let (model, start) = scene(BALL_ON_FLOOR);
    let p = 2.0 * 9.8 * H;
    let (depth_m, ghost, _) = judged(&model, &start, &kicked(&model, &start, p), &[on_floor(&start, p)]);
    assert_eq!((depth_m, ghost), (0.0, 0.0));
}

#[test]
fn an_impulse_at_a_distance_is_a_ghost() {
    let (model, mut start) = scene(BALL_ON_FLOOR);
    start.bodies[0].p_WB.y = 0.8;
    start.bodies[0].v_WB.y = -1.0;
    let (_, ghost, _) = judged(&model, &start, &kicked(&model, &start, 1.0), &[on_floor(&start, 1.0)]);
    // Of m(v + g h).
    assert!((ghost - 1.0 / (2.0 * (1.0 + 9.8 * H))).abs() < 1e-12, "{ghost}");
}

#[test]
fn an_impulse_that_pulls_is_a_ghost() {
    let (model, mut start) = scene(BALL_ON_FLOOR);
    start.bodies[0].v_WB.y = 1.0;
    let (_, ghost, _) = judged(&model, &start, &kicked(&model, &start, -0.5), &[on_floor(&start, -0.5)]);
    assert!(ghost > 0.2, "{ghost}");
}

#[test]
fn a_bounce_is_no_ghost() {
    let (model, mut start) = scene(BALL_ON_FLOOR);
    start.bodies[0].p_WB.y = 0.505;
    start.bodies[0].v_WB.y = -1.0;
    let (_, ghost, _) = judged(&model, &start, &kicked(&model, &start, 3.0), &[on_floor(&start, 3.0)]);
    assert_eq!(ghost, 0.0);
}

/// What the judge says of a blow on the floor, which changes velocities alone.
fn judged_blow(model: &Model, before: &State, contacts: &[SolvedContact], after: &State) -> f64 {
    let mut ledger = GeometryLedger::new(model, before, true);
    let acted = Acted::Blow { contacts };
    ledger.observe(model, &Shown { before, after, acted, way: None, stalled: None, is_last: false });
    ledger.ghost_impulse_max_rel.unwrap()
}

/// Something else throws the ball up as well: what is left to rebound by is less than what parts them without it.
#[test]
fn what_rebounds_may_be_pushed_by_less_than_others_part_it_by() {
    let (model, mut start) = scene(BALL_ON_FLOOR);
    let mut ghost = |came_m_s: f64, restitution: f64| {
        start.bodies[0].v_WB.y = came_m_s;
        let mut after = start.clone();
        after.bodies[0].v_WB.y = 0.5;
        let mut contact = on_floor(&start, 0.1);
        contact.contact.restitution = restitution;
        judged_blow(&model, &start, &[contact], &after)
    };
    assert_eq!(ghost(-1.0, 0.5), 0.0);
    assert!(ghost(-1.0, 0.0) > 0.0, "what does not rebound is not pushed beyond rest");
    assert!(ghost(0.1, 0.5) > 0.0, "what parts has nothing to rebound from");
}

const CRATE_AT_A_SEAM: &str = "
scene:
  bodies:
    - { name: crate, shape: { box: { size_m: [0.2, 0.2, 0.2] } }, mass_kg: 1, position_m: [-0.1, 0.1, 0] }
    - { name: block, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0.5, -0.5, 0], fixed: true }
time: { step_s: 0.01, end_s: 1 }
";

/// A crate lands with its leading edge at a block's: its top turns it back, and its side has no part in that.
#[test]
fn what_rebounds_from_a_top_is_not_pushed_by_a_side() {
    let (model, mut start) = scene(CRATE_AT_A_SEAM);
    start.bodies[0].v_WB = Vector3::new(2.0, -1.0, 0.0);
    let mut after = start.clone();
    after.bodies[0].v_WB = Vector3::new(1.0, 0.5, 0.0);
    let ghost = |normal: Vector3<f64>| {
        let SolvedContact { contact, .. } = on_floor(&start, 0.0);
        let (p_WC, restitution) = (Vector3::zeros(), 0.5);
        let [r_BC_W, r_OC_W] = [0, 1].map(|i: usize| p_WC - start.bodies[i].p_WB);
        let other = Some(1);
        let contact = Contact { other, r_BC_W, r_OC_W, p_WC, normal, gap_m: 0.0, restitution, ..contact };
        judged_blow(&model, &start, &[SolvedContact { contact, impulse_W: normal }], &after)
    };
    assert!(ghost(-Vector3::x()) > 0.1);
    assert_eq!(ghost(Vector3::y()), 0.0);
}

const BALL_ON_BLOCK: &str = "
scene:
  bodies:
    - { name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 2, position_m: [0, 0.5, 0] }
    - { name: block, shape: { box: { size_m: [4, 1, 4] } }, mass_kg: 1, position_m: [0, -0.5, 0], fixed: true }
time: { step_s: 0.01, end_s: 1 }
";

/// A ball slides, and comes down by far less: what rubs it most is no ghost, if it also keeps it from going inside.
#[test]
fn what_mostly_passes_by_may_be_stopped() {
    let (model, mut start) = scene(BALL_ON_BLOCK);
    start.bodies[0].v_WB = Vector3::new(1.002, -5e-5, 0.0);
    let mut after = start.clone();
    after.bodies[0].v_WB = Vector3::x();
    let ghost = |pressing_n_s: f64| {
        let SolvedContact { contact, .. } = on_floor(&start, 0.0);
        let r_OC_W = contact.p_WC - start.bodies[1].p_WB;
        let contact = Contact { other: Some(1), r_OC_W, friction: 40.0, ..contact };
        let impulse_W = Vector3::new(-4e-3, pressing_n_s, 0.0);
        judged_blow(&model, &start, &[SolvedContact { contact, impulse_W }], &after)
    };
    assert_eq!(ghost(1e-4), 0.0);
    assert!(ghost(0.0) > 0.0, "what only rubs holds nothing apart");
}

#[test]
fn a_body_that_nothing_holds_is_seen_sinking() {
    let (model, start) = scene(BALL_ON_FLOOR);
    let mut after = start.clone();
    after.bodies[0].p_WB.y = 0.4;
    let (depth_m, ..) = judged(&model, &start, &after, &[]);
    assert!((depth_m - 0.1).abs() < 1e-15, "{depth_m}");
}

#[test]
fn a_state_that_was_shifted_into_another_body_is_seen() {
    let (model, start) = scene(TWO_BOXES);
    let mut after = start.clone();
    after.bodies[1].p_WB.x = 0.1;
    let (depth_m, ..) = judged(&model, &start, &after, &[]);
    assert!((depth_m - 0.01).abs() < 1e-15, "{depth_m}");
}

#[test]
fn a_box_that_is_before_a_plate_and_then_behind_it_has_passed() {
    let (model, start) = scene(TWO_BOXES);
    let moved = |x: f64| {
        let mut after = start.clone();
        (after.bodies[1].p_WB.x, after.time_s) = (x, H);
        judged(&model, &start, &after, &[]).2
    };
    assert_eq!([moved(-0.5), moved(0.12), moved(0.9)], [1, 0, 0]);
    // Around the plate.
    let mut beside = start.clone();
    beside.bodies[1].p_WB.y = 1.2;
    let mut after = beside.clone();
    (after.bodies[1].p_WB.x, after.time_s) = (-0.5, H);
    assert_eq!(judged(&model, &beside, &after, &[]).2, 0);
}

/// Half a turn in a step: before and after it lies beside the post.
#[test]
fn a_rod_that_turns_through_a_post_has_passed() {
    let (model, mut start) = scene(
        "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies:
    - { name: post, shape: { cylinder: { radius_m: 0.05, height_m: 1 } }, mass_kg: 1, position_m: [0.4, 0, 0], fixed: true }
    - { name: rod, shape: { capsule: { radius_m: 0.02, height_m: 1 } }, mass_kg: 1, orientation: { axis: [1, 0, 0], angle_deg: 90 } }
time: { step_s: 0.01, end_s: 1 }
",
    );
    let turn_rad = 3.0;
    start.bodies[1].w_WB = Vector3::y() * (turn_rad / H);
    let mut after = start.clone();
    after.time_s = H;
    after.bodies[1].q_WB = UnitQuaternion::from_scaled_axis(Vector3::y() * turn_rad) * start.bodies[1].q_WB;
    assert_eq!(judged(&model, &start, &after, &[]).2, 1);
    // A full turn and a little shows in the angular velocity alone.
    start.bodies[1].w_WB *= 2.0;
    after.bodies[1].w_WB = start.bodies[1].w_WB;
    after.bodies[1].q_WB = UnitQuaternion::from_scaled_axis(Vector3::y() * 2.0 * turn_rad) * start.bodies[1].q_WB;
    assert_eq!(judged(&model, &start, &after, &[]).2, 1);
}

const SEAM: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  bodies:
    - { name: near, shape: { box: { size_m: [2, 1, 2] } }, mass_kg: 1, position_m: [-1, -0.5, 0], fixed: true }
    - { name: far, shape: { box: { size_m: [2, 1, 2] } }, mass_kg: 1, position_m: [1, -0.5, 0], fixed: true }
    - { name: crate, shape: { box: { size_m: [0.3, 0.2, 0.3] } }, mass_kg: 2, position_m: [-0.4993, 0.1, 0], velocity_m_s: [2, 0, 0] }
method: { time-stepping: { solver: newton } }
time: { step_s: 0.001, end_s: 0.4 }
measure: [state]
";

/// A crate slides over the seam of two blocks.
#[test]
fn a_crate_that_catches_on_a_seam_is_told_of() {
    let methods =
        ["{time-stepping: {solver: newton}}", "{time-stepping: {solver: pgs}}", "{time-stepping: {scheme: moreau}}"];
    for method in methods.into_iter().chain(["event-driven"]) {
        let row = measured(SEAM, &[&format!("method={method}")]);
        let x_m = row.more["crate.position_m.x"].as_f64().unwrap();
        let (goes_on, ghost) = ((x_m - 0.3007).abs() < 1e-6, row.ghost_impulse_max_rel.unwrap());
        assert!(if goes_on { ghost <= 1e-6 } else { ghost > 0.1 }, "{method}: {x_m} m, {ghost}");
    }
}

#[test]
fn a_bullet_through_a_plate_is_told_of() {
    let text = "
scene:
  gravity_m_s2: [0, 0, 0]
  restitution: 0
  bodies:
    - { name: plate, shape: { box: { size_m: [0.01, 2, 2] } }, mass_kg: 1, position_m: [0, 0, 0], fixed: true }
    - { name: ball, shape: { sphere: { radius_m: 0.025 } }, mass_kg: 0.1, position_m: [-1.13, 0, 0], velocity_m_s: [20, 0, 0] }
time: { step_s: 0.01, end_s: 0.2 }
measure: [state]
";
    for (method, speed) in [("newton", 20), ("pgs", 20), ("newton", 200), ("pgs", 200)] {
        for scheme in ["semi-implicit", "moreau"] {
            let method = format!("method={{time-stepping: {{solver: {method}, scheme: {scheme}}}}}");
            let row = measured(text, &[&method, &format!("scene.bodies.ball.velocity_m_s=[{speed}, 0, 0]")]);
            let x_m = row.more["ball.position_m.x"].as_f64().unwrap();
            assert_eq!(row.passed_through, Some(u64::from(x_m > 0.0)), "{method}, {speed} m/s: {x_m} m");
        }
    }
}

#[test]
fn a_can_that_sinks_is_told_of() {
    let text = "
scene:
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: can, shape: { cylinder: { radius_m: 0.25, height_m: 0.5 } }, mass_kg: 1, position_m: [0, 0.9, 0], velocity_m_s: [0, -1, 0] }
method: { event-driven: { impact: sequential } }
time: { end_s: 1 }
measure: [state]
";
    let row = measured(text, &[]);
    let depth_m = 0.25 - row.more["can.position_m.y"].as_f64().unwrap();
    // It may lie askew.
    assert!(row.penetration_end_m.unwrap() > depth_m - 1e-6, "{depth_m} m");
}

/// A cube dropped on a stack: the blow goes through bodies at rest, whose velocities it does not change.
#[test]
fn a_blow_that_goes_through_a_body_at_rest_is_no_ghost() {
    let text = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: lower, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0] }
    - { name: upper, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 1.5, 0] }
    - { name: dropped, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 3, 0] }
time: { step_s: 0.01, end_s: 1 }
";
    for impact in ["newton", "poisson", "sequential"] {
        let row = measured(text, &[&format!("method={{ event-driven: {{ impact: {impact} }} }}")]);
        // measured: 0, and 2.5e-16
        assert_eq!(row.ghost_impulse_max_rel, Some(0.0), "{impact}");
        assert!(row.residual_max.unwrap() < 1e-9, "{impact}: {:?}", row.residual_max);
    }
}

#[test]
fn a_fall_past_an_edge_is_no_passage() {
    let text = "
scene:
  friction: 0.5
  bodies:
    - { name: table, shape: { box: { size_m: [2, 0.1, 2] } }, mass_kg: 1, position_m: [0, -0.05, 0], fixed: true }
    - { name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [0.5, 0.1, 0], velocity_m_s: [1.5, 0, 0], angular_velocity_rad_s: [0, 0, -15] }
method: event-driven
time: { end_s: 2 }
";
    for speed in [0.5, 1.5, 3.0] {
        let sets = [
            format!("scene.bodies.ball.velocity_m_s=[{speed}, 0, 0]"),
            format!("scene.bodies.ball.angular_velocity_rad_s=[0, 0, {}]", -10.0 * speed),
        ];
        let row = measured(text, &[&sets[0], &sets[1]]);
        assert_eq!((row.passed_through, row.ghost_impulse_max_rel), (Some(0), Some(0.0)), "{speed} m/s");
    }
}

/// A corner comes down fast beside a body's own turning: along its tangent it would be inside by the end of the step,
/// on its arc it is not quite, and another corner comes as near by what sends this one back.
#[test]
fn a_corner_that_turns_away_before_the_floor_is_no_ghost() {
    let text = "
scene:
  gravity_m_s2: [0, -9.8, 0]
  friction: 0.3
  restitution: 0.5
  container: { box: { size_m: [4, 4, 4] } }
  bodies:
    - { name: box, shape: { box: { size_m: [0.6, 0.4, 0.5] } }, density_kg_m3: 500, position_m: [0, 2, 0] }
  random: { speed_m_s: 2, spin_rad_s: 3, attitude: true }
seed: 5
time: { step_s: 0.01, end_s: 2 }
";
    let faster = "scene.random={speed_m_s: 6, spin_rad_s: 6, attitude: true}";
    let sequential = "method={time-stepping: {impact: sequential}}";
    for sets in [&["seed=5"][..], &["seed=19", faster], &["seed=20", faster, sequential]] {
        let row = measured(text, sets);
        // measured: 0; 0.998, 1.18 and 0.19 where the nearest corner was taken for the one that was pushed
        assert_eq!(row.ghost_impulse_max_rel, Some(0.0), "{sets:?}");
    }
}

#[test]
fn opposite_walls_and_heavy_loads_are_no_ghosts() {
    let tight = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  container: { box: { size_m: [1, 4, 4] } }
  bodies: [{ name: box, shape: { box: { size_m: [1, 1, 1] } }, mass_kg: 1, position_m: [0, 0.5, 0] }]
time: { step_s: 0.01, end_s: 1 }
";
    let loaded = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: light, shape: { box: { size_m: [0.2, 0.2, 0.2] } }, mass_kg: 1, position_m: [0, 0.1, 0] }
    - { name: heavy, shape: { box: { size_m: [0.2, 0.2, 0.2] } }, mass_kg: 1e4, position_m: [0, 0.3, 0] }
time: { step_s: 0.016666666666666666, end_s: 1 }
";
    for (text, what) in [(tight, "tight"), (loaded, "loaded")] {
        for method in ["event-driven", "{time-stepping: {solver: newton}}"] {
            let row = measured(text, &[&format!("method={method}")]);
            assert!(row.ghost_impulse_max_rel.unwrap() <= 1e-6, "{what}, {method}: {:?}", row.ghost_impulse_max_rel);
        }
    }
}

/// How often a body that tumbles for many turns in a step passes a ball and how often it hits it, which the judge tells
/// as a thousand looks a turn do. `then`: what is done to it at the end of the step.
fn tumbles(body: &str, then: impl Fn(&Model, &mut BodyState)) -> [usize; 2] {
    let text = format!(
        "
scene:
  gravity_m_s2: [0, 0, 0]
  bodies:
    - {{ name: ball, shape: {{ sphere: {{ radius_m: 0.01 }} }}, mass_kg: 1, fixed: true }}
    - {{ name: tumbling, mass_kg: 1, position_m: [0, 0, 1], {body} }}
time: {{ step_s: 0.01, end_s: 1 }}
"
    );
    let (model, start) = scene(&text);
    let solid = |i: usize| model.bodies[i].solid().unwrap().0;
    let mut said = [0, 0];
    for i in 0..40 {
        let mut before = start.clone();
        // It comes within its radius of 0.18 m and goes on as far.
        before.bodies[1].p_WB = Vector3::new(0.02 + 0.004 * f64::from(i), 0.05, -0.25);
        before.bodies[1].v_WB = Vector3::new(0.0, 0.0, 0.5 / H);
        let (from, mut after) = (before.bodies[1], before.clone());
        let turn = FreeRotation::new(&model.bodies[1].I_B, &from.q_WB, &from.w_WB);
        let at = |time_s: f64| {
            let (q_WB, w_WB) = turn.at(time_s);
            BodyState { p_WB: from.p_WB + from.v_WB * time_s, q_WB, w_WB, ..from }
        };
        after.bodies[1] = at(H);
        after.time_s += H;
        then(&model, &mut after.bodies[1]);
        let ball = Pose { p_W: Vector3::zeros(), q_W: UnitQuaternion::identity() };
        let gap_m = |look: u32| {
            let at = at(H * f64::from(look) / 4000.0);
            overlap(solid(0), &ball, solid(1), &Pose { p_W: at.p_WB, q_W: at.q_WB }).gap_m
        };
        let least_m = (0..=4000).map(gap_m).fold(f64::INFINITY, f64::min);
        // Between two looks a point moves by 1e-4 m.
        if (-2e-4..1e-4).contains(&least_m) {
            continue;
        }
        let (_, _, passed) = judged(&model, &before, &after, &[]);
        assert_eq!(passed, u64::from(least_m < 0.0), "{body}, {i}: {least_m:e} m");
        said[usize::from(least_m < 0.0)] += 1;
    }
    said
}

/// Of a rod, a turn by 1e-4 rad as overlap is taken away leaves its angular momentum, which makes it spin faster or
/// slower about its axis by hundreds of rad/s; or its angular velocity.
#[test]
fn what_tumbles_for_many_turns_in_a_step_is_followed() {
    const PLATE: &str = "shape: { box: { size_m: [0.2, 0.004, 0.3] } }, angular_velocity_rad_s: [400, 900, 1700]";
    const ROD: &str = "shape: { box: { size_m: [0.004, 0.004, 0.36] } }, angular_velocity_rad_s: [900, -700, 300]";
    let turn = |at: &mut BodyState| {
        at.q_WB = UnitQuaternion::from_scaled_axis(Vector3::new(1e-4, -1e-4, 0.0)) * at.q_WB;
    };
    let keep_velocity = |_: &Model, at: &mut BodyState| turn(at);
    let keep_momentum = |model: &Model, at: &mut BodyState| {
        let L_W = model.bodies[1].I_W(at) * at.w_WB;
        turn(at);
        at.w_WB = model.bodies[1].I_W_inverse(at) * L_W;
    };
    let as_it_is = |_: &Model, _: &mut BodyState| {};
    let said =
        [tumbles(PLATE, as_it_is), tumbles(ROD, as_it_is), tumbles(ROD, keep_velocity), tumbles(ROD, keep_momentum)];
    // Measured: 4 and 35; of each rod 32 and 8. Followed by its momentum in world axes, a rod that hits was missed.
    assert!(said.iter().flatten().all(|count| *count >= 3), "{said:?}");
}

//! The judges of energy, momentum and the law of contact see what a broken solver does: right steps of `newton`, of
//! which one is broken by hand, with the state that follows from it.

use crate::yaml::{experiment, measured};
use gotai::collide::SolvedContact;
use gotai::experiment::types::Diverge;
use gotai::measure::Judge;
use gotai::model::Model;
use gotai::plan::Plan;
use gotai::scene::build;
use gotai::shown::{Acted, Shown};
use gotai::state::State;
use gotai::step::Stepper;
use nalgebra::Vector3;

/// Without gravity, against a wall, no energy lost.
const BOUNCE: &str = "
scene:
  gravity_m_s2: [0, 0, 0]
  restitution: 1
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 2, position_m: [0, 0.75, 0], velocity_m_s: [1, -3, 0] }]
method: { time-stepping: { solver: newton } }
time: { step_s: 0.01, end_s: 0.3 }
";

const SLIDE: &str = "
scene:
  gravity_m_s2: [0, -9.81, 0]
  friction: 0.4
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: slab, shape: { box: { size_m: [1, 0.2, 1] } }, mass_kg: 2, position_m: [0, 0.1, 0], velocity_m_s: [3, 0, 0] }]
method: { time-stepping: { solver: newton } }
time: { step_s: 0.01, end_s: 0.3 }
";

/// What the judges say.
#[derive(Debug)]
struct Said {
    drift: f64,
    rise: f64,
    growth: Option<f64>,
    linear: f64,
    angular: f64,
    residual: f64,
}

/// Steps of a scene; the impulses of those that have contacts are changed as `broken` says, and the motion with them
/// if the solver `tells` of it.
fn judged(text: &str, tells: bool, broken: impl Fn(u64, &SolvedContact) -> Vector3<f64>) -> Said {
    let experiment = experiment(text, &[]);
    let (model, start) = build(&experiment).unwrap();
    let (clock, plan) = (experiment.clock(), Plan::new(&model, &experiment.method));
    let mut stepper = Stepper::new(&experiment.method.stepping().unwrap(), &plan, &model, &start);
    let mut judge = Judge::new(&model, &start, &Diverge::default(), &plan);
    let (mut before, mut state) = (start.clone(), start);
    while state.step < clock.steps {
        before.copy_from(&state);
        stepper.step(&model, &mut state, &clock);
        let Acted::Kick { kicked, contacts, step_s, approach } = stepper.acted(&before, &clock) else { unreachable!() };
        let wrong: Vec<SolvedContact> =
            contacts.iter().map(|s| SolvedContact { impulse_W: broken(before.step, s), ..*s }).collect();
        for (right, wrong) in contacts.iter().zip(&wrong) {
            push(&model, &mut state, right, wrong.impulse_W - right.impulse_W, step_s);
        }
        let contacts = if tells { &wrong[..] } else { contacts };
        let acted = Acted::Kick { kicked, contacts, step_s, approach };
        let shown = Shown { before: &before, after: &state, acted, way: None, stalled: None, is_last: false };
        judge.observe(&model, &shown);
    }
    judge.end(&model, &state);
    Said {
        drift: judge.energy.drift_rel(),
        rise: judge.energy.rise_max_rel(),
        growth: judge.energy.growth_max(),
        linear: judge.momentum.linear_drift_rel(&model, &state).unwrap(),
        angular: judge.momentum.angular_drift_rel(&model, &state).unwrap(),
        residual: judge.residual.max.unwrap(),
    }
}

/// What an impulse more does to the only body, in a step that moves it with its new velocities.
fn push(model: &Model, state: &mut State, solved: &SolvedContact, more_W: Vector3<f64>, step_s: f64) {
    let at = &mut state.bodies[0];
    let (v, w) =
        (more_W / model.bodies[0].mass_kg, model.bodies[0].I_W_inverse(at) * solved.contact.r_BC_W.cross(&more_W));
    (at.v_WB, at.w_WB, at.p_WB) = (at.v_WB + v, at.w_WB + w, at.p_WB + v * step_s);
}

#[test]
fn right_steps_are_right() {
    let said = judged(BOUNCE, true, |_, s| s.impulse_W);
    assert_eq!((said.drift, said.rise, said.linear, said.angular), (0.0, 0.0, 0.0, 0.0));
    let said = judged(SLIDE, true, |_, s| s.impulse_W);
    assert_eq!((said.rise, said.linear, said.angular), (0.0, 0.0, 0.0));
    // measured: 1.4e-15
    assert!(said.residual < 1e-12 && said.drift.abs() < 1e-12 && said.growth.unwrap() < 1.0 + 1e-12, "{said:?}");
}

#[test]
fn a_gain_of_a_thousandth_in_one_blow_is_seen() {
    // v⁺ = −(1 + δ) v⁻ makes 2 δ of 9 J, of 10 J that there are.
    let said = judged(BOUNCE, true, |_, s| s.impulse_W * (1.0 + 0.5 * 0.001 / 1.8));
    // measured: 1.0e-3, of which the rise and the growth say the same
    let gain = 0.001;
    let is_gain = |x: f64| (x / gain - 1.0).abs() < 1e-2;
    assert!(is_gain(said.drift) && is_gain(said.rise) && is_gain(said.growth.unwrap() - 1.0), "{said:?}");
    // measured: 1.4e-4
    assert!(said.residual > 1e-4 && said.linear == 0.0, "{said:?}");
}

#[test]
fn an_impulse_that_nobody_tells_is_seen() {
    let said = judged(SLIDE, false, |step, s| if step == 5 { s.impulse_W * 1.01 } else { s.impulse_W });
    // measured: 1.6e-4
    assert!(said.linear > 1e-4, "{said:?}");
}

#[test]
fn a_pull_is_seen() {
    let said = judged(SLIDE, true, |step, s| if step == 5 { -s.impulse_W } else { s.impulse_W });
    // measured: 2.6
    assert!(said.residual > 0.5, "{said:?}");
}

#[test]
fn a_contact_without_its_impulse_is_seen() {
    let said = judged(SLIDE, true, |step, s| if step == 5 { Vector3::zeros() } else { s.impulse_W });
    // measured: 0.4
    assert!(said.residual > 0.1, "{said:?}");
}

#[test]
fn friction_that_is_turned_is_seen() {
    let turned = |degrees: f64| {
        judged(SLIDE, true, |_, s| {
            let normal = s.contact.normal * s.contact.normal.dot(&s.impulse_W);
            let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::y_axis(), degrees.to_radians());
            normal + turn * (s.impulse_W - normal)
        })
    };
    // measured: 0.6 and 6.5e-3: sin of the angle, of μ/√(1 + μ²) of an impulse
    let [far, near] = [90.0, 1.0].map(|degrees| turned(degrees).residual);
    assert!(far > 0.1 && near > 1e-3, "{far} {near}");
    // Friction that pushes along makes energy.
    let along = judged(SLIDE, true, |_, s| {
        let normal = s.contact.normal * s.contact.normal.dot(&s.impulse_W);
        normal * 2.0 - s.impulse_W
    });
    // measured: 0.98
    assert!(along.drift > 0.1 && along.rise > 0.1 && along.residual > 0.1, "{along:?}");
}

/// A ball hits the upper of two crates. Whatever becomes of it, that they touched is judged.
#[test]
fn what_touches_has_a_residual() {
    let text = "
scene:
  friction: 0.4
  restitution: 0
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: lower, shape: { box: { size_m: [1, 0.5, 1] } }, mass_kg: 1, position_m: [0, 0.25, 0] }
    - { name: upper, shape: { box: { size_m: [1, 0.5, 0.9] } }, mass_kg: 1, position_m: [0.05, 0.75, 0] }
    - { name: ball, shape: { sphere: { radius_m: 0.2 } }, mass_kg: 2, position_m: [-2, 0.8, 0.05], velocity_m_s: [5, 0, 0] }
method: event-driven
time: { end_s: 1 }
";
    // measured: not a number by 1, for a force where nothing may push: the largest there is
    assert!(measured(text, &[]).residual_max.is_some());
}

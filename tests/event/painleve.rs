//! P. Painlevé's rod slides on its tip, leaning so that friction presses it down: with enough of it no finite force
//! goes on, and an impulse stops the tip.

use crate::yaml::{experiment, run};
use gotai::outcome::Outcome;
use gotai::run::Ended;
use gotai::state::BodyState;
use nalgebra::{Matrix2, Vector2};
use rayon::prelude::*;

/// Of length and mass 1, θ from the floor with tan θ = 2; and where its tip is from its centre of mass.
struct Rod {
    what: &'static str,
    shape: &'static str,
    tip_m: Vector2<f64>,
    /// Between its axis and x, in its own frame.
    axis_rad: f64,
}

const INERTIA: f64 = 1.0 / 12.0;
const THIN_M: f64 = 1e-3;

fn rods() -> [Rod; 3] {
    let half = Vector2::new(0.5, -1.0) / 1.25_f64.sqrt() * 0.5;
    [
        Rod {
            what: "convex",
            shape: "convex: { vertices_m: [[-0.5, 0, 0], [0.5, 0, 0], [0, 1e-3, 0], [0, 0, 1e-3], [0, 0, -1e-3]] }",
            tip_m: half,
            axis_rad: 0.0,
        },
        Rod {
            what: "capsule",
            shape: "capsule: { radius_m: 1e-3, height_m: 1 }",
            tip_m: half - Vector2::new(0.0, THIN_M),
            axis_rad: std::f64::consts::FRAC_PI_2,
        },
        // On two corners.
        Rod {
            what: "box",
            shape: "box: { size_m: [1, 2e-3, 2e-3] }",
            tip_m: half - Vector2::new(2.0, 1.0) / 5.0_f64.sqrt() * THIN_M,
            axis_rad: 0.0,
        },
    ]
}

fn slid(rod: &Rod, speed: f64, friction: f64, end_s: f64) -> Ended {
    let angle = -2.0_f64.atan() + rod.axis_rad;
    let text = format!(
        "
scene:
  friction: {friction}
  container: {{ plane: {{ normal: [0, 1, 0] }} }}
  bodies:
    - name: rod
      shape: {{ {} }}
      mass_kg: 1
      inertia_kg_m2: [{INERTIA:?}, {INERTIA:?}, {INERTIA:?}]
      center_of_mass_m: [0, 0, 0]
      position_m: [0, {:?}, 0]
      orientation: {{ axis: [0, 0, 1], angle_deg: {:?} }}
      velocity_m_s: [{speed:?}, 0, 0]
method: event-driven
time: {{ end_s: {end_s:?} }}
",
        rod.shape,
        -rod.tip_m.y,
        angle.to_degrees()
    );
    run(&experiment(&text, &[]))
}

/// (P_t, P_n) that stops the tip.
fn stopping(rod: &Rod, speed: f64) -> Vector2<f64> {
    let r = Vector2::new(-rod.tip_m.y, rod.tip_m.x);
    let inverse_mass = Matrix2::identity() + r * r.transpose() / INERTIA;
    inverse_mass.try_inverse().unwrap() * Vector2::new(-speed, 0.0)
}

#[test]
fn too_much_friction_stops_the_tip_at_once() {
    for rod in rods() {
        for friction in [1.35, 1.5, 2.0, 5.0] {
            let ended = slid(&rod, 1.0, friction, 1e-9);
            let BodyState { v_WB: v, w_WB: w, .. } = ended.state.bodies[0];
            let (got, wanted) = (Vector2::new(v.x - 1.0, v.y), stopping(&rod, 1.0));
            let tip = Vector2::new(v.x - w.z * rod.tip_m.y, v.y + w.z * rod.tip_m.x);
            assert_eq!(ended.measured.outcome, Outcome::Finished, "{}", rod.what);
            // measured: 3.4e-9, what gravity adds
            assert!((got - wanted).norm() < 5e-8 && tip.norm() < 5e-8, "{}, {friction}: {got} {tip}", rod.what);
            if rod.what == "convex" {
                assert!((wanted - Vector2::new(-0.4, 0.3)).norm() < 1e-15, "{wanted}");
            }
        }
    }
}

#[test]
fn with_less_friction_or_backwards_it_slides_on() {
    for rod in rods() {
        for (speed, friction) in [(1.0, 1.2), (-1.0, 1.2), (-1.0, 2.0)] {
            let ended = slid(&rod, speed, friction, 1e-9);
            let change = (ended.state.bodies[0].v_WB.x - speed).abs();
            // measured: 7.5e-8: at most ten times its weight, for a nanosecond
            assert!(change < 1e-6, "{}, {speed}, {friction}: {change:e}", rod.what);
        }
    }
}

#[test]
fn it_comes_to_rest_or_says_why_not() {
    let cases: Vec<(Rod, f64, f64)> = rods()
        .into_iter()
        .flat_map(|rod| {
            let Rod { what, shape, tip_m, axis_rad } = rod;
            [-3.0, -1.0, 0.5, 1.0, 2.0, 4.0].into_iter().flat_map(move |speed| {
                [1.0, 1.3, 1.34, 1.5, 2.0, 10.0].map(|friction| (Rod { what, shape, tip_m, axis_rad }, speed, friction))
            })
        })
        .collect();
    let worst = cases
        .par_iter()
        .map(|(rod, speed, friction)| {
            let Ended { measured: m, state, .. } = slid(rod, *speed, *friction, 2.0);
            let said = m.outcome == Outcome::Finished || m.criterion.as_deref() == Some("painleve");
            assert!(said, "{}, {speed}, {friction}: {:?} {:?}", rod.what, m.outcome, m.criterion);
            assert!(state.bodies.iter().all(BodyState::is_finite));
            m.energy_rise_max_rel.unwrap()
        })
        .reduce(|| 0.0, f64::max);
    // measured: 8.3e-13
    assert!(worst < 1e-11, "{worst:e}");
}

//! The sound default against exact motions and bounds.

use super::order;
use crate::yaml::{CUBE_IN_BOX, experiment, measured, run};
use gotai::outcome::Outcome;
use gotai::rows::Measured;

const SLAB: &str = "
scene:
  friction: 0.3
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: slab, shape: { box: { size_m: [1, 0.2, 1] } }, mass_kg: 2, position_m: [0, 0.1, 0] }
time: { step_s: 0.001, end_s: 3 }
";

fn stopped_after(angle_deg: f64, step_s: f64) -> f64 {
    let (sin, cos) = angle_deg.to_radians().sin_cos();
    let velocity = format!("scene.bodies.slab.velocity_m_s=[{}, 0, {}]", 5.0 * cos, 5.0 * sin);
    let ended = run(&experiment(SLAB, &[&velocity, &format!("time.step_s={step_s}")]));
    let p = ended.state.bodies[0].p_WB;
    (p.x * p.x + p.z * p.z).sqrt()
}

/// Problem: a block slides v²/2μg, in any direction. Its semi-implicit recurrence gives the order.
#[test]
fn a_sliding_slab_stops_where_coulomb_says_in_every_direction() {
    let exact = 25.0 / (2.0 * 0.3 * 9.8);
    for angle in [0.0, 17.0, 45.0] {
        let steps = [8e-3, 4e-3, 2e-3, 1e-3];
        let errors = steps.map(|h| (stopped_after(angle, h) - exact).abs());
        // measured: error 2.5e-3 at 1e-3, order 1.00
        assert!((order(&steps, &errors) - 1.0).abs() < 0.1, "{angle}°: {errors:?}");
    }
    let (along, askew) = (stopped_after(0.0, 1e-3), stopped_after(45.0, 1e-3));
    // A bound per component would stop at 1/√2. measured: 5e-14
    assert!((askew / along - 1.0).abs() < 1e-9, "{along} {askew}");
}

/// On a slope of 20° a slab with μ = 0.5 > tan 20° does not creep; with μ = 0.2 it slides with g (sin θ − μ cos θ).
#[test]
fn a_slab_on_a_slope_sticks_or_slides() {
    let (sin, cos) = 20.0_f64.to_radians().sin_cos();
    let slope = format!("scene.container={{plane: {{normal: [{sin}, {cos}, 0]}}}}");
    let at = format!("scene.bodies.slab.position_m=[{}, {}, 0]", 0.1 * sin, 0.1 * cos);
    let turned = "scene.bodies.slab.orientation={axis: [0, 0, 1], angle_deg: -20}";
    let along = |friction: &str, step: &str| {
        let ended = run(&experiment(SLAB, &[&slope, &at, turned, friction, step, "time.end_s=2"]));
        let p = ended.state.bodies[0].p_WB;
        (p.x - 0.1 * sin) * cos - (p.y - 0.1 * cos) * sin
    };
    let creep = along("scene.friction=0.5", "time.step_s=0.001").abs();
    // measured: 3.3e-16 … 1e-12
    assert!(creep < 1e-9, "{creep}");
    let exact = 0.5 * 9.8 * (sin - 0.2 * cos) * 4.0;
    let steps = [8e-3, 4e-3, 2e-3, 1e-3];
    let errors = steps.map(|h| (along("scene.friction=0.2", &format!("time.step_s={h}")) - exact).abs());
    // measured: 1.00
    assert!((order(&steps, &errors) - 1.0).abs() < 0.05, "{errors:?}");
}

/// e of a dropped sphere: the height after the bounce is e² of the drop, to first order.
#[test]
fn a_ball_bounces_with_newtons_restitution() {
    let text = "
scene:
  restitution: 0.8
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [0, 1.1, 0] }]
time: { step_s: 1e-4, end_s: 1 }
";
    let fall = (2.0_f64 / 9.8).sqrt();
    let apex = format!("time.end_s={}", fall * 1.8);
    let height = run(&experiment(text, &[&apex])).state.bodies[0].p_WB.y - 0.1;
    // measured: 0.6398
    assert!((height - 0.64).abs() < 2e-3, "{height}");
    let dead = run(&experiment(text, &["scene.restitution=0"])).state.bodies[0];
    // measured: 0 and 0, without a slop
    assert!(dead.v_WB.norm() < 1e-12 && (dead.p_WB.y - 0.1).abs() < 1e-13, "{dead:?}");
}

/// A ball that slips starts to roll at v = 5/7 v₀.
#[test]
fn a_slipping_ball_rolls_at_five_sevenths() {
    let text = "
scene:
  friction: 0.3
  container: { plane: { normal: [0, 1, 0] } }
  bodies:
    - { name: ball, shape: { sphere: { radius_m: 0.5 } }, mass_kg: 1, position_m: [0, 0.5, 0], velocity_m_s: [5, 0, 0] }
time: { step_s: 1e-3, end_s: 2 }
";
    let at = run(&experiment(text, &[])).state.bodies[0];
    // measured: 1.8e-15 each
    assert!((at.v_WB.x - 25.0 / 7.0).abs() < 1e-3, "{}", at.v_WB.x);
    assert!((at.w_WB.z + at.v_WB.x / 0.5).abs() < 1e-9, "{}", at.w_WB.z);
}

fn sound(m: &Measured, what: &str) {
    assert_eq!(m.outcome, Outcome::Finished, "{what}");
    // measured: 1.0 (after the solve, divided by before it)
    assert!(m.contact_gain_max.unwrap_or(0.0) <= 1.0 + 1e-12, "{what}: {:?}", m.contact_gain_max);
    assert!(m.angular_momentum_drift_rel.unwrap() < 1e-12, "{what}: {:?}", m.angular_momentum_drift_rel);
}

/// No contact solve adds energy: cubes, spheres, and a bar, which shows R I Rᵀ against Rᵀ I R.
#[test]
fn a_plastic_contact_never_gains_energy() {
    let shapes = [
        ("box: { size_m: [1, 1, 1] }", "nodes_per_edge: 5"),
        ("box: { size_m: [0.4, 0.4, 1.6] }", "nodes_per_edge: 3"),
        ("sphere: { radius_m: 0.5 }", "subdivisions: 2"),
    ];
    for (shape, mesh) in shapes {
        for step in ["1e-3", "1e-2", "5e-2"] {
            for friction in ["0", "0.3", "1"] {
                for seed in 0..6 {
                    let sets = [
                        format!("scene.bodies.cube.shape={{ {shape} }}"),
                        format!("scene.bodies.cube.mesh={{ {mesh} }}"),
                        format!("time.step_s={step}"),
                        format!("scene.friction={friction}"),
                        format!("seed={seed}"),
                    ];
                    let sets: Vec<&str> = sets.iter().map(String::as_str).collect();
                    sound(&measured(CUBE_IN_BOX, &sets), &format!("{sets:?}"));
                }
            }
        }
    }
}

#[test]
fn a_body_at_rest_stays_at_rest() {
    let m = run(&experiment(SLAB, &["time.step_s=0.01", "time.end_s=5"]));
    let p = m.state.bodies[0].p_WB;
    // measured: 0 m sideways, 8e-18 m down
    assert!(p.x.abs() + p.z.abs() + (p.y - 0.1).abs() < 1e-12, "{p}");
    let force: f64 = m.forces.iter().map(|c| c.force_W.y).sum();
    assert!((force - 2.0 * 9.8).abs() < 1e-9, "{force}");
}

//! The closed form of the ball on a turntable against its circle, its law of rolling, and small steps of its attitude.

use super::contact::{reference, scene};
use gotai::experiment::types::Exact;
use gotai::state::BodyState;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

const TABLE: f64 = 2.0;

fn moving() -> impl Fn(f64) -> BodyState {
    reference(&scene(Exact::Turntable), &[])
}

#[test]
fn the_circle_closes_after_seven_halves_of_a_turn() {
    let motion = moving();
    let period_s = 2.0 * std::f64::consts::PI * 3.5 / TABLE;
    for turns in [1.0, 10.0] {
        let (start, end) = (motion(0.0), motion(turns * period_s));
        let off =
            (start.p_WB - end.p_WB).norm().max((start.v_WB - end.v_WB).norm()).max((start.w_WB - end.w_WB).norm());
        // measured: 6.4e-15 after one turn, 4.2e-14 after ten
        assert!(off < 2e-14 * turns, "{off:e}");
    }
    let radius_m = 0.13_f64.sqrt() * 3.5 / TABLE;
    let across = (motion(0.0).p_WB - motion(period_s / 2.0).p_WB).norm();
    assert!((across - 2.0 * radius_m).abs() < 1e-14, "{across}");
}

#[test]
fn the_ball_rolls_on_the_table_at_every_time() {
    let motion = moving();
    for i in 0..50 {
        let at = motion(0.37 * f64::from(i));
        let n = Vector3::y();
        let slip = at.v_WB - at.w_WB.cross(&n) * 0.1 - (n * TABLE).cross(&at.p_WB);
        // measured: 8.0e-16
        assert!(slip.norm() < 1e-14 && (at.w_WB.y - 7.0).abs() < 1e-14, "{i}: {slip}");
    }
}

/// A circle elsewhere, and one about the axis of the table; 10⁵ steps of Runge and Kutta.
#[test]
fn the_attitude_is_that_of_small_steps() {
    let about_axis = reference(
        &scene(Exact::Turntable),
        &[
            "scene.bodies.b.velocity_m_s=[0, 0, -0.2857142857142857]",
            "scene.bodies.b.angular_velocity_rad_s=[7.142857142857143, 0.5, 0]",
        ],
    );
    let off = [along(&moving(), 5.0), along(&about_axis, 5.0), along(&moving(), 25.0)];
    // measured: 2.0e-13 and 1.3e-14, of which most is the steps'; more than two turns of the circle
    assert!(off.iter().all(|off| *off < 2e-12), "{off:?}");
}

fn along(motion: &dyn Fn(f64) -> BodyState, end_s: f64) -> f64 {
    let steps = (end_s * 20_000.0) as u32;
    let h = end_s / f64::from(steps);
    let slope = |q: Quaternion<f64>, w: Vector3<f64>| Quaternion::from_imag(w) * q * 0.5;
    // ω turns about the vertical and has a part that does not.
    let rate = TABLE * 2.0 / 7.0;
    let half = motion(std::f64::consts::PI / rate).w_WB;
    let start = motion(0.0).w_WB;
    let (steady, turning) = ((start + half) / 2.0, (start - half) / 2.0);
    let w = |t: f64| steady + UnitQuaternion::from_scaled_axis(Vector3::y() * (rate * t)) * turning;
    let mut q = *motion(0.0).q_WB.quaternion();
    for i in 0..steps {
        let t = h * f64::from(i);
        let k1 = slope(q, w(t));
        let k2 = slope(q + k1 * (h / 2.0), w(t + h / 2.0));
        let k3 = slope(q + k2 * (h / 2.0), w(t + h / 2.0));
        let k4 = slope(q + k3 * h, w(t + h));
        q += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
    }
    motion(end_s).q_WB.angle_to(&UnitQuaternion::new_normalize(q))
}

//! The closed form of a ball on a dome against the known angles, quadratures made with thirty digits, and small steps.

use super::contact::{reference, scene};
use crate::yaml::file;
use gotai::exact::dome::Dome;
use gotai::experiment::types::Exact;
use gotai::sweep::plan;
use nalgebra::{UnitQuaternion, Vector3};

const G: f64 = 9.81;

#[test]
fn a_ball_that_slides_leaves_at_two_thirds_of_its_height() {
    let dome = Dome::new(10.0_f64.to_radians(), 1.1, 0.4, 0.0, G).unwrap();
    let off = (dome.leaves_s - 0.7669885260516042).abs();
    let cosine = dome.swing.at(dome.leaves_s).0.cos() / 10.0_f64.to_radians().cos();
    // measured: 0 and 5.6e-16
    assert!(off < 1e-14 && (cosine - 2.0 / 3.0).abs() < 1e-14, "{off:e} {cosine}");
}

/// With more and more friction it rolls up to where it would leave, 10/17 of its height.
#[test]
fn a_ball_rolls_until_its_friction_ends_and_that_is_before_it_leaves() {
    let start = 10.0_f64.to_radians();
    let dome = Dome::new(start, 1.1, 0.4, 1.0, G).unwrap();
    let (angle, _) = dome.swing.at(dome.rolls_s);
    let off = (dome.rolls_s - 0.9006628105482945).abs().max((angle - 0.8406790119668628).abs());
    // measured: 4.4e-16
    assert!(off < 1e-14, "{off:e}");
    let mut before = 0.0;
    for friction in [0.1, 1.0, 10.0, 1e4, 1e8] {
        let dome = Dome::new(start, 1.1, 0.4, friction, G).unwrap();
        let short = dome.swing.at(dome.rolls_s).0.cos() / start.cos() - 10.0 / 17.0;
        assert!(dome.rolls_s > before && short > 0.0, "{friction}: {short:e}");
        before = dome.rolls_s;
        if friction == 1e8 {
            // measured: 9.7e-10
            assert!(short < 1e-8, "{short:e}");
        }
    }
    assert!(Dome::new(1.0, 1.1, 0.4, 0.1, G).is_none());
}

#[test]
fn its_way_down_is_that_of_small_steps_and_it_rolls_without_slip() {
    for (friction, end_s, k) in [(0.0, 0.7, 0.0), (1.0, 0.85, 0.4)] {
        let motion = reference(&scene(Exact::Dome), &[&format!("scene.friction={friction}"), "time.end_s=0.8"]);
        let slope = |[angle, rate]: [f64; 2]| [rate, G * angle.sin() / (1.1 * (1.0 + k))];
        let (steps, mut y) = (100_000, [10.0_f64.to_radians(), 0.0]);
        let h = end_s / f64::from(steps);
        for _ in 0..steps {
            let add = |k: [f64; 2], h: f64| [y[0] + k[0] * h, y[1] + k[1] * h];
            let k1 = slope(y);
            let k2 = slope(add(k1, h / 2.0));
            let k3 = slope(add(k2, h / 2.0));
            let k4 = slope(add(k3, h));
            y = [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        let at = motion(end_s);
        let place = Vector3::new(y[0].sin(), y[0].cos(), 0.0);
        let off = (at.p_WB - place * 1.1).norm();
        let slip = at.v_WB + at.w_WB.cross(&(place * -0.1));
        let slips = if k > 0.0 { slip.norm() } else { at.w_WB.norm() };
        let rolled = if k > 0.0 { 11.0 * (y[0] - 10.0_f64.to_radians()) } else { 0.0 };
        let turned = at.q_WB.angle_to(&UnitQuaternion::from_scaled_axis(Vector3::z() * -rolled));
        // measured: 4.3e-15 m, 7.9e-15 m/s, 4.4e-14 rad
        assert!(off < 1e-12 && slips < 1e-12 && turned < 1e-11, "{friction}: {off:e} {slips:e} {turned:e}");
    }
}

#[test]
fn rolling_is_not_told_beyond_where_it_slips() {
    let told = plan::cases(&file(&scene(Exact::Dome), &["scene.friction=1", "time.end_s=0.91"]));
    let message = told.map(|_| ()).unwrap_err().to_string();
    assert!(message.contains("time.end_s: expected at most 0.90066") && message.contains("`dome`"), "{message}");
}

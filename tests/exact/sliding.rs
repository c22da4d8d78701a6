//! The closed form of a sliding block against the textbook's distances, times and accelerations.

use super::contact::{reference, scene};
use gotai::experiment::types::Exact;
use gotai::state::BodyState;
use nalgebra::Vector3;

const G: f64 = 9.8;

#[test]
fn a_block_on_a_level_plane_stops_after_its_distance_and_stays() {
    let motion = reference(&scene(Exact::Sliding), &[]);
    let (v, mu) = (Vector3::<f64>::new(2.0, 0.0, 1.0), 0.3);
    let (time_s, distance_m) = (v.norm() / (mu * G), v.norm_squared() / (2.0 * mu * G));
    let end = Vector3::new(0.0, 0.2, 0.0) + v.normalize() * distance_m;
    for t_s in [time_s, 2.0 * time_s, 1e6] {
        let at = motion(t_s);
        let off = (at.p_WB - end).norm();
        // measured: 0
        assert!(off < 1e-14 && at.v_WB.norm() < 1e-14, "{t_s}: {off:e}");
    }
    let half = motion(time_s / 2.0);
    // measured: 3.1e-17
    assert!(
        (half.v_WB - v / 2.0).norm() < 1e-14 && (half.p_WB - end + v.normalize() * distance_m / 4.0).norm() < 1e-14
    );
}

/// Gravity at an angle to the plane is a slope.
fn slope(mu: f64, tangent: f64, speed: f64) -> (impl Fn(f64) -> BodyState, [f64; 2]) {
    let (sin, cos) = (tangent / (1.0 + tangent * tangent).sqrt(), 1.0 / (1.0 + tangent * tangent).sqrt());
    let sets = [
        format!("scene.gravity_m_s2=[{}, {}, 0]", G * sin, -G * cos),
        format!("scene.friction={mu}"),
        format!("scene.bodies.b.velocity_m_s=[{speed}, 0, 0]"),
    ];
    (reference(&scene(Exact::Sliding), &sets.each_ref().map(String::as_str)), [G * sin, G * cos])
}

#[test]
fn a_block_on_a_slope_sticks_or_slides_as_its_angle_says() {
    for (mu, tangent) in [(0.4, 0.39), (0.4, 0.41), (0.0, 0.2), (0.3, 0.6)] {
        let (motion, [pull, press]) = slope(mu, tangent, 0.0);
        let a = (pull - mu * press).max(0.0);
        let (p, expected) = (motion(3.0).p_WB, Vector3::new(a * 4.5, 0.2, 0.0));
        // measured: 6.7e-16
        assert!((p - expected).norm() < 1e-14, "{mu} {tangent}: {:e}", (p - expected).norm());
    }
}

#[test]
fn a_block_shot_up_a_steep_slope_comes_back_slower() {
    let (motion, [pull, press]) = slope(0.3, 0.6, -3.0);
    let (up, down) = (pull + 0.3 * press, pull - 0.3 * press);
    let (top_s, height_m) = (3.0 / up, 4.5 / up);
    let back_s = top_s + (2.0 * height_m / down).sqrt();
    let speed = 3.0 * (down / up).sqrt();
    let at = motion(back_s);
    let off = at.p_WB.x.abs().max((at.v_WB.x - speed).abs());
    // measured: 4.4e-16
    assert!(off < 1e-14, "{off:e}");
}

//! The closed form of a ball on a plane against textbook results, and against its own events one after another, by
//! matrices.

use super::contact::{reference, scene};
use gotai::exact::arc::Arc;
use gotai::exact::ball::{Ball, Setting};
use gotai::experiment::types::Exact;
use gotai::state::BodyState;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3, Vector4};

const G: f64 = 9.8;
const R: f64 = 0.1;

fn ball(sets: &[&str]) -> impl Fn(f64) -> BodyState + use<> {
    reference(&scene(Exact::Ball), sets)
}

#[test]
fn a_dropped_ball_is_at_rest_from_zenos_point_on() {
    for e in [0.0, 0.3, 0.9, 0.999] {
        let motion = ball(&[
            "scene.bodies.b.velocity_m_s=[0, 0, 0]",
            "scene.bodies.b.angular_velocity_rad_s=[0, 0, 0]",
            &format!("scene.restitution={e}"),
        ]);
        let fall_s = (2.0_f64 * 0.4 / G).sqrt();
        let zeno_s = fall_s * (1.0 + e) / (1.0 - e);
        assert!((motion(fall_s).p_WB.y - R).abs() < 1e-15);
        let apex_s = fall_s * (1.0 + e);
        // measured: 2.8e-17
        assert!((motion(apex_s).p_WB.y - R - 0.4 * e * e).abs() < 1e-15, "{e}");
        for part in [1.0 - 1e-9, 1.0, 1.0 + 1e-9, 100.0] {
            let at = motion(part * zeno_s);
            if e == 0.0 && part < 1.0 {
                continue;
            }
            // measured: 2.8e-17 m, 1.7e-9 m/s
            assert!((at.p_WB.y - R).abs() < 1e-12 && at.v_WB.norm() < 2e-5, "{e} {part}: {at:?}");
        }
        assert_eq!(motion(zeno_s * 1.001).v_WB.norm(), 0.0);
    }
}

#[test]
fn an_elastic_ball_bounces_for_ever() {
    let motion = ball(&["scene.restitution=1", "scene.friction=0"]);
    let period_s = 2.0 * (2.0_f64 * 0.4 / G).sqrt();
    for n in [1.0, 7.0, 1000.0] {
        let at = motion(n * period_s);
        let off = (at.p_WB - Vector3::new(2.0, 0.0, 1.0) * n * period_s - Vector3::new(0.0, 0.5, 0.0)).norm();
        // measured: 0
        assert!(off < 1e-14 * n, "{n}: {off:e}");
    }
}

#[test]
fn a_sliding_ball_rolls_with_five_sevenths_of_its_speed() {
    let motion = ball(&[
        "scene.bodies.b.position_m=[0, 0.1, 0]",
        "scene.bodies.b.velocity_m_s=[3, 0, 0]",
        "scene.bodies.b.angular_velocity_rad_s=[0, 4, 0]",
    ]);
    let (time_s, distance_m) = (6.0 / (7.0 * 0.2 * G), 12.0 * 9.0 / (49.0 * 0.2 * G));
    let at = motion(time_s);
    let expected = Vector3::new(0.0, 4.0, -15.0 / 7.0 / R);
    // measured: 2.2e-16 m, 3.6e-15 rad/s
    assert!((at.p_WB.x - distance_m).abs() < 1e-14 && (at.w_WB - expected).norm() < 1e-13, "{at:?}");
    let later = motion(time_s + 2.0);
    assert!((later.p_WB.x - distance_m - 30.0 / 7.0).abs() < 1e-14 && later.w_WB == motion(time_s + 1.0).w_WB);
}

#[test]
fn a_ball_on_a_slope_rolls_or_slides_as_the_friction_says() {
    let (sin, cos) = (0.6_f64, 0.8_f64);
    for mu in [0.0, 0.1, 0.2, 0.22, 0.5] {
        let motion = ball(&[
            &format!("scene.gravity_m_s2=[{}, {}, 0]", G * sin, -G * cos),
            "scene.bodies.b.position_m=[0, 0.1, 0]",
            "scene.bodies.b.velocity_m_s=[0, 0, 0]",
            "scene.bodies.b.angular_velocity_rad_s=[0, 0, 0]",
            &format!("scene.friction={mu}"),
        ]);
        let (a, spin) = if mu >= 2.0 / 7.0 * sin / cos {
            (5.0 / 7.0 * G * sin, 5.0 / 7.0 * G * sin / R)
        } else {
            (G * (sin - mu * cos), 2.5 * mu * G * cos / R)
        };
        let at = motion(2.0);
        // measured: 1.8e-15 m, 1.4e-14 rad/s
        assert!((at.p_WB.x - 2.0 * a).abs() < 1e-13 && (at.w_WB.z + 2.0 * spin).abs() < 1e-12, "{mu}: {at:?}");
    }
}

/// Events one after another: times summed up, impacts by the matrix of the point of contact, flights by midpoints.
fn one_after_another(start: &BodyState, g: &Vector3<f64>, [e, back]: [f64; 2], mu: f64, end_s: f64) -> BodyState {
    let (n, arm) = (Vector3::y(), Vector3::new(0.0, -R, 0.0));
    let inverse_inertia = 1.0 / (0.4 * R * R);
    let skew = arm.cross_matrix();
    let compliance = Matrix3::identity() - skew * skew * inverse_inertia;
    let mut at = *start;
    let mut left_s = end_s;
    loop {
        let (height, speed) = (at.p_WB.y - R, at.v_WB.y);
        let flight_s = (speed + (speed * speed - 2.0 * g.y * height).sqrt()) / -g.y;
        let dt = flight_s.min(left_s);
        at.q_WB = UnitQuaternion::from_scaled_axis(at.w_WB * dt) * at.q_WB;
        at.p_WB += (at.v_WB + g * (dt / 2.0)) * dt;
        at.v_WB += g * dt;
        left_s -= dt;
        if left_s <= 0.0 {
            return at;
        }
        at.p_WB.y = R;
        let slip = at.v_WB + at.w_WB.cross(&arm);
        let wanted = Vector3::new(-back * slip.x, -e * at.v_WB.y, -back * slip.z);
        let mut push = compliance.try_inverse().unwrap() * (wanted - slip);
        let tangential = push - n * push.y;
        if tangential.norm() > mu * push.y {
            let slide = Vector3::new(slip.x, 0.0, slip.z).normalize();
            push = n * push.y - slide * (mu * push.y);
        }
        at.v_WB += push;
        at.w_WB += arm.cross(&push) * inverse_inertia;
    }
}

#[test]
fn bounces_are_what_their_events_one_after_another_say() {
    let spins = [Vector3::new(1.0, 2.0, 3.0), Vector3::new(-40.0, 5.0, 60.0)];
    let plain = [(0.5, 0.2, 0.0), (0.9, 0.05, 0.0), (0.9, 0.3, 3.0), (0.99, 0.02, -2.0), (1.0, 0.1, 1.0)];
    let back = [(0.5, 0.8, 0.0), (0.9, 0.05, 0.0), (0.9, 2.0, 3.0), (0.99, 0.3, -2.0)];
    let plain = plain.into_iter().map(|(e, mu, pull)| (e, 0.0, mu, pull));
    let back = back.into_iter().map(|(e, mu, pull)| (e, 0.7, mu, pull));
    for (e, back, mu, pull) in plain.chain(back) {
        for spin in spins {
            let g = Vector3::new(pull, -G, 0.0);
            // On a slope without slip across it, lest it slides on a curve in the end.
            let (v_z, spin) = if pull == 0.0 { (1.0, spin) } else { (0.0, Vector3::new(0.0, spin.y, spin.z)) };
            let sets = [
                format!("scene.restitution={e}"),
                format!("scene.friction={mu}"),
                format!("scene.pairs=[{{ between: [b, container], tangential_restitution: {back} }}]"),
                format!("scene.gravity_m_s2=[{pull}, -{G}, 0]"),
                format!("scene.bodies.b.velocity_m_s=[2, 0, {v_z}]"),
                format!("scene.bodies.b.angular_velocity_rad_s=[{}, {}, {}]", spin.x, spin.y, spin.z),
            ];
            let motion = ball(&sets.each_ref().map(String::as_str));
            let end_s = if e < 1.0 { 0.9 * (2.0_f64 * 0.4 / G).sqrt() * (1.0 + e) / (1.0 - e) } else { 50.0 };
            let at = motion(end_s);
            let other = one_after_another(&motion(0.0), &g, [e, back], mu, end_s);
            let size = other.p_WB.norm();
            let off = (at.p_WB - other.p_WB).norm() / size;
            let turned = at.q_WB.angle_to(&other.q_WB);
            // measured: 4e-16 and 1.2e-13 for e < 0.95; 1.5e-15 and 1.2e-11 after 88 elastic bounces at up to 200 rad/s
            assert!(
                off < 1e-12 && turned < 1e-10 && (at.w_WB - other.w_WB).norm() < 1e-11,
                "{e} {back} {mu} {pull}: {off:e} {turned:e}"
            );
        }
    }
}

/// Garwin's ball gives back all of its slip up to |s| = 7/4 μ(1 + e)w; without tangential restitution the slip ends up
/// to 7/2.
#[test]
fn the_slip_comes_back_up_to_seven_quarters_of_the_friction_impulse() {
    let (mu, e, w) = (0.2, 0.9, 3.0);
    for (back, threshold) in [(1.0, 1.75), (0.0, 3.5), (0.5, 3.5 / 1.5)] {
        for part in [0.3, 1.0 - 1e-9, 1.0 + 1e-9, 2.0] {
            let slip = part * threshold * mu * (1.0 + e) * w;
            let motion = ball(&[
                &format!("scene.restitution={e}"),
                &format!("scene.friction={mu}"),
                &format!("scene.pairs=[{{ between: [b, container], tangential_restitution: {back} }}]"),
                "scene.bodies.b.position_m=[0, 0.1, 0]",
                &format!("scene.bodies.b.velocity_m_s=[{slip}, -{w}, 0]"),
                "scene.bodies.b.angular_velocity_rad_s=[0, 0, 0]",
            ]);
            let at = motion(1e-3);
            let after = at.v_WB.x + R * at.w_WB.z;
            let wanted = if part <= 1.0 { -back * slip } else { slip - 3.5 * mu * (1.0 + e) * w };
            // measured: 4.4e-16
            assert!((after - wanted).abs() < 1e-14, "{back} {part}: {after} {wanted}");
        }
    }
}

/// Thrown with v and no spin it turns between two motions: after the first bounce (3v/7, −10v/7r), after the second as
/// it was. Its energy is kept.
#[test]
fn a_superball_returns_to_its_throw_every_second_bounce() {
    let motion = ball(&[
        "scene.restitution=1",
        "scene.friction=5",
        "scene.pairs=[{ between: [b, container], tangential_restitution: 1 }]",
        "scene.bodies.b.velocity_m_s=[2, 0, 0]",
        "scene.bodies.b.angular_velocity_rad_s=[0, 0, 0]",
    ]);
    let fall_s = (2.0_f64 * 0.4 / G).sqrt();
    for bounces in 0..40 {
        let at = motion(2.0 * fall_s * f64::from(bounces));
        let (v, w) = if bounces % 2 == 0 { (2.0, 0.0) } else { (6.0 / 7.0, -20.0 / 7.0 / R) };
        // measured: 1.1e-16 m/s, 0
        assert!((at.v_WB.x - v).abs() < 1e-13 && (at.w_WB.z - w).abs() < 1e-12, "{bounces}: {at:?}");
    }
}

/// ω turns in the world while the ball slides: against 10⁵ steps of Runge and Kutta.
#[test]
fn the_attitude_of_a_ball_that_slides_with_spin_is_that_of_small_steps() {
    let motion = ball(&[
        "scene.bodies.b.position_m=[0, 0.1, 0]",
        "scene.bodies.b.velocity_m_s=[3, 0, 0]",
        "scene.bodies.b.angular_velocity_rad_s=[5, 14, 3]",
        "scene.friction=0.05",
    ]);
    let (end_s, steps) = (0.8, 100_000);
    let h = end_s / f64::from(steps);
    let slope = |q: Quaternion<f64>, w: Vector3<f64>| Quaternion::from_imag(w) * q * 0.5;
    let mut q = *motion(0.0).q_WB.quaternion();
    for i in 0..steps {
        let t = h * f64::from(i);
        let w = [0.0, 0.5, 1.0].map(|part| {
            let (a, b) = (motion(0.0).w_WB, motion(end_s).w_WB);
            a + (b - a) * ((t + part * h) / end_s)
        });
        let k1 = slope(q, w[0]);
        let k2 = slope(q + k1 * (h / 2.0), w[1]);
        let k3 = slope(q + k2 * (h / 2.0), w[1]);
        let k4 = slope(q + k3 * h, w[2]);
        q += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
    }
    let off = motion(end_s).q_WB.angle_to(&UnitQuaternion::new_normalize(q));
    // measured: 5.7e-15
    assert!(off < 1e-13, "{off:e}");
}

/// ω = w + α t that passes α's own axis near and far, forward and back, against arcs of a few radians one after
/// another.
#[test]
fn the_attitude_of_an_arc_takes_few_steps_however_often_it_turns() {
    let still = Vector3::zeros();
    let directions = [[1.0, 0.2, -0.3], [-1.0, 1e-3, 1e-3], [-1.0, 0.05, -0.1], [0.0, 1.0, 0.0], [-1.0, 1e-9, 0.0]];
    let rows = [
        (300.0, 1.0, 1.0),
        (1e3, 1e3, -0.5),
        (50.0, 50.0, 4.0),
        (1e3, 1e-5, 1.0),
        (300.0, 1e-25, 1.0),
        (1e-3, 1e-8, 3e5),
        (20.0, 1e4, 0.1),
        (9.0, 1.0, 30.0),
        (10.5, 1.0, -30.0),
    ];
    for (w, alpha, t_s) in rows {
        for direction in directions.map(Vector3::from) {
            let q_WB = UnitQuaternion::from_scaled_axis(Vector3::new(0.3, -0.2, 0.9));
            let from = BodyState { p_WB: still, q_WB, v_WB: still, w_WB: direction.normalize() * w };
            let angular_rad_s2 = Vector3::new(alpha, 0.0, 1e-3 * alpha);
            let arc = Arc { t_s: 0.0, from, acceleration_m_s2: still, angular_rad_s2 };
            let turned = arc.turned(t_s);
            let phase = (w + alpha * f64::abs(t_s)) * f64::abs(t_s);
            let mut part = arc.clone();
            let parts = (phase / 100.0).ceil();
            for i in 1..=parts as u32 {
                part.from = part.at(t_s * f64::from(i) / parts);
                part.t_s = t_s * f64::from(i) / parts;
                part.from.w_WB = arc.at(part.t_s).w_WB;
            }
            let off = turned.q_WB.angle_to(&part.from.q_WB) / phase;
            // measured: 200 steps; 2e-16 rad of a radian, of which the parts have most
            assert!(turned.steps <= 256 && off < 2e-15, "{w} {alpha} {t_s} {direction:?}: {} {off:e}", turned.steps);
        }
    }
    for w in [1e4, 1e6, 1e9] {
        let from =
            BodyState { p_WB: still, q_WB: UnitQuaternion::identity(), v_WB: still, w_WB: Vector3::new(w, 3.0, 20.0) };
        let arc = Arc { t_s: 0.0, from, acceleration_m_s2: still, angular_rad_s2: Vector3::new(-14.7, 0.0, 0.03) };
        assert!(arc.turned(3.0).steps <= 256 && arc.turned(1e6).steps <= 256, "{w}");
    }
}

/// After 350 turns: by mpmath, Taylor's series of 30 terms in 1500 steps of 34 digits.
#[test]
fn the_attitude_of_an_arc_of_many_turns_is_right_to_the_last_digits() {
    let (still, q_WB) = (Vector3::zeros(), UnitQuaternion::identity());
    let from = BodyState { p_WB: still, q_WB, v_WB: still, w_WB: Vector3::new(0.0, 1000.0, 0.0) };
    let arc = Arc { t_s: 0.0, from, acceleration_m_s2: still, angular_rad_s2: Vector3::new(500.0, 0.0, 0.0) };
    let turned = arc.turned(2.0);
    let expected = [-0.34309850365346445, -0.8284998550712723, 0.16908522483450525, -0.4090007257698929];
    let off = (turned.q_WB.coords - Vector4::from(expected)).norm();
    // measured: 1.3e-16
    assert!(turned.steps == 0 && off < 1e-15, "{} {off:e}", turned.steps);
}

fn setting(restitution: f64, pull: f64) -> Setting {
    Setting {
        normal: Vector3::y(),
        acceleration_m_s2: Vector3::new(pull, -G, 0.0),
        radius_m: R,
        inertia: 0.4,
        friction: 0.3,
        restitution,
        tangential_restitution: 0.0,
    }
}

fn thrown(v_z: f64) -> BodyState {
    BodyState {
        p_WB: Vector3::new(0.0, 0.5, 0.0),
        q_WB: UnitQuaternion::identity(),
        v_WB: Vector3::new(0.1, 0.0, v_z),
        w_WB: Vector3::new(0.0, 3.0, -1.0),
    }
}

/// Nor are they taken before they are asked for: at a restitution near 1 millions come until Zeno's point.
#[test]
fn every_impact_is_taken_once() {
    for e in [0.5, 0.999, 0.999_999, 1.0 - 1e-12, 1.0] {
        for pull in [0.0, 1.0] {
            let ball = Ball::new(setting(e, pull), &thrown(0.0), 0.4).unwrap();
            assert_eq!(ball.taken(), 0, "{e}");
            let times = (0..1000).map(|i| 0.02 * f64::from(i));
            let once: Vec<_> = times.map(|t_s| ball.at(t_s)).collect();
            // 20 s of flights of 0.57 s, or some tens up to Zeno's point.
            assert!(ball.taken() <= 61, "{e}: {}", ball.taken());
            // Back, and there again: the same to the last bit.
            assert_eq!((ball.at(0.02 * 300.0), ball.at(0.02 * 999.0)), (once[300], once[999]), "{e}");
        }
    }
}

#[test]
fn a_ball_that_slips_across_a_slope_is_known_without_its_last_impact() {
    // It grips before its last impact, in all up to 56 m/s, and rolls down the slope then; or it slips on.
    for (e, v_z, is_one) in [(0.999_999, 0.1, true), (0.9, 50.0, true), (0.9, 80.0, false), (1.0 - 1e-12, 1e14, false)]
    {
        let ball = Ball::new(setting(e, 1.0), &thrown(v_z), 0.4);
        assert_eq!(ball.is_some(), is_one, "{e} {v_z}");
        assert!(ball.is_none_or(|ball| ball.taken() == 0));
    }
}

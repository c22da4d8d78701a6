//! Closed forms of a point mass against 40 digits (point.py), in any direction.

use gotai::exact::linear_drag::LinearDrag;
use gotai::exact::point_motion::{Harmonic, PointMotion};
use gotai::exact::quadratic_drag::QuadraticDrag;
use nalgebra::Vector3;
use serde::Deserialize;

#[derive(Deserialize)]
struct Reference {
    quadratic: Vec<Quadratic>,
    linear: Vec<Linear>,
    harmonic: Vec<Shaken>,
}

#[derive(Deserialize)]
struct Quadratic {
    name: String,
    g: f64,
    k: f64,
    v: f64,
    rows: Vec<Row>,
}

#[derive(Deserialize)]
struct Linear {
    name: String,
    a: f64,
    rate: f64,
    v: f64,
    rows: Vec<Row>,
}

#[derive(Deserialize)]
struct Shaken {
    name: String,
    g: f64,
    waves: Vec<[f64; 3]>,
    v: f64,
    rows: Vec<Row>,
}

#[derive(Deserialize)]
struct Row {
    t_s: f64,
    p_m: f64,
    v_m_s: f64,
}

fn reference() -> Reference {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/exact/point.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

const ALONG: Vector3<f64> = Vector3::new(0.0, -1.0, 0.0);
const START: Vector3<f64> = Vector3::new(0.0, 0.0, 0.0);

/// The largest error of position and of velocity; `at` gives both, and the scales they are relative to.
fn errors(name: &str, rows: &[Row], at: impl Fn(f64) -> [(Vector3<f64>, Vector3<f64>); 2]) -> [f64; 2] {
    let mut most = [0.0_f64; 2];
    for row in rows {
        let [(p, v), (p_scale, v_scale)] = at(row.t_s);
        let p_off = (p - ALONG * row.p_m).norm() / p_scale.norm();
        let v_off = (v - ALONG * row.v_m_s).norm() / v_scale.norm();
        println!("{name}, {} s: {p_off:.1e}, {v_off:.1e}", row.t_s);
        most = [most[0].max(p_off), most[1].max(v_off)];
    }
    most
}

fn larger(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0].max(b[0]), a[1].max(b[1])]
}

#[test]
fn quadratic_drag_is_that_of_forty_digits() {
    let mut most = [0.0; 2];
    for case in reference().quadratic {
        let motion = QuadraticDrag::new(START, ALONG * case.v, ALONG * case.g, case.k).unwrap();
        // Where the motion turns back, position and speed pass zero: the whole path and g t are their scales.
        let up = case.v < 0.0;
        let scale = |t: f64, (p, v): (Vector3<f64>, Vector3<f64>)| {
            let rise = ALONG * (case.v * case.v / (2.0 * case.g)).min(case.v.abs() * t);
            if up { (ALONG * rise.norm().max(p.norm()), ALONG * (case.g * t).max(v.norm())) } else { (p, v) }
        };
        let here = errors(&case.name, &case.rows, |t| [motion.at(t), scale(t, motion.at(t))]);
        most = larger(most, here);
    }
    // measured: 2.6e-16 and 2.2e-16
    assert!(most[0] < 1e-15 && most[1] < 1e-15, "{most:?}");
}

#[test]
fn linear_drag_is_that_of_forty_digits() {
    let mut most = [0.0; 2];
    for case in reference().linear {
        let at = |v: f64, a: f64, t: f64| {
            let (velocity_m_s, acceleration_m_s2) = (ALONG * v, ALONG * a);
            LinearDrag { position_m: START, velocity_m_s, acceleration_m_s2, rate_per_s: case.rate }.at(t)
        };
        // What start and force give apart may cancel: the sum of both.
        let here =
            errors(&case.name, &case.rows, |t| [at(case.v, case.a, t), at(case.v.abs(), case.a * t.signum(), t)]);
        most = larger(most, here);
    }
    // measured: 2.2e-16 and 1.3e-16
    assert!(most[0] < 1e-15 && most[1] < 1e-15, "{most:?}");
}

#[test]
fn a_shaken_point_is_where_forty_digits_say() {
    let mut most = [0.0; 2];
    for case in reference().harmonic {
        let wave =
            |&[A, rate_rad_s, phase_rad]: &[f64; 3]| Harmonic { amplitude_m_s2: ALONG * A, rate_rad_s, phase_rad };
        let motion = PointMotion {
            position_m: START,
            velocity_m_s: ALONG * case.v,
            constant_m_s2: ALONG * case.g,
            harmonics: case.waves.iter().map(wave).collect(),
        };
        let a = case.g.abs() + case.waves.iter().map(|w| w[0].abs()).sum::<f64>();
        let rate = case.waves.iter().map(|w| w[1]).fold(0.0, f64::max);
        // Of the largest acceleration over the time, or over a radian of the fastest harmonic if that is shorter.
        let scale = |t: f64| {
            let (v, p) = (case.v.abs() + case.g.abs() * t, a * t.min(1.0 / rate));
            (ALONG * (v * t + p * t / 2.0), ALONG * (v + p))
        };
        most = larger(most, errors(&case.name, &case.rows, |t| [motion.at(t), scale(t)]));
    }
    // measured: 8.5e-17 and 1.5e-16
    assert!(most[0] < 1e-15 && most[1] < 1e-15, "{most:?}");
}

#[test]
fn gravity_may_point_anywhere() {
    let along = Vector3::new(2.0, -3.0, 6.0) / 7.0;
    let origin = Vector3::new(1.0, 2.0, 3.0);
    for (v, g, k) in [(-3.0, 9.81, 0.2), (4.0, 9.81, 0.2), (4.0, 0.0, 0.2), (0.0, 9.81, 0.2), (-3.0, 9.81, 0.0)] {
        let line = QuadraticDrag::new(START, ALONG * v, ALONG * g, k).unwrap();
        let turned = QuadraticDrag::new(origin, along * v, along * g, k).unwrap();
        assert_eq!(line.terminal_speed_m_s().is_some(), g > 0.0 && k > 0.0);
        for t_s in [0.0, 0.1, 0.7, 5.0] {
            let ((p, u), (q, w)) = (line.at(t_s), turned.at(t_s));
            let off = (q - origin - along * p.dot(&ALONG)).norm().max((w - along * u.dot(&ALONG)).norm());
            // Of up to 108 m; measured: 1.6e-14
            assert!(off < 3e-14, "{v} {g} {k} {t_s}: {off:.1e}");
        }
    }
}

#[test]
fn a_motion_off_the_line_has_no_closed_form() {
    let g = Vector3::new(0.0, -9.81, 0.0);
    assert!(QuadraticDrag::new(START, Vector3::new(1e-6, 5.0, 0.0), g, 0.1).is_none());
    assert!(QuadraticDrag::new(START, Vector3::new(0.0, 5.0, 0.0), g, -0.1).is_none());
    assert!(QuadraticDrag::new(START, Vector3::new(1.0, 5.0, 0.0), Vector3::zeros(), 0.1).is_some());
}

#[test]
fn the_speed_ends_at_the_terminal_speed() {
    let motion = QuadraticDrag::new(START, ALONG * -20.0, ALONG * 9.81, 0.4).unwrap();
    let terminal = motion.terminal_speed_m_s().unwrap();
    let (_, v) = motion.at(1e6);
    // measured: 0
    assert!((v.norm() / terminal - 1.0).abs() < 3e-16, "{v:?}");
}

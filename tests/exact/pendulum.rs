//! The closed form of the plane pendulum against 40 digits (pendulum.py).

use gotai::exact::pendulum::Pendulum;
use serde::Deserialize;
use std::f64::consts::PI;

#[derive(Deserialize)]
struct Case {
    name: String,
    moment: f64,
    inertia: f64,
    theta: f64,
    rate: f64,
    /// t, θ, θ̇.
    rows: Vec<[f64; 3]>,
}

fn cases() -> Vec<Case> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/exact/pendulum.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn every_pendulum_is_where_forty_digits_say() {
    let mut most = [0.0_f64; 2];
    for case in cases() {
        let motion = Pendulum::new(case.moment, case.inertia, case.theta, case.rate);
        // Of the amplitude, or of a turn and the angle turned.
        let natural = (case.moment / case.inertia).sqrt();
        let amplitude = (case.theta.abs() + case.rate.abs() / natural).min(PI);
        for &[t_s, theta, rate] in &case.rows {
            let at = motion.at(t_s);
            let off = [
                (at.0 - theta).abs() / amplitude.max(theta.abs()),
                (at.1 - rate).abs() / (natural * amplitude).max(rate.abs()),
            ];
            println!("{}, {t_s} s: {:.1e}, {:.1e}", case.name, off[0], off[1]);
            most = [most[0].max(off[0]), most[1].max(off[1])];
        }
    }
    // measured: 2.9e-16 and 3.4e-16, also after 10⁴ periods
    assert!(most.iter().all(|x| *x < 1e-14), "{most:?}");
}

#[test]
fn rest_at_the_bottom_and_at_the_top_lasts() {
    // 2π rounds: measured 4.6e-16 rad/s
    for angle in [0.0, PI, -PI, 2.0 * PI] {
        let (theta, rate) = Pendulum::new(2.0, 0.5, angle, 0.0).at(1e3);
        assert!((theta - angle).abs() <= 1e-15 && rate.abs() <= 1e-15, "{angle}: {theta} {rate}");
    }
    assert!(Pendulum::new(2.0, 0.5, 0.0, 0.0).period_s().is_none());
}

#[test]
fn a_period_later_it_is_back_or_a_turn_on() {
    for (theta, rate, gain) in [(1.0, 0.3, 0.0), (-3.0, 0.0, 0.0), (0.5, 7.0, 2.0 * PI), (0.5, -7.0, -2.0 * PI)] {
        let motion = Pendulum::new(2.0, 0.5, theta, rate);
        let (end, end_rate) = motion.at(motion.period_s().unwrap());
        let off = (end - theta - gain).abs().max((end_rate - rate).abs());
        println!("{off:.1e}");
        // measured: 1.2e-15
        assert!(off < 2e-14, "{theta} {rate}: {off:.1e}");
    }
}

//! The closed form of the falling rod against the known time of its fall, its energy, and small steps.

use super::contact::{reference, scene};
use gotai::exact::falling_rod::FallingRod;
use gotai::experiment::types::Exact;
use nalgebra::Vector3;

const G: f64 = 9.81;

#[test]
fn a_rod_of_a_metre_from_one_degree_is_flat_after_its_time() {
    let rod = FallingRod::new(1.0_f64.to_radians(), 1.0 / 3.0, 0.5, G);
    // measured: 2.4e-10, the digits that are given
    assert!((rod.flat_s() - 0.811130469).abs() < 6e-10, "{}", rod.flat_s());
}

#[test]
fn its_angle_and_rate_are_those_of_small_steps() {
    for (start, kappa) in [(0.02, 1.0 / 3.0), (0.5, 1.0 / 3.0), (1.4, 0.1), (1e-3, 1.0)] {
        let rod = FallingRod::new(start, kappa, 0.5, G);
        // θ̈ = (g/l) sin θ ((cos θ − cos θ₀)² + κ + sin² θ₀)/(κ + sin² θ)².
        let slope = |[theta, rate]: [f64; 2]| {
            let (s, c) = (theta.sin(), theta.cos());
            let pull = (c - start.cos()).powi(2) + kappa + start.sin().powi(2);
            [rate, G / 0.5 * s * pull / (kappa + s * s).powi(2)]
        };
        let (steps, mut y) = (100_000, [start, 0.0]);
        let h = rod.flat_s() * 0.95 / f64::from(steps);
        for _ in 0..steps {
            let add = |k: [f64; 2], h: f64| [y[0] + k[0] * h, y[1] + k[1] * h];
            let k1 = slope(y);
            let k2 = slope(add(k1, h / 2.0));
            let k3 = slope(add(k2, h / 2.0));
            let k4 = slope(add(k3, h));
            y = [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        let (theta, rate) = rod.at(rod.flat_s() * 0.95);
        let off = (theta - y[0]).abs().max((rate - y[1]).abs());
        // measured: 7.7e-14
        assert!(off < 1e-12, "{start} {kappa}: {theta} {rate} {y:?}");
    }
}

#[test]
fn energy_is_kept_until_it_lies() {
    let start = 0.3_f64;
    let rod = FallingRod::new(start, 1.0 / 3.0, 0.5, G);
    for part in [0.0, 1e-6, 0.3, 0.9, 1.0] {
        let (theta, rate) = rod.at(part * rod.flat_s());
        let square = 2.0 * G / 0.5 * (start.cos() - theta.cos()) / (1.0 / 3.0 + theta.sin().powi(2));
        // measured: 1.4e-14
        assert!((rate * rate - square).abs() < 2e-13, "{part}: {:e}", rate * rate - square);
    }
    assert!((rod.at(rod.flat_s()).0 - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
}

#[test]
fn a_capsule_slides_with_its_lower_end_and_lies_flat() {
    let motion = reference(&scene(Exact::FallingRod), &[]);
    let start = motion(0.0).p_WB;
    for i in 0..30 {
        let at = motion(0.02 * f64::from(i));
        let end = at.p_WB - at.q_WB * Vector3::new(0.0, 0.5, 0.0);
        // measured: 2.0e-16
        assert!((end.y - 0.01).abs() < 1e-14 && at.p_WB.x == start.x && at.p_WB.z == start.z, "{i}: {end}");
    }
    let flat = motion(10.0);
    assert!((flat.p_WB.y - 0.01).abs() < 1e-15 && (flat.q_WB * Vector3::y()).y.abs() < 1e-15 && flat.v_WB.y == 0.0);
}

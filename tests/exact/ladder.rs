//! The closed form of a ladder against quadratures made with thirty digits, small steps, and what it touches.

use super::contact::{reference, scene};
use gotai::exact::ladder::Ladder;
use gotai::experiment::types::Exact;
use nalgebra::Vector3;

const G: f64 = 9.81;

#[test]
fn it_leaves_the_wall_and_lies_flat_at_the_times_of_thirty_digits() {
    let ladder = Ladder::new(30.0_f64.to_radians(), 1.0 / 3.0, 0.5, G).unwrap();
    let off = (ladder.leaves_s() - 0.3250307015908207).abs();
    let off_flat = (ladder.flat_s() - 0.48517390441487607).abs();
    // measured: 5.6e-17 and 1.1e-16
    assert!(off < 1e-15 && off_flat < 1e-15, "{off:e} {off_flat:e}");
}

#[test]
fn it_leaves_at_two_thirds_of_its_height_whatever_its_inertia() {
    let mut worst = 0.0_f64;
    for (start, kappa) in [(0.05, 1.0 / 3.0), (0.5, 0.0), (0.5, 1.0), (1.4, 0.2)] {
        let ladder = Ladder::new(start, kappa, 0.5, G).unwrap();
        for t_s in [ladder.leaves_s() * (1.0 - 1e-15), ladder.leaves_s()] {
            let at = ladder.at(t_s);
            let square = 2.0 * G / 0.5 / (1.0 + kappa) * f64::cos(start) / 3.0;
            worst = worst.max((at.angle_rad.cos() - 2.0 / 3.0 * f64::cos(start)).abs());
            worst = worst.max((at.rate_rad_s * at.rate_rad_s / square - 1.0).abs());
        }
    }
    // measured: 1.8e-14; it grows as the start comes near the vertical, 1.4e-11 at 0.001 rad
    assert!(worst < 1e-13, "{worst:e}");
}

/// θ, θ̇ of the ladder on wall and floor, or on the floor alone.
fn slope(on_wall: bool, kappa: f64, l: f64, [angle, rate]: [f64; 2]) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    let turning = if on_wall {
        G / l * s / (1.0 + kappa)
    } else {
        // Of N (l sin θ) = I θ̈ and N = m (g − l (θ̈ sin θ + θ̇² cos θ)).
        (G / l - rate * rate * c) * s / (kappa + s * s)
    };
    [rate, turning]
}

#[test]
fn it_slides_as_small_steps_say() {
    let mut worst = 0.0_f64;
    for (start, kappa, l) in [(0.02, 1.0 / 3.0, 0.5), (0.5, 0.1, 2.0), (1.2, 1.0, 0.5)] {
        let ladder = Ladder::new(start, kappa, l, G).unwrap();
        let end_s = ladder.leaves_s() + 0.9 * (ladder.flat_s() - ladder.leaves_s());
        let mut y = [start, 0.0];
        for (on_wall, time_s) in [(true, ladder.leaves_s()), (false, end_s - ladder.leaves_s())] {
            let steps = 50_000;
            let h = time_s / f64::from(steps);
            for _ in 0..steps {
                let add = |k: [f64; 2], h: f64| [y[0] + k[0] * h, y[1] + k[1] * h];
                let k1 = slope(on_wall, kappa, l, y);
                let k2 = slope(on_wall, kappa, l, add(k1, h / 2.0));
                let k3 = slope(on_wall, kappa, l, add(k2, h / 2.0));
                let k4 = slope(on_wall, kappa, l, add(k3, h));
                y = [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
            }
            let at = ladder.at(if on_wall { ladder.leaves_s() } else { end_s });
            worst = worst.max((at.angle_rad - y[0]).abs()).max((at.rate_rad_s - y[1]).abs());
        }
    }
    // measured: 3.1e-13
    assert!(worst < 1e-11, "{worst:e}");
}

#[test]
fn a_capsule_touches_the_floor_always_and_the_wall_until_it_leaves() {
    let motion = reference(&scene(Exact::Ladder), &[]);
    let (mut floor, mut wall, mut moved) = (0.0_f64, 0.0_f64, 0.0_f64);
    for i in 0..60 {
        let t_s = 0.01 * f64::from(i);
        let at = motion(t_s);
        let [foot, head] = [-0.5, 0.5].map(|y| at.p_WB + at.q_WB * Vector3::new(0.0, y, 0.0));
        let foot = if foot.y < head.y { foot } else { head };
        let head = at.p_WB * 2.0 - foot;
        floor = floor.max((foot.y - 0.01).abs());
        if t_s < 0.325 {
            wall = wall.max((head.x - 0.01).abs());
        } else {
            assert!(head.x > 0.01 - 1e-12, "{t_s}: {head}");
        }
        let h = 1e-6;
        let quotient = (motion(t_s + h).p_WB - motion((t_s - h).max(0.0)).p_WB) / (h + h.min(t_s));
        // Not where it lies down.
        if t_s > 0.0 && (t_s - 0.485).abs() > 0.004 {
            moved = moved.max((quotient - at.v_WB).norm());
        }
    }
    // measured: 1.8e-16 and 1.2e-16 m; 2.1e-10 m/s, of the quotient
    assert!(floor < 1e-14 && wall < 1e-14 && moved < 1e-8, "{floor:e} {wall:e} {moved:e}");
}

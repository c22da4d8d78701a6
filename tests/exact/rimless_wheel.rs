//! The closed form of the rimless wheel against small steps of its equation of motion, McGeer's ratio and limit cycle,
//! and the rocking block.

use super::contact::{reference, scene};
use gotai::exact::rimless_wheel::RimlessWheel;
use gotai::experiment::types::Exact;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Steps, ψ and ψ̇ from impact to impact by Runge and Kutta, the last step of each by Newton's method.
fn by_steps(wheel: &RimlessWheel, end_s: f64) -> (i64, [f64; 2]) {
    let RimlessWheel { half_angle_rad: alpha, slope_rad, gravity_rad_s2, inertia, start } = *wheel;
    let slope = |[psi, rate]: [f64; 2]| [rate, gravity_rad_s2 / (1.0 + inertia) * (psi + slope_rad).sin()];
    let step = |y: [f64; 2], h: f64| {
        let add = |k: [f64; 2], h: f64| [y[0] + k[0] * h, y[1] + k[1] * h];
        let k1 = slope(y);
        let k2 = slope(add(k1, h / 2.0));
        let k3 = slope(add(k2, h / 2.0));
        let k4 = slope(add(k3, h));
        [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    };
    let (h, mut y, mut left_s, mut steps) = (0.5_f64.powi(15), start, end_s, 0);
    while left_s > 0.0 {
        let dt = f64::min(h, left_s);
        let next = step(y, dt);
        if next[0].abs() <= alpha {
            (y, left_s) = (next, left_s - dt);
            continue;
        }
        let side = next[0].signum();
        let mut part = dt / 2.0;
        for _ in 0..20 {
            let at = step(y, part);
            part -= (at[0] - side * alpha) / at[1];
        }
        let left = (inertia + (2.0 * alpha).cos()) / (inertia + 1.0);
        y = [-side * alpha, left * step(y, part)[1]];
        left_s -= part;
        steps += side as i64;
    }
    (steps, y)
}

#[test]
fn it_rolls_and_rocks_as_small_steps_say() {
    let mut worst = 0.0_f64;
    for (spokes, slope_rad, inertia, start) in [
        (6.0, 0.0, 5.0 / 12.0, [-PI / 6.0, 4.0]),
        (6.0, 0.25, 5.0 / 12.0, [-PI / 6.0, 2.0]),
        (6.0, -0.2, 5.0 / 12.0, [0.1, 1.0]),
        (8.0, 0.6, 0.3, [-0.2, -0.5]),
        (4.0, 0.4, 1.0 / 3.0, [0.0, -1.0]),
        (12.0, 0.05, 0.0, [-0.1, 0.0]),
    ] {
        let wheel = RimlessWheel { half_angle_rad: PI / spokes, slope_rad, gravity_rad_s2: 19.62, inertia, start };
        // Before any of them stands.
        for end_s in [0.01, 0.1, 0.3, 0.6] {
            let (steps, other) = by_steps(&wheel, end_s);
            let at = wheel.at(end_s);
            assert_eq!(at.steps, steps, "{spokes} {slope_rad} {end_s}");
            worst = worst.max((at.angle_rad - other[0]).abs()).max((at.rate_rad_s - other[1]).abs());
        }
    }
    // measured: 2.6e-14
    assert!(worst < 1e-10, "{worst:e}");
}

/// Every step gains p² 4 sin α sin γ and an impact leaves ε²: the speeds are those of a geometric series.
#[test]
fn down_a_slope_it_comes_to_mc_geers_rate() {
    let (alpha, gamma, inertia) = (PI / 8.0, 0.1_f64, 0.3);
    let wheel =
        RimlessWheel { half_angle_rad: alpha, slope_rad: gamma, gravity_rad_s2: 10.0, inertia, start: [-alpha, 3.0] };
    let left = (inertia + (2.0 * alpha).cos()) / (inertia + 1.0);
    let gain = 4.0 * 10.0 / (1.0 + inertia) * alpha.sin() * gamma.sin();
    let steady = (left * left * gain / (1.0 - left * left)).sqrt();
    let mut t_s = 0.0;
    let mut found = wheel.at(0.0);
    while found.steps < 200 {
        t_s += 0.05;
        found = wheel.at(t_s);
    }
    let p2 = 10.0 / (1.0 + inertia);
    let square = found.rate_rad_s.powi(2) - 2.0 * p2 * ((gamma - alpha).cos() - (found.angle_rad + gamma).cos());
    // measured: 2.2e-16
    assert!((square.sqrt() / steady - 1.0).abs() < 1e-12, "{} {steady}", square.sqrt());
    assert_eq!(wheel.left(), left);
}

/// A box of a square cross-section is a wheel of four spokes.
#[test]
fn a_square_box_rocks_as_the_closed_form_of_blocks_says() {
    let box_of = |which: Exact| {
        scene(Exact::RockingBlock).replace("[0.4, 1, 0.8]", "[1, 1, 0.8]").replace("rocking-block", which.word())
    };
    // Tilted by asin 0.1 about its edge at x = z = 0.
    let sets = ["scene.friction=1.5", "scene.bodies.b.position_m=[0.44749371855331, 0.54749371855331, 0]"];
    let [wheel, block] = [Exact::RimlessWheel, Exact::RockingBlock].map(|which| reference(&box_of(which), &sets));
    let mut worst = 0.0_f64;
    for i in 0..100 {
        let [a, b] = [wheel(0.02 * f64::from(i)), block(0.02 * f64::from(i))];
        let off = (a.p_WB - b.p_WB).norm() + a.q_WB.angle_to(&b.q_WB);
        worst = worst.max(off + (a.v_WB - b.v_WB).norm() + (a.w_WB - b.w_WB).norm());
    }
    // measured: 2.3e-15
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn a_prism_touches_the_plane_with_its_lowest_edge_and_stands_in_the_end() {
    let motion = reference(&scene(Exact::RimlessWheel), &[]);
    let lowest = |t_s: f64| {
        let at = motion(t_s);
        let corner = |i: i32| {
            let angle = f64::from(i) * PI / 3.0;
            (at.p_WB + at.q_WB * Vector3::new(0.5 * angle.cos(), 0.5 * angle.sin(), 0.2)).y
        };
        (0..6).map(corner).fold(f64::INFINITY, f64::min)
    };
    let off = (0..200).map(|i| lowest(0.02 * f64::from(i)).abs()).fold(0.0, f64::max);
    let end = motion(100.0);
    // measured: 3.3e-16
    assert!(off < 1e-14, "{off:e}");
    assert!((end.p_WB.y - 0.4330127018922193).abs() < 1e-14 && end.v_WB.norm() == 0.0 && end.p_WB.x > 0.9);
}

//! The closed form of the rocking block against small steps of its equation of motion, and Housner's ratio.

use super::contact::{reference, scene};
use gotai::exact::rocking_block::RockingBlock;
use gotai::experiment::types::Exact;
use nalgebra::Vector3;

/// θ and θ̇ on the way from impact to impact by Runge and Kutta, the last step of each by Newton's method.
fn by_steps(alpha: f64, p: f64, left: f64, [tilt, rate]: [f64; 2], end_s: f64) -> [f64; 2] {
    let slope = |[theta, rate]: [f64; 2]| [rate, -p * p * (alpha - theta).sin()];
    let step = |y: [f64; 2], h: f64| {
        let add = |k: [f64; 2], h: f64| [y[0] + k[0] * h, y[1] + k[1] * h];
        let k1 = slope(y);
        let k2 = slope(add(k1, h / 2.0));
        let k3 = slope(add(k2, h / 2.0));
        let k4 = slope(add(k3, h));
        [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    };
    let (h, mut y, mut left_s) = (0.5_f64.powi(15), [tilt, rate], end_s);
    while left_s > 0.0 {
        let dt = f64::min(h, left_s);
        let next = step(y, dt);
        if next[0] >= 0.0 {
            (y, left_s) = (next, left_s - dt);
            continue;
        }
        let mut part = dt / 2.0;
        for _ in 0..20 {
            let at = step(y, part);
            part -= at[0] / at[1];
        }
        y = [0.0, -left * step(y, part)[1]];
        left_s -= part;
    }
    y
}

#[test]
fn it_rocks_as_small_steps_say() {
    for (alpha, left, start) in
        [(0.38, 0.79, [0.1, 0.0]), (0.2, 0.94, [0.199, 0.0]), (0.3, 0.87, [0.05, 0.3]), (0.3, 0.87, [0.0, -0.4])]
    {
        let p = 3.3;
        let block = RockingBlock::new(alpha, p, left, start[0], start[1]).unwrap();
        for end_s in [0.01, 0.1, 0.7, 1.6] {
            let (_, tilt, rate) = block.at(end_s);
            let other = by_steps(alpha, p, left, start, end_s);
            let off = (tilt - other[0]).abs().max((rate - other[1]).abs());
            // measured: 2.0e-13 near overturning, else 1.7e-14
            assert!(off < 2e-12, "{alpha} {start:?} {end_s}: {tilt} {rate} {other:?}");
        }
    }
}

#[test]
fn every_impact_leaves_housners_part_and_the_block_stands_in_the_end() {
    let (alpha, left) = (0.25_f64, 1.0 - 1.5 * 0.25_f64.sin().powi(2));
    let block = RockingBlock::new(alpha, 3.0, left, 0.1, 0.0).unwrap();
    let impacts: Vec<f64> = block.impacts_s().collect();
    for t_s in impacts.iter().take(20) {
        let (before, after) = (block.at(t_s - 1e-12).2, block.at(*t_s).2);
        // measured: 2.1e-11, as the speed is not that of the impact itself
        assert!((after / before + left).abs() < 1e-7, "{t_s}: {before} {after}");
    }
    let end_s = impacts[impacts.len() - 1];
    assert_eq!(block.at(end_s), (impacts.len(), 0.0, 0.0));
    assert!(block.at(end_s - 1e-3).1 < 1e-5);
    assert!(RockingBlock::new(alpha, 3.0, left, 0.26, 0.0).is_none());
    assert!(RockingBlock::new(alpha, 3.0, left, 0.0, 3.0).is_none());
}

#[test]
fn a_box_rocks_on_its_edges_and_stands_in_the_end() {
    let motion = reference(&scene(Exact::RockingBlock), &[]);
    let lowest = |t_s: f64| {
        let at = motion(t_s);
        let corner = |i: u32| {
            let sign = |bit: u32| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
            (at.p_WB + at.q_WB * Vector3::new(0.2 * sign(0), 0.5 * sign(1), 0.4 * sign(2))).y
        };
        (0..8).map(corner).fold(f64::INFINITY, f64::min)
    };
    for i in 0..200 {
        // measured: 1.1e-16
        assert!(lowest(0.02 * f64::from(i)).abs() < 1e-14, "{i}");
    }
    let end = motion(100.0);
    let off = (end.p_WB - Vector3::new(0.2, 0.5, 0.0)).norm().max(end.q_WB.angle());
    assert!(off < 1e-15 && end.v_WB.norm() == 0.0, "{off:e}");
}

//! Gaps of all pairs, by weak duality: no plane parts two solids by more than their distance. A gap that a plane parts
//! them by, with a point of either solid at its ends, is the distance; if negative, no plane of thousands may do
//! better.

use super::oracle::{Draws, beside, level_at, separation, solids};
use gotai::shape::pair::{apart, touches};
use gotai::shape::solid::{Meeting, Pose, Solid};
use nalgebra::{Isometry3, Vector3};

const GAPS_M: [f64; 8] = [0.3, 0.01, 1e-6, 0.0, -1e-9, -1e-3, -0.02, -0.08];

fn nearest(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose) -> Meeting {
    let mut all = Vec::new();
    touches(a, pose_a, b, pose_b, 10.0, &mut all);
    *all.iter().min_by(|a, b| a.gap_m.total_cmp(&b.gap_m)).unwrap()
}

fn each_pair(seed: u64, poses: usize, mut visit: impl FnMut(&mut Draws, &Solid, &Pose, &Solid, &Pose)) {
    let mut draws = Draws(seed);
    for a in solids() {
        for b in solids() {
            for gap_m in GAPS_M {
                for _ in 0..poses {
                    let (pose_a, pose_b) = beside(&mut draws, &a, &b, gap_m);
                    visit(&mut draws, &a, &pose_a, &b, &pose_b);
                }
            }
        }
    }
}

/// Better planes than n, near it and anywhere.
fn largest_separation(draws: &mut Draws, n: &Vector3<f64>, of: impl Fn(&Vector3<f64>) -> f64) -> f64 {
    let mut best = of(n);
    let mut consider = |n: &Vector3<f64>| best = best.max(of(n));
    for _ in 0..400 {
        consider(&draws.direction());
    }
    for radius in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5] {
        for _ in 0..40 {
            consider(&(n + draws.direction() * radius).normalize());
        }
    }
    best
}

#[test]
fn the_gap_of_every_pair_is_its_signed_distance() {
    each_pair(1, 12, |draws, a, pose_a, b, pose_b| {
        let touch = nearest(a, pose_a, b, pose_b);
        let (n, gap_m) = (touch.normal, touch.gap_m);
        let what = format!("{a:?} {pose_a:?} {b:?} {pose_b:?} {touch:?}");
        let parting = separation(a, pose_a, b, pose_b, &n);
        // measured: 1.2e-15 and 8.9e-16
        assert!((parting - gap_m).abs() < 1e-13 && (n.norm() - 1.0).abs() < 1e-14, "{parting} {what}");
        let (on_a, on_b) = (touch.p_W + n * (0.5 * gap_m), touch.p_W - n * (0.5 * gap_m));
        let (level_a, level_b) = (level_at(a, pose_a, &on_a), level_at(b, pose_b, &on_b));
        // measured: 1.3e-15
        assert!(level_a.abs().max(level_b.abs()) < 1e-13, "{level_a} {level_b} {what}");
        if gap_m < 0.0 {
            let best = largest_separation(draws, &n, |n| separation(a, pose_a, b, pose_b, n));
            // measured: 6.1e-16
            assert!(best - gap_m < 1e-13, "{best} {what}");
        }
    });
}

#[test]
fn turning_moving_and_swapping_a_pair_changes_nothing_but_the_frame() {
    each_pair(2, 2, |draws, a, pose_a, b, pose_b| {
        let touch = nearest(a, pose_a, b, pose_b);
        let swapped = nearest(b, pose_b, a, pose_a);
        // measured: 5.6e-16
        assert!((touch.gap_m - swapped.gap_m).abs() < 1e-13);
        let motion = Isometry3::from_parts((draws.vector() * 100.0).into(), draws.attitude());
        let moved = |pose: &Pose| Pose {
            p_W: motion * nalgebra::Point3::from(pose.p_W) - nalgebra::Point3::origin(),
            q_W: motion.rotation * pose.q_W,
        };
        let after = nearest(a, &moved(pose_a), b, &moved(pose_b));
        // measured: 1.3e-14, the rounding of 100 m
        assert!((touch.gap_m - after.gap_m).abs() < 1e-12);
    });
}

/// A path of 400 poses from outside to inside and on: the gap changes by no more than the motion.
#[test]
fn the_gap_is_continuous_along_a_path_through_contact() {
    const STEPS: usize = 400;
    each_pair(3, 1, |draws, a, pose_a, b, pose_b| {
        let (velocity, spin) = (draws.direction() * 0.3, draws.direction() * 0.5);
        let mut before: Option<f64> = None;
        for step in 0..STEPS {
            let t = step as f64 / STEPS as f64 - 0.5;
            let pose = Pose {
                p_W: pose_a.p_W + velocity * t,
                q_W: nalgebra::UnitQuaternion::from_scaled_axis(spin * t) * pose_a.q_W,
            };
            let gap_m = nearest(a, &pose, b, pose_b).gap_m;
            let most_m = (0.3 + 0.5 * a.bounding_radius_m()) / STEPS as f64;
            if let Some(before) = before {
                // measured: 0.80
                assert!((gap_m - before).abs() <= most_m, "{a:?} {b:?} step {step}: {before} {gap_m}");
            }
            before = Some(gap_m);
        }
    });
}

/// A cap at the height of a face or of another cap that it does not stand on, by ever less, anywhere.
#[test]
fn what_is_beside_another_one_at_its_height_is_as_far_away_as_that() {
    let block = Solid::Box { half_m: Vector3::new(20.0, 0.5, 20.0) };
    let can = Solid::Cylinder { radius_m: 0.15, half_height_m: 0.1 };
    let toward = Vector3::new(0.6, 0.0, 0.8);
    let mut draws = Draws(4);
    for beside_m in [1e-7, 3e-7, 1e-6, 2.4e-6, 1e-5, 1e-4, 1e-3] {
        let away_m = 0.15 + beside_m;
        for (other, p_W) in [
            (&block, Vector3::new(20.0, 0.6, 20.0) + toward * away_m),
            (&block, Vector3::new(20.0 + away_m, 0.6, 3.7)),
            (&block, Vector3::new(20.0 + away_m, 0.6, 20.0 - 1e-9)),
            (&can, Vector3::new(0.0, 0.2, 0.0) + toward * (0.15 + away_m)),
        ] {
            for _ in 0..20 {
                let motion = Isometry3::from_parts(draws.vector().into(), draws.attitude());
                let moved =
                    |p_W: Vector3<f64>| Pose { p_W: motion * p_W + motion.translation.vector, q_W: motion.rotation };
                let found = apart(&can, &moved(p_W), other, &moved(Vector3::zeros()));
                let up = found.normal.dot(&(motion.rotation * Vector3::y()));
                // measured: 4.2e-13 m, in poses 20 m away, and 1.1e-12; was 0 m, and 1, up to 2.4 µm
                assert!((found.gap_m - beside_m).abs() < 1e-11, "{beside_m} {found:?}");
                assert!(up.abs() < 1e-11, "{beside_m} {found:?}");
            }
        }
    }
}

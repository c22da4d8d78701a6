//! Which points touch, and under which names.

use super::oracle::{Draws, about, at, level_at, solids};
use gotai::shape::pair::touches;
use gotai::shape::solid::{Meeting, Pose, Solid};
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

fn near(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose) -> Vec<Meeting> {
    let mut all = Vec::new();
    touches(a, pose_a, b, pose_b, 1e-6, &mut all);
    all
}

fn cube() -> Solid {
    Solid::Box { half_m: Vector3::repeat(0.5) }
}

/// Rounding's work: a pose off by some last bits.
fn shaken(draws: &mut Draws, pose: &Pose) -> Pose {
    let turn = about(draws.direction(), 1e-15 * draws.next());
    Pose { p_W: pose.p_W + draws.vector() * 1e-15, q_W: turn * pose.q_W }
}

/// Number of points of contact of `a` at rest on `b`, the same names in all of a hundred shakes.
fn steady_points(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose) -> usize {
    let mut draws = Draws(1);
    let names = |touches: &[Meeting]| touches.iter().map(|touch| touch.feature).collect::<Vec<_>>();
    let first = near(a, pose_a, b, pose_b);
    for _ in 0..100 {
        let again = near(a, &shaken(&mut draws, pose_a), b, &shaken(&mut draws, pose_b));
        assert_eq!(names(&first), names(&again), "{a:?} {pose_a:?} {b:?}");
        for (touch, other) in first.iter().zip(&again) {
            assert!((touch.p_W - other.p_W).norm() < 1e-6 && touch.gap_m.abs() < 1e-9, "{touch:?} {other:?}");
        }
    }
    let mut distinct = names(&first);
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(distinct.len(), first.len(), "{first:?}");
    first.len()
}

fn on_top(x: f64, z: f64, turn: f64) -> Pose {
    Pose { p_W: Vector3::new(x, 1.0, z), q_W: about(Vector3::y(), turn) }
}

#[test]
fn boxes_on_boxes_touch_in_the_corners_of_their_common_part() {
    let (cube, below) = (cube(), at(Vector3::zeros()));
    for (pose, points) in [
        (on_top(0.0, 0.0, 0.0), 4),
        (on_top(0.3, 0.0, 0.0), 4),
        (on_top(0.3, -0.2, 0.0), 4),
        (on_top(0.0, 0.0, FRAC_PI_2), 4),
        (on_top(0.0, 0.0, FRAC_PI_4), 8),
        (on_top(0.9, 0.9, 0.0), 4),
        (on_top(0.1, 0.0, 0.3), 8),
    ] {
        assert_eq!(steady_points(&cube, &pose, &cube, &below), points, "{pose:?}");
    }
    let small = Solid::Box { half_m: Vector3::repeat(0.1) };
    let pose = at(Vector3::new(0.2, 0.6, 0.0));
    assert_eq!(steady_points(&small, &pose, &cube, &below), 4);
    assert_eq!(steady_points(&cube, &below, &small, &pose), 4);
}

#[test]
fn caps_sides_and_capsules_on_a_box_touch_in_all_points_that_hold_them() {
    let (cube, below) = (cube(), at(Vector3::zeros()));
    let lying = about(Vector3::z(), FRAC_PI_2);
    let (cylinder, capsule) =
        (Solid::Cylinder { radius_m: 0.3, half_height_m: 0.2 }, Solid::Capsule { radius_m: 0.1, half_height_m: 0.3 });
    assert_eq!(steady_points(&cylinder, &at(Vector3::y() * 0.7), &cube, &below), 4);
    assert_eq!(steady_points(&cube, &below, &cylinder, &at(Vector3::y() * 0.7)), 4);
    assert_eq!(steady_points(&cylinder, &Pose { p_W: Vector3::y() * 0.8, q_W: lying }, &cube, &below), 2);
    assert_eq!(steady_points(&capsule, &Pose { p_W: Vector3::y() * 0.6, q_W: lying }, &cube, &below), 2);
    assert_eq!(steady_points(&capsule, &Pose { p_W: Vector3::new(0.4, 0.6, 0.0), q_W: lying }, &cube, &below), 2);
    // A disc half over the edge: where its rim crosses the edge, the point inside, and those of the rim between.
    let over = near(&cylinder, &at(Vector3::new(0.4, 0.7, 0.0)), &cube, &below);
    let inner = over.iter().map(|touch| touch.p_W.x).fold(f64::INFINITY, f64::min);
    let outer: Vec<f64> = over.iter().filter(|touch| (touch.p_W.x - 0.5).abs() < 1e-12).map(|t| t.p_W.z).collect();
    assert!((inner - 0.1).abs() < 1e-12, "{over:?}");
    assert!(outer.len() == 2 && outer.iter().all(|z| (z.abs() - 0.08_f64.sqrt()).abs() < 1e-12), "{over:?}");
}

#[test]
fn a_box_larger_than_a_cap_and_one_smaller_are_held_by_what_they_share() {
    let cap = Solid::Cylinder { radius_m: 0.5, half_height_m: 0.5 };
    let small = Solid::Box { half_m: Vector3::repeat(0.2) };
    assert_eq!(steady_points(&small, &at(Vector3::y() * 0.7), &cap, &at(Vector3::zeros())), 4);
    let plate = Solid::Box { half_m: Vector3::new(2.0, 0.2, 2.0) };
    assert_eq!(steady_points(&plate, &at(Vector3::y() * 0.7), &cap, &at(Vector3::zeros())), 4);
}

#[test]
fn a_cap_on_a_cap_touches_in_points_that_surround_the_common_part() {
    let coin = Solid::Cylinder { radius_m: 0.5, half_height_m: 0.1 };
    let small = Solid::Cylinder { radius_m: 0.2, half_height_m: 0.1 };
    let below = at(Vector3::zeros());
    assert_eq!(steady_points(&coin, &at(Vector3::y() * 0.2), &coin, &below), 4);
    assert_eq!(steady_points(&small, &at(Vector3::new(0.1, 0.2, 0.0)), &coin, &below), 4);
    assert_eq!(steady_points(&coin, &below, &small, &at(Vector3::new(0.1, 0.2, 0.0))), 4);
    let offset = near(&coin, &at(Vector3::new(0.31, 0.2, 0.52)), &coin, &below);
    assert!(offset.len() >= 4);
    for touch in &offset {
        // measured: 0
        assert!(level_at(&coin, &below, &touch.p_W) < 1e-15, "{touch:?}");
    }
}

#[test]
fn parallel_capsules_and_cylinders_touch_in_two_points() {
    let capsule = Solid::Capsule { radius_m: 0.2, half_height_m: 0.5 };
    let beside = at(Vector3::new(0.4, 0.0, 0.0));
    assert_eq!(steady_points(&capsule, &beside, &capsule, &at(Vector3::zeros())), 2);
    assert_eq!(steady_points(&capsule, &at(Vector3::new(0.4, 0.3, 0.0)), &capsule, &at(Vector3::zeros())), 2);
    assert_eq!(steady_points(&capsule, &at(Vector3::y() * 1.4), &capsule, &at(Vector3::zeros())), 1);
    let cylinder = Solid::Cylinder { radius_m: 0.2, half_height_m: 0.5 };
    assert_eq!(steady_points(&cylinder, &beside, &cylinder, &at(Vector3::zeros())), 2);
    assert_eq!(steady_points(&cylinder, &beside, &capsule, &at(Vector3::zeros())), 2);
}

#[test]
fn edges_that_cross_touch_in_one_point_between_them() {
    let cube = cube();
    let edge_up = about(Vector3::z(), FRAC_PI_4);
    let edge_down = about(Vector3::y(), FRAC_PI_2) * edge_up;
    let lower = Pose { p_W: Vector3::zeros(), q_W: edge_up };
    let upper = Pose { p_W: Vector3::new(0.1, 2.0_f64.sqrt(), 0.2), q_W: edge_down };
    let touches = near(&cube, &upper, &cube, &lower);
    assert_eq!(steady_points(&cube, &upper, &cube, &lower), 1);
    // Along z the lower edge, along x the upper one; measured: 5.6e-17 and 0
    assert!((touches[0].p_W - Vector3::new(0.0, 0.5_f64.sqrt(), 0.2)).norm() < 1e-14, "{touches:?}");
    assert!((touches[0].normal - Vector3::y()).norm() < 1e-14);
}

/// A small turn and shift of a body that rests on another: every point that is there after was there before, under its
/// name and near its place.
#[test]
fn names_stay_with_their_points_in_small_motions() {
    let (cube, below) = (cube(), at(Vector3::zeros()));
    let mut draws = Draws(5);
    let mut pose = on_top(0.13, -0.21, 0.4);
    let mut before = near(&cube, &pose, &cube, &below);
    for _ in 0..200 {
        pose.p_W += Vector3::new(draws.next(), 0.0, draws.next()) * 1e-4;
        pose.q_W = about(Vector3::y(), 1e-4 * draws.next()) * pose.q_W;
        let after = near(&cube, &pose, &cube, &below);
        assert_eq!(after.len(), before.len());
        for touch in &after {
            let old = before.iter().find(|old| old.feature == touch.feature).unwrap();
            assert!((old.p_W - touch.p_W).norm() < 1e-3, "{old:?} {touch:?}");
        }
        before = after;
    }
}

#[test]
fn concentric_and_crossing_solids_have_finite_contacts() {
    for a in solids() {
        for b in solids() {
            let mut all = Vec::new();
            for q_W in [UnitQuaternion::identity(), about(Vector3::z(), FRAC_PI_2), about(Vector3::x(), 0.3)] {
                touches(&a, &Pose { p_W: Vector3::zeros(), q_W }, &b, &at(Vector3::zeros()), 0.0, &mut all);
            }
            assert!(!all.is_empty(), "{a:?} {b:?}");
            for touch in all {
                assert!((touch.normal.norm() - 1.0).abs() < 1e-12 && touch.gap_m < 0.0, "{a:?} {b:?} {touch:?}");
                assert!(touch.p_W.iter().all(|x| x.is_finite()));
            }
        }
    }
}

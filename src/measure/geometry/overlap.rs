//! Whether two convex solids, or a solid and a container, overlap, and how deep: the judge's own second way, which
//! shares types with the contact test and nothing else.

use super::boxes::boxes;
use super::expand::Expansion;
use super::nearest::level;
use super::parting::{Parting, along_m, better};
use super::posed::{Core, Posed};
use super::segments::{along, between};
use crate::shape::solid::{Pose, Solid};

/// Lengths (m) that are no direction; and part of a solid's size, below which a vector between cores is no good one.
const NO_WAY: f64 = 1e-300;
const SURFACE: f64 = 1e-6;

/// The parting of two solids.
pub fn overlap(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose) -> Parting {
    let origin_W = pose_b.p_W;
    part(&Posed::new(a, pose_a, &origin_W), &Posed::new(b, pose_b, &origin_W), &mut Expansion::default())
}

/// The same, with memory.
pub fn part(a: &Posed, b: &Posed, memory: &mut Expansion) -> Parting {
    match (a.core(), b.core()) {
        (Core::Point, _) => of_point(a, b),
        (_, Core::Point) => of_point(b, a).flipped(),
        (Core::Segment(half_a), Core::Segment(half_b)) => {
            let [u, v] = [(a, half_a), (b, half_b)].map(|(of, half)| of.R.column(1) * half);
            let r = between(&(a.p - b.p), &u, &v);
            let gap_m = r.norm();
            if gap_m > SURFACE * (half_a.min(half_b) + a.radius_m().min(b.radius_m())) {
                return Parting { gap_m: gap_m - a.radius_m() - b.radius_m(), normal: r / gap_m };
            }
            // Cores that cross are parted across both.
            let across = u.cross(&v).try_normalize(0.0).unwrap_or_else(|| a.R.column(0).into());
            let known = r.try_normalize(NO_WAY).unwrap_or(across);
            better(along_m(a, b, &known), along_m(a, b, &(across * 1.0_f64.copysign(across.dot(&(a.p - b.p))))))
        }
        (Core::Segment(half), Core::Thick) => of_segment(a, half, b, memory),
        (Core::Thick, Core::Segment(half)) => of_segment(b, half, a, memory).flipped(),
        (Core::Thick, Core::Thick) => match (a.solid, b.solid) {
            (Solid::Box { half_m: half_a }, Solid::Box { half_m: half_b }) => boxes(a, half_a, b, half_b),
            _ => memory.part(a, b, sizes_m(a, b)),
        },
    }
}

fn of_point(ball: &Posed, b: &Posed) -> Parting {
    let level = level(b.solid, &b.own(&ball.p));
    Parting { gap_m: level.distance_m - ball.radius_m(), normal: b.R * level.outward }
}

/// A core that is inside has to be parted whole; on the surface, the vector to it says nothing.
fn of_segment(capsule: &Posed, half_m: f64, b: &Posed, memory: &mut Expansion) -> Parting {
    let level = along(capsule, half_m, b);
    let sizes_m = sizes_m(capsule, b);
    if level.distance_m > SURFACE * sizes_m[0] {
        let gap_m = level.distance_m - capsule.radius_m();
        return Parting { gap_m, normal: b.R * level.outward };
    }
    let whole = memory.part(capsule, b, sizes_m);
    better(along_m(capsule, b, &(b.R * level.outward)), along_m(capsule, b, &whole.normal))
}

/// Of the smaller, and of both with what is between them.
fn sizes_m(a: &Posed, b: &Posed) -> [f64; 2] {
    let [of_a, of_b] = [a, b].map(|of| of.solid.bounding_radius_m());
    [of_a.min(of_b), of_a + of_b + (a.p - b.p).norm()]
}

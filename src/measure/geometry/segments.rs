//! Capsules: how far their cores, segments, are from each other and from other solids.

use super::nearest::{Level, level};
use super::posed::Posed;
use crate::shape::solid::Solid;
use nalgebra::Vector3;

/// Tangents, of which each halves the error at least.
const MOST: usize = 100;

/// The vector from the nearest point of b to that of a, where a's runs `u` both ways from the centre, b's `v`.
pub fn between(r: &Vector3<f64>, u: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
    // Points r + s u and t v, |s| ≤ 1, |t| ≤ 1. The best of the ends, and of what is across both.
    let nearest_s = |t: f64| ((v * t - r).dot(u) / u.norm_squared()).clamp(-1.0, 1.0);
    let nearest_t = |s: f64| ((r + u * s).dot(v) / v.norm_squared()).clamp(-1.0, 1.0);
    let across = u.cross(v);
    let s = (-v.cross(&across).dot(r) / across.norm_squared()).clamp(-1.0, 1.0);
    let inner = if s.is_finite() { s } else { 0.0 };
    let t = nearest_t(inner);
    let points = [(nearest_s(t), t), (1.0, nearest_t(1.0)), (-1.0, nearest_t(-1.0)), (nearest_s(1.0), 1.0)];
    let apart = |(s, t): (f64, f64)| r + u * s - v * t;
    let last = apart((nearest_s(-1.0), -1.0));
    points.into_iter().map(apart).fold(last, |best, d| if d.norm_squared() < best.norm_squared() { d } else { best })
}

/// The least level of a solid along a segment of half a length, along y of the posed capsule: the level of a convex
/// solid is convex, so that two tangents hold its least between them.
pub fn along(capsule: &Posed, half_m: f64, of: &Posed) -> Level {
    let (middle, direction) = (of.own(&capsule.p), of.R.tr_mul(&capsule.R.column(1)));
    let at = |t: f64| seen(of.solid, &(middle + direction * t), &direction);
    let (mut low, mut high) = ((-half_m, at(-half_m)), (half_m, at(half_m)));
    if low.1.slope >= 0.0 || half_m == 0.0 {
        return low.1.level;
    }
    if high.1.slope <= 0.0 {
        return high.1.level;
    }
    let mut best = if low.1.level.distance_m < high.1.level.distance_m { low.1.level } else { high.1.level };
    for k in 0..MOST {
        let ((t0, a), (t1, b)) = (low, high);
        // Where the tangents meet; every third time half-way.
        let meet = (b.level.distance_m - a.level.distance_m + a.slope * t0 - b.slope * t1) / (a.slope - b.slope);
        let bound_m = a.level.distance_m + a.slope * (meet - t0);
        let t = if k % 3 == 2 || !(meet > t0 && meet < t1) { 0.5 * (t0 + t1) } else { meet };
        if t <= t0 || t >= t1 || best.distance_m - bound_m <= 4.0 * f64::EPSILON * half_m {
            break;
        }
        let here = at(t);
        if here.level.distance_m < best.distance_m {
            best = here.level;
        }
        if here.slope == 0.0 {
            break;
        }
        if here.slope < 0.0 { low = (t, here) } else { high = (t, here) }
    }
    best
}

#[derive(Clone, Copy)]
struct Here {
    level: Level,
    /// Along the segment.
    slope: f64,
}

fn seen(solid: &Solid, p: &Vector3<f64>, direction: &Vector3<f64>) -> Here {
    let level = level(solid, p);
    Here { level, slope: level.outward.dot(direction) }
}

//! A ball swept along a segment of the y axis, which is its core; `half_height_m`: half the distance of the centres of
//! its two spheres.

use super::closest::{Closest, about};
use super::moments::{Moments, about_centre};
use super::triangles::{ARC, Triangles, revolved};
use super::{cylinder, sphere};
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Calls `visit` for the lowest point of each sphere, along `-normal`.
#[inline]
pub(super) fn each_lowest(
    radius_m: f64,
    half_height_m: f64,
    normal: &Vector3<f64>,
    mut visit: impl FnMut(u32, Vector3<f64>),
) {
    visit(0, Vector3::y() * -half_height_m - normal * radius_m);
    visit(1, Vector3::y() * half_height_m - normal * radius_m);
}

/// Point of the core farthest along `d`.
#[inline]
pub(super) fn support(half_height_m: f64, d: &Vector3<f64>) -> Vector3<f64> {
    Vector3::y() * half_height_m.copysign(d.y)
}

/// An end of the core.
#[inline]
pub(super) fn end(half_height_m: f64, number: u32) -> Vector3<f64> {
    Vector3::y() * if number == 0 { -half_height_m } else { half_height_m }
}

/// Moments in closed form: a cylinder, its axis y, between two half balls; `height_m` between their centres.
pub fn moments(radius_m: f64, height_m: f64) -> Moments {
    let (middle, ball) = (cylinder::moments(radius_m, height_m), sphere::moments(radius_m));
    let half_m = height_m / 2.0;
    let fourth = radius_m * radius_m * radius_m * radius_m;
    // Of each half ball ∫(y + half)² dV with ∫y dV = π r⁴/4.
    let moved = PI * fourth * half_m + ball.volume_m3 * half_m * half_m;
    let second = middle.second.diagonal() + ball.second.diagonal() + Vector3::y() * moved;
    about_centre(middle.volume_m3 + ball.volume_m3, second)
}

pub fn surface_m2(radius_m: f64, half_height_m: f64) -> f64 {
    2.0 * PI * radius_m * (2.0 * radius_m + 2.0 * half_height_m)
}

pub fn closest(radius_m: f64, half_height_m: f64, p: &Vector3<f64>) -> Closest {
    about(&Vector3::new(p.x, p.y - p.y.clamp(-half_height_m, half_height_m), p.z), radius_m)
}

pub fn triangles(radius_m: f64, half_height_m: f64) -> Triangles {
    let arc = |k: u32| libm::sincos(FRAC_PI_2 * f64::from(k) / f64::from(ARC));
    let lower = (0..=ARC).map(arc).map(|(sin, cos)| (-half_height_m - radius_m * cos, radius_m * sin));
    let upper = (0..=ARC).map(arc).map(|(sin, cos)| (half_height_m + radius_m * sin, radius_m * cos));
    revolved(&lower.chain(upper).collect::<Vec<_>>())
}

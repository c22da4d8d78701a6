//! A cylinder about the y axis.

use super::closest::{Closest, about};
use super::moments::{Moments, about_centre};
use super::triangles::{Triangles, revolved};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// A cap tilted by less (rad) lies flat. Below it, the lowest point of a rim is known to less than six digits, and the
/// points of the rim are fixed in the body; what is lost is less than a third of this angle times the radius.
pub const FLAT: f64 = 1e-10;

/// Of a pair's features: the inside of a face; a corner, by its number.
pub const FACE: u32 = 0;
pub const VERTEX: u32 = 1 << 28;

/// The same: an edge, by the numbers of its corners, of 12 bits each: the smaller one from the 14th on, the other one.
pub const EDGE: u32 = 2 << 28;

/// In the name of an edge that lies along the other solid's: so it does at the first end of what they have in common,
/// and at the second one.
const FIRST_END: u32 = 1 << 26;
const SECOND_END: u32 = 1 << 27;

/// The same: a point of a rim, by its number.
pub const RIM: u32 = 3 << 28;

/// The same: where a rim crosses another outline (0 and 1), or the middle of the arc between.
pub const ARC: u32 = 4 << 28;

/// Which of these a feature is, without its number.
pub fn kind(feature: u32) -> u32 {
    feature >> 28 << 28
}

/// Of names of what crosses: the side whose rim has an arc there, if it is the middle of one.
pub fn middle_of_arc((of, other): (u32, u32)) -> Option<u32> {
    match (of, other) {
        _ if of == ARC | 2 => Some(0),
        _ if other == ARC | 2 || other == ARC | 3 => Some(1),
        _ => None,
    }
}

/// The names of two edges that lie side by side, at the first or second end of what they have in common.
pub fn side_by_side(edges: (u32, u32), is_second: bool) -> (u32, u32) {
    (edges.0, edges.1 | if is_second { SECOND_END } else { FIRST_END })
}

/// Whether they are such names.
pub fn are_side_by_side((edge, other): (u32, u32)) -> bool {
    kind(edge) == EDGE && kind(other) == EDGE && other & (FIRST_END | SECOND_END) != 0
}

pub fn bounding_radius_m(radius_m: f64, half_height_m: f64) -> f64 {
    (radius_m * radius_m + half_height_m * half_height_m).sqrt()
}

/// Calls `visit` for the lowest point of each rim and those a quarter turn on, along `-normal`.
#[inline]
pub(super) fn each_lowest(
    radius_m: f64,
    half_height_m: f64,
    normal: &Vector3<f64>,
    mut visit: impl FnMut(u32, Vector3<f64>),
) {
    for (cap, y) in [-half_height_m, half_height_m].into_iter().enumerate() {
        for (k, u) in rim_directions(&-normal).into_iter().enumerate() {
            visit((4 * cap + k) as u32, u * radius_m + Vector3::y() * y);
        }
    }
}

/// The point farthest along `d`.
#[inline]
pub(super) fn support(radius_m: f64, half_height_m: f64, d: &Vector3<f64>) -> Vector3<f64> {
    radial(d) * radius_m + Vector3::y() * half_height_m.copysign(d.y)
}

/// Second derivative of the support function at a unit d.
#[inline]
pub(super) fn curvature(radius_m: f64, d: &Vector3<f64>) -> Matrix3<f64> {
    let radial = Vector3::new(d.x, 0.0, d.z);
    let along = Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 1.0));
    (along - radial * radial.transpose() / radial.norm_squared()) * (radius_m / radial.norm())
}

/// Radial unit vectors: the one nearest to `along`, then by quarter turns about y.
#[inline]
pub fn rim_directions(along: &Vector3<f64>) -> [Vector3<f64>; 4] {
    let radial = Vector3::new(along.x, 0.0, along.z);
    let length = radial.norm();
    let first = if length > FLAT { radial / length } else { Vector3::x() };
    let second = Vector3::y().cross(&first);
    [first, second, -first, -second]
}

/// However little of `d` is radial, as separations are measured with it; x if nothing is.
#[inline]
fn radial(d: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(d.x, 0.0, d.z).try_normalize(0.0).unwrap_or_else(Vector3::x)
}

/// Moments in closed form: a cylinder about its centre, its axis y.
pub fn moments(radius_m: f64, height_m: f64) -> Moments {
    let square = radius_m * radius_m;
    let volume_m3 = PI * square * height_m;
    let across = square / 4.0;
    about_centre(volume_m3, Vector3::new(across, height_m * height_m / 12.0, across) * volume_m3)
}

pub fn surface_m2(radius_m: f64, half_height_m: f64) -> f64 {
    2.0 * PI * radius_m * (radius_m + 2.0 * half_height_m)
}

pub fn closest(radius_m: f64, half_height_m: f64, p: &Vector3<f64>) -> Closest {
    let radial = Vector3::new(p.x, 0.0, p.z);
    let side = about(&radial, radius_m);
    let axial = Vector3::y() * if p.y < 0.0 { -1.0 } else { 1.0 };
    let cap_m = p.y.abs() - half_height_m;
    if side.distance_m > 0.0 && cap_m > 0.0 {
        return about(&(side.normal * side.distance_m + axial * cap_m), 0.0);
    }
    if side.distance_m >= cap_m { side } else { Closest { normal: axial, distance_m: cap_m } }
}

pub fn triangles(radius_m: f64, half_height_m: f64) -> Triangles {
    revolved(&[(-half_height_m, 0.0), (-half_height_m, radius_m), (half_height_m, radius_m), (half_height_m, 0.0)])
}

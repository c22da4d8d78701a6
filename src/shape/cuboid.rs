//! A box, by half its edges.

use super::closest::{Closest, about};
use super::mesh::box_mesh;
use super::moments::{Moments, about_centre};
use super::triangles::{Triangles, of_mesh};
use nalgebra::Vector3;

/// Corners of the faces −x, x, −y, y, −z, z, counter-clockwise seen from outside.
pub(super) const FACES: [[u32; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// A corner: bits 0, 1, 2 of its number say on which side in x, y, z.
#[inline]
pub(super) fn corner(half_m: &Vector3<f64>, number: u32) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| if number >> axis & 1 == 1 { half_m[axis] } else { -half_m[axis] })
}

/// The corner farthest along `d`.
#[inline]
pub(super) fn support(half_m: &Vector3<f64>, d: &Vector3<f64>) -> Vector3<f64> {
    half_m.zip_map(d, f64::copysign)
}

/// Moments in closed form: a box of the given edge lengths about its centre.
pub fn moments(size_m: [f64; 3]) -> Moments {
    let size = Vector3::from(size_m);
    let volume_m3 = size.product();
    about_centre(volume_m3, size.component_mul(&size) * (volume_m3 / 12.0))
}

pub fn surface_m2(half_m: &Vector3<f64>) -> f64 {
    let [x, y, z]: [f64; 3] = (half_m * 2.0).into();
    2.0 * (x * y + y * z + z * x)
}

pub fn closest(half_m: &Vector3<f64>, p: &Vector3<f64>) -> Closest {
    let beyond = p.zip_map(half_m, |x, half| x - x.clamp(-half, half));
    if beyond != Vector3::zeros() {
        return about(&beyond, 0.0);
    }
    let depth = half_m - p.abs();
    let axis = depth.imin();
    Closest { normal: Vector3::ith(axis, if p[axis] < 0.0 { -1.0 } else { 1.0 }), distance_m: -depth[axis] }
}

pub fn triangles(half_m: &Vector3<f64>) -> Triangles {
    of_mesh(box_mesh((half_m * 2.0).into(), [2; 3]))
}

//! Point of a surface nearest to a point, from outside and from inside: contact of spheres.

use nalgebra::Vector3;

/// Nearest point of a surface, by the normal there and the distance to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Unit normal, outward.
    pub normal: Vector3<f64>,
    /// Distance in metres, negative inside.
    pub distance_m: f64,
}

/// Nearest point of a surface that is `radius_m` from a core, seen from `r`, which is relative to the nearest point of
/// the core. On the core itself x is outward, which no axis of a capsule is.
pub(super) fn about(r: &Vector3<f64>, radius_m: f64) -> Closest {
    let length = r.norm();
    let normal = if length > 0.0 { r / length } else { Vector3::x() };
    Closest { normal, distance_m: length - radius_m }
}

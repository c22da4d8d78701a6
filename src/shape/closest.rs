//! The point of a surface nearest to a point, from outside and from inside: contact of spheres.

use nalgebra::Vector3;

/// Nearest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Outward, unit.
    pub normal: Vector3<f64>,
    /// Negative inside.
    pub distance_m: f64,
}

/// From a point of the core to `r`, with the surface at a distance from the core. On the core itself x is outward,
/// which no axis of a capsule is.
pub(super) fn about(r: &Vector3<f64>, radius_m: f64) -> Closest {
    let length = r.norm();
    let normal = if length > 0.0 { r / length } else { Vector3::x() };
    Closest { normal, distance_m: length - radius_m }
}

//! Surface of a shape: four times the mean of its shadow over all directions, if it is convex (A. Cauchy, 1841).

use super::hull::Hull;
use crate::experiment::types::Shape;
use crate::math::elliptic::{carlson_rf, carlson_rj};
use std::f64::consts::PI;

pub fn surface_m2(shape: &Shape, hull: Option<&Hull>) -> f64 {
    match shape {
        Shape::Sphere(s) => 4.0 * PI * s.radius_m * s.radius_m,
        Shape::Box(b) => {
            let [x, y, z] = b.size_m;
            2.0 * (x * y + y * z + z * x)
        }
        Shape::Cylinder(c) => 2.0 * PI * c.radius_m * (c.radius_m + c.height_m),
        Shape::Capsule(c) => 2.0 * PI * c.radius_m * (2.0 * c.radius_m + c.height_m),
        Shape::Ellipsoid(e) => ellipsoid_m2(e.semi_axes_m),
        Shape::Convex(_) => hull.map_or(0.0, Hull::area_m2),
        Shape::None => 0.0,
    }
}

/// 4π R_G(a²b², a²c², b²c²), R_G by R_F and R_D (DLMF 19.33.1 and 19.21.10).
fn ellipsoid_m2(mut semi_axes_m: [f64; 3]) -> f64 {
    semi_axes_m.sort_by(f64::total_cmp);
    let [a, b, c] = semi_axes_m.map(|axis| axis * axis);
    let (x, y, z) = (a * b, a * c, b * c);
    let rd = carlson_rj(x, y, z, z, 0.0);
    2.0 * PI * (z * carlson_rf(x, y, z) - (z - x) * (z - y) * rd / 3.0 + (x / z * y).sqrt())
}

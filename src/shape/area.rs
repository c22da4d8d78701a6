//! Surface of a shape: four times the mean of its shadow over all directions, if it is convex (A. Cauchy, 1841).

use super::solid::Solid;
use crate::math::elliptic::{carlson_rf, carlson_rj};
use std::f64::consts::PI;

pub fn surface_m2(solid: &Solid) -> f64 {
    match solid {
        Solid::Sphere { radius_m } => 4.0 * PI * radius_m * radius_m,
        Solid::Box { half_m } => {
            let [x, y, z]: [f64; 3] = (half_m * 2.0).into();
            2.0 * (x * y + y * z + z * x)
        }
        Solid::Cylinder { radius_m, half_height_m } => 2.0 * PI * radius_m * (radius_m + 2.0 * half_height_m),
        Solid::Capsule { radius_m, half_height_m } => 2.0 * PI * radius_m * (2.0 * radius_m + 2.0 * half_height_m),
        Solid::Ellipsoid { semi_axes_m } => ellipsoid_m2((*semi_axes_m).into()),
        Solid::Convex(hull) => hull.area_m2(),
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

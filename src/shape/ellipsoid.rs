//! An ellipsoid, by its semi-axes.

use super::closest::Closest;
use super::mesh::sphere_mesh;
use super::moments::{Moments, about_centre};
use super::triangles::Triangles;
use crate::math::elliptic::{carlson_rf, carlson_rj};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::PI;

/// The point farthest along `d`.
#[inline]
pub(super) fn support(semi_axes_m: &Vector3<f64>, d: &Vector3<f64>) -> Vector3<f64> {
    let scaled = semi_axes_m.component_mul(d);
    semi_axes_m.component_mul(&scaled) / scaled.norm()
}

/// Second derivative of the support function at a unit d.
#[inline]
pub(super) fn curvature(semi_axes_m: &Vector3<f64>, d: &Vector3<f64>) -> Matrix3<f64> {
    let squares = semi_axes_m.component_mul(semi_axes_m);
    let (h, point) = (semi_axes_m.component_mul(d).norm(), squares.component_mul(d));
    Matrix3::from_diagonal(&(squares / h)) - point * point.transpose() / (h * h * h)
}

/// Moments in closed form: an ellipsoid about its centre.
pub fn moments(semi_axes_m: [f64; 3]) -> Moments {
    let axes = Vector3::from(semi_axes_m);
    let volume_m3 = 4.0 / 3.0 * PI * axes.product();
    about_centre(volume_m3, axes.component_mul(&axes) * (volume_m3 / 5.0))
}

/// Surface 4π R_G(a²b², a²c², b²c²), R_G by R_F and R_D (DLMF 19.33.1 and 19.21.10).
pub fn surface_m2(mut semi_axes_m: [f64; 3]) -> f64 {
    semi_axes_m.sort_by(f64::total_cmp);
    let [a, b, c] = semi_axes_m.map(|axis| axis * axis);
    let (x, y, z) = (a * b, a * c, b * c);
    let rd = carlson_rj(x, y, z, z, 0.0);
    2.0 * PI * (z * carlson_rf(x, y, z) - (z - x) * (z - y) * rd / 3.0 + (x / z * y).sqrt())
}

/// Point of the surface nearest to p, by the root of Σ (aᵢpᵢ/(τ + aᵢ² − a²))² = 1, a the least semi-axis: then
/// xᵢ = aᵢ²pᵢ/(τ + aᵢ² − a²) is nearest (D. Eberly, Distance from a Point to an Ellipse, an Ellipsoid, or a
/// Hyperellipsoid, 2013, 3). The sum is convex and falls with τ, so that Newton's iteration from below the root cannot
/// overshoot.
pub fn closest(semi_axes_m: &Vector3<f64>, p: &Vector3<f64>) -> Closest {
    let least = semi_axes_m.min();
    let y = p.abs();
    let more = semi_axes_m.map(|a| (a - least) * (a + least));
    let ay = semi_axes_m.component_mul(&y);
    let mut tau = (ay - more).max().max(0.0);
    // Most steps, from far below the root: each moves τ up by half of itself at least.
    for _ in 0..100 {
        let (mut sum, mut slope) = (0.0, 0.0);
        for i in 0..3 {
            let below = tau + more[i];
            if ay[i] > 0.0 && below > 0.0 {
                let term = ay[i] / below;
                sum += term * term;
                slope += 2.0 * term * term / below;
            }
        }
        let next = tau + (sum - 1.0) / slope;
        if sum <= 1.0 || next <= tau {
            break;
        }
        tau = next;
    }
    let mut x = Vector3::from_fn(|i, _| {
        let below = tau + more[i];
        if below > 0.0 { semi_axes_m[i] * semi_axes_m[i] * y[i] / below } else { 0.0 }
    });
    if tau == 0.0 {
        // Inside, on the plane of the longer axes: the nearest points lie above and below it.
        let part: f64 = (0..3).map(|i| x[i] / semi_axes_m[i]).map(|part| part * part).sum();
        x[semi_axes_m.imin()] += least * (1.0 - part).max(0.0).sqrt();
    }
    let sign = p.map(|x| if x < 0.0 { -1.0 } else { 1.0 });
    let normal = x.component_div(semi_axes_m).component_div(semi_axes_m).normalize().component_mul(&sign);
    Closest { normal, distance_m: normal.dot(&(p - x.component_mul(&sign))) }
}

/// Triangles of a ball's mesh, stretched.
pub fn triangles(semi_axes_m: &Vector3<f64>) -> Triangles {
    let unit = sphere_mesh(1.0, 2);
    (unit.nodes.iter().map(|u| u.component_mul(semi_axes_m)).collect(), unit.surface())
}

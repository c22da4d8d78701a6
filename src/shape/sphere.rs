//! A ball. Its core is its centre.

use super::closest::{Closest, about};
use super::ellipsoid;
use super::moments::{Moments, about_centre};
use super::triangles::Triangles;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Moments in closed form: a ball about its centre.
pub fn moments(radius_m: f64) -> Moments {
    let volume_m3 = 4.0 / 3.0 * PI * radius_m * radius_m * radius_m;
    about_centre(volume_m3, Vector3::repeat(volume_m3 * radius_m * radius_m / 5.0))
}

pub fn surface_m2(radius_m: f64) -> f64 {
    4.0 * PI * radius_m * radius_m
}

pub fn closest(radius_m: f64, p: &Vector3<f64>) -> Closest {
    about(p, radius_m)
}

pub fn triangles(radius_m: f64) -> Triangles {
    ellipsoid::triangles(&Vector3::repeat(radius_m))
}

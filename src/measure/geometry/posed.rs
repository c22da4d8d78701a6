//! A solid where it stands, as its support function sees it: a core, and a ball of some radius that is rolled around
//! it. Written for the judge alone: no step sees a solid through it.

use crate::shape::solid::{Pose, Solid};
use nalgebra::{Matrix3, Vector3};

/// A solid about an origin near it, so that far from the world's own nothing is lost.
#[derive(Clone, Copy)]
pub struct Posed<'a> {
    pub solid: &'a Solid,
    /// Its centre.
    pub p: Vector3<f64>,
    /// Its axes, as columns.
    pub R: Matrix3<f64>,
}

/// What is left of a solid without its ball.
pub enum Core {
    Point,
    /// Half its length, along the solid's y.
    Segment(f64),
    Thick,
}

impl<'a> Posed<'a> {
    pub fn new(solid: &'a Solid, pose: &Pose, origin_W: &Vector3<f64>) -> Self {
        Posed { solid, p: pose.p_W - origin_W, R: pose.q_W.to_rotation_matrix().into_inner() }
    }

    pub fn core(&self) -> Core {
        match self.solid {
            Solid::Sphere { .. } => Core::Point,
            Solid::Capsule { half_height_m, .. } => Core::Segment(*half_height_m),
            Solid::Box { .. } | Solid::Cylinder { .. } | Solid::Ellipsoid { .. } | Solid::Convex(_) => Core::Thick,
        }
    }

    /// Radius of the ball around the core.
    pub fn radius_m(&self) -> f64 {
        match self.solid {
            Solid::Sphere { radius_m } | Solid::Capsule { radius_m, .. } => *radius_m,
            Solid::Box { .. } | Solid::Cylinder { .. } | Solid::Ellipsoid { .. } | Solid::Convex(_) => 0.0,
        }
    }

    /// The core's point farthest along `d`.
    pub fn farthest(&self, d: &Vector3<f64>) -> Vector3<f64> {
        self.p + self.R * farthest(self.solid, &self.R.tr_mul(d))
    }

    /// A point of the world, in the solid's own axes from its centre.
    pub fn own(&self, p: &Vector3<f64>) -> Vector3<f64> {
        self.R.tr_mul(&(p - self.p))
    }
}

/// Of a and b, by how much a plane across a unit vector from b to a parts them.
pub fn gap_along_m(a: &Posed, b: &Posed, normal: &Vector3<f64>) -> f64 {
    let reach = |of: &Posed, d: &Vector3<f64>| reach_m(of.solid, &of.R.tr_mul(d));
    normal.dot(&(a.p - b.p)) - reach(a, &-normal) - reach(b, normal)
}

fn farthest(solid: &Solid, d: &Vector3<f64>) -> Vector3<f64> {
    match solid {
        Solid::Sphere { .. } => Vector3::zeros(),
        Solid::Box { half_m } => half_m.zip_map(d, f64::copysign),
        Solid::Capsule { half_height_m, .. } => Vector3::new(0.0, half_height_m.copysign(d.y), 0.0),
        Solid::Cylinder { radius_m, half_height_m } => {
            let across = (d.x * d.x + d.z * d.z).sqrt();
            let part = if across > 0.0 { radius_m / across } else { 0.0 };
            Vector3::new(d.x * part, half_height_m.copysign(d.y), d.z * part)
        }
        Solid::Ellipsoid { semi_axes_m } => {
            let scaled = semi_axes_m.component_mul(d);
            semi_axes_m.component_mul(&(scaled / scaled.norm()))
        }
        Solid::Convex(hull) => farthest_of(&hull.vertices, d),
    }
}

/// Of points, the one farthest along `d`, the first of equals.
fn farthest_of(points: &[Vector3<f64>], d: &Vector3<f64>) -> Vector3<f64> {
    let mut best = (f64::NEG_INFINITY, 0);
    for (i, point) in points.iter().enumerate() {
        let along = d.dot(point);
        if along > best.0 {
            best = (along, i);
        }
    }
    points[best.1]
}

/// How far a solid reaches from its centre along a unit vector in its own axes.
pub fn reach_m(solid: &Solid, d: &Vector3<f64>) -> f64 {
    match solid {
        Solid::Sphere { radius_m } => *radius_m,
        Solid::Box { half_m } => half_m.dot(&d.abs()),
        Solid::Capsule { radius_m, half_height_m } => radius_m + half_height_m * d.y.abs(),
        Solid::Cylinder { radius_m, half_height_m } => {
            radius_m * (d.x * d.x + d.z * d.z).sqrt() + half_height_m * d.y.abs()
        }
        Solid::Ellipsoid { semi_axes_m } => semi_axes_m.component_mul(d).norm(),
        Solid::Convex(hull) => reach_of_m(&hull.vertices, d),
    }
}

/// How far points reach from the origin along a vector.
pub fn reach_of_m(points: &[Vector3<f64>], d: &Vector3<f64>) -> f64 {
    points.iter().map(|point| d.dot(point)).fold(f64::NEG_INFINITY, f64::max)
}

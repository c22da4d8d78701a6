//! Convex solids in their own axes about their own centre, and what of them touches a half-space.

use super::hull::Hull;
use nalgebra::{UnitQuaternion, Vector3};

/// A cylinder's and a capsule's axis is y.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    Sphere {
        radius_m: f64,
    },
    Box {
        half_m: Vector3<f64>,
    },
    Cylinder {
        radius_m: f64,
        half_height_m: f64,
    },
    /// `half_height_m`: half the distance of the centres of its two spheres.
    Capsule {
        radius_m: f64,
        half_height_m: f64,
    },
    Ellipsoid {
        semi_axes_m: Vector3<f64>,
    },
    Convex(Hull),
}

/// Where a solid is: its centre in the world, and its axes → world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    pub p_W: Vector3<f64>,
    pub q_W: UnitQuaternion<f64>,
}

/// One point of contact of two solids, a and b, or of a solid a with a half-space b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// The middle of the gap.
    pub p_W: Vector3<f64>,
    /// Unit, from b to a.
    pub normal: Vector3<f64>,
    /// Along the normal, negative inside.
    pub gap_m: f64,
    /// What of a and what of b meet here: the same from step to step, to find last step's impulse by.
    pub feature: (u32, u32),
}

/// A cap tilted by less (rad) lies flat. Below it, the lowest point of a rim is an accident of rounding, and the points
/// of the rim are fixed in the body; what is lost is less than a third of this angle times the radius.
const FLAT: f64 = 1e-8;

impl Solid {
    /// About its centre.
    pub fn bounding_radius_m(&self) -> f64 {
        match self {
            Solid::Sphere { radius_m } => *radius_m,
            Solid::Box { half_m } => half_m.norm(),
            Solid::Cylinder { radius_m, half_height_m } => (radius_m * radius_m + half_height_m * half_height_m).sqrt(),
            Solid::Capsule { radius_m, half_height_m } => radius_m + half_height_m,
            Solid::Ellipsoid { semi_axes_m } => semi_axes_m.max(),
            Solid::Convex(hull) => hull.vertices.iter().map(|v| v.norm()).fold(0.0, f64::max),
        }
    }

    /// Most points that `each_lowest` visits.
    pub fn lowest_points(&self) -> usize {
        match self {
            Solid::Sphere { .. } | Solid::Ellipsoid { .. } => 1,
            Solid::Capsule { .. } => 2,
            Solid::Box { .. } | Solid::Cylinder { .. } => 8,
            Solid::Convex(hull) => hull.vertices.len(),
        }
    }

    /// Calls `visit(feature, point)` for all points that can bear on a half-space with this normal (unit, toward the
    /// free side, own axes): a box's and a hull's vertices, the lowest of each sphere of a capsule, an ellipsoid's
    /// lowest, and of each rim of a cylinder the lowest point and those a quarter turn on.
    pub fn each_lowest(&self, normal: &Vector3<f64>, mut visit: impl FnMut(u32, Vector3<f64>)) {
        match self {
            Solid::Sphere { radius_m } => visit(0, -normal * *radius_m),
            Solid::Box { half_m } => (0..8).for_each(|i| visit(i, corner(half_m, i))),
            Solid::Cylinder { radius_m, half_height_m } => {
                for (cap, y) in [-half_height_m, *half_height_m].into_iter().enumerate() {
                    for (k, u) in rim_directions(&-normal).into_iter().enumerate() {
                        visit((4 * cap + k) as u32, u * *radius_m + Vector3::y() * y);
                    }
                }
            }
            Solid::Capsule { radius_m, half_height_m } => {
                visit(0, Vector3::y() * -half_height_m - normal * *radius_m);
                visit(1, Vector3::y() * *half_height_m - normal * *radius_m);
            }
            Solid::Ellipsoid { semi_axes_m } => visit(0, ellipsoid_support(semi_axes_m, &-normal)),
            Solid::Convex(hull) => hull.vertices.iter().enumerate().for_each(|(i, v)| visit(i as u32, *v)),
        }
    }
}

/// All points of the solid whose gap to the half-space normal·x ≥ offset is below the margin.
pub fn plane_touches(
    a: &Solid,
    pose: &Pose,
    normal: &Vector3<f64>,
    offset_m: f64,
    margin_m: f64,
    out: &mut Vec<Meeting>,
) {
    let centre_gap_m = normal.dot(&pose.p_W) - offset_m;
    if centre_gap_m - a.bounding_radius_m() >= margin_m {
        return;
    }
    let normal_own = pose.q_W.inverse_transform_vector(normal);
    a.each_lowest(&normal_own, |feature, point| {
        let gap_m = centre_gap_m + normal_own.dot(&point);
        if gap_m < margin_m {
            let p_W = pose.p_W + pose.q_W * point - normal * (0.5 * gap_m);
            out.push(Meeting { p_W, normal: *normal, gap_m, feature: (feature, 0) });
        }
    });
}

/// Corner of a box: bits 0, 1, 2 of its number say on which side in x, y, z.
pub(super) fn corner(half_m: &Vector3<f64>, number: u32) -> Vector3<f64> {
    Vector3::from_fn(|axis, _| if number >> axis & 1 == 1 { half_m[axis] } else { -half_m[axis] })
}

/// Radial unit vectors of a cylinder: the one nearest to `along`, then by quarter turns about y.
pub(super) fn rim_directions(along: &Vector3<f64>) -> [Vector3<f64>; 4] {
    let radial = Vector3::new(along.x, 0.0, along.z);
    let length = radial.norm();
    let first = if length > FLAT { radial / length } else { Vector3::x() };
    let second = Vector3::y().cross(&first);
    [first, second, -first, -second]
}

/// Point of an ellipsoid farthest along `d`.
pub(super) fn ellipsoid_support(semi_axes_m: &Vector3<f64>, d: &Vector3<f64>) -> Vector3<f64> {
    let scaled = semi_axes_m.component_mul(d);
    semi_axes_m.component_mul(&scaled) / scaled.norm()
}

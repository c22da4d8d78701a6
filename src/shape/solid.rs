//! Convex solids in their own axes about their own centre, and their points that touch a half-space. The facts of each
//! stand in its own file; here is which one is asked.

use super::closest::Closest;
use super::hull::Hull;
use super::moments::Moments;
use super::triangles::Triangles;
use super::{capsule, convex, cuboid, cylinder, ellipsoid, sphere};
use nalgebra::{UnitQuaternion, Vector3};

/// A convex solid. A cylinder's and a capsule's axis is y.
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
    /// A capsule; `half_height_m` is half the distance of the centres of its two spheres.
    Capsule {
        radius_m: f64,
        half_height_m: f64,
    },
    Ellipsoid {
        semi_axes_m: Vector3<f64>,
    },
    Convex(Hull),
}

/// Pose of a solid: its centre in the world, and its axes → world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    pub p_W: Vector3<f64>,
    pub q_W: UnitQuaternion<f64>,
}

/// One point of contact of two solids, a and b, or of a solid a with a half-space b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Middle of the gap.
    pub p_W: Vector3<f64>,
    /// Unit normal from b to a.
    pub normal: Vector3<f64>,
    /// Gap along the normal, negative inside.
    pub gap_m: f64,
    /// Features of a and of b that meet here: the same from step to step, to find last step's impulse by.
    pub feature: (u32, u32),
}

impl Solid {
    /// Radius of the sphere about its centre that holds it.
    pub fn bounding_radius_m(&self) -> f64 {
        match self {
            Solid::Sphere { radius_m } => *radius_m,
            Solid::Box { half_m } => half_m.norm(),
            Solid::Cylinder { radius_m, half_height_m } => cylinder::bounding_radius_m(*radius_m, *half_height_m),
            Solid::Capsule { radius_m, half_height_m } => radius_m + half_height_m,
            Solid::Ellipsoid { semi_axes_m } => semi_axes_m.max(),
            Solid::Convex(hull) => convex::bounding_radius_m(hull),
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
            Solid::Box { half_m } => (0..8).for_each(|i| visit(i, cuboid::corner(half_m, i))),
            Solid::Cylinder { radius_m, half_height_m } => {
                cylinder::each_lowest(*radius_m, *half_height_m, normal, visit);
            }
            Solid::Capsule { radius_m, half_height_m } => {
                capsule::each_lowest(*radius_m, *half_height_m, normal, visit);
            }
            Solid::Ellipsoid { semi_axes_m } => visit(0, ellipsoid::support(semi_axes_m, &-normal)),
            Solid::Convex(hull) => hull.vertices.iter().enumerate().for_each(|(i, v)| visit(i as u32, *v)),
        }
    }

    /// Whether its surface has one normal everywhere.
    pub fn is_smooth(&self) -> bool {
        matches!(self, Solid::Sphere { .. } | Solid::Capsule { .. } | Solid::Ellipsoid { .. })
    }

    /// Width across its thinnest, in metres; of a hull between two parallel planes of which one holds a face.
    pub fn least_width_m(&self) -> f64 {
        match self {
            Solid::Sphere { radius_m } | Solid::Capsule { radius_m, .. } => 2.0 * radius_m,
            Solid::Box { half_m } => 2.0 * half_m.min(),
            Solid::Cylinder { radius_m, half_height_m } => 2.0 * radius_m.min(*half_height_m),
            Solid::Ellipsoid { semi_axes_m } => 2.0 * semi_axes_m.min(),
            Solid::Convex(hull) => convex::least_width_m(hull),
        }
    }

    /// Moments about its centre: closed forms, and the tets of a hull.
    pub fn moments(&self) -> Moments {
        match self {
            Solid::Sphere { radius_m } => sphere::moments(*radius_m),
            Solid::Box { half_m } => cuboid::moments((half_m * 2.0).into()),
            Solid::Cylinder { radius_m, half_height_m } => cylinder::moments(*radius_m, 2.0 * half_height_m),
            Solid::Capsule { radius_m, half_height_m } => capsule::moments(*radius_m, 2.0 * half_height_m),
            Solid::Ellipsoid { semi_axes_m } => ellipsoid::moments((*semi_axes_m).into()),
            Solid::Convex(hull) => convex::moments(hull),
        }
    }

    /// Area of the surface, four times the mean of its shadow over all directions (A. Cauchy, 1841).
    pub fn surface_m2(&self) -> f64 {
        match self {
            Solid::Sphere { radius_m } => sphere::surface_m2(*radius_m),
            Solid::Box { half_m } => cuboid::surface_m2(half_m),
            Solid::Cylinder { radius_m, half_height_m } => cylinder::surface_m2(*radius_m, *half_height_m),
            Solid::Capsule { radius_m, half_height_m } => capsule::surface_m2(*radius_m, *half_height_m),
            Solid::Ellipsoid { semi_axes_m } => ellipsoid::surface_m2((*semi_axes_m).into()),
            Solid::Convex(hull) => hull.area_m2(),
        }
    }

    /// Point of its surface nearest to a point in its own axes; where several points are nearest, one of them, always
    /// the same.
    pub fn closest(&self, p: &Vector3<f64>) -> Closest {
        match self {
            Solid::Sphere { radius_m } => sphere::closest(*radius_m, p),
            Solid::Box { half_m } => cuboid::closest(half_m, p),
            Solid::Cylinder { radius_m, half_height_m } => cylinder::closest(*radius_m, *half_height_m, p),
            Solid::Capsule { radius_m, half_height_m } => capsule::closest(*radius_m, *half_height_m, p),
            Solid::Ellipsoid { semi_axes_m } => ellipsoid::closest(semi_axes_m, p),
            Solid::Convex(hull) => convex::closest(hull, p),
        }
    }

    /// Triangles of its surface, for pictures.
    pub fn triangles(&self) -> Triangles {
        match self {
            Solid::Sphere { radius_m } => sphere::triangles(*radius_m),
            Solid::Box { half_m } => cuboid::triangles(half_m),
            Solid::Cylinder { radius_m, half_height_m } => cylinder::triangles(*radius_m, *half_height_m),
            Solid::Capsule { radius_m, half_height_m } => capsule::triangles(*radius_m, *half_height_m),
            Solid::Ellipsoid { semi_axes_m } => ellipsoid::triangles(semi_axes_m),
            Solid::Convex(hull) => convex::triangles(hull),
        }
    }
}

/// Adds all points of the solid whose gap to the half-space normal·x ≥ offset is below the margin.
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

//! Triangles of a solid's surface for pictures, counter-clockwise seen from outside.

use super::mesh::{box_mesh, hull_mesh, sphere_mesh};
use super::solid::Solid;
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, TAU};

type Triangles = (Vec<Vector3<f64>>, Vec<[u32; 3]>);

/// Around the axis; fine enough for a picture.
const SECTORS: u32 = 32;
/// Of a quarter circle.
const ARC: u32 = 8;

pub fn of(solid: &Solid) -> Triangles {
    match solid {
        Solid::Sphere { radius_m } => ball(&Vector3::repeat(*radius_m)),
        Solid::Ellipsoid { semi_axes_m } => ball(semi_axes_m),
        Solid::Box { half_m } => {
            let mesh = box_mesh((half_m * 2.0).into(), [2; 3]);
            let triangles = mesh.surface();
            (mesh.nodes, triangles)
        }
        Solid::Convex(hull) => {
            let mesh = hull_mesh(hull);
            let triangles = mesh.surface();
            (mesh.nodes, triangles)
        }
        Solid::Cylinder { radius_m, half_height_m } => revolved(&[
            (-half_height_m, 0.0),
            (-half_height_m, *radius_m),
            (*half_height_m, *radius_m),
            (*half_height_m, 0.0),
        ]),
        Solid::Capsule { radius_m, half_height_m } => {
            let arc = |k: u32| libm::sincos(FRAC_PI_2 * f64::from(k) / f64::from(ARC));
            let lower = (0..=ARC).map(arc).map(|(sin, cos)| (-half_height_m - radius_m * cos, radius_m * sin));
            let upper = (0..=ARC).map(arc).map(|(sin, cos)| (half_height_m + radius_m * sin, radius_m * cos));
            revolved(&lower.chain(upper).collect::<Vec<_>>())
        }
    }
}

fn ball(semi_axes_m: &Vector3<f64>) -> Triangles {
    let unit = sphere_mesh(1.0, 2);
    (unit.nodes.iter().map(|u| u.component_mul(semi_axes_m)).collect(), unit.surface())
}

/// A profile of (y, distance from the y axis), from a point of the axis below to one above, turned about it.
fn revolved(profile: &[(f64, f64)]) -> Triangles {
    let rings = profile.len() as u32;
    let mut points = Vec::new();
    for sector in 0..SECTORS {
        let (sin, cos) = libm::sincos(TAU * f64::from(sector) / f64::from(SECTORS));
        points.extend(profile.iter().map(|(y, rho)| Vector3::new(rho * cos, *y, rho * sin)));
    }
    let mut triangles = Vec::new();
    for sector in 0..SECTORS {
        let next = (sector + 1) % SECTORS;
        for ring in 0..rings - 1 {
            let [a, b] = [sector, next].map(|s| s * rings + ring);
            // At the poles one side of the quadrangle is a point.
            if ring + 2 < rings {
                triangles.push([a, a + 1, b + 1]);
            }
            if ring > 0 {
                triangles.push([a, b + 1, b]);
            }
        }
    }
    (points, triangles)
}

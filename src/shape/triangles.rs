//! Triangles of surfaces for pictures, counter-clockwise seen from outside.

use super::mesh::TetMesh;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Points, and triangles of three of their numbers each.
pub type Triangles = (Vec<Vector3<f64>>, Vec<[u32; 3]>);

/// Number of sectors around the axis; fine enough for a picture.
const SECTORS: u32 = 32;
/// Number of parts of a quarter circle.
pub(super) const ARC: u32 = 8;

pub(super) fn of_mesh(mesh: TetMesh) -> Triangles {
    let triangles = mesh.surface();
    (mesh.nodes, triangles)
}

/// Surface of a profile of (y, distance from the y axis), from a point of the axis below to one above, turned about it.
pub(super) fn revolved(profile: &[(f64, f64)]) -> Triangles {
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

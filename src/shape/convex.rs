//! A convex polyhedron, the hull of its corners.

use super::closest::{Closest, about};
use super::hull::{Hull, Polygon};
use super::mesh::hull_mesh;
use super::moments::{Moments, exact};
use super::triangles::{Triangles, of_mesh};
use nalgebra::Vector3;

pub fn bounding_radius_m(hull: &Hull) -> f64 {
    hull.vertices.iter().map(|v| v.norm()).fold(0.0, f64::max)
}

/// The corner farthest along `d`, the first of equals.
#[inline]
pub(super) fn support(hull: &Hull, d: &Vector3<f64>) -> Vector3<f64> {
    let mut farthest = (f64::NEG_INFINITY, Vector3::zeros());
    for vertex in &hull.vertices {
        let along = d.dot(vertex);
        if along > farthest.0 {
            farthest = (along, *vertex);
        }
    }
    farthest.1
}

/// Least width between two parallel planes of which one holds a face.
pub fn least_width_m(hull: &Hull) -> f64 {
    let width_m =
        |face: &Polygon| face.normal.dot(&(hull.vertices[face.corners[0] as usize] - support(hull, &-face.normal)));
    hull.faces.iter().map(width_m).fold(f64::INFINITY, f64::min)
}

/// Moments of its tets.
pub fn moments(hull: &Hull) -> Moments {
    exact(&hull_mesh(hull))
}

pub fn closest(hull: &Hull, p: &Vector3<f64>) -> Closest {
    let height = |face: &Polygon| face.normal.dot(&(p - hull.vertices[face.corners[0] as usize]));
    let mut inside = Closest { normal: Vector3::x(), distance_m: f64::NEG_INFINITY };
    let mut outside = f64::INFINITY;
    let mut toward = Vector3::zeros();
    for face in &hull.faces {
        let distance_m = height(face);
        if distance_m > inside.distance_m {
            inside = Closest { normal: face.normal, distance_m };
        }
        if distance_m > 0.0 {
            let r = p - on_polygon(hull, face, p, distance_m);
            if r.norm_squared() < outside {
                outside = r.norm_squared();
                toward = r;
            }
        }
    }
    // Above a face the face's own normal is the more exact one.
    let distance_m = outside.sqrt();
    let is_above = distance_m <= inside.distance_m * (1.0 + 4.0 * f64::EPSILON);
    if inside.distance_m <= 0.0 || is_above { inside } else { about(&toward, 0.0) }
}

fn on_polygon(hull: &Hull, face: &Polygon, p: &Vector3<f64>, height: f64) -> Vector3<f64> {
    let mut best = p - face.normal * height;
    let foot = best;
    let mut least = f64::INFINITY;
    for (i, from) in face.corners.iter().enumerate() {
        let from = hull.vertices[*from as usize];
        let edge = hull.vertices[face.corners[(i + 1) % face.corners.len()] as usize] - from;
        if edge.cross(&face.normal).dot(&(foot - from)) <= 0.0 {
            continue;
        }
        let on_edge = from + edge * (edge.dot(&(p - from)) / edge.norm_squared()).clamp(0.0, 1.0);
        if (p - on_edge).norm_squared() < least {
            least = (p - on_edge).norm_squared();
            best = on_edge;
        }
    }
    best
}

pub fn triangles(hull: &Hull) -> Triangles {
    of_mesh(hull_mesh(hull))
}

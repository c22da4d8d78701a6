//! The point of a solid's surface nearest to a point, from outside and from inside: contact of spheres.

use super::hull::{Hull, Polygon};
use super::solid::Solid;
use nalgebra::Vector3;

/// Nearest point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Outward, unit.
    pub normal: Vector3<f64>,
    /// Negative inside.
    pub distance_m: f64,
}

/// Of the solid in its own axes; where several points are nearest, one of them, always the same.
pub fn closest(solid: &Solid, p: &Vector3<f64>) -> Closest {
    match solid {
        Solid::Sphere { radius_m } => about(p, *radius_m),
        Solid::Box { half_m } => to_box(half_m, p),
        Solid::Cylinder { radius_m, half_height_m } => to_cylinder(*radius_m, *half_height_m, p),
        Solid::Capsule { radius_m, half_height_m } => {
            about(&Vector3::new(p.x, p.y - p.y.clamp(-half_height_m, *half_height_m), p.z), *radius_m)
        }
        Solid::Ellipsoid { semi_axes_m } => to_ellipsoid(semi_axes_m, p),
        Solid::Convex(hull) => to_hull(hull, p),
    }
}

/// From a point of the core to `r`, with the surface at a distance from the core. On the core itself x is outward,
/// which no axis of a capsule is.
fn about(r: &Vector3<f64>, radius_m: f64) -> Closest {
    let length = r.norm();
    let normal = if length > 0.0 { r / length } else { Vector3::x() };
    Closest { normal, distance_m: length - radius_m }
}

fn to_box(half_m: &Vector3<f64>, p: &Vector3<f64>) -> Closest {
    let beyond = p.zip_map(half_m, |x, half| x - x.clamp(-half, half));
    if beyond != Vector3::zeros() {
        return about(&beyond, 0.0);
    }
    let depth = half_m - p.abs();
    let axis = depth.imin();
    Closest { normal: Vector3::ith(axis, if p[axis] < 0.0 { -1.0 } else { 1.0 }), distance_m: -depth[axis] }
}

fn to_cylinder(radius_m: f64, half_height_m: f64, p: &Vector3<f64>) -> Closest {
    let radial = Vector3::new(p.x, 0.0, p.z);
    let side = about(&radial, radius_m);
    let axial = Vector3::y() * if p.y < 0.0 { -1.0 } else { 1.0 };
    let cap_m = p.y.abs() - half_height_m;
    if side.distance_m > 0.0 && cap_m > 0.0 {
        return about(&(side.normal * side.distance_m + axial * cap_m), 0.0);
    }
    if side.distance_m >= cap_m { side } else { Closest { normal: axial, distance_m: cap_m } }
}

/// The root of Σ (aᵢpᵢ/(τ + aᵢ² − a²))² = 1, a the least semi-axis: then xᵢ = aᵢ²pᵢ/(τ + aᵢ² − a²) is nearest
/// (D. Eberly, Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid, 2013, 3). The sum is convex and
/// falls with τ, so that Newton's iteration from below the root cannot overshoot.
fn to_ellipsoid(semi_axes_m: &Vector3<f64>, p: &Vector3<f64>) -> Closest {
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

fn to_hull(hull: &Hull, p: &Vector3<f64>) -> Closest {
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

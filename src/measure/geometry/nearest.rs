//! The signed distance of a point from a solid, in the solid's own axes: closed forms, written a second time for the
//! judge.

use crate::shape::hull::{Hull, Polygon};
use crate::shape::solid::Solid;
use nalgebra::Vector3;

/// Of the coordinates: a point that is nearer is on the surface, and the vector to it no direction.
const SURFACE: f64 = 1e-12;

/// Distance of a point from a surface, negative inside, and the direction in which it grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    pub distance_m: f64,
    pub outward: Vector3<f64>,
}

impl Level {
    /// From a nearest point at a vector from it.
    fn beyond(r: &Vector3<f64>, otherwise: Vector3<f64>) -> Self {
        let distance_m = r.norm();
        Level { distance_m, outward: if distance_m > 0.0 { r / distance_m } else { otherwise } }
    }
}

pub fn level(solid: &Solid, p: &Vector3<f64>) -> Level {
    match solid {
        Solid::Sphere { radius_m } => rolled(p, *radius_m),
        Solid::Capsule { radius_m, half_height_m } => rolled(&from_segment(*half_height_m, p), *radius_m),
        Solid::Box { half_m } => of_box(half_m, p),
        Solid::Cylinder { radius_m, half_height_m } => of_cylinder(*radius_m, *half_height_m, p),
        Solid::Ellipsoid { semi_axes_m } => of_ellipsoid(semi_axes_m, p),
        Solid::Convex(hull) => of_hull(hull, p),
    }
}

/// To a point from the nearest one of a segment along y.
fn from_segment(half_height_m: f64, p: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(p.x, p.y - p.y.clamp(-half_height_m, half_height_m), p.z)
}

/// With a ball around what it is the distance of.
fn rolled(r: &Vector3<f64>, radius_m: f64) -> Level {
    let level = Level::beyond(r, Vector3::x());
    Level { distance_m: level.distance_m - radius_m, ..level }
}

fn of_box(half_m: &Vector3<f64>, p: &Vector3<f64>) -> Level {
    let over = p.abs() - half_m;
    let sign = p.map(|x| 1.0_f64.copysign(x));
    let axis = over.imax();
    if over[axis] <= 0.0 {
        return Level { distance_m: over[axis], outward: Vector3::ith(axis, sign[axis]) };
    }
    let beyond = over.map(|x| x.max(0.0)).component_mul(&sign);
    Level::beyond(&beyond, Vector3::ith(axis, sign[axis]))
}

/// A rectangle, in the plane of the axis and the point.
fn of_cylinder(radius_m: f64, half_height_m: f64, p: &Vector3<f64>) -> Level {
    let across = (p.x * p.x + p.z * p.z).sqrt();
    let out = if across > 0.0 { Vector3::new(p.x, 0.0, p.z) / across } else { Vector3::x() };
    let up = Vector3::y() * 1.0_f64.copysign(p.y);
    let (side_m, cap_m) = (across - radius_m, p.y.abs() - half_height_m);
    if side_m > 0.0 && cap_m > 0.0 {
        return Level::beyond(&(out * side_m + up * cap_m), up);
    }
    if side_m > cap_m { Level { distance_m: side_m, outward: out } } else { Level { distance_m: cap_m, outward: up } }
}

/// Of the nearest point x the normal is along xᵢ/aᵢ²: p − x = τ·(xᵢ/aᵢ²), xᵢ = aᵢ² pᵢ/(τ + aᵢ²), and τ is the largest
/// root of Σ xᵢ²/aᵢ² = 1 (D. Eberly, Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid, 2013),
/// here by bisection to the last bit. Inside, on the plane of the two longer axes, there may be none above −a², a the
/// least axis: then the nearest points are above and below that plane.
fn of_ellipsoid(semi_axes_m: &Vector3<f64>, p: &Vector3<f64>) -> Level {
    let least = semi_axes_m.imin();
    let a = semi_axes_m[least];
    // s = τ + a², so that nothing cancels near its end.
    let more = semi_axes_m.map(|axis| (axis - a) * (axis + a));
    let scaled = semi_axes_m.component_mul(&p.abs());
    let at = |s: f64| Vector3::from_fn(|i, _| if scaled[i] > 0.0 { scaled[i] / (s + more[i]) } else { 0.0 });
    let (mut low, mut high) = (scaled[least], scaled.norm());
    while high > 0.0 {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if at(middle).norm_squared() > 1.0 { low = middle } else { high = middle }
    }
    let mut unit = if high > 0.0 { at(high) } else { Vector3::zeros() };
    let rest = 1.0 - unit.norm_squared();
    if scaled[least] == 0.0 && rest > 0.0 {
        unit[least] = rest.sqrt();
    }
    let x = semi_axes_m.component_mul(&unit);
    let outward = unit.component_div(semi_axes_m).normalize();
    let distance_m = outward.dot(&(p.abs() - x));
    Level { distance_m, outward: outward.zip_map(p, f64::copysign) }
}

/// The highest plane inside; the nearest point of the faces that see it outside.
fn of_hull(hull: &Hull, p: &Vector3<f64>) -> Level {
    let mut inside = Level { distance_m: f64::NEG_INFINITY, outward: Vector3::x() };
    let mut outside: Option<Level> = None;
    for face in &hull.faces {
        let height = face.normal.dot(&(p - hull.vertices[face.corners[0] as usize]));
        if height > inside.distance_m {
            inside = Level { distance_m: height, outward: face.normal };
        }
        if height > 0.0 && outside.is_none_or(|known| height < known.distance_m) {
            let level = Level::beyond(&from_polygon(hull, face, p, height), face.normal);
            if outside.is_none_or(|known| level.distance_m < known.distance_m) {
                outside = Some(level);
            }
        }
    }
    outside.filter(|level| level.distance_m > SURFACE * p.amax()).unwrap_or(inside)
}

/// To a point above a face from the face's nearest.
fn from_polygon(hull: &Hull, face: &Polygon, p: &Vector3<f64>, height: f64) -> Vector3<f64> {
    let above = face.normal * height;
    let foot = p - above;
    let mut best: Option<Vector3<f64>> = None;
    for (i, from) in face.corners.iter().enumerate() {
        let from = hull.vertices[*from as usize];
        let edge = hull.vertices[face.corners[(i + 1) % face.corners.len()] as usize] - from;
        if edge.cross(&face.normal).dot(&(foot - from)) > 0.0 {
            let part = (edge.dot(&(p - from)) / edge.norm_squared()).clamp(0.0, 1.0);
            let r = p - (from + edge * part);
            if best.is_none_or(|best| r.norm_squared() < best.norm_squared()) {
                best = Some(r);
            }
        }
    }
    best.unwrap_or(above)
}

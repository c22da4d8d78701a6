//! Contacts of a body, as far as closed forms ask: planes under it, the points on them, the ball that it is.

use super::facts::{Lacks, SAME, constant_acceleration, unpinned};
use crate::collide::faces;
use crate::model::container::Face;
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::BodyState;
use nalgebra::Vector3;

/// The only face that the body touches, and the acceleration by all that acts on it but the contact.
pub(super) fn on_its_own(model: &Model, index: usize) -> Result<(Face, Vector3<f64>), Lacks> {
    let acceleration = unhindered(model, index)?;
    let [face] = only_faces(model).ok_or("a `container` of one plane, and one body with a shape")?;
    Ok((face, acceleration))
}

/// The faces of the container, if there is nothing else to touch.
pub(super) fn only_faces<const N: usize>(model: &Model) -> Option<[Face; N]> {
    let faces = model.container.as_ref().map(|container| container.faces.as_slice());
    faces.filter(|_| !model.touching_pairs).and_then(|faces| faces.try_into().ok())
}

pub(super) fn unhindered(model: &Model, index: usize) -> Result<Vector3<f64>, Lacks> {
    if !unpinned(model, index)?.drag.is_none() {
        return Err("no `air`".into());
    }
    constant_acceleration(model, index)
}

/// Points on the plane of a body that lies on it, and its state, moving along the plane.
pub(super) fn lying_flat(body: &Body, at: &BodyState, face: &Face) -> Result<(Vec<Vector3<f64>>, BodyState), Lacks> {
    let across = face.normal.dot(&at.v_WB);
    if across.abs() > SAME * at.v_WB.norm() || at.w_WB != Vector3::zeros() {
        return Err(format!("`{}` moving along the plane without turning", body.name));
    }
    let feet = feet(body, at, face);
    if !spread(&feet, &face.normal, body.bounding_radius_m) {
        return Err(format!("`{}` lying flat on the plane, on three points or more", body.name));
    }
    Ok((feet, BodyState { v_WB: at.v_WB - face.normal * across, ..*at }))
}

/// Distance from a plane of what is on it, relative to the size of the body and the distance from the origin.
pub(super) const ON: f64 = 1e-9;

pub(super) fn rounding_m(size_m: f64, at: &BodyState) -> f64 {
    ON * size_m + 8.0 * f64::EPSILON * at.p_WB.amax()
}

/// Vectors from the centre of mass to the points on the plane.
pub(super) fn feet(body: &Body, at: &BodyState, face: &Face) -> Vec<Vector3<f64>> {
    let near_m = rounding_m(body.bounding_radius_m, at);
    let mut feet = Vec::new();
    faces::each_near(body, at, face, near_m, |_, r_W, gap_m| {
        if gap_m > -near_m {
            feet.push(r_W);
        }
    });
    feet
}

/// A vector along the plane; zero if it is rounding of `scale`.
pub(super) fn along(v: &Vector3<f64>, normal: &Vector3<f64>, scale: f64) -> Vector3<f64> {
    let along = v - normal * normal.dot(v);
    if along.norm() <= 4.0 * f64::EPSILON * scale { Vector3::zeros() } else { along }
}

/// Whether the points do not lie on one line.
fn spread(points: &[Vector3<f64>], normal: &Vector3<f64>, size_m: f64) -> bool {
    let Some(first) = points.first() else { return false };
    let apart = |p: &&Vector3<f64>| (**p - first).norm();
    let Some(far) = points.iter().max_by(|a, b| apart(a).total_cmp(&apart(b))) else { return false };
    points.iter().any(|p| normal.dot(&(far - first).cross(&(p - first))).abs() > SAME * size_m * size_m)
}

/// Whether the convex hull of points on a plane has the point on it: seen from there, they leave no half-plane free.
pub(super) fn covers(points: &[Vector3<f64>], normal: &Vector3<f64>, point: &Vector3<f64>) -> bool {
    let e_1 = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    let e_2 = normal.cross(&e_1);
    let seen = |p: &Vector3<f64>| libm::atan2((p - point).dot(&e_2), (p - point).dot(&e_1));
    let mut angles: Vec<f64> = points.iter().map(seen).collect();
    angles.sort_by(f64::total_cmp);
    let turn = 2.0 * std::f64::consts::PI;
    let next = angles.iter().skip(1).copied().chain(angles.first().map(|first| first + turn));
    let widest = angles.iter().zip(next).map(|(a, b)| b - a).fold(0.0, f64::max);
    widest <= turn / 2.0 + ON
}

/// Radius and k = I/(m r²) of a homogeneous ball, or one with its mass about its centre.
pub(super) fn sphere(body: &Body) -> Result<(f64, f64), Lacks> {
    match &body.geometry {
        Geometry::Solid { solid: Solid::Sphere { radius_m }, centre }
            if body.isotropic && centre.norm() <= ON * radius_m =>
        {
            Ok((*radius_m, body.I_B[(0, 0)] / (body.mass_kg * radius_m * radius_m)))
        }
        _ => Err(format!("`{}` a sphere without a mesh, its mass about its centre", body.name)),
    }
}

/// A level plane's normal, and g.
pub(super) fn level(model: &Model, index: usize) -> Result<(Face, f64), Lacks> {
    let (face, acceleration) = on_its_own(model, index)?;
    Ok((face, press_on(&face, &acceleration).ok_or("a level plane")?))
}

/// Acceleration g towards the plane, if the plane is level.
pub(super) fn press_on(face: &Face, acceleration: &Vector3<f64>) -> Option<f64> {
    let press = -face.normal.dot(acceleration);
    (press > 0.0 && along(acceleration, &face.normal, press).norm() <= SAME * press).then_some(press)
}

//! What of a body the judge of geometry sees.

use super::posed::{Posed, reach_m, reach_of_m};
use crate::model::container::Face;
use crate::model::{Body, Geometry, Model};
use crate::shape::hull::Hull;
use crate::shape::solid::Solid;
use crate::state::BodyState;
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Volume of three unit normals: they are of one corner.
const CORNER: f64 = 1e-6;

/// Where a body is: its centre of mass and its attitude.
#[derive(Clone, Copy, Debug)]
pub struct Stand {
    pub p_WB: Vector3<f64>,
    pub q_WB: UnitQuaternion<f64>,
}

impl From<&BodyState> for Stand {
    fn from(at: &BodyState) -> Self {
        Stand { p_WB: at.p_WB, q_WB: at.q_WB }
    }
}

/// A body's constants.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    /// Corners of a volume mesh, from the centre of mass in body axes; none: it is its solid.
    corners: Vec<Vector3<f64>>,
    /// About the centre of mass.
    pub radius_m: f64,
    /// How wide it is where it is thinnest.
    pub width_m: f64,
    pub is_driven: bool,
}

impl Figure {
    pub fn new(body: &Body) -> Self {
        let corners = match &body.geometry {
            Geometry::Mesh { nodes, mesh, .. } => corners(&mesh.hull()).map(|i| nodes[i]).collect(),
            Geometry::Solid { .. } | Geometry::None => Vec::new(),
        };
        let width_m = body.solid().map_or(0.0, |(solid, _)| width_m(solid));
        Figure { corners, radius_m: body.bounding_radius_m, width_m, is_driven: body.driven }
    }

    /// How deep the body is in a face of its container; none: not deeper than what is known.
    pub fn depth_m(&self, body: &Body, at: &Stand, face: &Face, known_m: f64) -> Option<f64> {
        let centre_gap_m = face.gap_m(&at.p_WB);
        if centre_gap_m - self.radius_m > -known_m {
            return None;
        }
        let down = -at.q_WB.inverse_transform_vector(&face.normal);
        let reach_m = if self.corners.is_empty() {
            let (solid, centre) = body.solid()?;
            down.dot(centre) + reach_m(solid, &down)
        } else {
            reach_of_m(&self.corners, &down)
        };
        (reach_m - centre_gap_m > known_m).then_some(reach_m - centre_gap_m)
    }
}

/// The solid of a body, if it has one, about an origin.
pub fn posed<'a>(model: &'a Model, index: usize, at: &Stand, origin_W: &Vector3<f64>) -> Option<Posed<'a>> {
    turned(model, index, &at.p_WB, &at.q_WB.to_rotation_matrix().into_inner(), origin_W)
}

/// The same, by its axes.
pub fn turned<'a>(
    model: &'a Model,
    index: usize,
    p_WB: &Vector3<f64>,
    R: &Matrix3<f64>,
    origin_W: &Vector3<f64>,
) -> Option<Posed<'a>> {
    let (solid, centre) = model.bodies[index].solid()?;
    Some(Posed { solid, p: p_WB - origin_W + R * centre, R: *R })
}

/// Vertices whose faces have normals in three directions. Of a fine mesh of a box only eight are left.
fn corners(hull: &Hull) -> impl Iterator<Item = usize> {
    let mut normals: Vec<Vec<Vector3<f64>>> = vec![Vec::new(); hull.vertices.len()];
    for face in &hull.faces {
        face.corners.iter().for_each(|i| normals[*i as usize].push(face.normal));
    }
    let spans = |of: &[Vector3<f64>]| {
        let Some(first) = of.first() else { return false };
        let side = of.iter().map(|n| first.cross(n)).fold(Vector3::zeros(), longer);
        of.iter().any(|n| side.dot(n).abs() > CORNER)
    };
    let are_corners: Vec<bool> = normals.iter().map(|of| spans(of)).collect();
    (0..are_corners.len()).filter(move |i| are_corners[*i])
}

fn longer(a: Vector3<f64>, b: Vector3<f64>) -> Vector3<f64> {
    if b.norm_squared() > a.norm_squared() { b } else { a }
}

/// Of a hull, between a face and what is opposite.
fn width_m(solid: &Solid) -> f64 {
    match solid {
        Solid::Sphere { radius_m } | Solid::Capsule { radius_m, .. } => 2.0 * radius_m,
        Solid::Box { half_m } => 2.0 * half_m.min(),
        Solid::Cylinder { radius_m, half_height_m } => 2.0 * radius_m.min(*half_height_m),
        Solid::Ellipsoid { semi_axes_m } => 2.0 * semi_axes_m.min(),
        Solid::Convex(hull) => {
            let across = |n: &Vector3<f64>| reach_m(solid, n) + reach_m(solid, &-n);
            hull.faces.iter().map(|face| across(&face.normal)).fold(f64::INFINITY, f64::min)
        }
    }
}

//! Points of a body against the faces of a container. A face farther from the centre of mass than the bounding radius
//! is skipped with one dot product.

use crate::model::container::Face;
use crate::model::{Body, Geometry};
use crate::shape::solid::Solid;
use crate::state::BodyState;
use nalgebra::Vector3;

/// Calls `visit(node, lever arm from the centre of mass in world axes, gap)` for all candidate points of a body whose
/// gap to the face is below the limit, and returns the number of points that were looked at: none of a face beyond the
/// bounding radius.
pub fn each_near(
    body: &Body,
    at: &BodyState,
    face: &Face,
    limit_m: f64,
    visit: impl FnMut(u32, Vector3<f64>, f64),
) -> u64 {
    let is_far = face.gap_m(&at.p_WB) - body.bounding_radius_m >= limit_m;
    if is_far { 0 } else { each_of_all(body, at, face, limit_m, visit) }
}

/// The same, the points looked at however far the face is.
pub fn each_of_all(
    body: &Body,
    at: &BodyState,
    face: &Face,
    limit_m: f64,
    mut visit: impl FnMut(u32, Vector3<f64>, f64),
) -> u64 {
    let centre_gap_m = face.gap_m(&at.p_WB);
    let normal_B = at.q_WB.inverse_transform_vector(&face.normal);
    let points = body.geometry.points() as u64;
    if let Geometry::Solid { solid: Solid::Sphere { radius_m }, centre } = &body.geometry {
        // Along the face's own normal, so that a push at the centre turns nothing.
        let to_centre_W = at.q_WB * centre;
        let gap_m = centre_gap_m + face.normal.dot(&to_centre_W) - radius_m;
        if gap_m < limit_m {
            visit(0, to_centre_W - face.normal * *radius_m, gap_m);
        }
        return points;
    }
    let mut consider = |node: u32, u: Vector3<f64>| {
        let gap_m = centre_gap_m + normal_B.dot(&u);
        if gap_m < limit_m {
            visit(node, at.q_WB * u, gap_m);
        }
    };
    match &body.geometry {
        Geometry::None => {}
        Geometry::Mesh { nodes, .. } => {
            nodes.iter().enumerate().for_each(|(i, u)| consider(i as u32, *u));
        }
        Geometry::Solid { solid, centre } => {
            solid.each_lowest(&normal_B, |feature, point| consider(feature, centre + point));
        }
    }
    points
}

/// Point of a body nearest to a face, the first of equals: the vector from the centre of mass to it, world axes, and
/// its gap in metres.
pub fn nearest(body: &Body, at: &BodyState, face: &Face) -> Option<(Vector3<f64>, f64)> {
    let mut nearest: Option<(Vector3<f64>, f64)> = None;
    each_near(body, at, face, f64::INFINITY, |_, r_W, gap_m| {
        if nearest.is_none_or(|(_, least)| gap_m < least) {
            nearest = Some((r_W, gap_m));
        }
    });
    nearest
}

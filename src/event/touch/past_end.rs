//! What has come over the end of something straight: a corner over that of a round side, an ellipsoid over that of an
//! edge, a rim over the edge that its cap lies on.

use super::moving::BORDER;
use crate::event::shown::{ROLLS, face_toward};
use crate::model::{Body, pose_of_solid};
use crate::shape::cylinder::{EDGE, FACE, RIM, VERTEX, kind};
use crate::shape::pair::edge_ends_W;
use crate::shape::solid::Solid;
use crate::state::BodyState;
use nalgebra::Vector3;

/// Whether nothing is where the contact test found a point.
pub fn is_nothing(
    bodies: [(&Body, &BodyState); 2],
    feature: (u32, u32),
    (p_W, normal): (&Vector3<f64>, &Vector3<f64>),
) -> bool {
    is_past_end(bodies, feature, p_W) || is_over_edge(bodies, feature, normal)
}

/// Whether what the contact test calls a corner on a round side is beyond that one's end: nothing is there, and what is
/// behind the corner comes to the rim. It takes the two as one up to half of this, and its point is half-way between.
fn is_past_end(bodies: [(&Body, &BodyState); 2], feature: (u32, u32), p_W: &Vector3<f64>) -> bool {
    let round = match [feature.0, feature.1].map(kind) {
        [EDGE, VERTEX] => 0,
        [VERTEX, EDGE] => 1,
        _ => return false,
    };
    let (body, at) = bodies[round];
    let Some((Solid::Cylinder { half_height_m, .. }, centre)) = body.solid() else { return false };
    let is_corner = matches!(bodies[1 - round].0.solid(), Some((Solid::Box { .. } | Solid::Convex(_), _)));
    let slack_m = 0.5 * BORDER * bodies.iter().map(|(body, _)| body.bounding_radius_m).sum::<f64>();
    is_corner && (at.q_WB.inverse_transform_vector(&(p_W - at.p_WB)) - centre).y.abs() > half_height_m + slack_m
}

/// Whether a point of a rim was found on a face along the normal of its own cap, which is tilted to the face: an edge
/// lies under the cap, and where the rim crosses that, nothing but the crossing touches. What a rim rolls on has a
/// normal of its own.
fn is_over_edge(bodies: [(&Body, &BodyState); 2], feature: (u32, u32), normal: &Vector3<f64>) -> bool {
    let (rim, out_W) = match [feature.0, feature.1].map(kind) {
        [RIM, FACE] => (0, -normal),
        [FACE, RIM] => (1, *normal),
        _ => return false,
    };
    let own = |(_, at): (&Body, &BodyState), v: &Vector3<f64>| at.q_WB.inverse_transform_vector(v);
    let is_of_cap = own(bodies[rim], &out_W).xz().norm() <= ROLLS;
    let face = face_toward(bodies[1 - rim].0, &own(bodies[1 - rim], &-out_W));
    is_of_cap && face.is_some_and(|face| face.normal_B.cross(&own(bodies[1 - rim], &out_W)).norm() > ROLLS)
}

/// How far an ellipsoid's point of contact on an edge is beyond that one's end, along the edge: the contact test knows
/// it to the root of rounding only, and on the corner bodies part and meet at other speeds. None: it is not.
pub fn beyond_edge_W(
    bodies: [(&Body, &BodyState); 2],
    feature: (u32, u32),
    p_W: &Vector3<f64>,
) -> Option<Vector3<f64>> {
    let (edge, name) = match [feature.0, feature.1].map(kind) {
        [EDGE, VERTEX] => (0, feature.0),
        [VERTEX, EDGE] => (1, feature.1),
        _ => return None,
    };
    let (Some((Solid::Ellipsoid { .. }, _)), (body, at)) = (bodies[1 - edge].0.solid(), bodies[edge]) else {
        return None;
    };
    let (solid, centre) = body.solid()?;
    let [from, to] = edge_ends_W(solid, &pose_of_solid(centre, at), name)?;
    let d = (to - from).try_normalize(0.0)?;
    let along_m = d.dot(&(p_W - from));
    let on_m = along_m.clamp(0.0, d.dot(&(to - from)));
    (on_m != along_m).then(|| d * (along_m - on_m))
}

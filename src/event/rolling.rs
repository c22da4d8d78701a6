//! How fast a gap may close where the cap of a cylinder meets another body: its lowest point rolls along the rim, the
//! flatter the faster, but a corner that stands on it does not, and an edge that lies along it only as it turns.

use super::caps::Cap;
use super::descent::Descent;
use super::shown::face_toward;
use crate::model::{Body, pose_of_solid};
use crate::shape::cylinder::{ARC, EDGE, FACE, FLAT, RIM, VERTEX, kind};
use crate::shape::pair::edge_W;
use crate::shape::solid::{Meeting, Solid};
use crate::state::BodyState;
use nalgebra::Vector3;

/// How the lowest point of a rim that is nearly flat may move toward what it faces.
pub struct Rolling {
    /// Beside what its points are accelerated, for a time; none: it is flat.
    pub along: Option<(f64, f64)>,
    /// How much faster than this point any other may come nearer.
    pub faster_m_s: f64,
    /// All points of the rims, if none of them is lower than what touches.
    pub down: Option<Vec<Descent>>,
}

/// The tilt (rad) up to which that is more than the points of contact of other parts may do.
const NEARLY: f64 = 0.2;

/// Part of a tilt that is sure to be left while the bound of the curvature is used.
const KEPT: f64 = 0.5;

/// Whether a body may have a face across a direction from it, on which a rim could come down.
fn is_flat_toward(body: &Body, at: &BodyState, out: &Vector3<f64>) -> bool {
    match body.solid() {
        Some((Solid::Box { .. } | Solid::Convex(_), _)) => {
            face_toward(body, &at.q_WB.inverse_transform_vector(out)).is_some()
        }
        Some((Solid::Cylinder { .. }, _)) => true,
        Some((Solid::Sphere { .. } | Solid::Capsule { .. } | Solid::Ellipsoid { .. }, _)) | None => false,
    }
}

/// A cap that touches.
struct Touching {
    cap: Cap,
    normal: Vector3<f64>,
    tilt: f64,
    /// Of the other body, where that crosses the rim of a cap along whose own normal they touch: all its points are
    /// beyond the cap, and only those of the edge come nearer than the one that touches.
    edge_W: Option<Vector3<f64>>,
}

/// Of two bodies that touch so, and turn no faster than this against each other. None: no rim does.
pub fn rolling(
    bodies: [&Body; 2],
    at: &[BodyState; 2],
    (touch, delta_m): (&Meeting, f64),
    w_rad_s: f64,
) -> Option<Rolling> {
    let features = [touch.feature.0, touch.feature.1];
    let of = |k: usize| {
        let (own, other) = (features[k], features[1 - k]);
        // What stands on the inside of a cap is a point of the other body.
        if own == FACE && [VERTEX, RIM].contains(&kind(other)) {
            return None;
        }
        let normal = if k == 0 { touch.normal } else { -touch.normal };
        let cap = Cap::facing(bodies[k], &at[k], &normal)?;
        let tilt = cap.lean_W(&at[k], &normal).norm();
        // A cap along its own normal has all its points among those of the contact test.
        let may_roll = tilt > FLAT || is_flat_toward(bodies[1 - k], &at[1 - k], &normal);
        let crosses = tilt <= FLAT && [ARC, ARC | 1].contains(&own) && kind(other) == EDGE;
        let edge = |solid, centre| edge_W(solid, &pose_of_solid(centre, &at[1 - k]), other);
        let edge_W = if crosses { bodies[1 - k].solid().and_then(|(solid, centre)| edge(solid, centre)) } else { None };
        (tilt <= NEARLY && may_roll).then_some(Touching { cap, normal, tilt, edge_W })
    };
    let caps = [0, 1].map(of);
    let there = || caps.iter().enumerate().filter_map(|(k, of)| Some((k, of.as_ref()?)));
    let tilt = there().map(|(_, of)| of.tilt).reduce(f64::min)?;
    let radius_m = there().map(|(_, of)| of.cap.radius_m).fold(0.0, f64::max);
    let turns = touch.normal.cross(&(at[0].w_WB - at[1].w_WB));
    let faster_m_s = |(_, of): (usize, &Touching)| {
        2.0 * of.cap.radius_m * of.edge_W.map_or_else(|| turns.norm(), |edge_W| edge_W.dot(&turns).abs())
    };
    let kept = KEPT * tilt;
    let along = (tilt > FLAT).then(|| (w_rad_s * w_rad_s * radius_m / kept, kept / w_rad_s.max(f64::MIN_POSITIVE)));
    let down = there().filter(|(_, of)| of.edge_W.is_none()).map(|(k, Touching { cap, normal, tilt, .. })| {
        let centre_m = (at[k].p_WB + at[k].q_WB * cap.centre_B - touch.p_W).dot(normal) + touch.gap_m / 2.0;
        let lower_m = touch.gap_m - (centre_m - cap.radius_m * tilt);
        (lower_m <= delta_m).then(|| cap.descent([&at[k], &at[1 - k]], normal))
    });
    let down = down.collect();
    Some(Rolling { along, faster_m_s: there().map(faster_m_s).fold(0.0, f64::max), down })
}

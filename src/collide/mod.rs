//! Contact test (L18, step 1 of L21): nodes of a body against the faces of its container.
//!
//! A node is in contact when n·(u_c − u_p) < margin. Contacts come in a stable order: body, face, node. A face farther
//! from the centre of mass than the bounding radius is skipped with one dot product.

mod axis;
pub mod broad;
pub mod closest;
mod gjk;
pub mod hull;
mod manifold;
pub mod pair;
mod placed;
pub mod reduce;
pub mod solid;

use crate::measure::work::Work;
use crate::model::container::Face;
use crate::model::surface::Surface;
use crate::model::{Body, Geometry, Model};
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// One point of contact of a body with the container or with another body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    pub body: usize,
    /// Of a higher index than `body`; none: the container.
    pub other: Option<usize>,
    /// Face and node: the same from step to step, to find last step's impulse by.
    pub feature: (u32, u32),
    /// From the body's centre of mass to the point, world axes (the lecture's ᴳu_c).
    pub r_BC_W: Vector3<f64>,
    /// From the other body's centre of mass to the same point; zero for the container.
    pub r_OC_W: Vector3<f64>,
    pub p_WC: Vector3<f64>,
    /// From the container or the other body to the body.
    pub normal: Vector3<f64>,
    pub gap_m: f64,
    pub friction: f64,
    pub restitution: f64,
}

impl Contact {
    /// Its place in the order of contacts, and its name from step to step.
    pub fn key(&self) -> Key {
        (self.body, self.other, self.feature)
    }

    /// The bodies that it pushes: which, the lever arm, and the sign of the impulse.
    pub fn ends(&self) -> impl Iterator<Item = (usize, Vector3<f64>, f64)> {
        let other = self.other.map(|other| (other, self.r_OC_W, -1.0));
        std::iter::once((self.body, self.r_BC_W, 1.0)).chain(other)
    }

    /// e₁ = n and two tangents; for the faces of a box the tangents are the other coordinate axes.
    pub fn frame(&self) -> [Vector3<f64>; 3] {
        let normal = self.normal;
        let least = normal.iamin();
        let along = Vector3::ith(least, 1.0);
        let t1 = (along - normal * normal[least]).normalize();
        [normal, t1, normal.cross(&t1)]
    }
}

/// Body, other body, feature.
pub type Key = (usize, Option<usize>, (u32, u32));

/// A contact of the last step and the impulse that it put on its body, world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolvedContact {
    pub contact: Contact,
    pub impulse_W: Vector3<f64>,
}

/// Fills `contacts` with all points whose gap is below `margin` × the body's bounding radius.
pub fn detect(model: &Model, state: &State, margin: f64, contacts: &mut Vec<Contact>, work: &mut Work) {
    contacts.clear();
    let Some(container) = &model.container else { return };
    for (index, (body, at)) in model.bodies.iter().zip(&state.bodies).enumerate() {
        if !body.touches() {
            continue;
        }
        let Surface { friction, restitution } = model.pair(index, None);
        for (f, face) in container.faces.iter().enumerate() {
            let centre_gap = face.gap_m(&at.p_WB);
            let limit = margin * body.bounding_radius_m;
            if centre_gap - body.bounding_radius_m >= limit {
                continue;
            }
            let mut touch = |node: u32, r_BC_W: Vector3<f64>, gap_m: f64| {
                contacts.push(Contact {
                    body: index,
                    other: None,
                    feature: (f as u32, node),
                    r_BC_W,
                    r_OC_W: Vector3::zeros(),
                    p_WC: at.p_WB + r_BC_W,
                    normal: face.normal,
                    gap_m,
                    friction,
                    restitution,
                });
            };
            work.contact_tests += each_gap(body, at, face, centre_gap, |node, r_B, r_shift_W, gap| {
                if gap < limit {
                    touch(node, at.q_WB * r_B + r_shift_W, gap);
                }
            });
        }
    }
}

/// Largest depth of any point of the body in any face; 0 if none is inside.
pub fn deepest_m(model: &Model, body: &Body, at: &BodyState) -> f64 {
    let mut deepest = 0.0_f64;
    if !body.touches() {
        return deepest;
    }
    for face in model.container.iter().flat_map(|c| &c.faces) {
        let centre_gap = face.gap_m(&at.p_WB);
        if centre_gap < body.bounding_radius_m {
            each_gap(body, at, face, centre_gap, |_, _, _, gap| deepest = deepest.max(-gap));
        }
    }
    deepest
}

/// The body's point nearest to a face, the first of equals: from the centre of mass to it, world axes, and its gap.
pub fn nearest(body: &Body, at: &BodyState, face: &Face) -> Option<(Vector3<f64>, f64)> {
    let mut nearest: Option<(Vector3<f64>, f64)> = None;
    each_gap(body, at, face, face.gap_m(&at.p_WB), |_, r_B, r_shift_W, gap| {
        if nearest.is_none_or(|(_, least)| gap < least) {
            nearest = Some((at.q_WB * r_B + r_shift_W, gap));
        }
    });
    nearest
}

/// Calls `visit(node, point in body axes, further shift in world axes, gap)` for every candidate point; says how many.
fn each_gap(
    body: &Body,
    at: &BodyState,
    face: &Face,
    centre_gap: f64,
    mut visit: impl FnMut(u32, Vector3<f64>, Vector3<f64>, f64),
) -> u64 {
    match &body.geometry {
        Geometry::None => 0,
        Geometry::Mesh { nodes, .. } | Geometry::Corners(nodes) => {
            let normal_B = at.q_WB.inverse_transform_vector(&face.normal);
            for (i, u) in nodes.iter().enumerate() {
                visit(i as u32, *u, Vector3::zeros(), centre_gap + normal_B.dot(u));
            }
            nodes.len() as u64
        }
        Geometry::Sphere { centre, radius_m } => {
            let gap = centre_gap + face.normal.dot(&(at.q_WB * centre)) - radius_m;
            visit(0, *centre, -face.normal * *radius_m, gap);
            1
        }
        Geometry::Solid { solid, centre } => {
            let normal_B = at.q_WB.inverse_transform_vector(&face.normal);
            solid.each_lowest(&normal_B, |feature, point| {
                let u = centre + point;
                visit(feature, u, Vector3::zeros(), centre_gap + normal_B.dot(&u));
            });
            solid.lowest_points() as u64
        }
    }
}

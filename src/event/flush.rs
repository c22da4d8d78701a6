//! Blocks that lie flush, side by side: what is over the seam between them has the contacts that it has on one block.
//!
//! Where faces of bodies that do not move against each other lie in one plane, next to each other, a border inside of
//! all of them ends nothing. A point of contact there bears nothing that those of the body itself would not bear as
//! well; but of contacts that are redundant it would change how they share their load, and with that the friction.

use super::shown::{Face, ROLLS, face_toward};
use crate::collide::Contact;
use crate::model::Model;
use crate::shape::cylinder::{FACE, RIM, rim_directions};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// Sine of the angle of normals that are one: what is round and just over an edge has a normal of its own there.
const ONE_NORMAL: f64 = 1e-4;

/// Of the smaller body's size: how far around a point the faces are looked for, and what is beside a border no more.
const AROUND: f64 = 1e-7;
const AT: f64 = 2e-9;

/// Directions in which they are looked for.
const DIRECTIONS: u32 = 8;

/// A body that stands on another one, which moves as it is told.
struct Footed {
    top: usize,
    base: usize,
    /// From the base.
    normal: Vector3<f64>,
    /// Of the base.
    feature: u32,
}

impl Footed {
    fn of(model: &Model, contact: &Contact) -> Option<Self> {
        let (a, b) = (contact.body, contact.other?);
        let (feature_a, feature_b) = contact.feature;
        match [a, b].map(|i| model.bodies[i].driven) {
            [false, true] => Some(Footed { top: a, base: b, normal: contact.normal, feature: feature_b }),
            [true, false] => Some(Footed { top: b, base: a, normal: -contact.normal, feature: feature_a }),
            _ => None,
        }
    }
}

/// Leaves, of what touches, no contact at a border over which another body's face goes on, and of points that are one
/// the first; of a rim that rolls, which has one point alone, that one which is inside of a face, or all if none is; a
/// cap that lies flat, wholly on faces that go on, stands on four points of its rim.
pub fn merge(model: &Model, state: &State, found: &mut Vec<Contact>) {
    let footed: Vec<Option<Footed>> = found.iter().map(|contact| Footed::of(model, contact)).collect();
    let several = |of: &Footed| footed.iter().flatten().any(|other| other.top == of.top && other.base != of.base);
    if !footed.iter().flatten().any(several) {
        return;
    }
    let mut left_out = vec![false; found.len()];
    for i in 0..found.len() {
        let Some(of) = &footed[i] else { continue };
        let with: Vec<usize> = (0..found.len()).filter(|j| is_beside(state, found, &footed, (i, *j))).collect();
        if with.is_empty() {
            continue;
        }
        let is_one = |j: &usize| (found[*j].p_WC - found[i].p_WC).norm() <= AT * size_m(model, of);
        let is_inside = |j: &usize| footed[*j].as_ref().is_some_and(|of| of.feature == FACE);
        left_out[i] = if is_of_flat_cap(model, state, of) {
            false
        } else if is_of_rim(model, state, of) {
            let axis = state.bodies[of.top].q_WB * Vector3::y();
            let is_of_cap = |j: usize| axis.dot(&(found[j].p_WC - found[i].p_WC)).abs() <= ONE_CAP * size_m(model, of);
            let rests_inside = |j: usize| is_inside(&j) && is_of_cap(j) && is_with(state, found, &footed, (i, j));
            let rests_inside = (0..found.len()).any(rests_inside);
            let others = with.iter().filter_map(|j| footed[*j].as_ref());
            of.feature != FACE && rests_inside && goes_on(model, state, (&found[i], of), others)
        } else if of.feature == FACE {
            with.iter().any(|j| *j < i && is_inside(j) && is_one(j))
        } else {
            goes_on(model, state, (&found[i], of), with.iter().filter_map(|j| footed[*j].as_ref()))
        };
    }
    let mut at = 0..;
    found.retain(|_| at.next().is_none_or(|i: usize| !left_out[i]));
    seat_caps(model, state, found);
}

/// Gives flat caps that lie on several faces, wholly, four points of their rims.
fn seat_caps(model: &Model, state: &State, found: &mut Vec<Contact>) {
    let mut from = 0;
    while from < found.len() {
        let footed: Vec<Option<Footed>> = found.iter().map(|contact| Footed::of(model, contact)).collect();
        let first = (from..found.len()).find(|i| {
            footed[*i]
                .as_ref()
                .is_some_and(|of| is_of_flat_cap(model, state, of) && seats(state, found, &footed, *i).len() > 1)
        });
        let Some((i, of)) = first.and_then(|i| Some((i, footed[i].as_ref()?))) else { return };
        from = i + 1;
        let group: Vec<usize> = (0..found.len()).filter(|j| is_with(state, found, &footed, (i, *j))).collect();
        let others = || group.iter().filter_map(|j| footed[*j].as_ref());
        let lies_wholly = group
            .iter()
            .all(|j| footed[*j].as_ref().is_some_and(|of| goes_on(model, state, (&found[*j], of), others())));
        let Some(points) = lies_wholly.then(|| cap_points(model, state, (&found[i], of), others())).flatten() else {
            continue;
        };
        let mut at = 0..;
        found.retain(|_| at.next().is_none_or(|j: usize| !group.contains(&j)));
        let place = i.min(found.len());
        found.splice(place..place, points);
        from = place + 4;
    }
}

/// The bodies on which it stands as it does on this one.
fn seats(state: &State, found: &[Contact], footed: &[Option<Footed>], i: usize) -> Vec<usize> {
    let with = (0..found.len()).filter(|j| is_with(state, found, footed, (i, *j)));
    let mut bases: Vec<usize> = with.filter_map(|j| footed[j].as_ref()).map(|of| of.base).collect();
    bases.sort_unstable();
    bases.dedup();
    bases
}

/// The same contact, or one beside it, of the same two bodies or with another base.
fn is_with(state: &State, found: &[Contact], footed: &[Option<Footed>], (i, j): (usize, usize)) -> bool {
    let is_same = |a: &Footed, b: &Footed| (a.top, a.base) == (b.top, b.base) && a.normal.dot(&b.normal) > 0.0;
    is_beside(state, found, footed, (i, j))
        || footed[i].as_ref().zip(footed[j].as_ref()).is_some_and(|(a, b)| is_same(a, b))
}

/// Four points of the rim of a cap, each on what is below it; none: below one is nothing.
fn cap_points<'a>(
    model: &Model,
    state: &State,
    (like, of): (&Contact, &Footed),
    others: impl Iterator<Item = &'a Footed>,
) -> Option<Vec<Contact>> {
    let Some((Solid::Cylinder { radius_m, half_height_m }, centre)) = model.bodies[of.top].solid() else { return None };
    let at = &state.bodies[of.top];
    let out_B = -Vector3::y() * at.q_WB.inverse_transform_vector(&of.normal).y.signum();
    let faces = faces(model, state, of, others);
    let size_m = size_m(model, of);
    let point = |(u_B, node): (Vector3<f64>, u32)| {
        let p_WC = at.p_WB + at.q_WB * (centre + out_B * *half_height_m + u_B * *radius_m);
        let (base, _) = faces.iter().find(|(base, face)| is_over(state, (*base, face), &p_WC, size_m))?;
        Some(seated(state, like, (of, *base), (p_WC, RIM | node)))
    };
    rim_directions(&Vector3::zeros()).into_iter().zip(0..).map(point).collect()
}

/// A contact of a body at a point of its own, on such a base.
fn seated(state: &State, like: &Contact, (of, base): (&Footed, usize), (p_WC, own): (Vector3<f64>, u32)) -> Contact {
    let (body, other) = (of.top.min(base), of.top.max(base));
    let (sign, feature) = if body == of.top { (1.0, (own, FACE)) } else { (-1.0, (FACE, own)) };
    Contact {
        body,
        other: Some(other),
        feature,
        r_BC_W: p_WC - state.bodies[body].p_WB,
        r_OC_W: p_WC - state.bodies[other].p_WB,
        p_WC,
        normal: of.normal * sign,
        gap_m: like.gap_m + of.normal.dot(&(p_WC - like.p_WC)),
        ..*like
    }
}

/// Puts a contact of a flat cap on that one of some bases that is below it.
pub fn seat(model: &Model, state: &State, contact: &mut Contact, among: &[Contact]) {
    let Some(of) = Footed::of(model, contact) else { return };
    let others: Vec<Footed> =
        among.iter().filter_map(|other| Footed::of(model, other)).filter(|other| other.top == of.top).collect();
    let size_m = size_m(model, &of);
    let below = faces(model, state, &of, others.iter());
    if let Some((base, _)) = below.iter().find(|(base, face)| is_over(state, (*base, face), &contact.p_WC, size_m))
        && *base != of.base
    {
        let own = if contact.body == of.top { contact.feature.0 } else { contact.feature.1 };
        *contact = seated(state, contact, (&of, *base), (contact.p_WC, own));
    }
}

/// Whether two bodies are one to what stands on both of them: they are driven, and rest.
pub fn is_one_base(model: &Model, state: &State, [a, b]: [usize; 2]) -> bool {
    let rests = |i: usize| {
        let at = &state.bodies[i];
        model.bodies[i].driven && at.v_WB == Vector3::zeros() && at.w_WB == Vector3::zeros()
    };
    a == b || (rests(a) && rests(b))
}

/// The same: points of one cap are no farther from each other along its axis.
const ONE_CAP: f64 = 1e-3;

/// Sine of the angle to an axis below which a cylinder lies on its side.
const LIES: f64 = 1e-6;

/// Of a cap whose points stand for all of it (`caps`).
fn is_of_flat_cap(model: &Model, state: &State, of: &Footed) -> bool {
    let is_cylinder = matches!(model.bodies[of.top].solid(), Some((Solid::Cylinder { .. }, _)));
    is_cylinder && (state.bodies[of.top].q_WB * Vector3::y()).cross(&of.normal).norm() <= ROLLS
}

/// Of a cylinder that neither lies nor stands flat: it has one point alone. Its crossings with the edges of a seam are
/// none of its own.
fn is_of_rim(model: &Model, state: &State, of: &Footed) -> bool {
    let is_cylinder = matches!(model.bodies[of.top].solid(), Some((Solid::Cylinder { .. }, _)));
    let axis = state.bodies[of.top].q_WB * Vector3::y();
    is_cylinder && axis.cross(&of.normal).norm() > ROLLS && axis.dot(&of.normal).abs() > LIES
}

/// Contacts of one body with two others, whose surfaces are alike, that do not move against each other, along one
/// normal.
fn is_beside(state: &State, found: &[Contact], footed: &[Option<Footed>], (i, j): (usize, usize)) -> bool {
    let (Some(a), Some(b)) = (&footed[i], &footed[j]) else { return false };
    let surface = |contact: &Contact| (contact.friction, contact.restitution, contact.tangential_restitution);
    let [of_a, of_b] = [a, b].map(|of| &state.bodies[of.base]);
    let velocity = |of: &BodyState| of.v_WB + of.w_WB.cross(&(found[i].p_WC - of.p_WB));
    a.top == b.top
        && a.base != b.base
        && a.normal.dot(&b.normal) > 0.0
        && a.normal.cross(&b.normal).norm() <= ONE_NORMAL
        && surface(&found[i]) == surface(&found[j])
        && of_a.w_WB == of_b.w_WB
        && velocity(of_a) == velocity(of_b)
}

/// Whether the faces of its own base and of others lie all around a point.
fn goes_on<'a>(
    model: &Model,
    state: &State,
    (contact, of): (&Contact, &Footed),
    others: impl Iterator<Item = &'a Footed>,
) -> bool {
    let faces = faces(model, state, of, others);
    let Some((_, own)) = faces.first().filter(|(base, _)| *base == of.base) else { return false };
    let size_m = size_m(model, of);
    let normal = state.bodies[of.base].q_WB * own.normal_B;
    let first = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    let second = normal.cross(&first);
    (0..DIRECTIONS).all(|k| {
        // Off the directions in which borders lie most often.
        let angle = (f64::from(k) + 0.3) * std::f64::consts::TAU / f64::from(DIRECTIONS);
        let p_W = contact.p_WC + (first * libm::cos(angle) + second * libm::sin(angle)) * (AROUND * size_m);
        faces.iter().any(|(base, face)| is_over(state, (*base, face), &p_W, size_m))
    })
}

/// The faces of its own base, and of others, on which something stands.
fn faces<'a>(
    model: &Model,
    state: &State,
    of: &Footed,
    others: impl Iterator<Item = &'a Footed>,
) -> Vec<(usize, Face)> {
    let mut faces: Vec<(usize, Face)> = Vec::new();
    let own = [of.base].into_iter();
    for base in own.chain(others.map(|other| other.base)) {
        if faces.iter().any(|(known, _)| *known == base) {
            continue;
        }
        let out_B = state.bodies[base].q_WB.inverse_transform_vector(&of.normal);
        let face = face_toward(&model.bodies[base], &out_B);
        faces.extend(face.filter(|face| (face.normal_B - out_B).norm() <= ONE_NORMAL).map(|face| (base, face)));
    }
    faces
}

/// Whether a point is over a body's face.
fn is_over(state: &State, (base, face): (usize, &Face), p_W: &Vector3<f64>, size_m: f64) -> bool {
    let base = &state.bodies[base];
    let p_B = base.q_WB.inverse_transform_vector(&(p_W - base.p_WB));
    let p_B = p_B + face.normal_B * (face.offset_m - face.normal_B.dot(&p_B));
    face.border.inside_m(&p_B) >= -AT * size_m
}

/// Of the smaller of the two.
fn size_m(model: &Model, of: &Footed) -> f64 {
    model.bodies[of.top].bounding_radius_m.min(model.bodies[of.base].bounding_radius_m)
}

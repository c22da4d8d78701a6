//! Which contact two bodies have that share an edge or a corner alone.
//!
//! They are apart as long as one axis separates them: what is kept is s = max sₙ ≥ 0 over all axes n, an "or". Axes
//! within a band of the largest count alike, and the rate of s is the largest of theirs. A pair whose s does not fall
//! carries nothing, as one of its axes separates it still; where s falls, the last axis to close is its contact. Where
//! no rate is one, accelerations say the same: those that the other contacts leave.

use super::decide::{Change, Decision, decide};
use super::flush;
use super::forces::{Gathered, NO_SLIP, meeting_m_s};
use super::touch::Touch;
use crate::collide::Contact;
use crate::collide::closed::is_closed_to_delta;
use crate::model::{Model, pose_of_solid};
use crate::shape::band::{Along, axes, band_m, touches_beside};
use crate::shape::solid::{Pose, Solid};
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::Vector3;

/// Of the speed of two bodies: what comes along a surface closes no faster once it is within the band of it,
/// (2 · 10⁻⁹)^½ = 4.5e-5.
pub const GRAZING: f64 = 1e-4;

/// Of the acceleration of gravity: what is less does not close a pair.
const NONE: f64 = 1e-9;

/// Axes that separate two bodies alike, two of them at least, and how fast each of them opens.
#[derive(Clone, Debug)]
pub struct Sharing {
    pub axes: Vec<(Along, f64)>,
}

impl Sharing {
    /// None: one axis alone.
    pub fn new(model: &Model, pair: [usize; 2], at: [&BodyState; 2]) -> Option<Self> {
        let [(solid_a, pose_a), (solid_b, pose_b)] = posed(model, pair, at)?;
        let found = axes(solid_a, &pose_a, solid_b, &pose_b);
        if found.len() < 2 {
            return None;
        }
        let point_m_s = |k: usize, p_W: &Vector3<f64>| at[k].v_WB + at[k].w_WB.cross(&(p_W - at[k].p_WB));
        let rated = found.into_iter().map(|along| {
            let rate = |p_W: &Vector3<f64>| along.normal.dot(&(point_m_s(0, p_W) - point_m_s(1, p_W)));
            let rate_m_s = along.points.iter().map(|point| rate(&point.p_W)).fold(f64::INFINITY, f64::min);
            (along, rate_m_s)
        });
        Some(Sharing { axes: rated.collect() })
    }

    /// The rate of s.
    pub fn rate_m_s(&self) -> f64 {
        self.axes.iter().map(|(_, rate_m_s)| *rate_m_s).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Contacts along the axis of the largest of some numbers, of which there is one an axis.
    fn contacts(&self, like: &Contact, at: [&BodyState; 2], of: &[f64]) -> Vec<Contact> {
        let Some(last) = (0..of.len()).reduce(|best, i| if of[i] > of[best] { i } else { best }) else { return vec![] };
        self.axes[last].0.points.iter().map(|point| like.meeting(point, at)).collect()
    }
}

fn posed<'a>(model: &'a Model, pair: [usize; 2], at: [&BodyState; 2]) -> Option<[(&'a Solid, Pose); 2]> {
    let [Some((solid_a, centre_a)), Some((solid_b, centre_b))] = pair.map(|i| model.bodies[i].solid()) else {
        return None;
    };
    Some([(solid_a, pose_of_solid(centre_a, at[0])), (solid_b, pose_of_solid(centre_b, at[1]))])
}

/// A pair that is set aside: one of its axes does not close.
struct Aside {
    pair: [usize; 2],
    first: Contact,
    sharing: Sharing,
}

/// Leaves, of pairs that share an edge alone, the contacts of those that come nearer. `found`: in the order of their
/// keys, and closed. Blocks that lie flush are one (`flush`).
pub fn choose(model: &Model, state: &State, found: &mut Vec<Contact>, gathered: &mut Gathered, work: &mut Work) {
    choose_axes(model, state, found, gathered, work);
    flush::merge(model, state, found);
}

fn choose_axes(model: &Model, state: &State, found: &mut Vec<Contact>, gathered: &mut Gathered, work: &mut Work) {
    let mut aside = Vec::new();
    let mut kept = Vec::with_capacity(found.len());
    for group in found.chunk_by(|a, b| (a.body, a.other) == (b.body, b.other)) {
        let first = group[0];
        let sharing = first.other.and_then(|other| {
            let pair = [first.body, other];
            Some((pair, Sharing::new(model, pair, pair.map(|i| &state.bodies[i]))?))
        });
        let Some((pair, sharing)) = sharing else {
            kept.extend(beside(model, state, group));
            continue;
        };
        let rates: Vec<f64> = sharing.axes.iter().map(|(_, rate_m_s)| *rate_m_s).collect();
        if sharing.rate_m_s() < -NO_SLIP * meeting_m_s(model, state, pair.into_iter()) {
            kept.extend(sharing.contacts(&first, pair.map(|i| &state.bodies[i]), &rates));
        } else {
            aside.push(Aside { pair, first, sharing });
        }
    }
    if aside.is_empty() {
        if kept.len() != found.len() || kept != *found {
            *found = kept;
        }
        return;
    }
    while let Some(pressed) = pressed(model, state, &kept, &mut aside, gathered, work) {
        kept.extend(pressed);
    }
    kept.sort_unstable_by_key(Contact::key);
    *found = kept;
}

/// Contacts of a pair with one axis: those found; where something round is beside a face, with its edge.
fn beside(model: &Model, state: &State, group: &[Contact]) -> Vec<Contact> {
    let is_round = |i: usize| {
        let solid = model.bodies[i].solid();
        solid.is_some_and(|(solid, _)| matches!(solid, Solid::Capsule { .. } | Solid::Cylinder { .. }))
    };
    let Some(pair) = group[0].other.map(|other| [group[0].body, other]) else { return group.to_vec() };
    let at = pair.map(|i| &state.bodies[i]);
    let posed = if pair.into_iter().any(is_round) { posed(model, pair, at) } else { None };
    let Some([(solid_a, pose_a), (solid_b, pose_b)]) = posed else { return group.to_vec() };
    let mut points = Vec::new();
    if !touches_beside(solid_a, &pose_a, solid_b, &pose_b, band_m(solid_a, solid_b), &mut points) {
        return group.to_vec();
    }
    let contacts = points.iter().map(|point| group[0].meeting(point, at));
    contacts.filter(|contact| is_closed_to_delta(model, contact)).collect()
}

/// Contacts of the first pair that the others leave to come nearer; it is set aside no longer.
fn pressed(
    model: &Model,
    state: &State,
    kept: &[Contact],
    aside: &mut Vec<Aside>,
    gathered: &mut Gathered,
    work: &mut Work,
) -> Option<Vec<Contact>> {
    // What separates a pair faster than rounding, does so whatever accelerates it.
    let slow = |of: &Aside| NO_SLIP * meeting_m_s(model, state, of.pair.into_iter());
    if aside.iter().all(|of| of.sharing.rate_m_s() > slow(of)) {
        return None;
    }
    let accelerations = accelerations(model, state, kept, gathered, work)?;
    for (k, of) in aside.iter().enumerate() {
        let at = of.pair.map(|i| &state.bodies[i]);
        let point_m_s2 = |k: usize, p_W: &Vector3<f64>| {
            let (r, w, Twist { v, w: alpha }) = (p_W - at[k].p_WB, at[k].w_WB, accelerations[of.pair[k]]);
            v + alpha.cross(&r) + w.cross(&w.cross(&r))
        };
        let rate = of.sharing.rate_m_s();
        let opens = |(along, rate_m_s): &(Along, f64)| {
            let of_point = |p_W: &Vector3<f64>| along.normal.dot(&(point_m_s2(0, p_W) - point_m_s2(1, p_W)));
            let least = along.points.iter().map(|point| of_point(&point.p_W)).fold(f64::INFINITY, f64::min);
            // Axes that close are no longer in question.
            if *rate_m_s < rate - slow(of) { f64::NEG_INFINITY } else { least }
        };
        let opening: Vec<f64> = of.sharing.axes.iter().map(opens).collect();
        let largest = opening.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if rate <= slow(of) && largest < -NONE * model.gravity_m_s2.norm() {
            let Aside { first, sharing, .. } = aside.remove(k);
            return Some(sharing.contacts(&first, at, &opening));
        }
    }
    None
}

/// Of all bodies, with the forces of these contacts; none: they are not known.
fn accelerations(
    model: &Model,
    state: &State,
    kept: &[Contact],
    gathered: &mut Gathered,
    work: &mut Work,
) -> Option<Vec<Twist>> {
    let leaves = |contact: &Contact| {
        let velocity = contact.velocity(|i| [state.bodies[i].v_WB, state.bodies[i].w_WB]);
        contact.normal.dot(&velocity) > NO_SLIP * meeting_m_s(model, state, contact.ends().map(|(i, ..)| i))
    };
    let rest = kept.iter().filter(|contact| !leaves(contact));
    let touches: Option<Vec<Touch>> = rest.map(|contact| Touch::new(model, state, contact)).collect();
    let Decision::Holds(held, solved) = decide(model, state, touches?, &Change::default(), gathered, work) else {
        return None;
    };
    if held.is_empty() {
        gathered.gather(model, state, std::iter::empty());
        return Some(gathered.free.clone());
    }
    Some((0..model.bodies.len()).map(|i| solved.acceleration(gathered, i)).collect())
}

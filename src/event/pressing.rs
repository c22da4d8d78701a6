//! Where a flat cap is pressed, and which points of its rim stand for it then (`caps`).
//!
//! A cap bears wherever its disc does: it stays flat until the centre of what presses it has come to its rim, and tips
//! over that point. Four points span a square of the disc alone. Where the centre comes near their border, they are
//! laid anew: two of them to either side of where it presses, the nearer to each other the nearer that is to the rim,
//! two opposite. In the end only the first two hold, and the cap tips over their chord, which is as good as the rim.
//! The centre moves along the rim while the cap tips, and they with it.

use super::caps::{Footing, POINTS, Rim, STAND, each_cap, relative, rim_side};
use super::decide::{Change, Margin, margin};
use super::flush::{is_one_base, seat};
use super::forces::{Gathered, Held, NO_SLIP, meeting_m_s};
use super::last_forces::LastForces;
use crate::collide::{Contact, Key};
use crate::model::Model;
use crate::shape::cylinder::rim_directions;
use crate::state::State;
use crate::work::Work;
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_4, PI};

/// Distance of the centre from the rim, over the radius, below which the points are laid about it: a square's sides
/// are at 1 − cos 45° = 0.29.
const NEAR_RIM: f64 = 0.3;

/// Of the root of that distance: the angle (rad) from the centre to either point, whose chord is then at 1/32 of it.
const BESIDE: f64 = 0.25;

/// The least such angle (rad): what tips over a chord at 1 − 5e-7 of the radius, tips over the rim.
const LEAST_RAD: f64 = 1e-3;

/// Of the least angle's sagitta: the centre has come to the chord.
const AT_CHORD: f64 = 1.001;

/// A cap's share of the largest force: less does not press.
const PRESSES: f64 = 1e-6;

/// A flat cap and what it stands on.
#[derive(Clone, Debug)]
struct CapOn {
    of: usize,
    base: Option<usize>,
    /// Of the container.
    face: u32,
    /// Number of its cap's first point.
    first: u32,
}

/// A flat cap, and the directions (body axes) of the four points that stand for it, from its centre.
#[derive(Clone, Debug)]
pub struct Laid {
    cap: CapOn,
    directions_B: [Vector3<f64>; 4],
}

/// A flat cap that is pressed near its rim.
#[derive(Clone, Debug)]
pub struct Pressed {
    cap: CapOn,
    /// From the centre of the cap (unit).
    toward_B: Vector3<f64>,
    /// The angle to either of the points about it.
    beside_rad: f64,
    /// It tips: the points opposite do not hold.
    tips: bool,
}

/// Flat caps of what is held that are pressed near their rims, as far as they tip or a point of theirs opens that
/// leaves fewer than three: what happens to others changes nothing of where a cap bears.
pub fn pressed(
    model: &Model,
    state: &State,
    (held, opening): (&[Held], &[(Key, Vector3<f64>)]),
    gathered: &mut Gathered,
    work: &mut Work,
) -> Vec<Pressed> {
    if !held.iter().any(|held| held.touch.standing(state).is_some_and(|of| of.is_on_rim(model))) {
        return Vec::new();
    }
    let rims: Vec<Option<Rim>> = held.iter().map(|held| Rim::of(model, &held.touch, state)).collect();
    let Margin { solved, .. } = margin(model, state, held, (gathered, &mut LastForces::default()), work);
    let forces = &solved.p;
    let largest = forces.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let mut seen = vec![false; held.len()];
    let mut pressed = Vec::new();
    for i in 0..held.len() {
        let Some(rim) = &rims[i] else { continue };
        if seen[i] || rim.toward_B().is_none() {
            continue;
        }
        let is_same = |j: &usize| {
            let touches = [&held[i].touch, &held[*j].touch];
            rims[*j].as_ref().is_some_and(|of| of.toward_B().is_some() && rim.is_same((model, state), touches, of))
        };
        let own: Vec<usize> = (i..held.len()).filter(is_same).collect();
        own.iter().for_each(|j| seen[*j] = true);
        let presses: f64 = own.iter().map(|j| forces[*j].x).sum();
        if own.len() < 2 || presses <= PRESSES * largest {
            continue;
        }
        let toward = |j: &usize| rims[*j].as_ref().and_then(Rim::toward_B).unwrap_or_default() * forces[*j].x;
        let centre_B = own.iter().map(toward).sum::<Vector3<f64>>() / presses;
        let inside = (1.0 - centre_B.norm()).max(0.0);
        let Some(toward_B) = centre_B.try_normalize(0.0).filter(|_| inside < NEAR_RIM) else { continue };
        let (key, of) = (held[i].touch.key(), rim.standing.of);
        let tips = own.len() == 2 || inside <= AT_CHORD * 0.5 * LEAST_RAD * LEAST_RAD;
        let opens = |j: &usize| opening.iter().any(|(key, _)| *key == held[*j].touch.key());
        let bears = |j: &&usize| forces[**j].x > PRESSES * presses && !opens(j);
        if !tips && (!own.iter().any(opens) || own.iter().filter(bears).count() > 2) {
            continue;
        }
        let base = held[i].touch.bodies().find(|body| *body != of);
        pressed.push(Pressed {
            cap: CapOn { of, base, face: key.2.0, first: rim.cap.first() },
            toward_B,
            beside_rad: (BESIDE * inside.sqrt()).max(LEAST_RAD),
            tips,
        });
    }
    pressed
}

/// Has every flat cap among what touches stand on four points: where it is pressed near its rim, about that; else the
/// first of them where it comes down, or, if it does not turn over, on those that stood for it before (`laid`), or that
/// are the body's own. Of pressed caps `change` then says what opens.
pub fn turn(
    model: &Model,
    state: &State,
    (found, laid): (&mut Vec<Contact>, &mut Vec<Laid>),
    (pressed, change): (&[Pressed], &mut Change),
) {
    let before = std::mem::take(laid);
    found.retain(|contact| Footing::of(model, state, contact).is_none_or(|footing| footing.node < POINTS));
    each_cap(model, state, found, |found, group, footing| {
        if group.len() < STAND {
            return false;
        }
        let first = found[group.start];
        let descent = -footing.normal.cross(&relative(footing, &|i| state.bodies[i].w_WB));
        let speed_m_s = meeting_m_s(model, state, first.ends().map(|(i, ..)| i));
        let turns = footing.cap.radius_m * descent.norm() > NO_SLIP * speed_m_s;
        let at = &state.bodies[footing.of];
        let along_B = if turns { at.q_WB.inverse_transform_vector(&descent).normalize() } else { Vector3::zeros() };
        let (face, node) = first.feature;
        let is_of = |cap: &CapOn| cap.is_of((model, state), footing.of, footing.base, (face, node));
        let pressed = pressed.iter().find(|of| is_of(&of.cap) && (!turns || of.tips));
        let stood = before.iter().find(|of| !turns && is_of(&of.cap)).map(|of| of.directions_B);
        let directions_B = pressed.map(Pressed::directions_B).or(stood).unwrap_or_else(|| rim_directions(&along_B));
        let cap = CapOn { of: footing.of, base: footing.base, face, first: footing.cap.first() };
        laid.push(Laid { cap, directions_B });
        let most = |of: fn(&Contact) -> f64| found[group.clone()].iter().map(of).fold(0.0, f64::max);
        let restitution = most(|contact| contact.restitution);
        let tangential_restitution = most(|contact| contact.tangential_restitution);
        let own = found[group.clone()].to_vec();
        for ((contact, u_B), node) in found[group.clone()].iter_mut().zip(directions_B).zip(0..) {
            let like = Contact { restitution, tangential_restitution, ..first };
            *contact = footing.point(state, &like, &u_B, node);
            seat(model, state, contact, &own);
        }
        if let Some(pressed) = pressed {
            pressed.follow(model, state, &found[group.start..group.start + 4], change);
        }
        false
    });
}

impl CapOn {
    /// Whether it is this cap's, of a contact with this base, or this face of the container.
    fn is_of(
        &self,
        (model, state): (&Model, &State),
        of: usize,
        base: Option<usize>,
        (face, node): (u32, u32),
    ) -> bool {
        let is_its_base = match (self.base, base) {
            (Some(own), Some(base)) => is_one_base(model, state, [own, base]),
            (None, None) => self.face == face && self.has(node),
            _ => false,
        };
        self.of == of && is_its_base
    }

    fn has(&self, node: u32) -> bool {
        node % POINTS / 4 * 4 == self.first
    }
}

impl Pressed {
    /// Directions of the four points, from the centre of the cap.
    fn directions_B(&self) -> [Vector3<f64>; 4] {
        let turned = |by_rad: f64| UnitQuaternion::from_axis_angle(&Vector3::y_axis(), by_rad) * self.toward_B;
        [self.beside_rad, -self.beside_rad, PI - FRAC_PI_4, PI + FRAC_PI_4].map(turned)
    }

    /// Leaves out of a change what it says of the points that stood for this cap before: nothing of it opens, but
    /// what is opposite to where it tips. `laid`: the four points that stand for it now.
    fn follow(&self, model: &Model, state: &State, laid: &[Contact], change: &mut Change) {
        let is_other = |(key, _): &(Key, Vector3<f64>)| {
            let (body, other, feature) = *key;
            let base = if body == self.cap.of { other } else { Some(body) };
            let of = if body == self.cap.of { Some(body) } else { other };
            let is_of_rim = other.is_none() || rim_side(feature).is_some();
            !(is_of_rim && of.is_some_and(|of| self.cap.is_of((model, state), of, base, feature)))
        };
        change.opening.retain(is_other);
        change.opened.retain(is_other);
        if self.tips {
            change.opening.extend(laid.iter().skip(2).map(|contact| (contact.key(), contact.p_WC)));
        }
    }
}

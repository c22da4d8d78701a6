//! Caps of cylinders on planes: faces of a container, and of other bodies under all of the cap. They lie flat, fall
//! flat and tip over their rim.
//!
//! A tilted cap touches in one point, which rolls along its rim. The direction to that point has no limit where the
//! tilt goes to zero, and so below `FLAT` the cap is a disc whose points are fixed in the body: every one of its rim
//! may bear, wherever it is. Four of them stand for it, the first where the cap comes down, and to those is added
//! whichever else would sink: a cap that tips does so over one point, in the direction of its tilt. A rim that falls
//! flat goes on about its last point, up to the moment when the cap is flat; then all of it strikes.

use super::decide::SAME;
use super::descent::Descent;
use super::flush::{is_one_base, seat};
use super::forces::{Held, meeting_m_s};
use super::shown::{ROLLS, shown};
use super::touch::{Standing, Touch};
use crate::collide::Contact;
use crate::collide::closed::{SOME, delta_m};
use crate::integrate::rotation::exponential;
use crate::model::{Body, Geometry, Model};
use crate::shape::cylinder::{ARC, FACE, FLAT, RIM, kind, middle_of_arc};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Of `FLAT`: a rim that falls flat is a point of the body from here on, and one that tips is a rim from here on; what
/// is found between them is either (`shown::ROLLS`).
const LANDS: f64 = 1.5;
const TIPS: f64 = 2.0;

/// Beyond flat, in rad: so much is rounding.
const BEYOND: f64 = 1e-15;

/// A tilt (rad) that is none: rounding of a turn.
const LEVEL: f64 = 2e-16;

/// Of the time in which a rim would be flat: a step's part.
const BEFORE_FLAT: f64 = 0.9;

/// Accelerations that turn a cap over, of those without contact: less is rounding of what the law leaves.
pub const TIPS_AT_LEAST: f64 = 1e-9;

/// A point of the rim that sinks slower, of the speed of the bodies, does not.
const SINKS: f64 = 1e-12;

/// A tilt (rad) of two caps to which the contact test's normal is that of both.
const LYING: f64 = 1e-4;

/// Points that stand for a flat cap.
pub(super) const STAND: usize = 4;

/// Points that are tried of a cap that may stay flat.
const FLAT_TRIES: u32 = 4;

/// Points of the contact test: of either cap four.
pub(super) const POINTS: u32 = 8;

/// The cap of a cylinder that faces a plane.
pub struct Cap {
    first: u32,
    pub(super) centre_B: Vector3<f64>,
    out_B: Vector3<f64>,
    pub(super) radius_m: f64,
}

impl Cap {
    /// None: the body has no caps.
    pub fn facing(body: &Body, at: &BodyState, normal: &Vector3<f64>) -> Option<Self> {
        let Geometry::Solid { solid: Solid::Cylinder { radius_m, half_height_m }, centre } = &body.geometry else {
            return None;
        };
        let below = at.q_WB.inverse_transform_vector(normal).y > 0.0;
        let (first, out_B) = if below { (0, -Vector3::y()) } else { (4, Vector3::y()) };
        Some(Cap { first, centre_B: centre + out_B * *half_height_m, out_B, radius_m: *radius_m })
    }

    /// Toward the lowest point of the rim, as long as the sine of the tilt.
    pub(super) fn lean_W(&self, at: &BodyState, normal: &Vector3<f64>) -> Vector3<f64> {
        let out = at.q_WB * self.out_B;
        out * out.dot(normal) - normal
    }

    /// Of its points, against the normal: of the centre, and at most more toward some point of the rim.
    pub fn rates(&self, at: &BodyState, normal: &Vector3<f64>) -> (f64, f64) {
        let rate = normal.dot(&(at.v_WB + at.w_WB.cross(&(at.q_WB * self.centre_B))));
        (rate, self.radius_m * normal.cross(&at.w_WB).norm())
    }

    /// From the centre of mass to its centre, world axes; and how far below that, along a normal, its lowest point is.
    pub fn reach(&self, at: &BodyState, normal: &Vector3<f64>) -> (Vector3<f64>, f64) {
        (at.q_WB * self.centre_B, self.radius_m * self.lean_W(at, normal).norm())
    }

    pub fn is_flat(&self, at: &BodyState, normal: &Vector3<f64>) -> bool {
        self.lean_W(at, normal).norm() <= FLAT
    }

    /// Whether it is tilted by so much that it stands on the lowest point of its rim, which rolls.
    pub(super) fn rolls(&self, at: &BodyState, normal: &Vector3<f64>) -> bool {
        self.lean_W(at, normal).norm() > ROLLS
    }

    /// Number of its first point.
    pub fn first(&self) -> u32 {
        self.first
    }

    pub fn has(&self, node: u32) -> bool {
        node % POINTS / 4 * 4 == self.first
    }

    /// Turns the body so that it is flat, its lowest point as high as it is, or not inside.
    fn level(&self, at: &mut BodyState, normal: &Vector3<f64>, lowest_m: f64) {
        let (arm_W, sagitta_m) = self.reach(at, normal);
        let turn = (at.q_WB * self.out_B).cross(&-normal);
        at.q_WB = exponential(&turn) * at.q_WB;
        at.q_WB.renormalize();
        at.p_WB += arm_W - at.q_WB * self.centre_B - normal * (sagitta_m + lowest_m.min(0.0));
    }

    /// How its rim comes down to a plane that does not move.
    pub fn descent_on_plane(&self, at: &BodyState, normal: &Vector3<f64>) -> Descent {
        self.descent([at, &BodyState { v_WB: Vector3::zeros(), w_WB: Vector3::zeros(), ..*at }], normal)
    }

    /// How its rim comes down to a plane of the other body.
    pub(super) fn descent(&self, [at, other]: [&BodyState; 2], normal: &Vector3<f64>) -> Descent {
        let centre_W = at.p_WB + at.q_WB * self.centre_B;
        let velocity = |of: &BodyState| of.v_WB + of.w_WB.cross(&(centre_W - of.p_WB));
        Descent {
            radius_m: self.radius_m,
            centre_m_s: normal.dot(&(velocity(at) - velocity(other))),
            lean: self.lean_W(at, normal),
            leaning_rad_s: (at.w_WB - other.w_WB).cross(normal),
        }
    }

    /// It has a tilt, but is flat.
    fn is_nearly_level(&self, at: &BodyState, normal: &Vector3<f64>) -> bool {
        (LEVEL..=FLAT).contains(&self.lean_W(at, normal).norm())
    }
}

/// Puts what is flat to `FLAT` and touches flat to rounding, so that all of it touches: on a container, where its
/// lowest point is none of the contact test's.
pub fn level(model: &Model, state: &mut State) {
    let Some(container) = &model.container else { return };
    for (body, at) in model.bodies.iter().zip(&mut state.bodies).filter(|(body, _)| body.feels_container()) {
        for face in &container.faces {
            let Some(cap) = Cap::facing(body, at, &face.normal) else { continue };
            let (arm_W, sagitta_m) = cap.reach(at, &face.normal);
            let lowest_m = face.gap_m(&(at.p_WB + arm_W)) - sagitta_m;
            let delta_m = delta_m(body.bounding_radius_m, at.p_WB.amax() + body.bounding_radius_m);
            if cap.is_nearly_level(at, &face.normal) && lowest_m <= SOME * delta_m {
                cap.level(at, &face.normal, lowest_m);
            }
        }
    }
}

/// The same of what touches, on other bodies too, and where all four points of a cap that is next to flat are closed.
/// False: nothing had to be moved.
pub fn level_found(model: &Model, state: &mut State, found: &[Contact]) -> bool {
    let mut moved = false;
    for contact in found {
        let Some(Footing { of, base, normal, cap, .. }) = Footing::within(model, state, contact, ROLLS) else {
            continue;
        };
        if model.bodies[of].driven {
            continue;
        }
        let own = |base: usize, d: Vector3<f64>| state.bodies[base].q_WB.inverse_transform_vector(&d);
        let normal = match base {
            None => Some(normal),
            Some(base) => {
                let p_B = own(base, contact.p_WC - state.bodies[base].p_WB);
                let facing = shown(&model.bodies[base], &p_B, &own(base, normal), contact.gap_m);
                facing.and_then(|facing| facing.face).map(|face| state.bodies[base].q_WB * face.normal_B)
            }
        };
        let Some(normal) = normal else { continue };
        let tilt = cap.lean_W(&state.bodies[of], &normal).norm();
        let closed = || found.iter().filter(|other| is_same_cap(model, state, [contact, *other])).count();
        if (LEVEL..=FLAT).contains(&tilt) || ((FLAT..=ROLLS).contains(&tilt) && closed() >= 4) {
            let own = found.iter().filter(|other| is_same_cap(model, state, [contact, *other]));
            let lowest_m = own.map(|contact| contact.gap_m).fold(f64::INFINITY, f64::min);
            cap.level(&mut state.bodies[of], &normal, lowest_m);
            moved = true;
        }
    }
    moved
}

/// The normal, from the second of two bodies to the first, of a point of a rim on another cap: that one's. The
/// contact test has one for both of them, which are tilted against each other by as little as tells whether the rim
/// rolls. None: something else touches.
pub fn cap_under_rim_W(
    bodies: [(&Body, &BodyState); 2],
    feature: (u32, u32),
    normal: &Vector3<f64>,
) -> Option<Vector3<f64>> {
    let of_base = |side: u32| if side == 0 { feature.1 } else { feature.0 };
    let of_rim = rim_side(feature).filter(|side| of_base(*side) == FACE);
    let of_arc = || middle_of_arc(feature).filter(|side| kind(of_base(*side)) == ARC);
    let side = of_rim.or_else(of_arc)?;
    let ((body, at), sign) = if side == 0 { (bodies[1], 1.0) } else { (bodies[0], -1.0) };
    let inward = normal * -sign;
    let cap = Cap::facing(body, at, &inward)?;
    (cap.lean_W(at, &inward).norm() <= LYING).then(|| at.q_WB * cap.out_B * sign)
}

/// Gives all that stands so its normal.
pub fn along_caps(model: &Model, state: &State, found: &mut [Contact]) {
    for contact in found {
        let Some(bodies) = contact.both(model, state) else { continue };
        contact.normal = cap_under_rim_W(bodies, contact.feature, &contact.normal).unwrap_or(contact.normal);
    }
}

/// Of the size of a body: the middle of an arc of its rim is the lowest point again, so near to that.
const AGAIN: f64 = 0.1;

/// A rim that rolls, of the first or second body, with its lowest point: next to that, the middle of an arc is the same
/// point again and would stay behind, so that it is neither found nor watched.
#[derive(Clone, Copy)]
pub struct RollingRim {
    side: u32,
    p_W: Vector3<f64>,
    near_m: f64,
}

impl RollingRim {
    /// None: that is no lowest point of a rim that rolls.
    pub fn new(
        bodies: [(&Body, &BodyState); 2],
        feature: (u32, u32),
        (p_W, normal): (&Vector3<f64>, &Vector3<f64>),
    ) -> Option<Self> {
        let side = rim_side(feature)?;
        let (body, at) = bodies[side as usize];
        let normal = if side == 0 { *normal } else { -normal };
        let cap = Cap::facing(body, at, &normal)?;
        cap.rolls(at, &normal).then_some(RollingRim { side, p_W: *p_W, near_m: AGAIN * body.bounding_radius_m })
    }

    /// Whether a point is its lowest one again.
    pub fn has(&self, feature: (u32, u32), p_W: &Vector3<f64>) -> bool {
        middle_of_arc(feature) == Some(self.side) && (p_W - self.p_W).norm() <= self.near_m
    }
}

/// Leaves out the middles of arcs of rims that roll, beside their lowest points.
pub fn leave_arcs(model: &Model, state: &State, found: &mut Vec<Contact>) {
    let rolls = |contact: &Contact| {
        let at = (&contact.p_WC, &contact.normal);
        let rolling = RollingRim::new(contact.both(model, state)?, contact.feature, at)?;
        Some((contact.body, contact.other, rolling))
    };
    let all: Vec<_> = found.iter().filter_map(rolls).collect();
    found.retain(|contact| {
        let of_pair =
            |(body, other, _): &&(usize, Option<usize>, RollingRim)| (*body, *other) == (contact.body, contact.other);
        !all.iter().filter(of_pair).any(|(.., rolling)| rolling.has(contact.feature, &contact.p_WC))
    });
}

/// A flat cap that a contact is of.
pub(super) struct Footing {
    pub(super) of: usize,
    pub(super) base: Option<usize>,
    /// From the base.
    pub(super) normal: Vector3<f64>,
    pub(super) cap: Cap,
    /// Of the contact's point.
    pub(super) node: u32,
}

impl Footing {
    pub(super) fn of(model: &Model, state: &State, contact: &Contact) -> Option<Self> {
        Footing::within(model, state, contact, FLAT)
    }

    /// Of a cap that is tilted by no more.
    fn within(model: &Model, state: &State, contact: &Contact, most_rad: f64) -> Option<Self> {
        let on = |of: usize, base: Option<usize>, normal: Vector3<f64>, node: u32| {
            let cap = Cap::facing(&model.bodies[of], &state.bodies[of], &normal)?;
            let is_flat = cap.lean_W(&state.bodies[of], &normal).norm() <= most_rad;
            (is_flat && (base.is_some() || cap.has(node))).then_some(Footing { of, base, normal, cap, node })
        };
        match (contact.other, rim_side(contact.feature)) {
            (None, _) => on(contact.body, None, contact.normal, contact.feature.1),
            (Some(other), Some(0)) => on(contact.body, Some(other), contact.normal, contact.feature.0 - RIM),
            (Some(other), Some(_)) => on(other, Some(contact.body), -contact.normal, contact.feature.1 - RIM),
            (Some(_), None) => None,
        }
    }

    /// The same contact at another point of the rim.
    pub(super) fn point(&self, state: &State, like: &Contact, u_B: &Vector3<f64>, node: u32) -> Contact {
        let at = &state.bodies[self.of];
        let arm_W = |u_B: &Vector3<f64>| at.q_WB * (self.cap.centre_B + u_B * self.cap.radius_m);
        let r_W = arm_W(u_B);
        let p_WC = at.p_WB + r_W;
        match like.other {
            None => {
                let feature = (like.feature.0, node + self.cap.first);
                // As high as the other one: it is flat.
                let gap_m = like.gap_m + self.normal.dot(&(p_WC - like.p_WC));
                Contact { feature, r_BC_W: r_W, p_WC, gap_m, ..*like }
            }
            Some(other) => {
                let feature =
                    if self.of == like.body { (RIM | node, like.feature.1) } else { (like.feature.0, RIM | node) };
                let [r_BC_W, r_OC_W] = [like.body, other].map(|i| p_WC - state.bodies[i].p_WB);
                Contact { feature, r_BC_W, r_OC_W, p_WC, ..*like }
            }
        }
    }
}

/// Whether two contacts of one pair are points of one rim, by their features.
pub fn are_of_one_rim(a: (u32, u32), b: (u32, u32)) -> bool {
    rim_side(a).is_some_and(|side| rim_side(b) == Some(side))
}

/// Which side's rim a contact of a pair is a point of.
pub(super) fn rim_side(feature: (u32, u32)) -> Option<u32> {
    let is_rim = |feature: u32| kind(feature) == RIM;
    match feature {
        (feature, _) if is_rim(feature) => Some(0),
        (_, feature) if is_rim(feature) => Some(1),
        _ => None,
    }
}

/// Whether two contacts are points of one cap, on one plane.
fn is_same_cap(model: &Model, state: &State, contacts: [&Contact; 2]) -> bool {
    let of = |contact: &Contact| {
        let Some(other) = contact.other else {
            return (contact.body, None, (contact.feature.0, Some(contact.feature.1 % POINTS / 4)));
        };
        match rim_side(contact.feature) {
            Some(1) => (other, Some(contact.body), (0, Some(1))),
            side => (contact.body, Some(other), (0, side.map(|_| 1))),
        }
    };
    let [(top_a, base_a, part_a), (top_b, base_b, part_b)] = contacts.map(of);
    let is_one_base = match (base_a, base_b) {
        (Some(a), Some(b)) => is_one_base(model, state, [a, b]),
        (a, b) => a == b,
    };
    top_a == top_b && part_a == part_b && is_one_base
}

/// Calls `visit` for all that touches of flat caps, cap by cap: where its contacts begin and end, what it stands on.
pub(super) fn each_cap(
    model: &Model,
    state: &State,
    found: &mut Vec<Contact>,
    mut visit: impl FnMut(&mut Vec<Contact>, std::ops::Range<usize>, &Footing) -> bool,
) -> bool {
    let mut from = 0;
    while from < found.len() {
        let first = found[from];
        let len = found[from..].iter().take_while(|other| is_same_cap(model, state, [&first, *other])).count();
        if let Some(footing) = Footing::of(model, state, &first)
            && visit(found, from..from + len, &footing)
        {
            return true;
        }
        from += len;
    }
    false
}

pub(super) fn relative(footing: &Footing, of: &impl Fn(usize) -> Vector3<f64>) -> Vector3<f64> {
    of(footing.of) - footing.base.map_or_else(Vector3::zeros, of)
}

/// Velocities, or accelerations, of a body's points: of the one at an arm from its centre of mass (world axes), and of
/// its rotation.
pub type Rates = [Vector3<f64>; 2];

/// Velocities of a body in a state.
pub fn velocities(state: &State, i: usize, arm_W: &Vector3<f64>) -> Rates {
    let at = &state.bodies[i];
    [at.v_WB + at.w_WB.cross(arm_W), at.w_WB]
}

/// What is no velocity of a point that sinks.
pub fn sinks_m_s(model: &Model, state: &State, contact: &Contact) -> f64 {
    SINKS * meeting_m_s(model, state, contact.ends().map(|(i, ..)| i))
}

/// Which point of each flat cap's rim bears beside those that stand for it: the one that would sink. It bears where
/// its own push leaves it the lowest, a root of one angle.
#[derive(Default)]
pub struct Sinking {
    of: Vec<Search>,
}

struct Search {
    body: usize,
    feature: (Option<usize>, u32),
    tries: u32,
    /// The points that stood for the cap, where the one that is tried bears alone.
    stood: Option<Vec<Contact>>,
    /// Angles of the point tried, with the angles from there to the one that then sinks: to either side, and the last.
    above: Option<[f64; 2]>,
    below: Option<[f64; 2]>,
    tried_rad: Option<f64>,
}

impl Search {
    /// A cap may stay flat, on three points of those that stand for it and the one that is tried; else it tips about
    /// one, which then bears alone.
    fn tips(&mut self, group: &[Contact]) {
        self.tries += 1;
        if self.tries > FLAT_TRIES && self.stood.is_none() {
            (self.above, self.below, self.tried_rad) = (None, None, None);
            self.stood = Some(group.to_vec());
        }
    }

    /// The next angle to try, where the point at `sinks_rad` sinks.
    fn tried(&mut self, sinks_rad: f64) -> f64 {
        let next_rad = self.next_rad(sinks_rad);
        self.tried_rad = Some(next_rad);
        next_rad
    }

    fn next_rad(&mut self, sinks_rad: f64) -> f64 {
        let Some(tried_rad) = self.tried_rad else { return sinks_rad };
        let off_rad = (sinks_rad - tried_rad + PI).rem_euclid(2.0 * PI) - PI;
        let (side, other) =
            if off_rad > 0.0 { (&mut self.below, &mut self.above) } else { (&mut self.above, &mut self.below) };
        // The rule of the false position that does not stay on one side ("Illinois").
        if side.replace([tried_rad, off_rad]).is_some()
            && let Some([_, off]) = other
        {
            *off /= 2.0;
        }
        match (self.below, self.above) {
            (Some([below_rad, less]), Some([above_rad, more])) => {
                let apart = (above_rad - below_rad + PI).rem_euclid(2.0 * PI) - PI;
                below_rad + apart * less / (less - more)
            }
            _ => sinks_rad,
        }
    }
}

impl Sinking {
    /// Puts the point of a flat cap's rim that sinks faster than `least` to what touches; false: none does. `bears`:
    /// caps are looked at of which so many contacts do.
    pub fn add(
        &mut self,
        model: &Model,
        state: &State,
        found: &mut Vec<Contact>,
        (most, bears): (usize, impl Fn(&Contact) -> bool),
        (rates, least): (impl Fn(usize, &Vector3<f64>) -> Rates, impl Fn(&Contact) -> f64),
    ) -> bool {
        each_cap(model, state, found, |found, group, footing| {
            let first = found[group.start];
            let of_cap = &found[group.clone()];
            let search = self.search(model, &first, footing);
            let may_bear = group.len() >= STAND && of_cap.iter().filter(|contact| bears(contact)).count() >= most;
            if search.stood.is_none() && !may_bear {
                return false;
            }
            let (cap, at) = (&footing.cap, &state.bodies[footing.of]);
            let p_W = at.p_WB + at.q_WB * cap.centre_B;
            let of = |k: usize| relative(footing, &|i: usize| rates(i, &(p_W - state.bodies[i].p_WB))[k]);
            let descent = -footing.normal.cross(&of(1));
            if footing.normal.dot(&of(0)) - cap.radius_m * descent.norm() >= -least(&first) {
                return false;
            }
            let d_B = at.q_WB.inverse_transform_vector(&descent);
            search.tips(&found[group.clone()]);
            let angle_rad = search.tried(libm::atan2(d_B.x, d_B.z));
            let stood = search.stood.clone();
            let u_B = Vector3::new(libm::sin(angle_rad), 0.0, libm::cos(angle_rad));
            let mut point = footing.point(state, &first, &u_B, POINTS);
            seat(model, state, &mut point, stood.as_deref().unwrap_or(&found[group.clone()]));
            if stood.is_some() {
                found.splice(group, [point]);
                return true;
            }
            let own = |contact: &Contact| contact.feature.0.max(contact.feature.1);
            let is_it = |contact: &Contact| match point.other {
                None => contact.feature == point.feature,
                Some(_) => own(contact) == own(&point),
            };
            match found[group.clone()].iter().position(is_it) {
                Some(k) => found[group.start + k] = point,
                None => found.insert(group.end, point),
            }
            true
        })
    }

    fn search(&mut self, model: &Model, contact: &Contact, footing: &Footing) -> &mut Search {
        // Of bodies that do not move the point may come to another one.
        let base = footing.base.map(|base| if model.bodies[base].driven { usize::MAX } else { base });
        let (body, feature) = (footing.of, (base, if base.is_none() { contact.feature.0 } else { footing.cap.first }));
        let k = self.of.iter().position(|search| search.body == body && search.feature == feature);
        let k = k.unwrap_or_else(|| {
            self.of.push(Search { body, feature, tries: 0, stood: None, above: None, below: None, tried_rad: None });
            self.of.len() - 1
        });
        &mut self.of[k]
    }
}

/// A rim that stands on a plane.
pub(super) struct Rim {
    pub(super) cap: Cap,
    pub(super) standing: Standing,
}

impl Rim {
    pub(super) fn of(model: &Model, touch: &Touch, state: &State) -> Option<Self> {
        let standing = touch.standing(state)?;
        let cap = Cap::facing(&model.bodies[standing.of], &state.bodies[standing.of], &standing.normal_W)?;
        Some(Rim { cap, standing })
    }

    pub(super) fn is_same(&self, (model, state): (&Model, &State), [own, touch]: [&Touch; 2], other: &Rim) -> bool {
        let base = |touch: &Touch, rim: &Rim| touch.bodies().find(|i| *i != rim.standing.of);
        let is_on_one = match (base(own, self), base(touch, other)) {
            (Some(a), Some(b)) => is_one_base(model, state, [a, b]),
            (None, None) => own.key().2.0 == touch.key().2.0,
            _ => false,
        };
        is_on_one && self.standing.of == other.standing.of && self.cap.first == other.cap.first
    }

    /// Direction from the cap's centre to a point of the body on its rim.
    pub(super) fn toward_B(&self) -> Option<Vector3<f64>> {
        let from_B = self.standing.corner_B? - self.cap.centre_B;
        let out = from_B - self.cap.out_B * self.cap.out_B.dot(&from_B);
        ((out.norm() - self.cap.radius_m).abs() <= 1e-6 * self.cap.radius_m).then(|| out.normalize())
    }
}

/// A rim has come to lie flat, or a cap to tip.
pub fn has_turned(model: &Model, held: &[Held], state: &State) -> bool {
    let rim = |held: &Held| Rim::of(model, &held.touch, state);
    held.iter().any(|own| {
        let Some(of_own) = rim(own) else { return false };
        let at = &state.bodies[of_own.standing.of];
        let lean = of_own.cap.lean_W(at, &of_own.standing.normal_W);
        if of_own.standing.corner_B.is_none() {
            return lean.norm() < LANDS * FLAT;
        }
        let Some(toward_B) = of_own.toward_B() else { return false };
        if lean.norm() <= TIPS * FLAT && lean.dot(&(at.q_WB * toward_B)) >= -BEYOND {
            return false;
        }
        let same = |other: &Held| {
            let of = rim(other).filter(|of| of_own.is_same((model, state), [&own.touch, &other.touch], of))?;
            of.toward_B()
        };
        let others: Vec<Vector3<f64>> = held.iter().filter_map(same).collect();
        let is_new = |(i, d): (usize, &Vector3<f64>)| others[..i].iter().all(|other| (other - d).norm() > SAME);
        // Three of its points hold a cap flat.
        others.iter().enumerate().filter(|of| is_new(*of)).count() < 3
    })
}

/// The longest step in which no rim falls flat.
pub fn longest_s(model: &Model, held: &[Held], state: &State) -> f64 {
    let until_flat_s = |held: &Held| {
        let Rim { cap, standing } = Rim::of(model, &held.touch, state)?;
        if standing.corner_B.is_some() {
            return None;
        }
        let at = &state.bodies[standing.of];
        let (lean, out) = (cap.lean_W(at, &standing.normal_W), at.q_WB * cap.out_B);
        let out_rate = at.w_WB.cross(&out);
        let rising = lean.dot(&(out_rate * out.dot(&standing.normal_W) - standing.normal_rate_W));
        (rising < 0.0).then(|| BEFORE_FLAT * lean.norm_squared() / -rising)
    };
    held.iter().filter_map(until_flat_s).fold(f64::INFINITY, f64::min)
}

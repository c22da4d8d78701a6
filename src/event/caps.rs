//! Caps of cylinders on the faces of a container: that lie flat, fall flat and tip over their rim.
//!
//! A tilted cap touches in one point, which rolls along its rim. The direction to that point has no limit where the
//! tilt goes to zero, and so below `FLAT` the cap is a disc whose points are fixed in the body: every one of its rim
//! may bear, wherever it is. Four of them stand for it, the first where the cap comes down, and to those is added
//! whichever else would sink, until none does: a cap that tips does so over one point, in the direction of its tilt.
//! A rim that falls flat goes on about its last point, up to the moment when the cap is flat; then all of it strikes.

use super::forces::{Held, NO_SLIP, speed_m_s};
use super::touch::{Standing, Touch};
use crate::collide::Contact;
use crate::collide::closed::{SOME, delta_m, is_closed_to_delta};
use crate::integrate::rotation::exponential;
use crate::model::{Body, Geometry, Model};
use crate::shape::cylinder::{FLAT, rim_directions};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Of `FLAT`: a rim that falls flat is a point of the body from here on, and one that tips is a rim from here on; what
/// is found between them is either (`touch::ROLLS`).
const LANDS: f64 = 1.5;
const TIPS: f64 = 2.0;

/// Beyond flat, in rad: so much is rounding.
const BEYOND: f64 = 1e-15;

/// A tilt (rad) that is none: rounding of a turn.
const LEVEL: f64 = 2e-16;

/// Of the time in which a rim would be flat: a step's part.
const BEFORE_FLAT: f64 = 0.9;

/// A point of the rim that sinks slower, of the speed of the body, does not.
const SINKS: f64 = 1e-12;

/// Accelerations that turn a cap over, of those without contact: less is rounding of what the law leaves.
pub const TIPS_AT_LEAST: f64 = 1e-9;

/// Points of a container's contact test: of either cap four.
const POINTS: u32 = 8;

/// The cap of a cylinder that faces a plane.
pub struct Cap {
    first: u32,
    centre_B: Vector3<f64>,
    out_B: Vector3<f64>,
    radius_m: f64,
}

impl Cap {
    /// None: the body has no caps.
    pub fn facing(body: &Body, at: &BodyState, normal: &Vector3<f64>) -> Option<Self> {
        let below = at.q_WB.inverse_transform_vector(normal).y > 0.0;
        Cap::of(body, if below { 0 } else { 4 })
    }

    /// By the number of a contact's point.
    fn of(body: &Body, node: u32) -> Option<Self> {
        let Geometry::Solid { solid: Solid::Cylinder { radius_m, half_height_m }, centre } = &body.geometry else {
            return None;
        };
        let first = node % POINTS / 4 * 4;
        let out_B = if first == 0 { -Vector3::y() } else { Vector3::y() };
        Some(Cap { first, centre_B: centre + out_B * *half_height_m, out_B, radius_m: *radius_m })
    }

    /// Toward the lowest point of the rim, as long as the sine of the tilt.
    fn lean_W(&self, at: &BodyState, normal: &Vector3<f64>) -> Vector3<f64> {
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

    pub fn first(&self) -> u32 {
        self.first
    }

    pub fn has(&self, node: u32) -> bool {
        node % POINTS / 4 * 4 == self.first
    }
}

/// Puts what is flat to `FLAT` and touches flat to rounding, so that all of it touches.
pub fn level(model: &Model, state: &mut State) {
    let Some(container) = &model.container else { return };
    for (body, at) in model.bodies.iter().zip(&mut state.bodies).filter(|(body, _)| body.feels_container()) {
        for face in &container.faces {
            let Some(cap) = Cap::facing(body, at, &face.normal) else { continue };
            let (arm, sagitta_m) = cap.reach(at, &face.normal);
            let lowest_m = face.gap_m(&(at.p_WB + arm)) - sagitta_m;
            let delta_m = delta_m(body.bounding_radius_m, at.p_WB.amax() + body.bounding_radius_m);
            if !cap.is_flat(at, &face.normal) || sagitta_m <= LEVEL * cap.radius_m || lowest_m > SOME * delta_m {
                continue;
            }
            let turn = (at.q_WB * cap.out_B).cross(&-face.normal);
            at.q_WB = exponential(&turn) * at.q_WB;
            at.q_WB.renormalize();
            at.p_WB += arm - at.q_WB * cap.centre_B - face.normal * sagitta_m;
        }
    }
}

/// Has every flat cap among what touches stand on four points, the first of them where it comes down, or, if it does
/// not turn over, on those that are the body's own.
pub fn turn(model: &Model, state: &State, found: &mut Vec<Contact>) {
    found.retain(|contact| Cap::of_contact(model, contact).is_none() || contact.feature.1 < POINTS);
    let mut from = 0;
    while from < found.len() {
        let len = found[from..].iter().take_while(|other| is_same_cap(&found[from], other)).count();
        if let Some(cap) = flat(model, state, &found[from]) {
            let (first, body) = (found[from], &model.bodies[found[from].body]);
            let (at, normal) = (&state.bodies[first.body], first.normal);
            let descent = -normal.cross(&at.w_WB);
            let turns = cap.radius_m * descent.norm() > NO_SLIP * speed_m_s(model, body, at);
            let along_B = if turns { at.q_WB.inverse_transform_vector(&descent) } else { Vector3::zeros() };
            let group = &found[from..from + len];
            let most = |of: fn(&Contact) -> f64| group.iter().map(of).fold(0.0, f64::max);
            let (restitution, tangential_restitution) =
                (most(|contact| contact.restitution), most(|contact| contact.tangential_restitution));
            let all = rim_directions(&along_B.normalize_or_zero()).into_iter().zip(cap.first..).map(|(u_B, node)| {
                let at = Contact { restitution, tangential_restitution, ..first };
                cap.point(model, state, &at, &u_B, node)
            });
            found.splice(from..from + len, all.collect::<Vec<_>>());
            from += 4;
        } else {
            from += len;
        }
    }
}

/// The flat cap that a contact with the container is of.
fn flat(model: &Model, state: &State, contact: &Contact) -> Option<Cap> {
    let cap = Cap::of_contact(model, contact)?;
    let (at, normal) = (&state.bodies[contact.body], &contact.normal);
    let faces = (at.q_WB * cap.out_B).dot(normal) < 0.0;
    (faces && cap.is_flat(at, normal) && is_closed_to_delta(model, contact)).then_some(cap)
}

fn is_same_cap(a: &Contact, b: &Contact) -> bool {
    let of = |contact: &Contact| (contact.body, contact.other, contact.feature.0, contact.feature.1 % POINTS / 4);
    of(a) == of(b)
}

/// What falls flat has lost its restitution where all that come nearer have: what rests on one point of a rim and
/// strikes with the others rocks on without it.
pub fn lose_restitution(model: &Model, found: &mut [Contact], approaches: impl Fn(&Contact) -> bool) {
    let mut from = 0;
    while from < found.len() {
        let first = found[from];
        let len = found[from..].iter().take_while(|other| is_same_cap(&first, other)).count();
        let group = &mut found[from..from + len];
        let mut coming = group.iter().filter(|contact| approaches(contact)).peekable();
        let any = coming.peek().is_some();
        if Cap::of_contact(model, &first).is_some() && any && coming.all(|contact| contact.restitution == 0.0) {
            group.iter_mut().for_each(|contact| contact.restitution = 0.0);
        }
        from += len;
    }
}

trait NormalizeOrZero {
    fn normalize_or_zero(&self) -> Vector3<f64>;
}

impl NormalizeOrZero for Vector3<f64> {
    fn normalize_or_zero(&self) -> Vector3<f64> {
        self.try_normalize(0.0).unwrap_or_else(Vector3::zeros)
    }
}

impl Cap {
    fn of_contact(model: &Model, contact: &Contact) -> Option<Self> {
        if contact.other.is_some() {
            return None;
        }
        Cap::of(&model.bodies[contact.body], contact.feature.1)
    }

    /// The same contact at another point of the rim.
    fn point(&self, model: &Model, state: &State, like: &Contact, u_B: &Vector3<f64>, node: u32) -> Contact {
        let at = &state.bodies[like.body];
        let r_BC_W = at.q_WB * (self.centre_B + u_B * self.radius_m);
        let p_WC = at.p_WB + r_BC_W;
        let face = model.container.as_ref().map(|container| container.faces[like.feature.0 as usize]);
        let gap_m = face.map_or(like.gap_m, |face| face.gap_m(&p_WC));
        Contact { feature: (like.feature.0, node), r_BC_W, p_WC, gap_m, ..*like }
    }
}

/// Velocities, or accelerations, of all points of a body.
pub struct Rates {
    /// Of the point at the arm asked for.
    pub at_arm: Vector3<f64>,
    pub turning: Vector3<f64>,
    /// What is less than this is rounding.
    pub least: f64,
}

impl Rates {
    /// Velocities in a state, by a body's index and an arm from its centre of mass.
    pub fn velocities(model: &Model, state: &State, i: usize, arm_W: &Vector3<f64>) -> Self {
        let at = &state.bodies[i];
        Rates {
            at_arm: at.v_WB + at.w_WB.cross(arm_W),
            turning: at.w_WB,
            least: SINKS * speed_m_s(model, &model.bodies[i], at),
        }
    }
}

/// Which point of each flat cap's rim bears beside those that stand for it: the one that would sink. It bears where
/// its own push leaves it the lowest, a root of one angle.
#[derive(Default)]
pub struct Sinking {
    of: Vec<Search>,
}

struct Search {
    body: usize,
    feature: (u32, u32),
    /// Angles of the point tried, with the angles from there to the one that then sinks: to either side, and the last.
    above: Option<[f64; 2]>,
    below: Option<[f64; 2]>,
    tried_rad: Option<f64>,
}

impl Search {
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
        // A. M. Ostrowski's rule of the false position that does not stay on one side ("Illinois").
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
    /// Puts the point of a flat cap's rim that sinks to what touches; false: none does. `bears`: caps are looked at of
    /// which so many contacts do.
    pub fn add(
        &mut self,
        model: &Model,
        state: &State,
        found: &mut Vec<Contact>,
        (least, bears): (usize, impl Fn(&Contact) -> bool),
        rates: impl Fn(usize, &Vector3<f64>) -> Rates,
    ) -> bool {
        let mut from = 0;
        while from < found.len() {
            let first = found[from];
            let len = found[from..].iter().take_while(|other| is_same_cap(&first, other)).count();
            let group = &found[from..from + len];
            if let Some(cap) = flat(model, state, &first)
                && group.iter().filter(|contact| bears(contact)).count() >= least
            {
                let at = &state.bodies[first.body];
                let Rates { at_arm, turning, least } = rates(first.body, &(at.q_WB * cap.centre_B));
                let descent = -first.normal.cross(&turning);
                if first.normal.dot(&at_arm) - cap.radius_m * descent.norm() < -least {
                    let d_B = at.q_WB.inverse_transform_vector(&descent);
                    let angle_rad = self.search(&first, &cap).tried(libm::atan2(d_B.x, d_B.z));
                    let u_B = Vector3::new(libm::sin(angle_rad), 0.0, libm::cos(angle_rad));
                    let point = cap.point(model, state, &first, &u_B, cap.first + POINTS);
                    match group.iter().position(|contact| contact.feature.1 == point.feature.1) {
                        Some(k) => found[from + k] = point,
                        None => found.insert(from + len, point),
                    }
                    return true;
                }
            }
            from += len;
        }
        false
    }

    fn search(&mut self, contact: &Contact, cap: &Cap) -> &mut Search {
        let (body, feature) = (contact.body, (contact.feature.0, cap.first));
        let k = self.of.iter().position(|search| search.body == body && search.feature == feature);
        let k = k.unwrap_or_else(|| {
            self.of.push(Search { body, feature, above: None, below: None, tried_rad: None });
            self.of.len() - 1
        });
        &mut self.of[k]
    }
}

/// A rim that stands on a plane.
struct Rim {
    cap: Cap,
    standing: Standing,
}

impl Rim {
    fn of(model: &Model, touch: &Touch, state: &State) -> Option<Self> {
        let standing = touch.standing(state)?;
        let cap = Cap::facing(&model.bodies[standing.of], &state.bodies[standing.of], &standing.normal_W)?;
        Some(Rim { cap, standing })
    }

    fn is_same(&self, own: &Touch, other: &Rim, touch: &Touch) -> bool {
        let of = |touch: &Touch| {
            let (body, other, feature) = touch.key();
            (body, other, if other.is_none() { feature.0 } else { 0 })
        };
        of(own) == of(touch) && self.standing.of == other.standing.of && self.cap.first == other.cap.first
    }

    /// Direction from the cap's centre to a point of the body on its rim.
    fn toward_B(&self) -> Option<Vector3<f64>> {
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
        let same = |other: &&Held| rim(other).is_some_and(|of| of_own.is_same(&own.touch, &of, &other.touch));
        // Three of its points hold a cap flat.
        let is_flat = held.iter().filter(same).count() >= 3;
        !is_flat && (lean.norm() > TIPS * FLAT || lean.dot(&(at.q_WB * toward_B)) < -BEYOND)
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

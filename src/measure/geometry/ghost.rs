//! Impulses that were there for a contact that was not.
//!
//! The impulses of one pair along one normal are taken away and all others kept. If the two bodies, moved through the
//! step without them, nowhere overlap, nothing was there to be pushed by.
//!
//! What is removed is a positive combination of contacts that were closed: at least one of them, weighted by its
//! impulse, then goes inside, whatever the others do (p·A p > 0). An impulse without a contact has no such point.
//!
//! With friction, a contact that is closed may go outside without all of its impulses: what then tells is what goes
//! without those along the normal, and with the friction.
//!
//! A step sees a body that turns move along tangents. What the tangents would have led inside and the turning itself
//! does not is no ghost, but an error of the order of the step: as far as half the square of the angle, if the bodies
//! come nearer to each other by what the impulse kept them apart.

use super::expand::Expansion;
use super::figure::{Figure, Stand, posed};
use super::leg::{Leg, most_m};
use super::near::NearPair;
use super::overlap::part;
use super::parting::Parting;
use super::passage::gap_m;
use super::posed::{Posed, gap_along_m};
use crate::collide::SolvedContact;
use crate::model::Model;
use crate::model::container::Face;
use crate::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};

/// Sine of the angle of normals that are one.
const PARALLEL: f64 = 1e-6;
/// Of a body's size: it has been moved.
const MOVED: f64 = 1e-9;
/// Of the smaller body's size, and of the coordinates: an overlap that is no rounding.
const OVERLAP: f64 = 1e-10;
const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// Looks on the way of two bodies that begin and end apart.
const LOOKS: usize = 64;
/// Of a body's size: how far two bodies are followed after a blow, or by a force; and at least so many times what
/// rounding may make of them, far from the origin.
const AHEAD: f64 = 1e-6;
const BEYOND: f64 = 1e3;
/// Of that way: so far are two followed that come nearer on it by less than can be told.
const FURTHER: f64 = 8.0;
/// Of the smaller body's size: so far apart two bodies may be pushed, if that is what keeps them from coming nearer: a
/// point is on a face up to so far beyond its border (`event::touch`).
const BESIDE: f64 = 1e-8;
/// Cosine of the angle of normals that are of one face.
const ALONG: f64 = 0.99;
/// Of the speed: a change of velocity that shows in the motion itself.
const SHOWS: f64 = 1e-3;

/// Of the largest impulse of a blow: what rounding brings to bodies that others shield from it.
const AMONG: f64 = 1e-8;

/// Of an impulse: less along the normal is too little to be asked about without the friction.
const PUSHES: f64 = 1e-2;

/// Of what an impulse should have kept two bodies apart by: they come nearer without it.
const NEARER: f64 = 0.25;

/// What the impulses of one pair along one normal did to its bodies.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    pub bodies: (usize, Option<usize>),
    normal: Vector3<f64>,
    impulse_W: Vector3<f64>,
    /// About the bodies' centres of mass.
    angular_W: [Vector3<f64>; 2],
    /// How much pushes along the normal, and from the bodies' centres of mass to the middle of that.
    pushed: f64,
    arms_W: [Vector3<f64>; 2],
    /// One of its contacts has restitution.
    rebounds: bool,
}

impl Group {
    /// Of all impulses of one pair, those along the normal of the first; none: they have been seen before.
    pub fn new(solved: &[SolvedContact], first: usize) -> Option<Self> {
        let SolvedContact { contact: of, impulse_W } = &solved[first];
        let is_along = |n: &Vector3<f64>| n.dot(&of.normal) > 0.0 && n.cross(&of.normal).norm() <= PARALLEL;
        if *impulse_W == Vector3::zeros()
            || solved[..first].iter().any(|s| is_along(&s.contact.normal) && s.impulse_W != Vector3::zeros())
        {
            return None;
        }
        let zero = Vector3::zeros();
        let (bodies, normal) = ((of.body, of.other), of.normal);
        let mut group = Group {
            bodies,
            normal,
            impulse_W: zero,
            angular_W: [zero; 2],
            pushed: 0.0,
            arms_W: [zero; 2],
            rebounds: false,
        };
        for SolvedContact { contact, impulse_W } in solved[first..].iter().filter(|s| is_along(&s.contact.normal)) {
            let pushes = impulse_W.dot(&of.normal).max(0.0);
            group.pushed += pushes;
            group.rebounds |= contact.restitution > 0.0;
            group.arms_W[0] += contact.r_BC_W * pushes;
            group.arms_W[1] += contact.r_OC_W * pushes;
            group.impulse_W += impulse_W;
            group.angular_W[0] += contact.r_BC_W.cross(impulse_W);
            group.angular_W[1] -= contact.r_OC_W.cross(impulse_W);
        }
        if group.pushed > 0.0 {
            group.arms_W = group.arms_W.map(|arm_W| arm_W / group.pushed);
        }
        Some(group)
    }

    /// What pushes along the normal alone.
    fn without_friction(&self) -> Self {
        let impulse_W = self.normal * self.pushed;
        let [a_W, b_W] = self.arms_W.map(|arm_W| arm_W.cross(&impulse_W));
        Group { impulse_W, angular_W: [a_W, -b_W], ..*self }
    }

    /// How fast two bodies part by these changes of velocity, which the impulses made, along the impulse.
    fn kept_m_s(&self, gains: &[Gain; 2]) -> f64 {
        let work =
            |gain: &Gain, sign: f64, angular: &Vector3<f64>| self.impulse_W.dot(&gain.v) * sign + angular.dot(&gain.w);
        (work(&gains[0], 1.0, &self.angular_W[0]) + work(&gains[1], -1.0, &self.angular_W[1])) / self.impulse_W.norm()
    }
}

/// A change of velocities.
#[derive(Clone, Copy, Debug)]
struct Gain {
    v: Vector3<f64>,
    w: Vector3<f64>,
}

impl Gain {
    const NONE: Gain = Gain { v: Vector3::new(0.0, 0.0, 0.0), w: Vector3::new(0.0, 0.0, 0.0) };

    fn speed(&self, radius_m: f64) -> f64 {
        self.v.norm() + self.w.norm() * radius_m
    }
}

/// The judge of one step's impulses.
pub struct GhostJudge<'a> {
    pub model: &'a Model,
    pub figures: &'a [Figure],
    pub memory: &'a mut Expansion,
}

impl<'a> GhostJudge<'a> {
    /// The size of a group, if neither all of it nor what pushes alone was for a contact that was there; else 0.
    fn ghost(&mut self, group: &Group, mut size_rel: impl FnMut(&mut Self, &Group) -> f64) -> f64 {
        let all_rel = size_rel(self, group);
        let pushes = group.pushed >= PUSHES * group.impulse_W.norm();
        let was_there = all_rel == 0.0 || (pushes && size_rel(self, &group.without_friction()) == 0.0);
        if was_there { 0.0 } else { all_rel }
    }

    /// A kick at a state, after which the bodies move for a time `over_s` up to the next one; `after` is the state a
    /// time `more_s` before that.
    pub fn kicked(&mut self, group: &Group, states: [&State; 2], over_s: f64, more_s: f64) -> f64 {
        self.ghost(group, |judge, group| judge.of_kick(group, states, over_s, more_s))
    }

    fn of_kick(&mut self, group: &Group, [kicked, after]: [&State; 2], over_s: f64, more_s: f64) -> f64 {
        let gains = self.gains(group, kicked);
        if !self.moves(group, &gains, over_s) {
            return 0.0;
        }
        let end = |i: usize, gain: &Gain| {
            let (from, to) = (&kicked.bodies[i], &after.bodies[i]);
            Stand {
                p_WB: to.p_WB + to.v_WB * more_s - gain.v * over_s,
                q_WB: turned_less(from, to, gain, over_s, more_s),
            }
        };
        let [a, b] = [group.bodies.0, group.bodies.1.unwrap_or(group.bodies.0)];
        let without = [end(a, &gains[0]), end(b, &gains[1])];
        // Most of them go inside, and no way has to be followed.
        let closed_m = self.closed_m(group, kicked);
        if self.are_inside(group, &without, closed_m) || self.just_meet(group, &without, closed_m) {
            return 0.0;
        }
        let legs =
            |ends: &[Stand; 2]| [(a, &ends[0]), (b, &ends[1])].map(|(i, to)| Leg::to((&kicked.bodies[i]).into(), to));
        let (with, without) = (legs(&[end(a, &Gain::NONE), end(b, &Gain::NONE)]), legs(&without));
        let size_rel = self.weigh(group, kicked, &without, over_s);
        // What lasts through steps that kick half-way is turned back by as much as it came.
        let is_there = size_rel > 0.0
            && (self.is_early(group, &gains, [&with, &without], over_s)
                || (more_s > 0.0 && self.come(group, kicked, more_s)));
        if is_there { 0.0 } else { size_rel }
    }

    /// Without the impulses the bodies come as much nearer as they should, up to what a step does not see of their
    /// turning. `legs`: with the impulses and without.
    fn is_early(&mut self, group: &Group, gains: &[Gain; 2], [with, without]: [&[Leg; 2]; 2], over_s: f64) -> bool {
        let turning_m = |(leg, i): (&Leg, usize)| -> f64 {
            let body = &self.model.bodies[i];
            if body.is_centred_ball() { 0.0 } else { 0.5 * leg.turned.norm_squared() * self.figures[i].radius_m }
        };
        let bodies = [Some(group.bodies.0), group.bodies.1];
        // A step looks at its motion without them.
        let unseen_m = |legs: &[Leg; 2]| legs.iter().zip(bodies.into_iter().flatten()).map(turning_m).sum::<f64>();
        let unseen_m = unseen_m(with).max(unseen_m(without));
        if unseen_m == 0.0 {
            return false;
        }
        let kept_m = over_s * group.kept_m_s(gains);
        let comes_nearer = |[gap_m, left_m]: [f64; 2]| left_m <= unseen_m && gap_m - left_m >= NEARER * kept_m;
        // Another corner may be as near to a face with the impulse as this one is without it.
        let legs = [with, without];
        comes_nearer(legs.map(|legs| self.end_gap_m(group, legs)))
            || (group.bodies.1.is_none() && comes_nearer(legs.map(|legs| self.pushed_gap_m(group, &legs[0]))))
    }

    /// Gap of what was pushed, a point of the body, to the faces of the container that have the group's normal.
    fn pushed_gap_m(&self, group: &Group, leg: &Leg) -> f64 {
        let at = leg.at(1.0);
        let point = at.p_WB + at.q_WB * (leg.from.q_WB.inverse() * group.arms_W[0]);
        let faces = self.model.container.iter().flat_map(|container| &container.faces);
        let along = faces.filter(|face| face.normal.dot(&group.normal) > 1.0 - PARALLEL);
        along.map(|face| face.gap_m(&point)).fold(f64::INFINITY, f64::min)
    }

    fn end_gap_m(&mut self, group: &Group, legs: &[Leg; 2]) -> f64 {
        match group.bodies.1 {
            Some(other) => self.gap_at_m([group.bodies.0, other], legs, 1.0),
            None => {
                let (figure, body) = (&self.figures[group.bodies.0], &self.model.bodies[group.bodies.0]);
                let faces = self.model.container.iter().flat_map(|container| &container.faces);
                let along = faces.filter(|face| face.normal.dot(&group.normal) > 1.0 - PARALLEL);
                let at = legs[0].at(1.0);
                let depth_m = |face: &Face| figure.depth_m(body, &at, face, f64::NEG_INFINITY);
                along.filter_map(depth_m).map(|depth_m| -depth_m).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Of two bodies, so far on their ways.
    fn gap_at_m(&mut self, bodies: [usize; 2], legs: &[Leg; 2], way: f64) -> f64 {
        let mut pair = NearPair { bodies, axis: Vector3::zeros() };
        gap_m(self.model, &mut pair, legs.each_ref().map(|leg| leg.at(way)), f64::INFINITY, self.memory)
    }

    /// A blow, which changed velocities alone; the largest of its impulses in N s.
    pub fn struck(&mut self, group: &Group, states: [&State; 2], largest_n_s: f64) -> f64 {
        self.ghost(group, |judge, group| judge.of_blow(group, states, largest_n_s))
    }

    fn of_blow(&mut self, group: &Group, [before, after]: [&State; 2], largest_n_s: f64) -> f64 {
        if group.impulse_W.norm() <= AMONG * largest_n_s {
            return 0.0;
        }
        let gains = self.gains(group, before);
        let speed = |i: usize| {
            let (at, was) = (&after.bodies[i], &before.bodies[i]);
            let turning = at.w_WB.norm().max(was.w_WB.norm()) * self.figures[i].radius_m;
            at.v_WB.norm().max(was.v_WB.norm()) + turning
        };
        let speed = speed(group.bodies.0) + group.bodies.1.map_or(0.0, speed);
        let gained = self.largest(group, &gains);
        if gained <= MOVED * speed {
            return 0.0;
        }
        let shows = gained >= SHOWS * speed;
        let time_s = self.ahead_m(group, before) / if shows { speed.max(gained) } else { gained };
        let leg = |i: usize, gain: &Gain| {
            let at = &after.bodies[i];
            let (v, w) = if shows { (at.v_WB, at.w_WB) } else { (Vector3::zeros(), Vector3::zeros()) };
            Leg { from: at.into(), moved: (v - gain.v) * time_s, turned: (w - gain.w) * time_s }
        };
        let legs = [leg(group.bodies.0, &gains[0]), leg(group.bodies.1.unwrap_or(group.bodies.0), &gains[1])];
        let size_rel = self.weigh(group, before, &legs, 0.0);
        let is_there = size_rel > 0.0
            && (self.come_nearer(group, before, &legs, time_s * group.kept_m_s(&gains))
                || (group.rebounds && self.come(group, before, time_s)));
        if is_there { 0.0 } else { size_rel }
    }

    /// Two bodies go inside along the normal as they came: what rebounds may be pushed by less than others part them
    /// by.
    fn come(&mut self, group: &Group, before: &State, time_s: f64) -> bool {
        let leg = |i: usize| {
            let at = &before.bodies[i];
            Leg { from: at.into(), moved: at.v_WB * time_s, turned: at.w_WB * time_s }
        };
        let legs = [group.bodies.0, group.bodies.1.unwrap_or(group.bodies.0)].map(leg);
        let closed_m = self.closed_m(group, before);
        let at = legs.map(|leg| leg.at(1.0));
        if group.bodies.1.is_none() {
            return self.is_in_container(group, &at[0], closed_m);
        }
        // Not into another face.
        let is_along = |parting: &Parting| parting.normal.dot(&group.normal).abs() >= ALONG;
        self.parting(group, &at).is_some_and(|parting| parting.gap_m < -closed_m && is_along(&parting))
    }

    /// Forces over a time, given as impulses, at a state in it.
    pub fn pressed(&mut self, group: &Group, at: &State, over_s: f64) -> f64 {
        self.ghost(group, |judge, group| judge.of_forces(group, at, over_s))
    }

    fn of_forces(&mut self, group: &Group, at: &State, over_s: f64) -> f64 {
        let gains = self.gains(group, at);
        if !self.moves(group, &gains, 0.5 * over_s) {
            return 0.0;
        }
        let time_s = self.ahead_m(group, at) / self.largest(group, &gains);
        let leg = |i: usize, gain: &Gain| Leg {
            from: (&at.bodies[i]).into(),
            moved: -gain.v * time_s,
            turned: -gain.w * time_s,
        };
        let legs = [leg(group.bodies.0, &gains[0]), leg(group.bodies.1.unwrap_or(group.bodies.0), &gains[1])];
        let size_rel = self.weigh(group, at, &legs, over_s);
        let is_there = size_rel > 0.0 && self.come_nearer(group, at, &legs, time_s * group.kept_m_s(&gains));
        if is_there { 0.0 } else { size_rel }
    }

    /// Two bodies come nearer on these ways by what should have kept them apart by so much, all but touching.
    fn come_nearer(&mut self, group: &Group, at: &State, legs: &[Leg; 2], kept_m: f64) -> bool {
        let Some(other) = group.bodies.1 else { return false };
        let (beside_m, closed_m) = (BESIDE * self.size_m(group), self.closed_m(group, at));
        let mut gap_at_m = |way: f64| self.gap_at_m([group.bodies.0, other], legs, way);
        let [from_m, to_m] = [0.0, 1.0].map(&mut gap_at_m);
        // What mostly passes by comes nearer by less than can be told at first.
        (from_m <= beside_m && from_m - to_m >= NEARER * kept_m)
            || (to_m < from_m.min(0.0) && gap_at_m(FURTHER) < -closed_m)
    }

    /// M⁻¹ times the group's impulses.
    fn gains(&self, group: &Group, at: &State) -> [Gain; 2] {
        let gain = |i: usize, sign: f64, angular: &Vector3<f64>| {
            let body = &self.model.bodies[i];
            if body.driven {
                return Gain::NONE;
            }
            Gain { v: group.impulse_W * (sign / body.mass_kg), w: body.I_W_inverse(&at.bodies[i]) * angular }
        };
        let other = group.bodies.1.map_or(Gain::NONE, |other| gain(other, -1.0, &group.angular_W[1]));
        [gain(group.bodies.0, 1.0, &group.angular_W[0]), other]
    }

    fn each<'b>(&'b self, group: &Group, gains: &'b [Gain; 2]) -> impl Iterator<Item = (&'b Figure, &'b Gain)> {
        let bodies = [Some(group.bodies.0), group.bodies.1];
        bodies.into_iter().flatten().map(|i| &self.figures[i]).zip(gains)
    }

    fn moves(&self, group: &Group, gains: &[Gain; 2], time_s: f64) -> bool {
        self.each(group, gains).any(|(figure, gain)| gain.speed(figure.radius_m) * time_s > MOVED * figure.radius_m)
    }

    fn largest(&self, group: &Group, gains: &[Gain; 2]) -> f64 {
        self.each(group, gains).map(|(figure, gain)| gain.speed(figure.radius_m)).fold(0.0, f64::max)
    }

    /// Of the smaller body.
    fn size_m(&self, group: &Group) -> f64 {
        self.each(group, &[Gain::NONE; 2]).map(|(figure, _)| figure.radius_m).fold(f64::INFINITY, f64::min)
    }

    fn ahead_m(&self, group: &Group, at: &State) -> f64 {
        (AHEAD * self.size_m(group)).max(BEYOND * self.closed_m(group, at))
    }

    /// What rounding may make of two bodies that touch.
    fn closed_m(&self, group: &Group, at: &State) -> f64 {
        let coordinates_m = at.bodies[group.bodies.0].p_WB.amax() + self.figures[group.bodies.0].radius_m;
        OVERLAP * self.size_m(group) + ROUNDING * coordinates_m
    }

    /// The size of the impulse, if the bodies nowhere overlap on these ways; else 0.
    fn weigh(&mut self, group: &Group, at: &State, legs: &[Leg; 2], over_s: f64) -> f64 {
        let closed_m = self.closed_m(group, at);
        // A half-space is entered deepest at an end.
        let overlaps = match group.bodies.1 {
            Some(other) => self.overlap(group.bodies.0, other, legs, closed_m),
            None => [1.0, 0.0].iter().any(|way| self.is_in_container(group, &legs[0].at(*way), closed_m)),
        };
        if overlaps {
            return 0.0;
        }
        let bodies = [Some(group.bodies.0), group.bodies.1];
        let moving = bodies.into_iter().flatten().filter(|i| !self.model.bodies[*i].driven);
        let lighter =
            moving.reduce(|a, b| if self.model.bodies[b].mass_kg < self.model.bodies[a].mass_kg { b } else { a });
        let Some(i) = lighter else { return 0.0 };
        let (v, _) = self.model.gained(i, at.time_s, &at.bodies[i], over_s);
        let size = group.impulse_W.norm();
        let momentum = self.model.bodies[i].mass_kg * (at.bodies[i].v_WB.norm() + v.norm());
        // What rests without a force: as if it had come with a millionth of what it gets.
        size / momentum.max(1e-6 * size)
    }

    fn overlap(&mut self, a: usize, b: usize, legs: &[Leg; 2], closed_m: f64) -> bool {
        let mut pair = NearPair { bodies: [a, b], axis: Vector3::zeros() };
        let legs = [&legs[0], &legs[1]];
        let most_m = most_m(legs, [a, b].map(|i| self.figures[i].radius_m));
        let mut gap_at = |way: f64| gap_m(self.model, &mut pair, legs.map(|leg| leg.at(way)), most_m, self.memory);
        let ends_m = [1.0, 0.0].map(&mut gap_at);
        if ends_m.iter().any(|gap_m| *gap_m < -closed_m) {
            return true;
        }
        // What is light and pushed by much flies far through what it touched at first.
        let mut near = 4.0 * closed_m / most_m;
        while near < 1.0 / LOOKS as f64 {
            if gap_at(near) < -closed_m {
                return true;
            }
            near *= 8.0;
        }
        let (mut way, last) = (ends_m[1] / most_m, 1.0 - ends_m[0] / most_m);
        for _ in 0..LOOKS {
            way = way.max(1.0 / LOOKS as f64);
            if way >= last {
                break;
            }
            let gap_m = gap_at(way);
            if gap_m < -closed_m {
                return true;
            }
            way += (gap_m / most_m).max(1.0 / LOOKS as f64);
        }
        false
    }

    /// Whether the two bodies overlap where they stand.
    fn are_inside(&mut self, group: &Group, at: &[Stand; 2], closed_m: f64) -> bool {
        if group.bodies.1.is_none() {
            return self.is_in_container(group, &at[0], closed_m);
        }
        self.parting(group, at).is_some_and(|parting| parting.gap_m < -closed_m)
    }

    /// What parts the two bodies most where they stand.
    fn parting(&mut self, group: &Group, at: &[Stand; 2]) -> Option<Parting> {
        self.both(group, at).map(|[a, b]| part(&a, &b, self.memory))
    }

    /// The two bodies where they stand. None: there is one alone, or one has no shape.
    fn both(&self, group: &Group, at: &[Stand; 2]) -> Option<[Posed<'a>; 2]> {
        let of = |i: usize, own: &Stand| posed(self.model, i, own, &at[1].p_WB);
        Some([of(group.bodies.0, &at[0])?, of(group.bodies.1?, &at[1])?])
    }

    /// Whether the two bodies touch where they stand, along the group's normal and along no other.
    fn just_meet(&self, group: &Group, at: &[Stand; 2], closed_m: f64) -> bool {
        self.both(group, at).is_some_and(|[a, b]| gap_along_m(&a, &b, &group.normal).abs() <= closed_m)
    }

    /// In the faces that have the group's normal, or in any if none has.
    fn is_in_container(&self, group: &Group, at: &Stand, closed_m: f64) -> bool {
        let Some(container) = &self.model.container else { return false };
        let (figure, body) = (&self.figures[group.bodies.0], &self.model.bodies[group.bodies.0]);
        let is_along = |face: &&Face| face.normal.dot(&group.normal) > 1.0 - PARALLEL;
        let any_is = container.faces.iter().any(|face| is_along(&face));
        let mut faces = container.faces.iter().filter(|face| !any_is || is_along(face));
        faces.any(|face| figure.depth_m(body, at, face, closed_m).is_some())
    }
}

/// The attitude at the end without a gain: the torque-free turning that is left is the same to first order.
fn turned_less(from: &BodyState, to: &BodyState, gain: &Gain, over_s: f64, more_s: f64) -> UnitQuaternion<f64> {
    let turn = |w: Vector3<f64>, time_s: f64| UnitQuaternion::from_scaled_axis(w * time_s);
    let end = if more_s == 0.0 { to.q_WB } else { turn(to.w_WB, more_s) * to.q_WB };
    if gain.w == Vector3::zeros() {
        return end;
    }
    let steady = turn(to.w_WB, over_s) * from.q_WB;
    end * steady.inverse() * turn(to.w_WB - gain.w, over_s) * from.q_WB
}

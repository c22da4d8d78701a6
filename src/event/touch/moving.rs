//! A point of contact in every state of its bodies.

use super::ball_on_line::Beside;
use super::lines::Crossing;
use super::parts::Parts;
use super::plane::Plane;
use super::rates::pair;
use super::recognise::{over_border, parts, rim_on_edge};
use super::rim_on_edge::RimOnEdge;
use super::{ball_on_line, balls, lines, plane};
use crate::collide::{Contact, Key};
use crate::event::shown::{Border, Line, within_m};
use crate::math::few::OneOrTwo;
use crate::model::Model;
use crate::shape::cylinder::{ARC, VERTEX, kind};
use crate::shape::solid::Meeting;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// Of the bounding radii: so far beyond a border is not beyond it. The contact test takes points as one within half of
/// it.
pub(super) const BORDER: f64 = 2e-9;

/// Of the smaller body's size: so near to it, what is round and has come over a border is on the edge there.
const ON_EDGE: f64 = 1e-8;

/// The same: parts whose gap differs by more from the one that was found are others.
const ELSEWHERE: f64 = 1e-6;

/// What meets what.
#[derive(Clone, Debug, PartialEq)]
pub struct Touch {
    /// As of the contact test; friction and restitution are in it.
    found: Contact,
    pub(super) parts: Parts,
    /// It began within the borders of faces and the ends of edges, by so much or a little less.
    slack_m: Option<f64>,
}

/// The name of the other crossing of the same two.
fn other_name(feature: (u32, u32)) -> (u32, u32) {
    let name = |feature: u32| if [VERTEX, ARC].contains(&kind(feature)) { feature ^ 1 } else { feature };
    (name(feature.0), name(feature.1))
}

/// A touch in one state.
#[derive(Clone, Copy, Debug)]
pub struct Here {
    pub contact: Contact,
    /// u of the bodies' velocities: of the body's point against the other's.
    pub velocity_W: Vector3<f64>,
    /// β, and the normal part's ṅ·u.
    pub bias_W: Vector3<f64>,
    pub turning: f64,
}

impl Here {
    /// What the bodies' velocities alone add to the relative acceleration, in the contact's frame.
    pub fn bias(&self, frame: &[Vector3<f64>; 3]) -> Vector3<f64> {
        let [n, t1, t2] = frame.map(|e| e.dot(&self.bias_W));
        Vector3::new(n + self.turning, t1, t2)
    }

    pub fn normal_speed(&self) -> f64 {
        self.contact.normal.dot(&self.velocity_W)
    }

    /// Velocity along the surface.
    pub fn slip_W(&self) -> Vector3<f64> {
        self.velocity_W - self.contact.normal * self.normal_speed()
    }
}

impl Touch {
    /// None: parts whose motion along each other is not known here.
    pub fn new(model: &Model, state: &State, found: &Contact) -> Option<Self> {
        let of_parts = || Touch::of(model, state, found, parts(model, state, found)?);
        Touch::crossing(model, state, found).or_else(of_parts)
    }

    /// The same contact, more closely, where the rim of a cap next to flat crosses an edge: the contact test knows the
    /// less of that point the flatter the cap is. With the other point in which these cross, if that is one, too: the
    /// test tells the lower one, and an edge along a cap has both.
    pub fn refined(model: &Model, state: &State, found: &Contact) -> OneOrTwo<Contact> {
        let Some(touch) = Touch::crossing(model, state, found) else { return OneOrTwo::from_elem(*found, 1) };
        let mut all = OneOrTwo::from_elem(touch.here(state).contact, 1);
        all.extend(touch.other_crossing(|i| &state.bodies[i]));
        all
    }

    /// Of a rim that crosses an edge.
    fn crossing(model: &Model, state: &State, found: &Contact) -> Option<Self> {
        let crossing = rim_on_edge(model, &|i: usize| &state.bodies[i], found)?;
        Touch::of(model, state, found, Parts::RimOnEdge(crossing))
    }

    /// Both points in which a rim crosses an edge that lies nearer to its cap than to its axis, where that has been
    /// found between two bodies in these states, and the sine of the angle there. None: something else has been found.
    pub fn crossings(
        model: &Model,
        bodies: [usize; 2],
        at: &[BodyState; 2],
        found: &Meeting,
    ) -> Option<[(Meeting, f64); 2]> {
        let place = |i: usize| &at[usize::from(i != bodies[0])];
        let both = [&at[0], &at[1]];
        let contact = Contact { body: bodies[0], other: Some(bodies[1]), ..Contact::default() }.meeting(found, both);
        let first = rim_on_edge(model, &place, &contact)?;
        let meeting = |crossing: &RimOnEdge, feature: (u32, u32)| {
            let here = crossing.here(&Contact { feature, ..contact }, &place).0;
            (here.point(), crossing.sine(both))
        };
        let smaller_m = bodies.map(|i| model.bodies[i].bounding_radius_m).into_iter().fold(f64::INFINITY, f64::min);
        let nearest = meeting(&first, found.feature);
        let off_m = (nearest.0.gap_m - found.gap_m).abs();
        let is_it = off_m <= ELSEWHERE * smaller_m && first.inside_m(both) >= -BORDER * smaller_m && first.lies(both);
        is_it.then(|| [nearest, meeting(&first.other(both), other_name(found.feature))])
    }

    /// Whether it is of a rim that crosses an edge.
    pub fn is_crossing(&self) -> bool {
        matches!(&self.parts, Parts::RimOnEdge(_))
    }

    /// Of a rim that crosses an edge: the other point in which it does. None: it does not.
    pub fn other_crossing<'a>(&self, at: impl Fn(usize) -> &'a BodyState) -> Option<Contact> {
        let Parts::RimOnEdge(crossing) = &self.parts else { return None };
        let bodies = pair(&self.found, &at);
        let (crossing, slack_m) = (crossing.other(bodies), self.slack_m?);
        let is_there = crossing.inside_m(bodies) >= -slack_m;
        let found = Contact { feature: other_name(self.found.feature), ..self.found };
        let other = Touch { found, parts: Parts::RimOnEdge(crossing), slack_m: Some(slack_m) };
        is_there.then(|| other.here_of(at).contact)
    }

    /// None: these parts do not meet there.
    fn of(model: &Model, state: &State, found: &Contact, parts: Parts) -> Option<Self> {
        let mut touch = Touch { found: *found, parts, slack_m: None };
        let sizes_m = || found.ends().map(|(i, ..)| model.bodies[i].bounding_radius_m);
        let slack_m = BORDER * sizes_m().sum::<f64>();
        if touch.inside_m(state) < -slack_m
            && let Some(parts) = over_border(model, state, found, &touch.parts)
        {
            let over = Touch { parts, ..touch.clone() };
            if over.here(state).contact.gap_m.abs() <= ON_EDGE * sizes_m().fold(f64::INFINITY, f64::min) {
                touch = over;
            }
        }
        touch.slack_m = (touch.inside_m(state) >= -slack_m).then_some(slack_m);
        let off_m = (touch.here(state).contact.gap_m - found.gap_m).abs();
        (off_m <= ELSEWHERE * sizes_m().fold(f64::INFINITY, f64::min)).then_some(touch)
    }

    /// It may come to a border.
    pub fn is_bounded(&self) -> bool {
        let ends = match &self.parts {
            Parts::OnPlane { plane, .. } => plane.border != Border::Nowhere,
            Parts::Balls(balls) => balls.iter().any(|ball| !ball.cone.is_empty()),
            Parts::Lines(_) | Parts::BallOnLine { .. } | Parts::OnRim(_) | Parts::Curved(_) => true,
            Parts::RimOnEdge(_) => true,
        };
        ends && self.slack_m.is_some()
    }

    /// How far it is from having left a face or an edge. Negative: it has.
    pub fn left_m(&self, state: &State) -> f64 {
        match self.slack_m {
            Some(slack_m) if self.is_bounded() => self.inside_m(state) + 2.0 * slack_m,
            _ => f64::INFINITY,
        }
    }

    fn inside_m(&self, state: &State) -> f64 {
        let at = |i: usize| &state.bodies[i];
        let along = |line: &Line, s: f64| (s - line.ends_m[0]).min(line.ends_m[1] - s);
        match &self.parts {
            Parts::OnPlane { plane: Plane { of: Some(of), border, .. }, .. } => {
                let base = at(*of);
                let p_W = self.here(state).contact.p_WC - base.p_WB;
                border.inside_m(&base.q_WB.inverse_transform_vector(&p_W))
            }
            Parts::OnPlane { .. } => f64::INFINITY,
            Parts::Balls(balls) => {
                let at = pair(&self.found, &at);
                let centre = [0, 1].map(|i| at[i].p_WB + at[i].q_WB * balls[i].centre_B);
                let within = |i: usize| {
                    within_m(&balls[i].cone, &at[i].q_WB.inverse_transform_vector(&(centre[1 - i] - centre[i])))
                };
                within(0).min(within(1))
            }
            Parts::Lines(lines) => {
                let Crossing { s, t, .. } = Crossing::new(&pair(&self.found, &at), lines);
                along(&lines[0], s).min(along(&lines[1], t))
            }
            Parts::BallOnLine { first, ball, line } => {
                let Beside { of_ball, of_line, s, off, .. } = Beside::new(pair(&self.found, &at), *first, ball, line);
                along(line, s)
                    .min(within_m(&line.cone, &of_line.q_WB.inverse_transform_vector(&off)))
                    .min(within_m(&ball.cone, &of_ball.q_WB.inverse_transform_vector(&-off)))
            }
            Parts::OnRim(crossing) => crossing.inside_m(pair(&self.found, &at)),
            Parts::Curved(curved) => curved.inside_m(pair(&self.found, &at)),
            Parts::RimOnEdge(crossing) => crossing.inside_m(pair(&self.found, &at)),
        }
    }

    pub fn key(&self) -> Key {
        self.found.key()
    }

    /// The two bodies, or the one.
    pub fn bodies(&self) -> impl Iterator<Item = usize> {
        std::iter::once(self.found.body).chain(self.found.other)
    }

    /// A part of this body on a plane of another one, or of the container: where it does not turn, the point is one of
    /// its own.
    pub fn is_on_plane(&self, part_of: usize) -> bool {
        matches!(&self.parts, Parts::OnPlane { of, .. } if *of == part_of)
    }

    pub fn friction(&self) -> f64 {
        self.found.friction
    }

    pub fn here(&self, state: &State) -> Here {
        self.here_of(|i| &state.bodies[i])
    }

    /// `at`: a body by its index.
    pub fn here_of<'a>(&self, at: impl Fn(usize) -> &'a BodyState) -> Here {
        let (mut contact, rates) = match &self.parts {
            Parts::OnPlane { of, part, plane } => plane::here(&self.found, &at, *of, part, plane),
            Parts::Balls(balls) => balls::here(&self.found, &at, balls),
            Parts::Lines(lines) => lines::here(&self.found, &at, lines),
            Parts::BallOnLine { first, ball, line } => ball_on_line::here(&self.found, &at, *first, ball, line),
            Parts::OnRim(crossing) => crossing.here(&self.found, &at),
            Parts::Curved(curved) => curved.here(&self.found, &at),
            Parts::RimOnEdge(crossing) => crossing.here(&self.found, &at),
        };
        let (a, b) = (at(contact.body), contact.other.map(&at));
        contact.r_BC_W = contact.p_WC - a.p_WB;
        contact.r_OC_W = b.map_or_else(Vector3::zeros, |b| contact.p_WC - b.p_WB);
        let velocity_W = contact.velocity(|i| [at(i).v_WB, at(i).w_WB]);
        let bias_W = a.w_WB.cross(&rates.r_A) - b.map_or_else(Vector3::zeros, |b| b.w_WB.cross(&rates.r_B));
        Here { contact, velocity_W, bias_W, turning: rates.normal.dot(&velocity_W) }
    }
}

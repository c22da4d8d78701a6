//! When the next gap closes, and the proof that none closes before.
//!
//! On its path a gap g obeys g(t + s) ≥ g + ġ s − M s²/2, M a bound of the acceleration of any point toward the plane
//! (`motion::Bounds`): up to the root of that parabola nothing can close. Going from root to root never steps over a
//! contact, and near one it is Newton's method from outside: the error is squared at every step. A ball's M is its
//! exact acceleration, and one step is enough. The contact is there when g ≤ δ while it closes; a gap that stays within
//! δ may go unseen, and none beyond it (conservative advancement, B. Mirtich 1996, with a bound of second order).
//!
//! Pairs of bodies: of balls likewise; of others by their distance and the largest speed of their points, and within a
//! thousandth of their size by their points of contact.

use super::dense::Dense;
use super::forces::{Held, NO_SLIP, speed_m_s};
use super::motion::{Bounds, Motion};
use crate::collide::closed::delta_m;
use crate::collide::faces;
use crate::deadline::Deadline;
use crate::model::container::Face;
use crate::model::{Body, Geometry, Model};
use crate::shape::pair::touches;
use crate::shape::solid::{Meeting as Found, Pose, Solid};
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::Vector3;

/// All bodies between two events.
#[derive(Clone, Copy)]
pub struct Paths<'a> {
    pub model: &'a Model,
    pub motions: &'a [Motion],
    pub dense: &'a Dense,
    pub deadline: Deadline,
}

impl Paths<'_> {
    pub fn at(&self, body: usize, t_s: f64) -> BodyState {
        match &self.motions[body] {
            Motion::Closed(course) => course.at(t_s),
            Motion::Dense(place) => self.dense.at(*place, t_s),
        }
    }

    fn bounds(&self, body: usize, end_s: f64) -> Bounds {
        match &self.motions[body] {
            Motion::Closed(course) => course.bounds(&self.model.bodies[body], end_s),
            Motion::Dense(place) => self.dense.bounds(*place),
        }
    }
}

/// Looks taken before a search is given up; they get shorter only where a gap stays within some δ.
const MOST: u32 = 100_000;

/// One look at a gap.
struct Look {
    gap_m: f64,
    rate_m_s: f64,
    /// M.
    toward_m_s2: f64,
    /// Nothing is known beyond this time.
    known_s: f64,
    /// M is the acceleration itself.
    is_exact: bool,
}

impl Look {
    const EMPTY: Look = Look { gap_m: 0.0, rate_m_s: 0.0, toward_m_s2: 0.0, known_s: f64::INFINITY, is_exact: false };

    /// Of two points that touch at a distance.
    fn of_points(apart: Vector3<f64>, rate: Vector3<f64>, reach_m: f64, toward_m_s2: f64) -> Self {
        let distance = apart.norm();
        let rate_m_s = if distance > 0.0 { apart.dot(&rate) / distance } else { 0.0 };
        Look { gap_m: distance - reach_m, rate_m_s, toward_m_s2, ..Look::EMPTY }
    }

    /// The time in which the gap cannot close.
    fn safe_s(&self, delta_m: f64, slow_m_s: f64) -> f64 {
        let g = match self.gap_m {
            gap_m if gap_m > delta_m => gap_m,
            // A bounce comes back to where it began; what lingers within δ is let through it.
            gap_m => gap_m.max(0.0) + delta_m,
        };
        let (rate, m) = (self.rate_m_s, self.toward_m_s2);
        let square = rate * rate + 2.0 * m * g;
        let s = if square < 0.0 || (m <= 0.0 && rate >= 0.0) {
            f64::INFINITY
        } else if rate <= 0.0 {
            2.0 * g / (square.sqrt() - rate)
        } else {
            (rate + square.sqrt()) / m
        };
        let s = if self.gap_m <= delta_m && rate > slow_m_s && m > 0.0 {
            // A bounce comes back to where it began, but for what M is too much.
            let back_s = 2.0 * rate / m;
            if self.is_exact { back_s } else { back_s.max((2.0 * delta_m / m).sqrt()) }
        } else {
            s
        };
        s.min(self.known_s)
    }

    /// What comes nearer by rounding alone, the impact would not see either, however deep it is.
    fn is_touching(&self, delta_m: f64, slow_m_s: f64) -> bool {
        self.gap_m <= delta_m && self.rate_m_s < -slow_m_s
    }
}

/// What has to be known of a search.
#[derive(Clone, Copy)]
pub struct Window {
    pub from_s: f64,
    pub to_s: f64,
}

/// The earliest time in the window at which something that is not held touches; none: nothing does, or
/// it is too late to say.
pub fn first(paths: &Paths, held: &[Held], window: Window, work: &mut Work) -> Option<f64> {
    let mut window = window;
    let mut found = None;
    let mut note = |at: Option<f64>, window: &mut Window| {
        if let Some(t_s) = at {
            window.to_s = t_s;
            found = Some(t_s);
        }
    };
    let bodies = &paths.model.bodies;
    if let Some(container) = &paths.model.container {
        for (i, body) in bodies.iter().enumerate().filter(|(_, body)| body.feels_container()) {
            for (f, face) in container.faces.iter().enumerate() {
                note(with_face(paths, (i, body), (f, face), held, window, work), &mut window);
            }
        }
    }
    if paths.model.touching_pairs {
        for b in 1..bodies.len() {
            for a in 0..b {
                let left_out = (bodies[a].driven && bodies[b].driven) || paths.model.are_pinned([a, b]);
                if !left_out && bodies[a].solid().is_some() && bodies[b].solid().is_some() {
                    note(with_each_other(paths, [a, b], held, window, work), &mut window);
                }
            }
        }
    }
    found
}

/// Goes from look to look, up to the deadline. `look`: None, nothing is to be seen any more.
fn march(window: Window, deadline: Deadline, mut look: impl FnMut(f64) -> Option<(f64, bool)>) -> Option<f64> {
    let mut t_s = window.from_s;
    for _ in 0..MOST {
        if deadline.is_over() {
            return None;
        }
        let (safe_s, touching) = look(t_s)?;
        if touching {
            return Some(t_s);
        }
        let next_s = t_s + safe_s;
        if next_s >= window.to_s {
            return None;
        }
        // A safe time below the clock's own rounding.
        t_s = if next_s > t_s { next_s } else { t_s.next_up() };
    }
    Some(t_s)
}

fn with_face(
    paths: &Paths,
    (i, body): (usize, &Body),
    (f, face): (usize, &Face),
    held: &[Held],
    window: Window,
    work: &mut Work,
) -> Option<f64> {
    let bounds = paths.bounds(i, window.to_s);
    let radius_m = body.bounding_radius_m;
    let is_held = |node: u32| held.iter().any(|h| is_same_feature(body, h, i, f, node));
    let rest = held.iter().any(|h| h.touch.key().0 == i && h.touch.key().1.is_none() && h.touch.key().2.0 == f as u32);
    if rest && body.geometry.points() == 1 {
        return None;
    }
    let arm_m = arm_m(body);
    let delta = |at: &BodyState| delta_m(radius_m, at.p_WB.amax() + radius_m);
    march(window, paths.deadline, |t_s| {
        let at = paths.at(i, t_s);
        work.contact_tests += 1;
        let delta_m = delta(&at);
        let centre = Look {
            gap_m: face.gap_m(&at.p_WB) - radius_m,
            rate_m_s: face.normal.dot(&at.v_WB),
            toward_m_s2: bounds.toward(&face.normal, 0.0),
            ..Look::EMPTY
        };
        if centre.gap_m > delta_m && arm_m > 0.0 {
            return Some((centre.safe_s(delta_m, 0.0), false));
        }
        let slow = NO_SLIP * speed_m_s(paths.model, body, &at);
        let (curvature_m, known_s) = roundness(body, &at, &face.normal, &bounds);
        let toward_m_s2 = bounds.toward(&face.normal, arm_m) + bounds.w * bounds.w * curvature_m;
        let (mut safe_s, mut touching) = (f64::INFINITY, false);
        faces::each_near(body, &at, face, f64::INFINITY, |node, r_W, gap_m| {
            if is_held(node) {
                return;
            }
            let rate_m_s = face.normal.dot(&(at.v_WB + at.w_WB.cross(&r_W)));
            let look = Look { gap_m, rate_m_s, toward_m_s2, known_s, is_exact: arm_m == 0.0 && bounds.beside == 0.0 };
            safe_s = safe_s.min(look.safe_s(delta_m, slow));
            touching |= look.is_touching(delta_m, slow);
        });
        Some((safe_s, touching))
    })
}

/// A rim's or a smooth body's one lowest point is held, wherever it is; the others by their numbers.
fn is_same_feature(body: &Body, held: &Held, i: usize, f: usize, node: u32) -> bool {
    let (of, other, feature) = held.touch.key();
    let is_cylinder = matches!(&body.geometry, Geometry::Solid { solid: Solid::Cylinder { .. }, .. });
    let same = if is_cylinder { feature.1 / 4 == node / 4 } else { feature.1 == node };
    of == i && other.is_none() && feature.0 == f as u32 && same
}

/// How far a point of the core is from the centre of mass at most.
fn arm_m(body: &Body) -> f64 {
    match &body.geometry {
        Geometry::Solid { solid: Solid::Sphere { .. }, centre } => centre.norm(),
        Geometry::Solid { solid: Solid::Capsule { half_height_m, .. }, centre } => centre.norm() + half_height_m,
        _ => body.bounding_radius_m,
    }
}

/// The sine of a cylinder's tilt below which its rim lies flat, as far as the contact test can tell.
const FLAT: f64 = 1e-8;

/// Part of a tilt that is sure to be left until the next look: the bound of the curvature is for that.
const KEPT: f64 = 0.5;

/// The largest radius of curvature of what is round, and how long that is sure.
fn roundness(body: &Body, at: &BodyState, normal: &Vector3<f64>, bounds: &Bounds) -> (f64, f64) {
    match &body.geometry {
        Geometry::Solid { solid: Solid::Ellipsoid { semi_axes_m }, .. } => {
            (semi_axes_m.max() * semi_axes_m.max() / semi_axes_m.min(), f64::INFINITY)
        }
        Geometry::Solid { solid: Solid::Cylinder { radius_m, .. }, .. } => {
            let tilt = at.q_WB.inverse_transform_vector(normal).cross(&Vector3::y()).norm();
            let flat = tilt < FLAT;
            if flat {
                (0.0, f64::INFINITY)
            } else {
                (radius_m / (KEPT * tilt), KEPT * tilt / bounds.w.max(f64::MIN_POSITIVE))
            }
        }
        _ => (0.0, f64::INFINITY),
    }
}

/// Within this part of the smaller body's size, its points of contact are looked at, which beyond it only their
/// distance bounds: small enough for normals to turn little on the way, large against δ, so that the first of them is
/// not missed.
const NEAR: f64 = 1e-3;

/// Two points of contact that are nearer to each other, of the smaller body's size, are the same: the contact test
/// finds one that is held again, to rounding of the parts' own axes.
const SAME: f64 = 1e-6;

/// The longest way between two looks at points of contact, of the smaller body's size: other parts may come to be the
/// nearest.
const WAY: f64 = 0.05;

/// Points of contact move over the surfaces as well as with them, and normals turn: twice the bound of either.
const ROLLING: f64 = 2.0;

fn with_each_other(paths: &Paths, pair: [usize; 2], held: &[Held], window: Window, work: &mut Work) -> Option<f64> {
    let two = Two::new(paths, pair, held, window)?;
    if let [Solid::Sphere { radius_m: a }, Solid::Sphere { radius_m: b }] = two.solids {
        return if two.resting.is_empty() { two.balls(window, a + b, work) } else { None };
    }
    two.bodies(window, work)
}

/// Two bodies that may come to touch.
struct Two<'a> {
    paths: &'a Paths<'a>,
    pair: [usize; 2],
    bodies: [&'a Body; 2],
    solids: [&'a Solid; 2],
    centres: [&'a Vector3<f64>; 2],
    bounds: [Bounds; 2],
    resting: Vec<&'a Held>,
    sizes: [f64; 2],
    /// Of the centres against each other.
    between_m_s2: f64,
}

/// Both at one time.
struct Now {
    at: [BodyState; 2],
    poses: [Pose; 2],
    delta_m: f64,
    slow_m_s: f64,
}

impl<'a> Two<'a> {
    fn new(paths: &'a Paths, pair: [usize; 2], held: &'a [Held], window: Window) -> Option<Self> {
        let bodies = pair.map(|i| &paths.model.bodies[i]);
        let bounds = pair.map(|i| paths.bounds(i, window.to_s));
        let [Some((solid_a, centre_a)), Some((solid_b, centre_b))] = bodies.map(Body::solid) else { return None };
        let is_theirs = |h: &&Held| h.touch.key().0 == pair[0] && h.touch.key().1 == Some(pair[1]);
        Some(Two {
            paths,
            pair,
            bodies,
            solids: [solid_a, solid_b],
            centres: [centre_a, centre_b],
            bounds,
            resting: held.iter().filter(is_theirs).collect(),
            sizes: bodies.map(|body| body.bounding_radius_m),
            between_m_s2: (bounds[0].acceleration - bounds[1].acceleration).norm(),
        })
    }

    fn smaller_m(&self) -> f64 {
        self.sizes[0].min(self.sizes[1])
    }

    fn now(&self, t_s: f64, work: &mut Work) -> Now {
        let at = self.pair.map(|i| self.paths.at(i, t_s));
        work.contact_tests += 1;
        let speeds = [0, 1].map(|k| speed_m_s(self.paths.model, self.bodies[k], &at[k]));
        let pose = |k: usize| Pose { p_W: at[k].p_WB + at[k].q_WB * self.centres[k], q_W: at[k].q_WB };
        Now {
            at,
            poses: [0, 1].map(pose),
            delta_m: delta_m(self.smaller_m(), at[0].p_WB.amax().max(at[1].p_WB.amax()) + self.sizes[0]),
            slow_m_s: NO_SLIP * speeds.into_iter().fold(0.0, f64::max),
        }
    }

    /// M against every direction, as the normal turns, of points so far from their centres of mass.
    fn toward_m_s2(&self, arms_m: [f64; 2]) -> f64 {
        let size = |b: &Bounds, arm_m: f64| b.beside + arm_m * (b.alpha + b.w * b.w);
        self.between_m_s2 + size(&self.bounds[0], arms_m[0]) + size(&self.bounds[1], arms_m[1])
    }

    /// Balls touch where their centres are so near, wherever those are in their bodies.
    fn balls(&self, window: Window, reach_m: f64, work: &mut Work) -> Option<f64> {
        let toward_m_s2 = self.toward_m_s2(self.centres.map(|centre| centre.norm()));
        march(window, self.paths.deadline, |t_s| {
            let Now { at, poses, delta_m, slow_m_s } = self.now(t_s, work);
            let rate = |k: usize| at[k].v_WB + at[k].w_WB.cross(&(poses[k].p_W - at[k].p_WB));
            let look = Look::of_points(poses[0].p_W - poses[1].p_W, rate(0) - rate(1), reach_m, toward_m_s2);
            Some((look.safe_s(delta_m, slow_m_s), look.is_touching(delta_m, slow_m_s)))
        })
    }

    /// Others cannot touch while their bounding spheres do not; then their parts are looked at.
    fn bodies(&self, window: Window, work: &mut Work) -> Option<f64> {
        let (reach_m, toward_m_s2) = (self.sizes[0] + self.sizes[1], self.toward_m_s2([0.0, 0.0]));
        let mut found: Vec<Found> = Vec::new();
        march(window, self.paths.deadline, |t_s| {
            let now = self.now(t_s, work);
            let at = &now.at;
            let look = Look::of_points(at[0].p_WB - at[1].p_WB, at[0].v_WB - at[1].v_WB, reach_m, toward_m_s2);
            if look.gap_m > now.delta_m {
                return Some((look.safe_s(now.delta_m, now.slow_m_s), false));
            }
            found.clear();
            touches(self.solids[0], &now.poses[0], self.solids[1], &now.poses[1], reach_m, &mut found);
            Some(self.parts(&now, &found))
        })
    }

    /// Of the parts that face each other: the time in which none can touch, and whether one does.
    fn parts(&self, now: &Now, found: &[Found]) -> (f64, bool) {
        let Now { at, delta_m, slow_m_s, .. } = now;
        let [a, b] = &self.bounds;
        let near_m = NEAR * self.smaller_m();
        let closing = a.w * self.sizes[0] + b.w * self.sizes[1] + (at[0].v_WB - at[1].v_WB).norm();
        let (mut safe_s, mut touching) = (f64::INFINITY, false);
        for touch in found.iter().filter(|touch| !self.is_held(at, touch)) {
            if touch.gap_m > near_m {
                let (gap_m, rate_m_s) = (touch.gap_m - near_m / 2.0, -closing);
                let bound = Look { gap_m, rate_m_s, toward_m_s2: self.between_m_s2, ..Look::EMPTY };
                safe_s = safe_s.min(bound.safe_s(*delta_m, *slow_m_s));
                continue;
            }
            let velocity = |k: usize| at[k].v_WB + at[k].w_WB.cross(&(touch.p_W - at[k].p_WB));
            let rate_m_s = touch.normal.dot(&(velocity(0) - velocity(1)));
            // The normal turns with the bodies.
            let turning = ROLLING * (a.w + b.w) * closing;
            let toward_m_s2 = ROLLING * self.toward_m_s2(self.sizes) + turning;
            let look = Look { gap_m: touch.gap_m, rate_m_s, toward_m_s2, known_s: near_m / closing, ..Look::EMPTY };
            safe_s = safe_s.min(look.safe_s(*delta_m, *slow_m_s));
            touching |= look.is_touching(*delta_m, *slow_m_s);
        }
        let way_m = near_m.max(self.smaller_m() * WAY);
        (safe_s.min(way_m / closing.max(f64::MIN_POSITIVE)), touching)
    }

    fn is_held(&self, at: &[BodyState; 2], touch: &Found) -> bool {
        self.resting.iter().any(|h| {
            let p = h.touch.here_of(|i| if i == self.pair[0] { &at[0] } else { &at[1] }).contact.p_WC;
            (p - touch.p_W).norm() <= SAME * self.smaller_m()
        })
    }
}

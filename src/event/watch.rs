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
use crate::collide::{Contact, faces};
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

/// δ: of the bounding radius, and of the coordinates.
const DELTA: f64 = 1e-13;
const ULPS: f64 = 8.0 * f64::EPSILON;

pub fn delta_m(radius_m: f64, coordinate_m: f64) -> f64 {
    DELTA * radius_m + ULPS * coordinate_m
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

    fn is_touching(&self, delta_m: f64, slow_m_s: f64) -> bool {
        (self.gap_m <= delta_m && self.rate_m_s < -slow_m_s) || (self.gap_m < -delta_m && self.rate_m_s < 0.0)
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

/// The largest radius of curvature of what is round, and how long that is sure.
fn roundness(body: &Body, at: &BodyState, normal: &Vector3<f64>, bounds: &Bounds) -> (f64, f64) {
    match &body.geometry {
        Geometry::Solid { solid: Solid::Ellipsoid { semi_axes_m }, .. } => {
            (semi_axes_m.max() * semi_axes_m.max() / semi_axes_m.min(), f64::INFINITY)
        }
        Geometry::Solid { solid: Solid::Cylinder { radius_m, .. }, .. } => {
            let tilt = at.q_WB.inverse_transform_vector(normal).cross(&Vector3::y()).norm();
            let flat = tilt < 1e-8;
            if flat {
                (0.0, f64::INFINITY)
            } else {
                (2.0 * radius_m / tilt, 0.5 * tilt / bounds.w.max(f64::MIN_POSITIVE))
            }
        }
        _ => (0.0, f64::INFINITY),
    }
}

fn with_each_other(paths: &Paths, pair: [usize; 2], held: &[Held], window: Window, work: &mut Work) -> Option<f64> {
    let bodies = pair.map(|i| &paths.model.bodies[i]);
    let bounds = pair.map(|i| paths.bounds(i, window.to_s));
    let resting: Vec<&Held> =
        held.iter().filter(|h| h.touch.key().0 == pair[0] && h.touch.key().1 == Some(pair[1])).collect();
    let [Some((solid_a, centre_a)), Some((solid_b, centre_b))] = bodies.map(Body::solid) else { return None };
    let balls = match (solid_a, solid_b) {
        (Solid::Sphere { radius_m: a }, Solid::Sphere { radius_m: b }) => Some(a + b),
        _ => None,
    };
    if balls.is_some() && !resting.is_empty() {
        return None;
    }
    let sizes = bodies.map(|body| body.bounding_radius_m);
    let reach_m = balls.unwrap_or(sizes[0] + sizes[1]);
    let arms = if balls.is_some() { [centre_a.norm(), centre_b.norm()] } else { [0.0, 0.0] };
    // Against every direction: the normal turns.
    let size = |b: &Bounds, arm: f64| b.beside + arm * (b.alpha + b.w * b.w);
    let between = (bounds[0].acceleration - bounds[1].acceleration).norm();
    let toward_m_s2 = between + size(&bounds[0], arms[0]) + size(&bounds[1], arms[1]);
    let points_toward = between + size(&bounds[0], sizes[0]) + size(&bounds[1], sizes[1]);
    let mut found: Vec<Found> = Vec::new();
    march(window, paths.deadline, |t_s| {
        let at = pair.map(|i| paths.at(i, t_s));
        work.contact_tests += 1;
        let delta_m = delta_m(sizes[0].min(sizes[1]), at[0].p_WB.amax().max(at[1].p_WB.amax()) + sizes[0]);
        let slow = NO_SLIP * [0, 1].map(|k| speed_m_s(paths.model, bodies[k], &at[k])).into_iter().fold(0.0, f64::max);
        let poses =
            [(centre_a, &at[0]), (centre_b, &at[1])].map(|(c, at)| Pose { p_W: at.p_WB + at.q_WB * c, q_W: at.q_WB });
        let of_centres = balls.is_some();
        let point = |side: usize| if of_centres { poses[side].p_W } else { at[side].p_WB };
        let rate = |side: usize| {
            if of_centres {
                at[side].v_WB + at[side].w_WB.cross(&(poses[side].p_W - at[side].p_WB))
            } else {
                at[side].v_WB
            }
        };
        let apart = point(0) - point(1);
        let distance = apart.norm();
        let look = Look {
            gap_m: distance - reach_m,
            rate_m_s: if distance > 0.0 { apart.dot(&(rate(0) - rate(1))) / distance } else { 0.0 },
            toward_m_s2,
            ..Look::EMPTY
        };
        if of_centres {
            return Some((look.safe_s(delta_m, slow), look.is_touching(delta_m, slow)));
        }
        if look.gap_m > delta_m {
            return Some((look.safe_s(delta_m, slow), false));
        }
        let near_m = 1e-3 * sizes[0].min(sizes[1]);
        found.clear();
        touches(solid_a, &poses[0], solid_b, &poses[1], sizes[0] + sizes[1], &mut found);
        let closing = bounds[0].w * sizes[0] + bounds[1].w * sizes[1] + (at[0].v_WB - at[1].v_WB).norm();
        let (mut safe_s, mut touching) = (f64::INFINITY, false);
        for touch in &found {
            let is_held = resting.iter().any(|h| {
                let p = h.touch.here_of(|i| if i == pair[0] { &at[0] } else { &at[1] }).contact.p_WC;
                (p - touch.p_W).norm() <= 1e-6 * sizes[0].min(sizes[1])
            });
            if is_held {
                continue;
            }
            let velocity = |side: usize| at[side].v_WB + at[side].w_WB.cross(&(touch.p_W - at[side].p_WB));
            let rate_m_s = touch.normal.dot(&(velocity(0) - velocity(1)));
            if touch.gap_m > near_m {
                let bound =
                    Look { gap_m: touch.gap_m - near_m / 2.0, rate_m_s: -closing, toward_m_s2: between, ..Look::EMPTY };
                safe_s = safe_s.min(bound.safe_s(delta_m, slow));
                continue;
            }
            // The normal turns with the bodies.
            let turning = 2.0 * (bounds[0].w + bounds[1].w) * closing;
            let look = Look {
                gap_m: touch.gap_m,
                rate_m_s,
                toward_m_s2: 2.0 * points_toward + turning,
                known_s: near_m / closing,
                ..Look::EMPTY
            };
            safe_s = safe_s.min(look.safe_s(delta_m, slow));
            touching |= look.is_touching(delta_m, slow);
        }
        Some((safe_s.min(near_m.max(sizes[0].min(sizes[1]) * 0.05) / closing.max(f64::MIN_POSITIVE)), touching))
    })
}

/// δ of a contact: of the smaller body.
pub fn delta_at_m(model: &Model, contact: &Contact) -> f64 {
    let radius_m = contact.ends().map(|(i, ..)| model.bodies[i].bounding_radius_m).fold(f64::INFINITY, f64::min);
    delta_m(radius_m, contact.p_WC.amax() + radius_m)
}

/// Whether a contact of the contact test is within δ.
pub fn is_closed(model: &Model, contact: &Contact) -> bool {
    // The search ends within δ, the projection of what is held likewise.
    contact.gap_m <= 20.0 * delta_at_m(model, contact)
}

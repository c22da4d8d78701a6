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

use super::caps::{self, Cap};
use super::dense::Dense;
use super::forces::{Held, NO_SLIP, speed_m_s};
use super::motion::{Bounds, Motion};
use super::which::{GRAZING, Sharing};
use crate::collide::closed::delta_m;
use crate::collide::faces;
use crate::deadline::Deadline;
use crate::model::container::Face;
use crate::model::{Body, Geometry, Model, pose_of_solid};
use crate::shape::band::{Along, BAND, touches_beside};
use crate::shape::cylinder::FLAT;
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
        let flattest = Cap::facing(body, &at, &face.normal).filter(|cap| !is_held(cap.first()));
        // Of all points of the rim, wherever the lowest will be.
        let flat = flattest.map(|cap| {
            let (arm_W, sagitta_m) = cap.reach(&at, &face.normal);
            let (rate_m_s, more_m_s) = cap.rates(&at, &face.normal);
            let (gap_m, rate_m_s) = (face.gap_m(&(at.p_WB + arm_W)) - sagitta_m, rate_m_s - more_m_s);
            let toward_m_s2 = bounds.toward(&face.normal, arm_m);
            (Look { gap_m, rate_m_s, toward_m_s2, ..Look::EMPTY }, cap)
        });
        let (mut safe_s, mut touching) = (f64::INFINITY, false);
        let mut of_flattest_s = f64::INFINITY;
        faces::each_near(body, &at, face, f64::INFINITY, |node, r_W, gap_m| {
            if is_held(node) {
                return;
            }
            let rate_m_s = face.normal.dot(&(at.v_WB + at.w_WB.cross(&r_W)));
            let look = Look { gap_m, rate_m_s, toward_m_s2, known_s, is_exact: arm_m == 0.0 && bounds.beside == 0.0 };
            let of = if flat.as_ref().is_some_and(|(_, cap)| cap.has(node)) { &mut of_flattest_s } else { &mut safe_s };
            *of = of.min(look.safe_s(delta_m, slow));
            touching |= look.is_touching(delta_m, slow);
        });
        if let Some((look, cap)) = &flat {
            let of_rim_s = look.safe_s(delta_m, slow);
            if cap.is_flat(&at, &face.normal) {
                of_flattest_s = of_rim_s;
                touching |= look.is_touching(delta_m, slow);
            }
            safe_s = safe_s.min(of_flattest_s.max(of_rim_s));
        }
        Some((safe_s, touching))
    })
}

/// A rim's or a smooth body's one lowest point is held, wherever it is; the others by their numbers.
fn is_same_feature(body: &Body, held: &Held, i: usize, f: usize, node: u32) -> bool {
    let (of, other, feature) = held.touch.key();
    let is_cylinder = matches!(&body.geometry, Geometry::Solid { solid: Solid::Cylinder { .. }, .. });
    let same = if is_cylinder { feature.1 % 8 / 4 == node / 4 } else { feature.1 == node };
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

/// δ that what passes by may be inside, and looks at it: halving its rate, it is none after forty.
const FEW: f64 = 10.0;
const MOST_ARRIVING: u32 = 200;

/// Parts of two bodies that face each other.
struct Parted {
    /// In which none can touch.
    safe_s: f64,
    /// One does.
    touching: bool,
    /// So many are closed and stay so.
    lingering: usize,
}

/// How two bodies come to each other.
#[derive(Clone, Copy)]
enum Way {
    Apart,
    /// An edge or a corner alone is shared.
    Shared,
    /// The gap closes without an impact, at the next look.
    Arriving,
}

fn nearest(found: &[Found]) -> Option<&Found> {
    found.iter().min_by(|a, b| a.gap_m.total_cmp(&b.gap_m))
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
    /// All that is held.
    held: &'a [Held],
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
            held,
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
        let pose = |k: usize| pose_of_solid(self.centres[k], &at[k]);
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
        let mut way = Way::Apart;
        let mut known = None;
        march(window, self.paths.deadline, |t_s| {
            let now = self.now(t_s, work);
            let at = &now.at;
            let look = Look::of_points(at[0].p_WB - at[1].p_WB, at[0].v_WB - at[1].v_WB, reach_m, toward_m_s2);
            if look.gap_m > now.delta_m {
                return Some((look.safe_s(now.delta_m, now.slow_m_s), false));
            }
            self.find(&now, &mut found);
            let Parted { safe_s, touching, lingering } = self.parts(&now, &found);
            // What comes to be touched beside what is held is to be held, too.
            let is_new = known.replace(lingering).is_some_and(|known| lingering > known);
            if !self.resting.is_empty() && is_new {
                return Some((safe_s, true));
            }
            if !self.resting.is_empty() || nearest(&found).is_none_or(|nearest| nearest.gap_m > self.band_m()) {
                way = Way::Apart;
                return Some((safe_s, touching));
            }
            if let Some(sharing) = Sharing::new(self.paths.model, self.pair, at.each_ref())
                && sharing.rate_m_s() >= -now.slow_m_s
            {
                way = Way::Shared;
                return Some((self.parted_s(&now, &sharing), false));
            }
            match std::mem::replace(&mut way, Way::Apart) {
                // What they shared has got an area, or comes to be touched.
                Way::Shared | Way::Arriving => Some((safe_s, true)),
                Way::Apart if touching => match self.arrives_s(t_s, window, work) {
                    Some(arrives_s) => {
                        way = Way::Arriving;
                        Some((arrives_s - t_s, false))
                    }
                    None => Some((safe_s, true)),
                },
                Way::Apart => Some((safe_s, false)),
            }
        })
    }

    fn find(&self, now: &Now, found: &mut Vec<Found>) {
        found.clear();
        let reach_m = self.sizes[0] + self.sizes[1];
        touches_beside(self.solids[0], &now.poses[0], self.solids[1], &now.poses[1], reach_m, found);
    }

    fn band_m(&self) -> f64 {
        BAND * self.smaller_m()
    }

    /// How fast any of their points comes nearer at most.
    fn closing_m_s(&self, at: &[BodyState; 2]) -> f64 {
        let [a, b] = &self.bounds;
        a.w * self.sizes[0] + b.w * self.sizes[1] + (at[0].v_WB - at[1].v_WB).norm()
    }

    /// M of points of contact: the normal turns with the bodies, and they move over the surfaces.
    fn rolling_m_s2(&self, closing_m_s: f64) -> f64 {
        let turning = ROLLING * (self.bounds[0].w + self.bounds[1].w) * closing_m_s;
        ROLLING * self.toward_m_s2(self.sizes) + turning
    }

    /// In which none of the axes that separate two bodies alike is out of the band.
    fn parted_s(&self, now: &Now, sharing: &Sharing) -> f64 {
        let toward_m_s2 = self.rolling_m_s2(self.closing_m_s(&now.at));
        let out_s = |(along, rate_m_s): &(Along, f64)| {
            let look = Look { gap_m: along.gap_m + self.band_m(), rate_m_s: *rate_m_s, toward_m_s2, ..Look::EMPTY };
            look.safe_s(now.delta_m, now.slow_m_s)
        };
        let way_s = self.smaller_m() * WAY / self.closing_m_s(&now.at).max(f64::MIN_POSITIVE);
        sharing.axes.iter().map(out_s).fold(way_s, f64::min)
    }

    /// When a gap that closes ever more slowly has closed, if it does not go on: what comes over an edge along a
    /// surface that another contact holds, or passes by. None: it is an impact.
    fn arrives_s(&self, from_s: f64, window: Window, work: &mut Work) -> Option<f64> {
        let mut found = Vec::new();
        let mut t_s = from_s;
        let mut most_m = None;
        for _ in 0..MOST_ARRIVING {
            let now = self.now(t_s, work);
            self.find(&now, &mut found);
            let Some(nearest) = nearest(&found) else { return Some(t_s) };
            let closing_m_s = self.closing_m_s(&now.at);
            let velocity = |k: usize| now.at[k].v_WB + now.at[k].w_WB.cross(&(nearest.p_W - now.at[k].p_WB));
            let rate_m_s = nearest.normal.dot(&(velocity(0) - velocity(1)));
            let most_m = *most_m.get_or_insert_with(|| {
                if self.is_held_along(t_s, &nearest.normal) { self.band_m() } else { FEW * now.delta_m }
            });
            if rate_m_s < -GRAZING * closing_m_s || nearest.gap_m < -most_m {
                return None;
            }
            if rate_m_s >= -now.slow_m_s {
                return Some(t_s);
            }
            let toward_m_s2 = self.rolling_m_s2(closing_m_s);
            let look = Look { gap_m: nearest.gap_m + most_m, rate_m_s, toward_m_s2, ..Look::EMPTY };
            t_s = (t_s + look.safe_s(0.0, now.slow_m_s)).max(t_s.next_up());
            if t_s >= window.to_s {
                return Some(window.to_s);
            }
        }
        None
    }

    /// Whether something else holds one of the two along this normal.
    fn is_held_along(&self, t_s: f64, normal: &Vector3<f64>) -> bool {
        self.held.iter().any(|h| {
            let at: Vec<(usize, BodyState)> = h.touch.bodies().map(|i| (i, self.paths.at(i, t_s))).collect();
            let of = |i: usize| at.iter().find(|(j, _)| *j == i).map_or(&at[0].1, |(_, at)| at);
            let held = h.touch.here_of(of).contact;
            let along = |sign: f64| held.normal.dot(normal) * sign > 0.0;
            let turned = held.normal.cross(normal).norm();
            turned <= GRAZING
                && held
                    .ends()
                    .any(|(i, _, sign)| (i == self.pair[0] && along(sign)) || (i == self.pair[1] && along(-sign)))
        })
    }

    /// Of the parts that face each other and are not held.
    fn parts(&self, now: &Now, found: &[Found]) -> Parted {
        let Now { at, delta_m, slow_m_s, .. } = now;
        let near_m = NEAR * self.smaller_m();
        let closing = self.closing_m_s(at);
        let (mut safe_s, mut touching, mut lingering) = (f64::INFINITY, false, 0);
        for touch in found.iter().filter(|touch| !self.is_held(at, touch)) {
            if touch.gap_m > near_m {
                let (gap_m, rate_m_s) = (touch.gap_m - near_m / 2.0, -closing);
                let bound = Look { gap_m, rate_m_s, toward_m_s2: self.between_m_s2, ..Look::EMPTY };
                safe_s = safe_s.min(bound.safe_s(*delta_m, *slow_m_s));
                continue;
            }
            let velocity = |k: usize| at[k].v_WB + at[k].w_WB.cross(&(touch.p_W - at[k].p_WB));
            let rate_m_s = touch.normal.dot(&(velocity(0) - velocity(1)));
            let toward_m_s2 = self.rolling_m_s2(closing);
            let look = Look { gap_m: touch.gap_m, rate_m_s, toward_m_s2, known_s: near_m / closing, ..Look::EMPTY };
            safe_s = safe_s.min(self.rolling_s(now, touch, &look));
            let touches = look.is_touching(*delta_m, *slow_m_s);
            touching |= touches;
            lingering += usize::from(!touches && look.gap_m <= *delta_m && look.rate_m_s <= *slow_m_s);
        }
        let way_m = near_m.max(self.smaller_m() * WAY);
        Parted { safe_s: safe_s.min(way_m / closing.max(f64::MIN_POSITIVE)), touching, lingering }
    }

    /// The safe time of such a look, of a cap that is nearly flat: its lowest point rolls along the rim.
    fn rolling_s(&self, now: &Now, touch: &Found, look: &Look) -> f64 {
        let Now { at, delta_m, slow_m_s, .. } = now;
        let w_rad_s = self.bounds[0].w + self.bounds[1].w;
        let Some(rolling) = caps::rolling(self.bodies, at, &touch.normal, w_rad_s) else {
            return look.safe_s(*delta_m, *slow_m_s);
        };
        let of_any = Look { rate_m_s: look.rate_m_s - rolling.faster_m_s, ..*look };
        let of_any_s = of_any.safe_s(*delta_m, *slow_m_s);
        let Some((more_m_s2, known_s)) = rolling.along else { return of_any_s };
        let along = Look { toward_m_s2: look.toward_m_s2 + more_m_s2, known_s: look.known_s.min(known_s), ..*look };
        of_any_s.max(along.safe_s(*delta_m, *slow_m_s))
    }

    fn is_held(&self, at: &[BodyState; 2], touch: &Found) -> bool {
        self.resting.iter().any(|h| {
            let p = h.touch.here_of(|i| if i == self.pair[0] { &at[0] } else { &at[1] }).contact.p_WC;
            // The lowest point of a rim is held, wherever it is.
            caps::are_of_one_rim(h.touch.key().2, touch.feature) || (p - touch.p_W).norm() <= SAME * self.smaller_m()
        })
    }
}

//! When two bodies come to touch with parts that are not held (`watch`).

use super::caps::{Cap, RollingRim, are_of_one_rim, cap_under_rim_W};
use super::decide::SAME;
use super::forces::{Held, NO_SLIP, speed_m_s};
use super::look::{Look, Paths, Window, march};
use super::motion::Bounds;
use super::rolling::rolling;
use super::touch::{Touch, beyond_edge_W, is_nothing};
use super::which::{GRAZING, Sharing};
use crate::collide::Contact;
use crate::collide::closed::delta_m;
use crate::model::{Body, pose_of_solid};
use crate::shape::band::{Along, BAND, touches_beside};
use crate::shape::cylinder::{EDGE, FACE, RIM, VERTEX, kind};
use crate::shape::solid::{Meeting as Found, Pose, Solid};
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::Vector3;
use smallvec::SmallVec;

/// Within this part of the smaller body's size, its points of contact are looked at, which beyond it only their
/// distance bounds: small enough for normals to turn little on the way, large against δ, so that the first of them is
/// not missed.
const NEAR: f64 = 1e-3;

/// Normals that differ by less are one, and so do points, of the smaller body's size, that are beside a line.
const FLUSH: f64 = 1e-9;

/// Of the smaller body's size: points this far apart span a line or a plane.
const SPREAD: f64 = 1e-6;

/// Whether the contact test has found a point of a rim on an edge.
fn is_rim_on_edge(feature: (u32, u32)) -> bool {
    let kinds = [feature.0, feature.1].map(kind);
    kinds == [EDGE, VERTEX] || kinds == [VERTEX, EDGE]
}

/// The edge of such a point.
fn edge(feature: (u32, u32)) -> u32 {
    if kind(feature.0) == EDGE { feature.0 } else { feature.1 }
}

/// Sine of an angle between a rim and an edge at which they cross.
const CROSSES: f64 = 1e-2;

/// The longest way between two looks at points of contact, of the smaller body's size: other parts may come to be the
/// nearest.
const WAY: f64 = 0.05;

/// Points of contact move over the surfaces as well as with them, and normals turn: twice the bound of either.
const ROLLING: f64 = 2.0;

/// The earliest time at which two bodies touch with what is not held.
pub(super) fn with_each_other(
    paths: &Paths,
    pair: [usize; 2],
    held: &[Held],
    window: Window,
    work: &mut Work,
) -> Option<f64> {
    let two = Two::new(paths, pair, held, window)?;
    if let [Solid::Sphere { radius_m: a }, Solid::Sphere { radius_m: b }] = two.solids {
        return if two.resting.is_empty() { two.balls(window, a + b, work) } else { None };
    }
    two.bodies(window, work)
}

/// δ that what passes by may be inside, and looks at it: halving its rate, it is none after forty.
const FEW: f64 = 10.0;
const MOST_ARRIVING: u32 = 200;

/// Of the band: where an axis leaves it is not asked more closely.
const PART_OF_BAND: f64 = 0.1;

/// Of how deep one is.
const DEEPER: f64 = 0.1;

/// Parts of two bodies that face each other.
struct Parted {
    /// The least gap.
    least_m: f64,
    /// In which none can touch; none of those that do not.
    safe_s: f64,
    others_s: f64,
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
    /// Where the one that moves stands on others than the other one, neither of which do.
    footing: Vec<&'a Held>,
    /// All that is held.
    held: &'a [Held],
    sizes: [f64; 2],
    /// Of the centres against each other.
    between_m_s2: f64,
}

/// What holds the one of a pair that moves on bodies that do not, if the other one does not.
fn footing<'a>(paths: &Paths, pair: [usize; 2], held: &'a [Held]) -> Vec<&'a Held> {
    let is_still = |i: usize| paths.model.bodies[i].driven;
    let [moving, still] = if is_still(pair[0]) { [pair[1], pair[0]] } else { pair };
    if is_still(moving) || !is_still(still) {
        return Vec::new();
    }
    let on_another = |held: &&Held| {
        let mut bodies = held.touch.bodies();
        held.touch.key().1.is_some()
            && bodies.any(|i| i == moving)
            && held.touch.bodies().any(|i| i != still && is_still(i))
    };
    held.iter().filter(on_another).collect()
}

/// Both at one time.
struct Now {
    t_s: f64,
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
            footing: footing(paths, pair, held),
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
            t_s,
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
            let Now { at, poses, delta_m, slow_m_s, .. } = self.now(t_s, work);
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
        // The last two looks at parts, and the least gaps there.
        let mut looks = [None::<(f64, f64)>; 2];
        let touch_s = march(window, self.paths.deadline, |t_s| {
            let now = self.now(t_s, work);
            let at = &now.at;
            let look = Look::of_points(at[0].p_WB - at[1].p_WB, at[0].v_WB - at[1].v_WB, reach_m, toward_m_s2);
            if look.gap_m > now.delta_m {
                return Some((look.safe_s(now.delta_m, now.slow_m_s), false));
            }
            self.find(&now, &mut found);
            let Parted { least_m, safe_s, others_s, touching, lingering } = self.parts(&now, &found);
            looks = [looks[1], Some((t_s, least_m))];
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
                    // Others may be there before.
                    Some(arrives_s) if arrives_s > t_s + others_s => Some((others_s, false)),
                    Some(arrives_s) => {
                        way = Way::Arriving;
                        Some((arrives_s - t_s, false))
                    }
                    None => Some((safe_s, true)),
                },
                Way::Apart => Some((safe_s, false)),
            }
        });
        let Some(touch_s) = touch_s else { return self.unseen_s(window, work) };
        let few_m = FEW * self.now(touch_s, work).delta_m;
        match looks {
            // Another part has come nearer than those that were looked at: what lies along a face, but next to, or the
            // other end of what has just struck with one.
            [Some((open_s, open_m)), Some((deep_s, deep_m))]
                if deep_s == touch_s && open_m >= -few_m && deep_m < -few_m =>
            {
                Some(self.closes_s([open_s, deep_s], few_m, work))
            }
            _ => Some(touch_s),
        }
    }

    /// When they came to be deeper in each other than the band, with parts that are not held, though no look has seen
    /// it: another part may have come to be the nearest on the way.
    fn unseen_s(&self, window: Window, work: &mut Work) -> Option<f64> {
        let band_m = self.band_m();
        let is_unseen = !self.paths.deadline.is_over()
            && self.least_m(window.to_s, work) < -band_m
            && self.least_m(window.from_s, work) >= -band_m;
        is_unseen.then(|| self.closes_s([window.from_s, window.to_s], band_m, work))
    }

    /// The least gap of what is not held.
    fn least_m(&self, t_s: f64, work: &mut Work) -> f64 {
        let now = self.now(t_s, work);
        if (now.at[0].p_WB - now.at[1].p_WB).norm() > self.sizes[0] + self.sizes[1] {
            return f64::INFINITY;
        }
        let mut found = Vec::new();
        self.find(&now, &mut found);
        self.others(&now, &found).map(|touch| touch.gap_m).fold(f64::INFINITY, f64::min)
    }

    /// When they touch, between two times: at the one they are apart, at the other one deep in each other.
    fn closes_s(&self, [mut open_s, mut deep_s]: [f64; 2], few_m: f64, work: &mut Work) -> f64 {
        loop {
            let middle_s = 0.5 * (open_s + deep_s);
            if middle_s <= open_s || middle_s >= deep_s || self.paths.deadline.is_over() {
                return deep_s;
            }
            let gap_m = self.least_m(middle_s, work);
            if gap_m > 0.0 {
                open_s = middle_s;
            } else {
                deep_s = middle_s;
                if gap_m >= -few_m {
                    return deep_s;
                }
            }
        }
    }

    fn find(&self, now: &Now, found: &mut Vec<Found>) {
        found.clear();
        let reach_m = self.sizes[0] + self.sizes[1];
        touches_beside(self.solids[0], &now.poses[0], self.solids[1], &now.poses[1], reach_m, found);
        let bodies = [0, 1].map(|k| (self.bodies[k], &now.at[k]));
        found.retain(|touch| !is_nothing(bodies, touch.feature, (&touch.p_W, &touch.normal)));
        for touch in &mut *found {
            touch.normal = cap_under_rim_W(bodies, touch.feature, &touch.normal).unwrap_or(touch.normal);
            touch.p_W -= beyond_edge_W(bodies, touch.feature, &touch.p_W).unwrap_or_default();
        }
        let rolls = |touch: &Found| RollingRim::new(bodies, touch.feature, (&touch.p_W, &touch.normal));
        let rolling: SmallVec<[RollingRim; 2]> = found.iter().filter_map(rolls).collect();
        found.retain(|touch| !rolling.iter().any(|rolling| rolling.has(touch.feature, &touch.p_W)));
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
        let closing_m_s = self.closing_m_s(&now.at).max(f64::MIN_POSITIVE);
        let least_s = PART_OF_BAND * self.band_m() / closing_m_s;
        sharing.axes.iter().map(out_s).fold(self.smaller_m() * WAY / closing_m_s, f64::min).max(least_s)
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
        let (mut safe_s, mut others_s) = (f64::INFINITY, f64::INFINITY);
        let (mut touching, mut lingering, mut least_m) = (false, 0, f64::INFINITY);
        for touch in &self.others(now, found).collect::<SmallVec<[Found; 4]>>() {
            least_m = least_m.min(touch.gap_m);
            if touch.gap_m > near_m {
                let (gap_m, rate_m_s) = (touch.gap_m - near_m / 2.0, -closing);
                let bound = Look { gap_m, rate_m_s, toward_m_s2: self.between_m_s2, ..Look::EMPTY };
                let of_touch_s = bound.safe_s(*delta_m, *slow_m_s);
                (safe_s, others_s) = (safe_s.min(of_touch_s), others_s.min(of_touch_s));
                continue;
            }
            let velocity = |k: usize| at[k].v_WB + at[k].w_WB.cross(&(touch.p_W - at[k].p_WB));
            let rate_m_s = touch.normal.dot(&(velocity(0) - velocity(1)));
            let toward_m_s2 = self.rolling_m_s2(closing);
            let look = Look { gap_m: touch.gap_m, rate_m_s, toward_m_s2, known_s: near_m / closing, ..Look::EMPTY };
            let touches = look.is_touching(*delta_m, *slow_m_s);
            let lingers = !touches && look.gap_m <= *delta_m && look.rate_m_s <= *slow_m_s;
            let of_touch_s = self.rolling_s(now, touch, &look).max(self.deeper_s(touch.gap_m, closing));
            safe_s = safe_s.min(of_touch_s);
            others_s = if touches { others_s } else { others_s.min(of_touch_s) };
            touching |= touches;
            lingering += usize::from(lingers);
        }
        let way_m = near_m.max(self.smaller_m() * WAY);
        let way_s = way_m / closing.max(f64::MIN_POSITIVE);
        Parted { least_m, safe_s: safe_s.min(way_s), others_s: others_s.min(way_s), touching, lingering }
    }

    /// In which what is deep inside and comes out gets deeper by no more than a part of that: what steps of equal
    /// length have left is not to be seen more sharply.
    fn deeper_s(&self, gap_m: f64, closing_m_s: f64) -> f64 {
        if gap_m < -self.band_m() { DEEPER * -gap_m / closing_m_s.max(f64::MIN_POSITIVE) } else { 0.0 }
    }

    /// The safe time of such a look, of a cap that is nearly flat: its lowest point rolls along the rim. Not where one
    /// crossing of it with an edge is held: between that and the other one, the edge is nowhere nearer than at these.
    fn rolling_s(&self, now: &Now, touch: &Found, look: &Look) -> f64 {
        let Now { at, delta_m, slow_m_s, .. } = now;
        if self.crossings(touch).next().is_some() {
            return look.safe_s(*delta_m, *slow_m_s);
        }
        if let Some(safe_s) = self.crossing_s(now, touch, look) {
            return safe_s;
        }
        let w_rad_s = self.bounds[0].w + self.bounds[1].w;
        let Some(rolling) = rolling(self.bodies, at, (touch, *delta_m), w_rad_s) else {
            return look.safe_s(*delta_m, *slow_m_s);
        };
        let of_any = Look { rate_m_s: look.rate_m_s - rolling.faster_m_s, ..*look };
        let of_rims_s = rolling.down.iter().flat_map(|down| {
            down.iter().map(|rim| rim.safe_s(look.height_m(*delta_m), look.toward_m_s2)).reduce(f64::min)
        });
        let of_any_s = of_rims_s.fold(of_any.safe_s(*delta_m, *slow_m_s), f64::max);
        let Some((more_m_s2, known_s)) = rolling.along else { return of_any_s };
        let along = Look { toward_m_s2: look.toward_m_s2 + more_m_s2, known_s: look.known_s.min(known_s), ..*look };
        of_any_s.max(along.safe_s(*delta_m, *slow_m_s))
    }

    /// The safe time of an edge that crosses a rim, of which no point is held: that of both crossings, between which it
    /// is nowhere nearer. They move along the rim as fast as the two do, over the sine of their angle. None: there are
    /// no such points, or the two are next to tangent.
    fn crossing_s(&self, now: &Now, touch: &Found, look: &Look) -> Option<f64> {
        let Now { at, delta_m, slow_m_s, .. } = now;
        if !is_rim_on_edge(touch.feature) {
            return None;
        }
        let crossings = Touch::crossings(self.paths.model, self.pair, at, touch)?;
        let least = crossings.iter().map(|(_, sine)| *sine).fold(f64::INFINITY, f64::min);
        let safe_s = |(point, sine): &(Found, f64)| {
            let velocity = |k: usize| at[k].v_WB + at[k].w_WB.cross(&(point.p_W - at[k].p_WB));
            let rate_m_s = point.normal.dot(&(velocity(0) - velocity(1)));
            let (toward_m_s2, known_s) = (look.toward_m_s2 / sine, look.known_s * sine);
            Look { gap_m: point.gap_m, rate_m_s, toward_m_s2, known_s, ..*look }.safe_s(*delta_m, *slow_m_s)
        };
        (least > CROSSES).then(|| crossings.iter().map(safe_s).fold(f64::INFINITY, f64::min))
    }

    /// Where the edge of such a point crosses the rim and is held.
    fn crossings(&self, touch: &Found) -> impl Iterator<Item = &Held> {
        let (is_on_edge, of) = (is_rim_on_edge(touch.feature), edge(touch.feature));
        let is_it = move |h: &&Held| is_on_edge && h.touch.is_crossing() && edge(h.touch.key().2) == of;
        self.resting.iter().copied().filter(is_it)
    }

    /// What is not held. Of an edge that crosses a rim in a point that is held, the other such point: the contact test
    /// hardly knows where it is.
    fn others<'b>(&'b self, now: &'b Now, found: &'b [Found]) -> impl Iterator<Item = Found> + 'b {
        let held = self.places(&now.at);
        let own = move |touch: &Found| {
            let mut crossing = self.crossings(touch);
            match (crossing.next(), crossing.next()) {
                (None, _) => (!self.is_held(&held, now, touch)).then_some(*touch),
                (Some(first), None) => {
                    let other = first.touch.other_crossing(|i| &now.at[usize::from(i != self.pair[0])])?;
                    Some(other.point())
                }
                (Some(_), Some(_)) => None,
            }
        };
        found.iter().filter_map(own)
    }

    /// Where the two are held.
    fn places(&self, at: &[BodyState; 2]) -> Vec<Contact> {
        let here = |h: &&Held| h.touch.here_of(|i| if i == self.pair[0] { &at[0] } else { &at[1] }).contact;
        self.resting.iter().map(here).collect()
    }

    /// The same of the body that moves, by others that do not; along its normals from the other one of the pair.
    fn footing_beside(&self, now: &Now) -> Vec<Contact> {
        let moving = usize::from(self.bodies[0].driven);
        let here = |held: &&Held| {
            let still = |i: usize| if i == self.pair[moving] { now.at[moving] } else { self.paths.at(i, now.t_s) };
            let at: Vec<(usize, BodyState)> = held.touch.bodies().map(|i| (i, still(i))).collect();
            let of = |i: usize| at.iter().find(|(j, _)| *j == i).map_or(&at[0].1, |(_, at)| at);
            let contact = held.touch.here_of(of).contact;
            let is_first = contact.body == self.pair[moving];
            // From the second of the pair to the first.
            let sign = if is_first == (moving == 0) { 1.0 } else { -1.0 };
            Contact { normal: contact.normal * sign, ..contact }
        };
        self.footing.iter().map(here).collect()
    }

    fn is_held(&self, held: &[Contact], now: &Now, touch: &Found) -> bool {
        let is_same = |contact: &Contact| {
            // The lowest point of a rim is held, wherever it is.
            are_of_one_rim(contact.feature, touch.feature)
                || (contact.p_WC - touch.p_W).norm() <= SAME * self.smaller_m()
        };
        held.iter().any(is_same) || self.is_kept(held, now, touch)
    }

    /// Whether a rim that rolls, of this one of the pair, is held at its lowest point in the same plane: nothing else
    /// of its cap comes down there.
    fn is_below_rim(&self, now: &Now, held: &Contact, touch: &Found, of: usize) -> bool {
        if !held.ends().any(|(i, ..)| i == self.pair[of]) {
            return false;
        }
        let is_first = held.body == self.pair[of];
        let (own, base) = if is_first { held.feature } else { (held.feature.1, held.feature.0) };
        // Along the normal from what it stands on.
        let normal = if of == 0 { held.normal } else { -held.normal };
        let at = &now.at[of];
        let cap = Cap::facing(self.bodies[of], at, &normal);
        let from_held = touch.p_W - held.p_WC;
        let is_of_cap = (at.q_WB * Vector3::y()).dot(&from_held).abs() <= NEAR * self.smaller_m();
        let is_in_plane = normal.dot(&from_held).abs() <= FLUSH * self.smaller_m();
        let rolls = || cap.is_some_and(|cap| cap.rolls(at, &normal));
        kind(own) == RIM && base == FACE && is_of_cap && is_in_plane && rolls()
    }

    /// Whether what is held keeps it, too: a point of the plane of three points, or of the line of two, where faces lie
    /// flush, or of that of a rim that rolls. When its support is needed, one that is held opens.
    fn is_kept(&self, held: &[Contact], now: &Now, touch: &Found) -> bool {
        let least_m = SPREAD * self.smaller_m();
        let others = self.footing_beside(now);
        let held: Vec<&Contact> = held.iter().chain(&others).collect();
        let flush = |contact: &&&Contact| {
            contact.normal.cross(&touch.normal).norm() <= FLUSH && contact.normal.dot(&touch.normal) > 0.0
        };
        if held.iter().filter(flush).any(|contact| (0..2).any(|of| self.is_below_rim(now, contact, touch, of))) {
            return true;
        }
        let mut flush = held.iter().filter(flush).map(|contact| contact.p_WC);
        let Some(first) = flush.next() else { return false };
        let rest: Vec<Vector3<f64>> = flush.map(|p| p - first).collect();
        let far = |p: &&Vector3<f64>| p.norm() > least_m;
        let Some(along) = rest.iter().find(far).map(|p| p.normalize()) else { return false };
        let aside = |p: &Vector3<f64>| (p - along * along.dot(p)).norm();
        rest.iter().any(|p| aside(p) > least_m) || aside(&(touch.p_W - first)) <= FLUSH * self.smaller_m()
    }
}

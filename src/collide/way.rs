//! Two bodies on their way through a step, moved by what moves them but for some impulses: whether and when they meet.
//!
//! The way is searched by conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems,
//! Berkeley 1996, 2.3): no gap closes faster than points of the bodies move. Where the way is long beside the bodies'
//! width, that is asked along the axis that parts them best: what slides along a face comes no nearer to it. And as
//! separations along a fixed axis bend no more than points of the bodies do, two of them bound all between.

use super::Contact;
use super::doubt::band_m;
use super::two::of_pair;
use crate::model::{Body, Model, pose_of_solid};
use crate::shape::pair::{Apart, along, apart, touches};
use crate::shape::solid::{Meeting, Pose, Solid};
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::{UnitQuaternion, Vector3};

/// Shortest advance, of the thinner body's least width: what overlaps for a shorter way does not meet.
const LEAST: f64 = 0.02;
/// First advance, of the way.
const FIRST: f64 = 1e-3;
/// Looks for the time at which an axis ends to part bodies.
const SECANTS: usize = 40;
/// Of that width: how deep a motion along an arc may lead beside its chord.
const SAG: f64 = 0.005;
/// Advances on one way.
const MOST: usize = 10_000;
/// Halvings of the time at which two bodies meet.
const HALVINGS: usize = 60;
/// Turn in radians up to which a body that nothing turns is taken to turn steadily.
const STEADY: f64 = 0.25;
/// Of that width: how far away what hits is, and how deep inside what has turned through.
const AFAR: f64 = 1e-3;
const DEEP: f64 = 0.005;
/// The most of that, where a step is cut often.
const DEEPEST: f64 = 0.05;
/// The same of what comes out again by itself: a hundredth is a passage.
const OUT_AGAIN: f64 = 0.0095;
/// Cosine of the angle within which an axis is the same at the end of a step as where bodies meet in it.
const SAME_AXIS: f64 = 0.99;
/// Of that width: a way that leads deep inside. Of half of the widths of both: one that leads through.
const INSIDE: f64 = 0.3;
const THROUGH: f64 = 0.9;

/// Shortest advance on a way that is long beside that width.
const LEAST_FAST: f64 = 2e-3;
/// Of ω²: the most that the angular velocity of a body changes without a torque, as (I₂ − I₃)/I₁ is below one: 3^-½.
const CHANGES: f64 = 0.578;
/// Advances on a way that is long.
const MOST_FAR: usize = 3_000;

/// Attitude of a body that turns without a torque, after a time.
pub type FreeTurn<'a> = Box<dyn Fn(f64) -> UnitQuaternion<f64> + 'a>;

/// How a body moves through a step: its mean velocity and angular velocity, and what of the latter is beyond that at
/// the start (`Body::turns_on`).
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    pub v: Vector3<f64>,
    pub w: Vector3<f64>,
    pub turning: Vector3<f64>,
}

/// Two bodies on their way through a step, straight on and turning without a torque.
pub struct Way<'a> {
    model: &'a Model,
    state: &'a State,
    pair: [usize; 2],
    solids: [(&'a Solid, &'a Vector3<f64>); 2],
    /// Velocity and angular velocity of each.
    moving: [[Vector3<f64>; 2]; 2],
    /// Angular acceleration of each without a torque.
    turning: [Vector3<f64>; 2],
    /// The turn of each that is too far for that, and its angular momentum.
    free: [Option<(FreeTurn<'a>, Vector3<f64>)>; 2],
    /// Those that turn farther than a step of second order sees.
    turns_far: [bool; 2],
    /// The most that the turning of each moves a point of it, in m/s.
    swing: [f64; 2],
    step_s: f64,
    /// The most that the gap can change in a second.
    speed: f64,
}

impl<'a> Way<'a> {
    /// None: one of them has nothing to touch. `freely`: how a body turns on from a state with an angular velocity.
    pub fn new(
        model: &'a Model,
        state: &'a State,
        pair: [usize; 2],
        moving: [Moving; 2],
        step_s: f64,
        freely: impl Fn(&'a Body, &'a BodyState, &Vector3<f64>) -> FreeTurn<'a>,
    ) -> Option<Self> {
        let [Some(solid_a), Some(solid_b)] = pair.map(|i| model.bodies[i].solid()) else { return None };
        let solids = [solid_a, solid_b];
        let bodies = pair.map(|i| &model.bodies[i]);
        let at = pair.map(|i| &state.bodies[i]);
        let steady = steady_rad(bodies, solids.map(|(solid, _)| solid));
        let w = moving.map(|of| of.w - of.turning);
        let turns_far = [0, 1].map(|k| {
            let (body, rad) = (bodies[k], w[k].norm() * step_s);
            rad > steady && rad.is_finite() && !body.is_centred_ball() && !body.driven
        });
        let turning = [0, 1].map(|k| bodies[k].torque_free(at[k], &moving[k].w));
        let is_free = [0, 1].map(|k| turns_far[k] && turning[k] != Vector3::zeros());
        let swing = [0, 1].map(|k| match is_free[k] {
            true => bodies[k].fastest_turn_rad_s(at[k], &w[k]) * bodies[k].bounding_radius_m,
            false => bodies[k].turning_m_s(&moving[k].w),
        });
        let speed = (moving[0].v - moving[1].v).norm() + swing[0] + swing[1];
        let moved = moving.map(|of| [of.v, of.w]);
        let free = [None, None];
        let mut way = Way { model, state, pair, solids, moving: moved, turning, free, turns_far, swing, step_s, speed };
        if way.spheres_pass() {
            way.turns_far = [false; 2];
        } else {
            let free = |k: usize| (freely(bodies[k], at[k], &w[k]), bodies[k].I_W(at[k]) * w[k]);
            way.free = [0, 1].map(|k| is_free[k].then(|| free(k)));
        }
        Some(way)
    }

    /// Whether a way may lead two bodies deep inside each other.
    pub fn may_be_deep(model: &Model, pair: [usize; 2], moving: &[Moving; 2], step_s: f64) -> bool {
        let turning = |k: usize| model.bodies[pair[k]].turning_m_s(&moving[k].w);
        let speed = (moving[0].v - moving[1].v).norm() + turning(0) + turning(1);
        let widths_m = pair.map(|i| model.bodies[i].solid().map_or(f64::INFINITY, |(solid, _)| solid.least_width_m()));
        speed * step_s > INSIDE * widths_m[0].min(widths_m[1])
    }

    /// Those that turn farther than a step of second order sees: their way is one of a free turn in closed form.
    pub fn turns_far(&self) -> [bool; 2] {
        self.turns_far
    }

    /// The most that a gap can change on the way.
    pub fn most_m(&self) -> f64 {
        self.speed * self.step_s
    }

    fn at(&self, k: usize, time_s: f64) -> BodyState {
        let (at, [v, w]) = (&self.state.bodies[self.pair[k]], self.moving[k]);
        let p_WB = at.p_WB + v * time_s;
        if let Some((free, _)) = &self.free[k] {
            return BodyState { p_WB, q_WB: free(time_s), ..*at };
        }
        // Of third order in time (W. Magnus, Comm. Pure Appl. Math. 7 (1954) 649).
        let a = self.turning[k];
        let turned = (w + (a + a.cross(&w) * (time_s / 6.0)) * (0.5 * time_s)) * time_s;
        let q_WB = UnitQuaternion::from_scaled_axis(turned) * at.q_WB;
        BodyState { p_WB, q_WB, ..*at }
    }

    fn poses(&self, time_s: f64) -> [Pose; 2] {
        [0, 1].map(|k| pose_of_solid(self.solids[k].1, &self.at(k, time_s)))
    }

    fn apart(&self, time_s: f64, work: &mut Work) -> Apart {
        work.contact_tests += 1;
        let [pose_a, pose_b] = self.poses(time_s);
        apart(self.solids[0].0, &pose_a, self.solids[1].0, &pose_b)
    }

    /// Not more than the gap, and the gap itself where the bodies are near each other.
    fn gap_m(&self, time_s: f64, work: &mut Work) -> f64 {
        self.gap_along(time_s, work).0
    }

    /// The same, and the unit axis from the second to the first along which it is.
    fn gap_along(&self, time_s: f64, work: &mut Work) -> (f64, Vector3<f64>) {
        let [pose_a, pose_b] = self.poses(time_s);
        let radii_m = self.solids[0].0.bounding_radius_m() + self.solids[1].0.bounding_radius_m();
        let between = pose_a.p_W - pose_b.p_W;
        let between_m = between.norm() - radii_m;
        if between_m > radii_m {
            return (between_m, between.normalize());
        }
        work.contact_tests += 1;
        let apart = apart(self.solids[0].0, &pose_a, self.solids[1].0, &pose_b);
        (apart.gap_m, apart.normal)
    }

    /// How long from a time on a gap along a unit axis cannot close by so much.
    fn closes_after_s(&self, by_m: f64, from_s: f64, normal: &Vector3<f64>) -> f64 {
        let mut closing = -normal.dot(&(self.moving[0][0] - self.moving[1][0]));
        let mut faster = 0.0;
        for k in [0, 1] {
            let body = &self.model.bodies[self.pair[k]];
            if body.is_centred_ball() {
                continue;
            }
            // A point's velocity along the axis is r · (n × ω), however far it has turned.
            let w = self.turns_at(k, from_s);
            closing += body.bounding_radius_m * w.cross(normal).norm();
            if self.turning[k] != Vector3::zeros() {
                faster += CHANGES * self.swing[k] * self.swing[k] / body.bounding_radius_m;
            }
        }
        if faster == 0.0 {
            return if closing > 0.0 { by_m / closing } else { f64::INFINITY };
        }
        let root = closing * closing + 2.0 * faster * by_m;
        if closing > 0.0 { 2.0 * by_m / (closing + root.sqrt()) } else { (root.sqrt() - closing) / faster }
    }

    /// How long from a time on an axis parts the bodies, but for a depth: what it does at the end of that says what it
    /// does between, as a separation along a fixed axis is the least of those of pairs of points, whose second
    /// derivatives have a bound. `least_m`: twice what their arcs may lead beside their chords.
    fn parts_for_s(&self, [gap_m, depth_m, least_m]: [f64; 3], from_s: f64, left_s: f64, normal: &Vector3<f64>) -> f64 {
        let bends = |k: usize| {
            let body = &self.model.bodies[self.pair[k]];
            let changes = if self.turning[k] == Vector3::zeros() { 1.0 } else { 1.0 + CHANGES };
            if self.swing[k] == 0.0 { 0.0 } else { changes * self.swing[k] * self.swing[k] / body.bounding_radius_m }
        };
        let bends = bends(0) + bends(1);
        let spare_m = (gap_m + depth_m).max(least_m);
        let mut span_s = if bends > 0.0 { (4.0 * spare_m / bends).sqrt().min(left_s) } else { left_s };
        for _ in 0..2 {
            let [pose_a, pose_b] = self.poses(from_s + span_s);
            let end_m = along(self.solids[0].0, &pose_a, self.solids[1].0, &pose_b, normal);
            let arc_m = (bends * span_s * span_s / 8.0 - 0.5 * least_m).max(0.0);
            if end_m.min(gap_m) - arc_m >= -depth_m {
                return span_s;
            }
            span_s *= 0.5;
        }
        0.0
    }

    /// Angular velocity after a time.
    fn turns_at(&self, k: usize, time_s: f64) -> Vector3<f64> {
        if let Some((free, L_W)) = &self.free[k] {
            let q_WB = free(time_s);
            return q_WB * (self.model.bodies[self.pair[k]].I_B_inverse * q_WB.inverse_transform_vector(L_W));
        }
        self.moving[k][1] + self.turning[k] * time_s
    }

    /// The time up to which the bodies are apart, but for the band, if they do not stay so.
    pub fn meet_s(&self, band_m: f64, work: &mut Work) -> Option<f64> {
        self.deeper_s(band_m, band_m, self.step_s, work)
    }

    /// The time up to which the bodies are apart, but for the band, before they overlap by a depth; of a long way up to
    /// a time.
    fn deeper_s(&self, depth_m: f64, band_m: f64, until_s: f64, work: &mut Work) -> Option<f64> {
        if self.spheres_pass() {
            return None;
        }
        if self.is_deep(0.0) {
            return self.deeper_far_s(depth_m, band_m, until_s, work);
        }
        let [(start_m, start_normal), end] = [0.0, self.step_s].map(|time_s| self.gap_along(time_s, work));
        let (end_m, _) = end;
        if start_m < -depth_m {
            return Some(0.0);
        }
        if self.speed == 0.0 || (end_m >= -depth_m && !self.may_pass([start_m, end_m], depth_m, work)) {
            return None;
        }
        let least_m = LEAST * self.width_m();
        let (mut apart_s, mut from_s) = (0.0, 0.0);
        let (mut gap_m, mut normal) = (start_m, start_normal);
        for _ in 0..MOST {
            // What came a short way may meet for as short a one.
            let shortest_m = least_m.min((from_s * self.speed).max(FIRST * self.most_m()));
            let to_s: f64 = from_s + (gap_m + depth_m).max(shortest_m) / self.speed;
            let to_s = to_s.max(self.parts_until_s(&normal, from_s, depth_m)).min(self.step_s);
            (gap_m, normal) = if to_s == self.step_s { end } else { self.gap_along(to_s, work) };
            if gap_m < -depth_m {
                // What never came apart before is as deep as that then.
                let band_m = if apart_s > 0.0 { band_m } else { depth_m };
                let from_s = if apart_s > 0.0 { apart_s } else { from_s };
                return Some(self.last_apart([from_s, to_s], band_m, work));
            }
            if to_s == self.step_s {
                return None;
            }
            from_s = to_s;
            if gap_m >= -band_m {
                apart_s = to_s;
            }
        }
        None
    }

    /// Right after the time up to which an axis that parts the bodies but for a depth at a time goes on to do so: a
    /// separation along a fixed axis, the least of those of pairs of points, bends down alone, but for their arcs.
    fn parts_until_s(&self, normal: &Vector3<f64>, from_s: f64, depth_m: f64) -> f64 {
        let spare_m = |time_s: f64| {
            let [pose_a, pose_b] = self.poses(time_s);
            along(self.solids[0].0, &pose_a, self.solids[1].0, &pose_b, normal) + depth_m
        };
        let (mut parts, mut ends) = ((from_s, spare_m(from_s)), (self.step_s, spare_m(self.step_s)));
        if parts.1 < 0.0 || ends.1 >= 0.0 {
            return if parts.1 < 0.0 { from_s } else { self.step_s };
        }
        // Regula falsi, from both sides.
        for k in 0..SECANTS {
            if ends.1 >= -depth_m {
                break;
            }
            let part = if k % 2 == 0 { (parts.1 + 0.5 * depth_m) / (parts.1 - ends.1) } else { 0.5 };
            let time_s = parts.0 + part.min(1.0) * (ends.0 - parts.0);
            let spare = (time_s, spare_m(time_s));
            if spare.1 >= 0.0 { parts = spare } else { ends = spare }
        }
        ends.0
    }

    /// The same of a way that is long beside the bodies' width. Where there is more of it than can be followed, the
    /// time up to which it was.
    fn deeper_far_s(&self, depth_m: f64, band_m: f64, until_s: f64, work: &mut Work) -> Option<f64> {
        let [mut from_s, last_s] = self.together_s()?;
        let last_s = last_s.min(until_s);
        if from_s > last_s {
            return None;
        }
        let least_m = LEAST_FAST * self.width_m();
        // What slides along another one comes apart from it by rounding all the time.
        let apart_m = if depth_m > band_m { AFAR * self.width_m() } else { -band_m };
        let (mut apart_s, mut before_s) = (None, from_s);
        for _ in 0..MOST_FAR {
            let (gap_m, normal) = self.gap_along(from_s, work);
            if gap_m < -depth_m {
                // What never came apart before is as deep as that then.
                let (start_s, band_m) = apart_s.map_or((before_s, depth_m), |apart_s| (apart_s, band_m));
                return Some(self.last_apart([start_s, from_s], band_m, work));
            }
            if gap_m >= apart_m {
                apart_s = Some(from_s);
            }
            if from_s >= last_s {
                return None;
            }
            before_s = from_s;
            let left_s = last_s - from_s;
            let by_speed_s = self.closes_after_s(gap_m + depth_m, from_s, &normal).min(left_s);
            let by_axis_s = self.parts_for_s([gap_m, depth_m, least_m], from_s, left_s, &normal);
            from_s = (from_s + by_speed_s.max(by_axis_s).max(least_m / self.speed)).min(last_s);
        }
        Some(from_s)
    }

    /// Whether the way that is left after they meet leads them deep inside each other, or through.
    pub fn is_deep(&self, meet_s: f64) -> bool {
        self.speed * (self.step_s - meet_s) > INSIDE * self.width_m()
    }

    /// Whether it leads them so far that they would come out on the other side.
    pub fn is_through(&self, meet_s: f64) -> bool {
        let half_m: f64 = self.solids.iter().map(|(solid, _)| 0.5 * solid.least_width_m()).sum();
        self.speed * (self.step_s - meet_s) > THROUGH * half_m
    }

    /// Whether they come from afar.
    pub fn is_from_afar(&self, meet_s: f64) -> bool {
        self.speed * meet_s > AFAR * self.width_m()
    }

    /// The time in which one of two bodies that touch turns as far as its contacts are those of the start; if it turns
    /// farther in the step.
    pub fn turned_s(&self) -> Option<f64> {
        let turning = |k: usize| {
            let body = &self.model.bodies[self.pair[k]];
            if body.is_centred_ball() || body.driven { 0.0 } else { self.moving[k][1].norm() }
        };
        let fastest = turning(0).max(turning(1));
        (fastest * self.step_s > STEADY && !self.spheres_pass()).then(|| STEADY / fastest)
    }

    /// The time at which they are deep inside each other, or deeper than they have been by as much, if they are on this
    /// way up to a time. `times`: as much as usual so often.
    pub fn deep_s(&self, times: f64, until_s: f64, work: &mut Work) -> Option<f64> {
        let band_m = band_m(self.model, self.pair, &self.at(0, 0.0));
        let start_m = self.gap_m(0.0, work).min(0.0);
        let deepest = (times * DEEP).min(DEEPEST);
        let [depth_m, passage_m] = [deepest, OUT_AGAIN].map(|part| part * self.width_m() - start_m);
        let mut deep_s = self.deeper_s(depth_m, band_m, until_s, work);
        if deep_s.is_none() && deepest > OUT_AGAIN && self.gap_m(until_s, work) > -passage_m {
            deep_s = self.deeper_s(passage_m, band_m, until_s, work);
        }
        deep_s.filter(|deep_s| self.is_from_afar(*deep_s))
    }

    /// Between a time at which they are apart and one at which they overlap, as far as the band tells.
    fn last_apart(&self, [mut from_s, mut to_s]: [f64; 2], band_m: f64, work: &mut Work) -> f64 {
        for _ in 0..HALVINGS {
            let middle_s = 0.5 * (from_s + to_s);
            if (to_s - from_s) * self.speed <= 0.5 * band_m || middle_s <= from_s || middle_s >= to_s {
                break;
            }
            if self.gap_m(middle_s, work) < -band_m {
                to_s = middle_s;
            } else {
                from_s = middle_s;
            }
        }
        from_s
    }

    /// Least width of the thinner one.
    fn width_m(&self) -> f64 {
        self.solids.map(|(solid, _)| solid.least_width_m()).into_iter().fold(f64::INFINITY, f64::min)
    }

    /// Whether bodies that are apart at both ends may overlap between them: not if they cannot come so far, nor if one
    /// axis parts them all the time.
    fn may_pass(&self, ends_m: [f64; 2], band_m: f64, work: &mut Work) -> bool {
        if 0.5 * (self.most_m() - ends_m[0] - ends_m[1]) <= band_m {
            return false;
        }
        let angle = |k: usize| self.moving[k][1].norm() * self.step_s;
        let arc = |k: usize| angle(k) * angle(k) / 8.0 * self.model.bodies[self.pair[k]].bounding_radius_m;
        if arc(0) + arc(1) > SAG * self.width_m() {
            return true;
        }
        let times = [0.0, self.step_s];
        let is_kept = |of: usize, work: &mut Work| {
            let axis = self.apart(times[of], work).normal;
            let [pose_a, pose_b] = self.poses(times[1 - of]);
            along(self.solids[0].0, &pose_a, self.solids[1].0, &pose_b, &axis) >= -band_m
        };
        !is_kept(0, work) && !is_kept(1, work)
    }

    /// Whether the balls around two bodies stay apart.
    fn spheres_pass(&self) -> bool {
        let (r, v, reach_m) = self.balls();
        let square = v.norm_squared();
        let time_s = if square > 0.0 { (-r.dot(&v) / square).clamp(0.0, self.step_s) } else { 0.0 };
        (r + v * time_s).norm_squared() > reach_m * reach_m
    }

    /// From when to when the balls around two bodies meet.
    fn together_s(&self) -> Option<[f64; 2]> {
        let (r, v, reach_m) = self.balls();
        let square = v.norm_squared();
        let nearest_s = if square > 0.0 { -r.dot(&v) / square } else { 0.0 };
        let left = reach_m * reach_m - (r + v * nearest_s).norm_squared();
        if left < 0.0 {
            return None;
        }
        let half_s = if square > 0.0 { (left / square).sqrt() } else { f64::INFINITY };
        let [from_s, to_s] = [(nearest_s - half_s).max(0.0), (nearest_s + half_s).min(self.step_s)];
        (from_s <= to_s).then_some([from_s, to_s])
    }

    /// Where the second body sees the first, how that moves, and both radii.
    fn balls(&self) -> (Vector3<f64>, Vector3<f64>, f64) {
        let r = self.state.bodies[self.pair[0]].p_WB - self.state.bodies[self.pair[1]].p_WB;
        let reach_m = self.pair.map(|i| self.model.bodies[i].bounding_radius_m).iter().sum();
        (r, self.moving[0][0] - self.moving[1][0], reach_m)
    }

    /// Fills `points` with the contacts of the two as they meet, or of smooth bodies, whose axis turns steadily, at the
    /// end of the step: arms from one point as the step begins, so that momentum is kept, a ball's as it will be, which
    /// no normal impulse turns, or else the lighter body's; gaps such that at the end of the step none is left below
    /// zero.
    pub fn points(&self, meet_s: f64, points: &mut Vec<Contact>, work: &mut Work) {
        let is_smooth = self.solids.iter().all(|(solid, _)| solid.is_smooth()) && !self.is_deep(meet_s);
        let is_same_axis = |work: &mut Work| {
            let [met, ended] = [meet_s, self.step_s].map(|time_s| self.apart(time_s, work).normal);
            met.dot(&ended) > SAME_AXIS
        };
        let time_s = if is_smooth && is_same_axis(work) { self.step_s } else { meet_s };
        let [pose_a, pose_b] = self.poses(time_s);
        // What is apart on this way may not be so on that with the pair's impulses.
        let left_m = self.most_m() + band_m(self.model, self.pair, &self.at(0, time_s));
        let mut found = Vec::new();
        touches(self.solids[0].0, &pose_a, self.solids[1].0, &pose_b, left_m, &mut found);
        let moved = [0, 1].map(|k| self.moving[k][0] * time_s);
        let bodies = self.pair.map(|i| &self.model.bodies[i]);
        let lightness = |k: usize| if bodies[k].driven { 0.0 } else { 1.0 / bodies[k].mass_kg };
        let [a, b] = match bodies.map(Body::is_centred_ball) {
            [true, false] => [1.0, 0.0],
            [false, true] => [0.0, 1.0],
            _ => [lightness(0), lightness(1)],
        };
        let back = (moved[0] * a + moved[1] * b) / (a + b);
        points.clear();
        points.extend(found.iter().map(|touch| {
            let arms = [0, 1].map(|k| touch.p_W - self.at(k, time_s).p_WB);
            let rate = |k: usize| self.moving[k][0] + self.moving[k][1].cross(&arms[k]);
            let gap_m = touch.gap_m - time_s * touch.normal.dot(&(rate(0) - rate(1)));
            of_pair(self.model, self.state, self.pair, &Meeting { p_W: touch.p_W - back, gap_m, ..*touch })
        }));
    }
}

/// Turn in radians up to which two bodies are taken to turn steadily: the steps of the motion itself are of third
/// order, what they leave is R θ³/12.
fn steady_rad(bodies: [&Body; 2], solids: [&Solid; 2]) -> f64 {
    let radius_m = bodies.map(|body| body.bounding_radius_m).into_iter().fold(0.0, f64::max);
    let width_m = solids.map(Solid::least_width_m).into_iter().fold(f64::INFINITY, f64::min);
    libm::cbrt(12.0 * DEEP * width_m / radius_m).min(STEADY)
}

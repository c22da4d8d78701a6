//! Pairs in doubt: whether two bodies touch in a step, and along which axis, if more than one may part them.
//!
//! Two convex bodies are apart as long as one axis separates them: what is kept is s = max s_n ≥ 0 over all axes n, an
//! "or". A step that asks for s_n ≥ 0 along the axis that separates them at its start asks for too much where another
//! axis may take over (a crate that slides flush from one block to the next, a body that passes an edge), and a plane
//! at a distance is not a round body. Such a pair is pushed only if its bodies, moved through the step with all its
//! impulses but this pair's, would overlap; the axis is that of s where it reaches zero on that way, and the gap is
//! what has to be left at the end of the step.
//!
//! The way is searched by conservative advancement (B. Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems,
//! Berkeley 1996, 2.3): no gap closes faster than points of the bodies move.

use super::Contact;
use super::closed::{closed_m, unresolved_m};
use super::two::of_pair;
use crate::model::{Body, Model, pose_of_solid};
use crate::shape::band::BAND;
use crate::shape::pair::{Apart, along, apart, touches};
use crate::shape::solid::{Meeting, Pose, Solid};
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::{UnitQuaternion, Vector3};

/// Shortest advance, of the thinner body's least width: what overlaps for a shorter way does not meet.
const LEAST: f64 = 0.02;
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
/// Cosine of the angle within which an axis is the same at the end of a step as where bodies meet in it.
const SAME_AXIS: f64 = 0.99;
/// Of that width: a way that leads deep inside. Of half of the widths of both: one that leads through.
const INSIDE: f64 = 0.3;
const THROUGH: f64 = 0.9;

/// A pair in doubt in this step.
#[derive(Clone, Debug)]
pub struct DoubtfulPair {
    pub pair: [usize; 2],
    /// Whether its points are asked to stay apart.
    pub is_imposed: bool,
    /// Whether its points were found by a motion without any impulse of its own.
    pub is_sure: bool,
    pub points: Vec<Contact>,
}

impl DoubtfulPair {
    /// Axis of the points.
    pub fn normal(&self) -> Vector3<f64> {
        self.points.first().map_or_else(Vector3::zeros, |point| point.normal)
    }
}

/// All pairs in doubt, in the order of their bodies; what was allocated is kept.
#[derive(Clone, Debug, Default)]
pub struct Doubts {
    all: Vec<DoubtfulPair>,
    used: usize,
}

impl Doubts {
    pub fn clear(&mut self) {
        self.used = 0;
    }

    pub fn list(&self) -> &[DoubtfulPair] {
        &self.all[..self.used]
    }

    pub fn list_mut(&mut self) -> &mut [DoubtfulPair] {
        &mut self.all[..self.used]
    }

    /// Takes in a pair with its points, if it is in doubt: another axis may part the two before this one closes, or a
    /// round surface come between. A pair that touches along one axis alone is asked to stay apart at first.
    pub(super) fn take(
        &mut self,
        model: &Model,
        (pair, at, apart): ([usize; 2], &BodyState, &Apart),
        limit_m: f64,
        points: impl Iterator<Item = Contact>,
    ) -> bool {
        let rounding_m = closed_m(smaller_m(model, pair), at.p_WB.amax() + model.bodies[pair[0]].bounding_radius_m);
        // Between smooth bodies, which have no edges, a plane stands for them as far as it is one within the step.
        let are_smooth = pair.iter().all(|i| model.bodies[*i].solid().is_some_and(|(solid, _)| solid.is_smooth()));
        let plane_m = if are_smooth { limit_m * limit_m / smaller_m(model, pair) } else { 0.0 };
        let touches = apart.gap_m <= rounding_m.max(plane_m);
        let stays = apart.is_flat || (touches && limit_m < smaller_m(model, pair));
        if apart.second_m < -limit_m && stays {
            return false;
        }

        if self.used == self.all.len() {
            self.all.push(DoubtfulPair { pair, is_imposed: false, is_sure: false, points: Vec::new() });
        }
        let doubt = &mut self.all[self.used];
        self.used += 1;
        doubt.pair = pair;
        doubt.points.clear();
        doubt.points.extend(points);
        doubt.is_imposed = touches && apart.second_m < -band_m(model, pair, at);
        doubt.is_sure = false;
        true
    }
}

fn smaller_m(model: &Model, pair: [usize; 2]) -> f64 {
    pair.map(|i| model.bodies[i].bounding_radius_m).into_iter().fold(f64::INFINITY, f64::min)
}

/// Overlap up to which two bodies are apart: the band within which separations count alike.
pub fn band_m(model: &Model, pair: [usize; 2], at: &BodyState) -> f64 {
    BAND * smaller_m(model, pair) + unresolved_m(at.p_WB.amax() + model.bodies[pair[0]].bounding_radius_m)
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
    step_s: f64,
    /// The most that the gap can change in a second.
    speed: f64,
}

impl<'a> Way<'a> {
    /// None: one of them has nothing to touch.
    pub fn new(
        model: &'a Model,
        state: &'a State,
        pair: [usize; 2],
        moving: [[Vector3<f64>; 2]; 2],
        step_s: f64,
    ) -> Option<Self> {
        let [Some(solid_a), Some(solid_b)] = pair.map(|i| model.bodies[i].solid()) else { return None };
        let turning = |k: usize| model.bodies[pair[k]].turning_m_s(&moving[k][1]);
        let speed = (moving[0][0] - moving[1][0]).norm() + turning(0) + turning(1);
        let free = [0, 1].map(|k| model.bodies[pair[k]].torque_free(&state.bodies[pair[k]], &moving[k][1]));
        Some(Way { model, state, pair, solids: [solid_a, solid_b], moving, turning: free, step_s, speed })
    }

    /// The most that a gap can change on the way.
    pub fn most_m(&self) -> f64 {
        self.speed * self.step_s
    }

    fn at(&self, k: usize, time_s: f64) -> BodyState {
        let (at, [v, w]) = (&self.state.bodies[self.pair[k]], self.moving[k]);
        // Of third order in time (W. Magnus, Comm. Pure Appl. Math. 7 (1954) 649).
        let a = self.turning[k];
        let turned = (w + (a + a.cross(&w) * (time_s / 6.0)) * (0.5 * time_s)) * time_s;
        let q_WB = UnitQuaternion::from_scaled_axis(turned) * at.q_WB;
        BodyState { p_WB: at.p_WB + v * time_s, q_WB, ..*at }
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
        let [pose_a, pose_b] = self.poses(time_s);
        let radii_m = self.solids[0].0.bounding_radius_m() + self.solids[1].0.bounding_radius_m();
        let between_m = (pose_a.p_W - pose_b.p_W).norm() - radii_m;
        if between_m > radii_m { between_m } else { self.apart(time_s, work).gap_m }
    }

    /// The time up to which the bodies are apart, but for the band, if they do not stay so.
    pub fn meet_s(&self, band_m: f64, work: &mut Work) -> Option<f64> {
        self.deeper_s(band_m, band_m, work)
    }

    /// The time up to which the bodies are apart, but for the band, before they overlap by a depth.
    fn deeper_s(&self, depth_m: f64, band_m: f64, work: &mut Work) -> Option<f64> {
        if self.spheres_pass() {
            return None;
        }
        let [start_m, end_m] = [0.0, self.step_s].map(|time_s| self.gap_m(time_s, work));
        if start_m < -depth_m {
            return Some(0.0);
        }
        if self.speed == 0.0 || (end_m >= -depth_m && !self.may_pass([start_m, end_m], depth_m, work)) {
            return None;
        }
        let least_m = LEAST * self.width_m();
        let (mut apart_s, mut from_s, mut gap_m) = (0.0, 0.0, start_m);
        for _ in 0..MOST {
            let to_s: f64 = from_s + (gap_m + depth_m).max(least_m) / self.speed;
            let to_s = to_s.min(self.step_s);
            gap_m = if to_s == self.step_s { end_m } else { self.gap_m(to_s, work) };
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

    /// The time in which one of two bodies that come together turns as far as its way is a steady turn; if it turns
    /// farther in the step.
    pub fn turned_s(&self) -> Option<f64> {
        let turning = |k: usize| {
            let body = &self.model.bodies[self.pair[k]];
            if body.is_centred_ball() || body.driven { 0.0 } else { self.moving[k][1].norm() }
        };
        let fastest = turning(0).max(turning(1));
        let radius_m = self.pair.map(|i| self.model.bodies[i].bounding_radius_m).into_iter().fold(0.0, f64::max);
        // The steps of the motion itself are of third order: what they leave is R θ³/12.
        let steady = libm::cbrt(12.0 * DEEP * self.width_m() / radius_m).min(STEADY);
        (fastest * self.step_s > steady && !self.spheres_pass()).then(|| steady / fastest)
    }

    /// The time at which they are deep inside each other, or deeper than they have been by as much, if they are on this
    /// way.
    pub fn deep_s(&self, work: &mut Work) -> Option<f64> {
        let band_m = band_m(self.model, self.pair, &self.at(0, 0.0));
        let depth_m = DEEP * self.width_m() - self.gap_m(0.0, work).min(0.0);
        self.deeper_s(depth_m, band_m, work).filter(|deep_s| self.is_from_afar(*deep_s))
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
        let r = self.state.bodies[self.pair[0]].p_WB - self.state.bodies[self.pair[1]].p_WB;
        let v = self.moving[0][0] - self.moving[1][0];
        let reach_m: f64 = self.pair.map(|i| self.model.bodies[i].bounding_radius_m).iter().sum();
        let square = v.norm_squared();
        let time_s = if square > 0.0 { (-r.dot(&v) / square).clamp(0.0, self.step_s) } else { 0.0 };
        (r + v * time_s).norm_squared() > reach_m * reach_m
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

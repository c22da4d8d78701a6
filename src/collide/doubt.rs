//! Pairs in doubt: whether two bodies touch in a step, and along which axis, if more than one may part them.
//!
//! Two convex bodies are apart as long as one axis separates them: what is kept is s = max s_n ≥ 0 over all axes n, an
//! "or". A step that asks for s_n ≥ 0 along the axis that separates them at its start asks for too much where another
//! axis may take over (a crate that slides flush from one block to the next, a body that passes an edge), and a plane
//! at a distance is not a round body. Such a pair is pushed only if its bodies, moved through the step with all its
//! impulses but this pair's, would overlap; the axis is that of s where it reaches zero on that way, and the gap is
//! what has to be left at the end of the step.
//! How that way is searched is `way.rs`'s.

use super::Contact;
use super::closed::{closed_m, unresolved_m};
use crate::model::Model;
use crate::shape::band::BAND;
use crate::shape::pair::Apart;
use crate::state::BodyState;
use nalgebra::Vector3;

/// A pair in doubt in this step.
#[derive(Clone, Debug)]
pub struct DoubtfulPair {
    pub pair: [usize; 2],
    /// Whether the two touch at the start of the step.
    pub touches: bool,
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
        let is_plane = are_smooth && limit_m < smaller_m(model, pair);
        let plane_m = if is_plane { limit_m * limit_m / smaller_m(model, pair) } else { 0.0 };
        let touches = apart.gap_m <= rounding_m.max(plane_m);
        let stays = apart.is_flat || (touches && limit_m < smaller_m(model, pair));
        if apart.second_m < -limit_m && stays {
            return false;
        }

        if self.used == self.all.len() {
            self.all.push(DoubtfulPair { pair, touches, is_imposed: false, is_sure: false, points: Vec::new() });
        }
        let doubt = &mut self.all[self.used];
        self.used += 1;
        (doubt.pair, doubt.touches) = (pair, touches);
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

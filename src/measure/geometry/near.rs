//! Which pairs of bodies may meet in a step: bounds around their ways, swept along one axis (D. Baraff, 1992), with a
//! skin, so that a pile at rest is swept once.

use super::figure::Figure;
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector3;

/// Of a body's radius: as long as no body has moved by more, the pairs hold.
const SKIN: f64 = 0.2;

/// Two bodies whose bounds meet, the first before the second.
#[derive(Clone, Copy, Debug)]
pub struct NearPair {
    pub bodies: [usize; 2],
    /// Along which they were parted best when they were last compared in full; zero: never.
    pub axis: Vector3<f64>,
}

impl NearPair {
    /// Whether it has been compared in full.
    pub fn has_axis(&self) -> bool {
        self.axis.x != 0.0 || self.axis.y != 0.0 || self.axis.z != 0.0
    }
}

/// All of them, sorted.
#[derive(Clone, Debug, Default)]
pub struct NearPairs {
    pub pairs: Vec<NearPair>,
    last: Vec<NearPair>,
    /// Where the bodies were when the pairs were found.
    seen_at: Vec<Vector3<f64>>,
    /// Bodies with a solid; in the order of their lower bounds.
    solids: Vec<usize>,
    bounds: Vec<(Vector3<f64>, Vector3<f64>)>,
    /// In that order, next to each other in memory.
    sorted: Vec<(Vector3<f64>, Vector3<f64>, usize)>,
}

impl NearPairs {
    pub fn new(model: &Model) -> Self {
        let has_solid = |i: &usize| model.bodies[*i].solid().is_some();
        let solids: Vec<usize> = (0..model.bodies.len()).filter(has_solid).collect();
        let room = if model.touching_pairs { 16 * solids.len() } else { 0 };
        NearPairs {
            pairs: Vec::with_capacity(room),
            last: Vec::with_capacity(room),
            seen_at: Vec::with_capacity(model.bodies.len()),
            bounds: Vec::with_capacity(model.bodies.len()),
            sorted: Vec::with_capacity(solids.len()),
            solids,
        }
    }

    /// Finds the pairs of a step that went through these states.
    pub fn find<'a>(&mut self, model: &Model, figures: &[Figure], states: impl Iterator<Item = &'a State> + Clone) {
        let stays = |state: &State| {
            let has_stayed = |&i: &usize| {
                let skin_m = SKIN * figures[i].radius_m;
                (state.bodies[i].p_WB - self.seen_at[i]).norm_squared() <= skin_m * skin_m
            };
            self.solids.iter().all(has_stayed)
        };
        if self.seen_at.len() == model.bodies.len() && states.clone().all(stays) {
            return;
        }
        self.bounds.clear();
        for (i, figure) in figures.iter().enumerate() {
            let reach_m = (1.0 + SKIN) * figure.radius_m;
            let nothing = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
            let around = |(low, high): (Vector3<f64>, Vector3<f64>), state: &State| {
                let p = &state.bodies[i].p_WB;
                (low.inf(&p.add_scalar(-reach_m)), high.sup(&p.add_scalar(reach_m)))
            };
            self.bounds.push(states.clone().fold(nothing, around));
        }
        self.seen_at.clear();
        if let Some(end) = states.last() {
            self.seen_at.extend(end.bodies.iter().map(|at| at.p_WB));
        }
        self.sweep(model, figures);
    }

    fn sweep(&mut self, model: &Model, figures: &[Figure]) {
        std::mem::swap(&mut self.pairs, &mut self.last);
        self.pairs.clear();
        let bounds = &self.bounds;
        let axis = spread(self.solids.iter().map(|&i| bounds[i].0)).imax();
        self.solids.sort_unstable_by(|&i, &j| bounds[i].0[axis].total_cmp(&bounds[j].0[axis]).then(i.cmp(&j)));
        self.sorted.clear();
        self.sorted.extend(self.solids.iter().map(|&i| (bounds[i].0, bounds[i].1, i)));
        for (k, (low, high, i)) in self.sorted.iter().enumerate() {
            for (other_low, other_high, j) in &self.sorted[k + 1..] {
                if other_low[axis] > high[axis] {
                    break;
                }
                let meets = |k: usize| low[k] <= other_high[k] && other_low[k] <= high[k];
                if !(meets(0) && meets(1) && meets(2)) || (figures[*i].is_driven && figures[*j].is_driven) {
                    continue;
                }
                let bodies = [*i.min(j), *i.max(j)];
                if !model.are_pinned(bodies) {
                    self.pairs.push(NearPair { bodies, axis: Vector3::zeros() });
                }
            }
        }
        self.pairs.sort_unstable_by_key(|pair| pair.bodies);
        let mut last = self.last.iter().peekable();
        for pair in &mut self.pairs {
            while last.next_if(|known| known.bodies < pair.bodies).is_some() {}
            if let Some(known) = last.next_if(|known| known.bodies == pair.bodies) {
                pair.axis = known.axis;
            }
        }
    }
}

fn spread(points: impl Iterator<Item = Vector3<f64>> + Clone) -> Vector3<f64> {
    let low = points.clone().fold(Vector3::repeat(f64::INFINITY), |low, p| low.inf(&p));
    points.fold(Vector3::repeat(f64::NEG_INFINITY), |high, p| high.sup(&p)) - low
}

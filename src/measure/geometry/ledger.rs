//! The geometry of a run, step by step.

use super::expand::Expansion;
use super::figure::{Figure, Stand, turned};
use super::ghost::{GhostJudge, Group};
use super::near::NearPairs;
use super::overlap::part;
use super::passage::{passes, together};
use super::posed::gap_along_m;
use super::track::Track;
use crate::collide::SolvedContact;
use crate::collide::approach::Approach;
use crate::model::Model;
use crate::shown::{Acted, Passage, Shown};
use crate::state::{BodyState, State};
use nalgebra::Matrix3;

/// Bodies of a scene whose ways and impulses are looked at in every step; of a larger one in every so many.
const FEW: usize = 50;
const EVERY: u64 = 8;
/// Parts of a way that is known at every time, at least; and the most that a body may turn in one (rad), up to so many.
const PARTS: f64 = 4.0;
const TURN: f64 = 1.0;
const MOST_PARTS: f64 = 256.0;
/// Of the least width: how far a straight part leaves a curved way.
const ASIDE: f64 = 2e-3;

/// What the columns of geometry are made of.
pub struct GeometryLedger {
    /// All three are null where nothing can touch, or the method never looks.
    pub penetration_max_m: Option<f64>,
    pub ghost_impulse_max_rel: Option<f64>,
    pub passed_through: Option<u64>,
    figures: Vec<Figure>,
    near: NearPairs,
    /// Attitudes of all bodies, as matrices.
    R: Vec<Matrix3<f64>>,
    memory: Expansion,
    every: u64,
    seen: u64,
    /// On a way: two states next to each other, and contacts with their impulses.
    on_way: [State; 2],
    pressed: Vec<SolvedContact>,
}

impl GeometryLedger {
    pub fn new(model: &Model, start: &State, judged: bool) -> Self {
        GeometryLedger {
            penetration_max_m: judged.then_some(0.0),
            ghost_impulse_max_rel: judged.then_some(0.0),
            passed_through: judged.then_some(0),
            figures: model.bodies.iter().map(Figure::new).collect(),
            near: NearPairs::new(model),
            R: vec![Matrix3::identity(); model.bodies.len()],
            memory: Expansion::default(),
            every: if model.bodies.len() > FEW { EVERY } else { 1 },
            seen: 0,
            on_way: [start.clone(), start.clone()],
            pressed: Vec::new(),
        }
    }

    /// Steps of which one at least is looked at in full.
    pub fn period(&self) -> u64 {
        self.every
    }

    /// Judges a step; the depth of the deepest overlap at its end, if no step before had a deeper one, else 0.
    pub fn observe(&mut self, model: &Model, shown: &Shown) -> f64 {
        let Some(known_m) = self.penetration_max_m else { return 0.0 };
        let Shown { before, after, .. } = *shown;
        if shown.stalled.is_some() || !after.bodies.iter().all(BodyState::is_finite) {
            return 0.0;
        }
        let middle = match shown.acted {
            Acted::Kick { kicked, .. } => kicked,
            Acted::Blow { .. } | Acted::Motion(_) => after,
        };
        if model.touching_pairs {
            self.near.find(model, &self.figures, [before, middle, after].into_iter());
        }
        let depth_m = self.deepest_m(model, after, known_m);
        self.penetration_max_m = Some(known_m.max(depth_m));
        if self.seen.is_multiple_of(self.every) {
            self.look_at_step(model, shown);
        }
        self.seen += 1;
        depth_m
    }

    /// Depth of the deepest overlap of a state.
    pub fn penetration_m(&mut self, model: &Model, state: &State) -> Option<f64> {
        let max_m = self.penetration_max_m?;
        if !state.bodies.iter().all(BodyState::is_finite) {
            return Some(0.0);
        }
        if model.touching_pairs {
            self.near.find(model, &self.figures, std::iter::once(state));
        }
        let depth_m = self.deepest_m(model, state, 0.0);
        self.penetration_max_m = Some(max_m.max(depth_m));
        Some(depth_m)
    }

    /// The deepest overlap that is deeper than what is known; else 0.
    fn deepest_m(&mut self, model: &Model, state: &State, known_m: f64) -> f64 {
        let mut deepest_m = known_m;
        if let Some(container) = &model.container {
            for ((body, figure), at) in model.bodies.iter().zip(&self.figures).zip(&state.bodies) {
                let stand = Stand::from(at);
                for face in container.faces.iter().filter(|_| body.feels_container()) {
                    deepest_m = figure.depth_m(body, &stand, face, deepest_m).unwrap_or(deepest_m);
                }
            }
        }
        if self.near.pairs.is_empty() {
            return if deepest_m > known_m { deepest_m } else { 0.0 };
        }
        for (R, at) in self.R.iter_mut().zip(&state.bodies) {
            *R = at.q_WB.to_rotation_matrix().into_inner();
        }
        for pair in &mut self.near.pairs {
            let [i, j] = pair.bodies;
            let [p, q] = [i, j].map(|i| &state.bodies[i].p_WB);
            let reach_m = self.figures[i].radius_m + self.figures[j].radius_m - deepest_m;
            if reach_m <= 0.0 || (p - q).norm_squared() >= reach_m * reach_m {
                continue;
            }
            let (Some(a), Some(b)) = (turned(model, i, p, &self.R[i], q), turned(model, j, q, &self.R[j], q)) else {
                continue;
            };
            // Every axis bounds the depth, the last one most likely best.
            if pair.has_axis() && gap_along_m(&a, &b, &pair.axis) >= -deepest_m {
                continue;
            }
            let parting = part(&a, &b, &mut self.memory);
            pair.axis = parting.normal;
            deepest_m = deepest_m.max(-parting.gap_m);
        }
        if deepest_m > known_m { deepest_m } else { 0.0 }
    }

    /// Ways and impulses.
    fn look_at_step(&mut self, model: &Model, shown: &Shown) {
        let Shown { before, after, .. } = *shown;
        match shown.acted {
            Acted::Kick { kicked, contacts, step_s, approach } => {
                let kicked_after_s = kicked.time_s - before.time_s;
                if kicked_after_s > 0.0 {
                    self.look_between(model, [before, kicked]);
                    self.look_between(model, [kicked, after]);
                } else {
                    self.look_between(model, [before, after]);
                }
                // An impulse lasts until the next one: of a kick half-way half a step beyond the end.
                let more_s = if approach == Approach::Middle { 0.5 * step_s } else { 0.0 };
                self.each_group(model, contacts, |judge, group| judge.kicked(group, [kicked, after], step_s, more_s));
            }
            Acted::Blow { contacts } => {
                let largest_n_s = contacts.iter().map(|of| of.impulse_W.norm()).fold(0.0, f64::max);
                self.each_group(model, contacts, |judge, group| judge.struck(group, [before, after], largest_n_s));
            }
            Acted::Motion(_) => {
                if let Some(way) = shown.way {
                    self.look_along(model, way, [before, after]);
                }
            }
        }
    }

    /// A smooth motion, part by part, and its forces in its middle.
    fn look_along(&mut self, model: &Model, way: &dyn Passage, [before, after]: [&State; 2]) {
        let span_s = after.time_s - before.time_s;
        if span_s <= 0.0 {
            return;
        }
        let nothing = || State { step: 0, time_s: 0.0, bodies: Vec::new() };
        let [mut from, mut to] = std::mem::replace(&mut self.on_way, [nothing(), nothing()]);
        if model.touching_pairs && !self.near.pairs.is_empty() {
            let parts = self.parts([before, after]);
            from.copy_from(before);
            for part in 1..=parts as u32 {
                to.copy_from(before);
                to.time_s = before.time_s + span_s * f64::from(part) / parts;
                way.state_at(model, &mut to);
                self.look_between(model, [&from, &to]);
                std::mem::swap(&mut from, &mut to);
            }
        }
        to.copy_from(before);
        to.time_s = before.time_s + 0.5 * span_s;
        way.state_at(model, &mut to);
        let mut pressed = std::mem::take(&mut self.pressed);
        pressed.clear();
        let forces = way.forces_at(model, &to);
        pressed.extend(forces.iter().map(|f| SolvedContact { contact: f.contact, impulse_W: f.force_W * span_s }));
        self.each_group(model, &pressed, |judge, group| judge.pressed(group, &to, span_s));
        self.pressed = pressed;
        self.on_way = [from, to];
    }

    /// Number of straight parts of a smooth motion that leave it by less than what a passage is.
    fn parts(&self, [before, after]: [&State; 2]) -> f64 {
        let span_s = after.time_s - before.time_s;
        let turning = before.bodies.iter().map(|at| at.w_WB.norm()).fold(0.0, f64::max) * span_s;
        let bends = before.bodies.iter().zip(&after.bodies).map(|(a, b)| (b.v_WB - a.v_WB).norm());
        let widths = self.near.pairs.iter().flat_map(|pair| pair.bodies).map(|i| self.figures[i].width_m);
        let (bend, width_m) = (bends.fold(0.0, f64::max), widths.fold(f64::INFINITY, f64::min));
        let of_bend = (bend * span_s / (8.0 * ASIDE * width_m)).sqrt();
        (turning / TURN).max(of_bend).ceil().clamp(PARTS, MOST_PARTS)
    }

    /// Counts the pairs that pass between two states.
    fn look_between(&mut self, model: &Model, [from, to]: [&State; 2]) {
        let Some(passed) = &mut self.passed_through else { return };
        let span_s = to.time_s - from.time_s;
        for pair in &mut self.near.pairs {
            let moved = |i: usize| {
                let (a, b) = (&from.bodies[i], &to.bodies[i]);
                (b.p_WB - a.p_WB).norm() + a.w_WB.norm().max(b.w_WB.norm()) * span_s * self.figures[i].radius_m
            };
            let width_m = pair.bodies.map(|i| self.figures[i].width_m);
            // No leg is made for what hardly moves.
            if moved(pair.bodies[0]) + moved(pair.bodies[1]) <= 0.01 * width_m[0].min(width_m[1]) {
                continue;
            }
            let [a, b] = pair.bodies;
            let ends = [from, to].map(|state| state.bodies[a].p_WB - state.bodies[b].p_WB);
            let Some(part) = together(ends, self.figures[a].radius_m + self.figures[b].radius_m) else { continue };
            let least_m = width_m[0].min(width_m[1]);
            let tracks = pair.bodies.map(|i| {
                let of = (&model.bodies[i], &self.figures[i]);
                Track::between(of, [&from.bodies[i], &to.bodies[i]], span_s, least_m)
            });
            let through = passes(model, &self.figures, pair, (tracks, part), &mut self.memory);
            *passed += u64::from(through);
        }
    }

    /// Shows the impulses of each pair along each normal; the largest ghost is kept.
    fn each_group(
        &mut self,
        model: &Model,
        contacts: &[SolvedContact],
        mut weigh: impl FnMut(&mut GhostJudge, &Group) -> f64,
    ) {
        let mut judge = GhostJudge { model, figures: &self.figures, memory: &mut self.memory };
        let mut largest = self.ghost_impulse_max_rel.unwrap_or(0.0);
        let pair = |s: &SolvedContact| (s.contact.body, s.contact.other);
        for of_pair in contacts.chunk_by(|a, b| pair(a) == pair(b)) {
            for group in (0..of_pair.len()).filter_map(|first| Group::new(of_pair, first)) {
                largest = largest.max(weigh(&mut judge, &group));
            }
        }
        self.ghost_impulse_max_rel = Some(largest);
    }
}

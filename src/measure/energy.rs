//! Energy of a state, and its ledger over a run.
//!
//! E is kinetic and potential energy, and what springs hold in place of a law of contact. W is the work of loads and of
//! driven bodies, D what contacts may take (`dissipation`). Amounts are relative to S = T(0) + Σ m|g|d + max|W|, where
//! d is the farthest that a body has been below its start: neither the container, nor the zero of the potential, nor
//! what an error has made is in it.

use super::dissipation::Taken;
use super::exchange::{Motion, Moved, kinetic_j};
use super::moving::moving;
use super::push::ROUNDING;
use super::work::Done;
use crate::model::Model;
use crate::model::loads::AppliedForce;
use crate::state::State;

/// Least scale, of a fall of all bodies by their size.
const LEAST: f64 = 1e-2;

/// Of the same fall: an energy at the start that is rounding.
const NOTHING: f64 = 1e-9;

/// Kinetic (of the centre of mass and about it), potential, and stored in springs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    pub kinetic_j: f64,
    pub potential_j: f64,
    pub stored_j: f64,
}

impl Energy {
    /// Without what springs hold.
    pub fn of(model: &Model, state: &State) -> Self {
        let mut energy = Energy::default();
        for (body, at) in moving(model, state) {
            energy.kinetic_j += kinetic_j(body, at, &Motion { v: at.v_WB, w: at.w_WB });
            energy.potential_j += model.potential_j(body, &at.p_WB);
        }
        energy
    }

    pub fn total_j(&self) -> f64 {
        self.kinetic_j + self.potential_j + self.stored_j
    }
}

/// What became of the energy.
#[derive(Clone, Debug)]
pub struct EnergyLedger {
    start: Energy,
    end: Energy,
    /// Σ m|g|R: a fall of all bodies by their size.
    fall_j: f64,
    /// Potential energy of every body that is not driven at the start, and how far it has been below that.
    start_j: Vec<f64>,
    fallen_j: Vec<f64>,
    work_j: f64,
    /// Largest |W| and largest W so far.
    work_max_j: f64,
    given_max_j: f64,
    /// Least and largest E − W so far, and the largest rise over an earlier value.
    lowest_j: f64,
    highest_j: f64,
    rise_max_j: f64,
    taken: Taken,
    /// Largest kinetic energy, largest Σ m|g·p|, and the sizes of the parts of W: what has rounding.
    kinetic_max_j: f64,
    height_max_j: f64,
    /// Largest Σ|F|(|p| + R) of applied forces.
    load_max_j: f64,
    work_parts_j: f64,
    /// Largest kinetic energy after / before one contact solve.
    pub contact_gain_max: Option<f64>,
}

impl EnergyLedger {
    /// From a first state, and what springs hold in it.
    pub fn new(model: &Model, state: &State, stored_j: f64) -> Self {
        let start = Energy { stored_j, ..Energy::of(model, state) };
        let g = model.gravity_m_s2.norm();
        let mut ledger = EnergyLedger {
            start,
            end: start,
            fall_j: moving(model, state).map(|(body, _)| body.mass_kg * g * body.bounding_radius_m).sum(),
            start_j: moving(model, state).map(|(body, at)| model.potential_j(body, &at.p_WB)).collect(),
            fallen_j: vec![0.0; moving(model, state).count()],
            work_j: 0.0,
            work_max_j: 0.0,
            given_max_j: 0.0,
            lowest_j: start.total_j(),
            highest_j: start.total_j(),
            rise_max_j: 0.0,
            taken: Taken::default(),
            kinetic_max_j: 0.0,
            height_max_j: 0.0,
            load_max_j: 0.0,
            work_parts_j: 0.0,
            contact_gain_max: None,
        };
        ledger.end_at(model, state, stored_j);
        ledger
    }

    /// After a step in which loads and driven bodies did this work; `stored_j`: what springs hold.
    pub fn observe(&mut self, model: &Model, after: &State, stored_j: f64, done: &Done) {
        self.work_j += done.work_j;
        self.work_max_j = self.work_max_j.max(self.work_j.abs());
        self.given_max_j = self.given_max_j.max(self.work_j);
        self.work_parts_j += done.parts_j;
        self.end_at(model, after, stored_j);
        let total_j = self.without_work_j();
        self.rise_max_j = self.rise_max_j.max(total_j - self.lowest_j);
        self.lowest_j = self.lowest_j.min(total_j);
        self.highest_j = self.highest_j.max(total_j);
    }

    /// One pass over the bodies.
    fn end_at(&mut self, model: &Model, state: &State, stored_j: f64) {
        let mut end = Energy { stored_j, ..Energy::default() };
        let mut height_j = 0.0;
        let falls = self.start_j.iter().zip(&mut self.fallen_j);
        for ((body, at), (start_j, fallen_j)) in moving(model, state).zip(falls) {
            let potential_j = model.potential_j(body, &at.p_WB);
            end.kinetic_j += kinetic_j(body, at, &Motion { v: at.v_WB, w: at.w_WB });
            end.potential_j += potential_j;
            *fallen_j = fallen_j.max(start_j - potential_j);
            let [g, zero] = [&at.p_WB, &model.potential_zero_m].map(|p| model.gravity_m_s2.dot(p).abs());
            height_j += body.mass_kg * (g + zero);
        }
        self.kinetic_max_j = self.kinetic_max_j.max(end.kinetic_j);
        self.height_max_j = self.height_max_j.max(height_j);
        if !model.forces.is_empty() {
            let reach_m = |i: usize| state.bodies[i].p_WB.norm() + model.bodies[i].bounding_radius_m;
            let load = |of: &AppliedForce| of.force_n.norm() * reach_m(of.body) + of.torque_n_m.norm();
            self.load_max_j = self.load_max_j.max(model.forces.iter().map(load).sum());
        }
        self.end = end;
    }

    /// What contacts took in one exchange, and in it the largest gain of kinetic energy so far.
    pub(super) fn observe_contacts(&mut self, taken: &Taken, moved: &[Moved]) {
        self.add_taken(taken, 1.0);
        let [before_j, after_j] = [0, 1].map(|k| moved.iter().map(|moved| moved.kinetic_j[k]).sum::<f64>());
        if before_j > 0.0 {
            let gain = after_j / before_j;
            self.contact_gain_max = Some(self.contact_gain_max.map_or(gain, |max| max.max(gain)));
        }
    }

    /// So many times.
    pub(super) fn add_taken(&mut self, taken: &Taken, times: f64) {
        self.taken.lawful += taken.lawful * times;
        self.taken.all += taken.all * times;
        self.taken.parts += taken.parts * times;
    }

    /// Kinetic energy of the last state.
    pub fn kinetic_j(&self) -> f64 {
        self.end.kinetic_j
    }

    /// Kinetic and potential energy of the last state.
    pub fn parts_j(&self) -> [f64; 2] {
        [self.end.kinetic_j, self.end.potential_j]
    }

    /// Energy less the work of loads and of driven bodies.
    pub fn without_work_j(&self) -> f64 {
        self.end.total_j() - self.work_j
    }

    /// Whether there is so many times as much energy as can be explained: E − W against E(0) + max|W|, or E against
    /// E(0) and the most that was given. (Work that takes energy away explains none: a body that the air throws about.)
    /// Not while what explains it is rounding.
    pub fn exceeds(&self, factor: f64) -> bool {
        let exceeds = |energy_j: f64, given_j: f64| {
            let explained_j = self.start_j() + given_j;
            explained_j > NOTHING * self.fall_j && energy_j > factor * explained_j
        };
        exceeds(self.without_work_j(), self.work_max_j) || exceeds(self.end_j(), self.given_max_j)
    }

    pub fn start_j(&self) -> f64 {
        self.start.total_j()
    }

    pub fn end_j(&self) -> f64 {
        self.end.total_j()
    }

    /// (E − E(0) − W + D) / S: made without a reason (+), or lost without a law (−).
    pub fn drift_rel(&self) -> f64 {
        self.part(self.end_j() - self.start_j() - self.work_j + self.taken.lawful)
    }

    /// The same with all that contacts took, with its sign.
    pub fn balance_rel(&self) -> f64 {
        self.part(self.end_j() - self.start_j() - self.work_j + self.taken.all)
    }

    /// Largest rise of E − W over an earlier value, / S.
    pub fn rise_max_rel(&self) -> f64 {
        self.part(self.rise_max_j)
    }

    /// Largest (E − W) / E(0). None: E(0) is nothing, or below the zero of the potential.
    pub fn growth_max(&self) -> Option<f64> {
        (self.start_j() > NOTHING * self.fall_j).then(|| self.highest_j / self.start_j())
    }

    fn part(&self, amount_j: f64) -> f64 {
        let largest_j = self.kinetic_max_j
            + self.height_max_j
            + self.fall_j
            + self.load_max_j
            + self.work_parts_j
            + self.taken.parts;
        if amount_j.abs() <= ROUNDING * largest_j {
            return 0.0;
        }
        let scale_j = self.scale_j();
        if scale_j > 0.0 { amount_j / scale_j } else { amount_j.signum() }
    }

    fn scale_j(&self) -> f64 {
        let fallen_j: f64 = self.fallen_j.iter().sum();
        (self.start.kinetic_j + fallen_j + self.work_max_j).max(LEAST * self.fall_j)
    }
}

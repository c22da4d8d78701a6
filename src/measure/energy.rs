//! Energy of a state, and its ledger over a run.

use super::push::{Push, beyond_rounding};
use crate::model::Model;
use crate::state::State;

/// Kinetic (of the centre of mass and about it) and potential.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    pub kinetic_j: f64,
    pub potential_j: f64,
}

impl Energy {
    pub fn of(model: &Model, state: &State) -> Self {
        let mut energy = Energy { kinetic_j: 0.0, potential_j: 0.0 };
        for (body, at) in model.bodies.iter().zip(&state.bodies).filter(|(body, _)| !body.driven) {
            let w_B = if body.isotropic { at.w_WB } else { at.q_WB.inverse_transform_vector(&at.w_WB) };
            energy.kinetic_j += 0.5 * body.mass_kg * at.v_WB.norm_squared() + 0.5 * w_B.dot(&(body.I_B * w_B));
            energy.potential_j += model.potential_j(body, &at.p_WB);
        }
        energy
    }

    pub fn total_j(&self) -> f64 {
        self.kinetic_j + self.potential_j
    }
}

/// What became of the energy.
#[derive(Clone, Copy, Debug)]
pub struct EnergyLedger {
    start: Energy,
    end: Energy,
    /// Of applied forces, so far.
    work_j: f64,
    /// Least energy less the work done until then.
    lowest_j: f64,
    rise_max_j: f64,
    kinetic_max_j: f64,
    potential_range_j: (f64, f64),
    /// −Σ p·½(v⁻ + v⁺) over all contacts of all steps.
    dissipated_j: f64,
    /// Largest kinetic energy after / before one contact solve.
    pub contact_gain_max: Option<f64>,
}

impl EnergyLedger {
    pub fn new(start: Energy) -> Self {
        EnergyLedger {
            start,
            end: start,
            work_j: 0.0,
            lowest_j: start.total_j(),
            rise_max_j: 0.0,
            kinetic_max_j: start.kinetic_j,
            potential_range_j: (start.potential_j, start.potential_j),
            dissipated_j: 0.0,
            contact_gain_max: None,
        }
    }

    /// After a step in which applied forces did this work.
    pub fn observe(&mut self, now: Energy, work_j: f64) {
        self.work_j += work_j;
        let total_j = now.total_j() - self.work_j;
        self.rise_max_j = self.rise_max_j.max(total_j - self.lowest_j);
        self.lowest_j = self.lowest_j.min(total_j);
        self.kinetic_max_j = self.kinetic_max_j.max(now.kinetic_j);
        let (low, high) = self.potential_range_j;
        self.potential_range_j = (low.min(now.potential_j), high.max(now.potential_j));
        self.end = now;
    }

    /// Energy that the contacts of one step took, and their gain. Before them the velocity is V + M⁻¹ F_E Δt, V that of
    /// the state; after them that plus M⁻¹ times the impulses; both at the attitude before the step.
    pub fn observe_contacts(&mut self, model: &Model, before: &State, pushes: &[Push], step_s: f64) {
        let (mut kinetic_j, mut added_j) = (0.0, 0.0);
        for (i, ((body, at), push)) in model.bodies.iter().zip(&before.bodies).zip(pushes).enumerate() {
            if body.driven {
                continue;
            }
            let (gained_v, gained_w) = model.gained(i, before.time_s, at, step_s);
            let (v, w) = (at.v_WB + gained_v, at.w_WB + gained_w);
            let (dv, dw) = (push.linear / body.mass_kg, body.I_W_inverse(at) * push.angular);
            kinetic_j += 0.5 * body.mass_kg * v.norm_squared() + 0.5 * w.dot(&(body.I_W(at) * w));
            added_j += push.linear.dot(&(v + dv / 2.0)) + push.angular.dot(&(w + dw / 2.0));
            let mean_v = (at.v_WB + v + dv) / 2.0;
            let mean_w = (at.w_WB + w + dw) / 2.0;
            self.dissipated_j -= push.linear.dot(&mean_v) + push.angular.dot(&mean_w);
        }
        if kinetic_j > 0.0 {
            let gain = (kinetic_j + added_j) / kinetic_j;
            self.contact_gain_max = Some(self.contact_gain_max.map_or(gain, |max| max.max(gain)));
        }
    }

    /// Energy that an impact took: from the velocities before and after, whatever else made them so (pins do no work).
    pub fn observe_blow(&mut self, model: &Model, [before, after]: [&State; 2], pushes: &[Push]) {
        for (((body, a), b), push) in model.bodies.iter().zip(&before.bodies).zip(&after.bodies).zip(pushes) {
            if !body.driven {
                self.dissipated_j -=
                    push.linear.dot(&(a.v_WB + b.v_WB)) / 2.0 + push.angular.dot(&(a.w_WB + b.w_WB)) / 2.0;
            }
        }
        let [kinetic_j, left_j] = [before, after].map(|state| Energy::of(model, state).kinetic_j);
        if kinetic_j > 0.0 {
            let gain = left_j / kinetic_j;
            self.contact_gain_max = Some(self.contact_gain_max.map_or(gain, |max| max.max(gain)));
        }
    }

    /// Energy that finite forces of contact took at a state, given as impulses.
    pub fn observe_forces(&mut self, model: &Model, state: &State, pushes: &[Push]) {
        for ((body, at), push) in model.bodies.iter().zip(&state.bodies).zip(pushes) {
            if !body.driven {
                self.dissipated_j -= push.linear.dot(&at.v_WB) + push.angular.dot(&at.w_WB);
            }
        }
    }

    pub fn start_j(&self) -> f64 {
        self.start.total_j()
    }

    pub fn end_j(&self) -> f64 {
        self.end.total_j()
    }

    /// (end − start − work of applied forces + dissipation) / scale.
    pub fn drift_rel(&self) -> f64 {
        self.part(self.end_j() - self.start_j() - self.work_j + self.dissipated_j)
    }

    /// Largest E(t) − min over s < t of E(s), less the work of applied forces between, / scale.
    pub fn rise_max_rel(&self) -> f64 {
        self.part(self.rise_max_j)
    }

    fn part(&self, amount_j: f64) -> f64 {
        let (low, high) = self.potential_range_j;
        let largest_j = self.kinetic_max_j + low.abs().max(high.abs());
        beyond_rounding(amount_j, largest_j, self.scale_j())
    }

    /// Largest kinetic energy of the run plus the range of the potential energy.
    fn scale_j(&self) -> f64 {
        self.kinetic_max_j + (self.potential_range_j.1 - self.potential_range_j.0)
    }
}

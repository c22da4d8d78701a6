//! When a run counts as diverged, and why runs stop. A run that stops is a result.

use super::energy::EnergyLedger;
use crate::experiment::types::Diverge;
use crate::model::{Body, Model};
use crate::outcome::Criterion;
use crate::state::{BodyState, State};

/// The rules of one run.
pub struct Divergence(Diverge);

impl Divergence {
    pub fn new(rules: &Diverge) -> Self {
        Divergence(rules.clone())
    }

    pub fn judge(&self, model: &Model, state: &State, energy: &EnergyLedger, depth_m: f64) -> Option<Criterion> {
        let Diverge { energy_factor, escape, speed_m_s, penetration_m } = self.0;
        let speed = |at: &BodyState| at.v_WB.norm();
        if !state.bodies.iter().all(BodyState::is_finite) {
            return Some(Criterion::NotFinite);
        }
        if energy_factor.is_some_and(|factor| energy.exceeds(factor)) {
            return Some(Criterion::Energy);
        }
        if escape && model.bodies.iter().zip(&state.bodies).any(|(body, at)| escaped(model, body, at)) {
            return Some(Criterion::Escape);
        }
        if speed_m_s.is_some_and(|limit| state.bodies.iter().any(|at| speed(at) > limit)) {
            return Some(Criterion::Speed);
        }
        penetration_m.is_some_and(|limit| depth_m > limit).then_some(Criterion::Penetration)
    }
}

/// The centre of mass is outside by more than the bounding radius. A body without a shape is held by nothing.
pub fn escaped(model: &Model, body: &Body, at: &BodyState) -> bool {
    let outside = |face: &crate::model::container::Face| face.gap_m(&at.p_WB) < -body.bounding_radius_m;
    body.feels_container() && model.container.as_ref().is_some_and(|container| container.faces.iter().any(outside))
}

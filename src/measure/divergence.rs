//! When a run counts as diverged, and why runs stop. A run that stops is a result.

use super::energy::Energy;
use crate::experiment::types::Diverge;
use crate::model::{Body, Model};
use crate::outcome::Criterion;
use crate::state::{BodyState, State};

/// Of a fall of all bodies by their size: an energy that is rounding.
const NOTHING: f64 = 1e-9;

/// The rules of one run.
pub struct Divergence {
    energy_limit_j: Option<f64>,
    escape: bool,
    speed_m_s: Option<f64>,
    penetration_m: Option<f64>,
}

impl Divergence {
    pub fn new(rules: &Diverge, model: &Model, start: &Energy) -> Self {
        // A start value of 0, or what rounding leaves of it (or below it, where no floor holds the scene), says nothing
        // about the scale.
        let start_j = start.total_j();
        let falls_j = |body: &Body| body.mass_kg * model.gravity_m_s2.norm() * body.bounding_radius_m;
        let fall_j: f64 = model.bodies.iter().filter(|body| !body.driven).map(falls_j).sum();
        Divergence {
            energy_limit_j: rules.energy_factor.filter(|_| start_j > NOTHING * fall_j).map(|factor| factor * start_j),
            escape: rules.escape,
            speed_m_s: rules.speed_m_s,
            penetration_m: rules.penetration_m,
        }
    }

    pub fn judge(&self, model: &Model, state: &State, energy: &Energy, depth_m: f64) -> Option<Criterion> {
        let speed = |at: &BodyState| at.v_WB.norm();
        if !state.bodies.iter().all(BodyState::is_finite) {
            return Some(Criterion::NotFinite);
        }
        if self.energy_limit_j.is_some_and(|limit| energy.total_j() > limit) {
            return Some(Criterion::Energy);
        }
        if self.escape && model.bodies.iter().zip(&state.bodies).any(|(body, at)| escaped(model, body, at)) {
            return Some(Criterion::Escape);
        }
        if self.speed_m_s.is_some_and(|limit| state.bodies.iter().any(|at| speed(at) > limit)) {
            return Some(Criterion::Speed);
        }
        self.penetration_m.is_some_and(|limit| depth_m > limit).then_some(Criterion::Penetration)
    }
}

/// The centre of mass is outside by more than the bounding radius. A body without a shape is held by nothing.
fn escaped(model: &Model, body: &Body, at: &BodyState) -> bool {
    let outside = |face: &crate::model::container::Face| face.gap_m(&at.p_WB) < -body.bounding_radius_m;
    body.feels_container() && model.container.as_ref().is_some_and(|container| container.faces.iter().any(outside))
}

//! The penalty method's critical step (L15), by the linear stability of its stiffest mode.
//!
//! Along a mode of J_n M⁻¹ J_nᵀ with eigenvalue ν the method is v' = v − Δt (λ x + γ v) with λ = k ν and γ = c ν, then
//! x' = x + Δt v' (semi-implicit) or x' = x + Δt v (explicit). It is stable while both roots of z² − T z + P are in the
//! unit circle, |T| ≤ 1 + P and P ≤ 1: here with T = 2 − γΔt − λΔt², P = 1 − γΔt or T = 2 − γΔt, P = 1 − γΔt + λΔt².

use super::kept::{Kept, eigenvalues};
use crate::collide::SolvedContact;
use crate::experiment::types::{Penalty, Update};
use crate::model::Model;
use crate::state::State;
use serde_json::{Value, json};

/// Keeps the first step in which a node is inside.
#[derive(Clone, Debug, Default)]
pub struct CriticalStep {
    kept: Kept,
}

impl CriticalStep {
    pub fn observe(&mut self, before: &State, contacts: &[SolvedContact]) {
        if self.kept.contacts.is_empty() {
            let inside = contacts.iter().map(|solved| solved.contact).filter(|contact| contact.gap_m < 0.0);
            self.kept.keep(before, inside);
        }
    }

    /// Largest eigenvalue of J_n M⁻¹ J_nᵀ, 1/kg. None if nothing has touched.
    pub fn normal_lambda_max(&self, model: &Model) -> Option<f64> {
        let largest = |rows: &Vec<_>| eigenvalues(rows).map(|values| values[0]);
        self.kept.rows(model, 1).iter().map(largest).collect::<Option<Vec<_>>>()?.into_iter().reduce(f64::max)
    }

    pub fn columns(&self, model: &Model, settings: Option<&Penalty>) -> [Value; 2] {
        let largest = self.normal_lambda_max(model);
        let step_s = largest.zip(settings).map(|(largest, settings)| critical_step_s(settings, largest));
        [json!(largest), json!(step_s)]
    }
}

/// The largest stable step of the mode that 1/kg `normal_lambda` belongs to; the stiffest one has the smallest.
pub fn critical_step_s(settings: &Penalty, normal_lambda: f64) -> f64 {
    let lambda = settings.stiffness_n_m * normal_lambda;
    let ratio = settings.damping_n_s_m / settings.stiffness_n_m;
    match settings.update {
        // |T| ≤ 1 + P: λ Δt² + 2 (c/k) λ Δt ≤ 4.
        Update::SemiImplicit => 4.0 / lambda / (ratio + (ratio * ratio + 4.0 / lambda).sqrt()),
        // P ≤ 1.
        Update::Explicit if ratio * lambda.sqrt() <= 2.0 => ratio,
        // Overdamped, |T| ≤ 1 + P: the smaller root of λ Δt² − 2γ Δt + 4 = 0.
        Update::Explicit => {
            let gamma = ratio * lambda;
            4.0 / (gamma + (gamma * gamma - 4.0 * lambda).sqrt())
        }
    }
}

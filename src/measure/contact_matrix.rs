//! The matrix A = J M⁻¹ Jᵀ (L16) in the step with the most contacts: what its solvers have to do with.
//!
//! A has three rows a contact and at most six degrees of freedom a body: its nonzero eigenvalues are found body by
//! body.

use super::kept::{Kept, eigenvalues};
use crate::collide::SolvedContact;
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector6;
use serde_json::{Value, json};

/// Eigenvalues above this part of the largest count for the rank.
const RANK: f64 = 1e-9;

/// Keeps the step with the most contacts, the first of equals.
#[derive(Clone, Debug, Default)]
pub struct ContactMatrix {
    kept: Kept,
}

/// What is measured of A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    pub contacts: usize,
    pub rank: usize,
    /// Spectral radius of E − D⁻¹A, D the diagonal of A: by what an error grows in a sweep of Jacobi's iteration (L20).
    pub jacobi_radius: f64,
}

impl ContactMatrix {
    pub fn observe(&mut self, before: &State, contacts: &[SolvedContact]) {
        if contacts.len() > self.kept.contacts.len() {
            self.kept.keep(before, contacts.iter().map(|solved| solved.contact));
        }
    }

    /// None if nothing has touched.
    pub fn measured(&self, model: &Model) -> Option<Spectrum> {
        let bodies = self.kept.rows(model, 3).iter().map(|rows| measured(rows)).collect::<Option<Vec<_>>>()?;
        bodies.into_iter().reduce(|a, b| Spectrum {
            contacts: a.contacts + b.contacts,
            rank: a.rank + b.rank,
            jacobi_radius: a.jacobi_radius.max(b.jacobi_radius),
        })
    }

    pub fn columns(&self, model: &Model) -> [Value; 3] {
        self.measured(model)
            .map_or([const { Value::Null }; 3], |m| [json!(m.contacts), json!(m.rank), json!(m.jacobi_radius)])
    }
}

/// Of one body. E − D⁻¹A is similar to E − D^(−1/2) A D^(−1/2), whose rows are those of J M^(−1/2) made unit: its
/// eigenvalues are 1 − λ, and 1 where A is singular.
fn measured(rows: &[Vector6<f64>]) -> Option<Spectrum> {
    let values = eigenvalues(rows)?;
    let rank = values.iter().filter(|value| **value > RANK * values[0]).count();
    let unit: Vec<_> = rows.iter().map(Vector6::normalize).collect();
    let scaled = eigenvalues(&unit)?;
    let regular = scaled[..rank].iter().map(|value| (1.0 - value).abs()).fold(0.0, f64::max);
    let jacobi_radius = if rows.len() > rank { regular.max(1.0) } else { regular };
    Some(Spectrum { contacts: rows.len() / 3, rank, jacobi_radius })
}

//! The discrete Moser–Veselov equations, order 2: h \[Π\]× = F J − J Fᵀ with J = ½ tr(I) − I, then R ← R F, Π ← Fᵀ Π
//! (Moser & Veselov 1991; as an integrator and its backward error: McLachlan & Zanna 2005).
//!
//! A variational method: R Π does not change. It is integrable with the motion's own integrals, which for three axes
//! include the energy: the body runs through the exact curve of Π at a rate that is wrong by O(h²). Beyond about
//! h |ω| = 1 there is no F.

use super::drive::Drive;
use super::implicit::Reached;
use super::momentum::{half_turned, kick_turn_kick};
use crate::model::Body;
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::{Matrix3, Vector3};

/// End of a step of half of the drive at the start, the turn, and half of that at the end (Störmer and Verlet's
/// method); None where the turn has no solution.
pub fn driven(
    body: &Body,
    start: &BodyState,
    [before, after]: &[Drive; 2],
    h: f64,
    work: &mut Work,
) -> Option<Reached> {
    let [end, _] = kick_turn_kick(equation, body, start, [before, after], h, work)?;
    Some(Reached { end, seen: end })
}

/// Equation for c, with F = cay(c): (1 + c²) g = 2 (I c + c × I c), or g + g × c + (g·c) c = 2 I c, where g = h Π.
pub fn equation(g: &Vector3<f64>, I_B: &Matrix3<f64>, c: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let (left, derivative) = half_turned(g, c);
    (left - I_B * c * 2.0, derivative - I_B * 2.0)
}

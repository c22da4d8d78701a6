//! The implicit midpoint rule on (R, Π), order 2: Π₁ − Π₀ = h Π_m × ω_m and R₁ − R₀ = h (R₀ + R₁)/2 \[ω_m\]× with
//! Π_m = (Π₀ + Π₁)/2 = I ω_m in body axes (Simo & Wong 1991; Austin, Krishnaprasad & Wang 1993).
//!
//! Both are the same Cayley transform of c = h ω_m/2, so that R Π does not change; |Π|² and the energy are quadratic,
//! and the midpoint rule keeps them. (The rule on the quaternion instead of R would turn by another angle.)

use super::drive::Drive;
use super::implicit::Reached;
use super::momentum::{half_turned, kick_turn_kick};
use crate::model::Body;
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::{Matrix3, Vector3};

/// End of a step with a torque τ_m in the middle: of Π₁ − Π₀ = h (Π_m × ω_m + τ_m), half of h τ_m comes before the turn
/// and half after it. None where the turn has no solution.
pub fn driven(body: &Body, start: &BodyState, [_, middle]: &[Drive; 2], h: f64, work: &mut Work) -> Option<Reached> {
    let [end, mut seen] = kick_turn_kick(equation, body, start, [middle, middle], h, work)?;
    seen.p_WB = (start.p_WB + end.p_WB) / 2.0;
    Some(Reached { end, seen })
}

/// Equation Π_m = (1 + \[c\]×)⁻¹ Π₀ = I ω_m for c: g + g × c + (g·c) c = 2 (1 + c²) I c with g = h Π₀.
pub fn equation(g: &Vector3<f64>, I_B: &Matrix3<f64>, c: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let (left, derivative) = half_turned(g, c);
    let stretch = 2.0 * (1.0 + c.norm_squared());
    let Ic = I_B * c;
    (left - Ic * stretch, derivative - I_B * stretch - Ic * c.transpose() * 4.0)
}

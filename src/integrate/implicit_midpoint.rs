//! The implicit midpoint rule on (R, Π), order 2: Π₁ − Π₀ = h Π_m × ω_m and R₁ − R₀ = h (R₀ + R₁)/2 \[ω_m\]× with
//! Π_m = (Π₀ + Π₁)/2 = I ω_m in body axes (Simo & Wong 1991; Austin, Krishnaprasad & Wang 1993).
//!
//! Both are the same Cayley transform of c = h ω_m/2, so that R Π does not change; |Π|² and the energy are quadratic,
//! and the midpoint rule keeps them. (The rule on the quaternion instead of R would turn by another angle.)

use super::momentum::{half_turned, turn};
use super::phase::fall;
use crate::measure::work::Work;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::{Matrix3, Vector3};

/// One step of a body under a constant acceleration; its parabola is exact.
pub fn step(body: &Body, at: &mut BodyState, acceleration: &Vector3<f64>, step_s: f64, work: &mut Work) {
    fall(at, acceleration, step_s);
    turn(equation, body, at, step_s, work);
}

/// Π_m = (1 + \[c\]×)⁻¹ Π₀ = I ω_m: g + g × c + (g·c) c = 2 (1 + c²) I c with g = h Π₀.
fn equation(g: &Vector3<f64>, I_B: &Matrix3<f64>, c: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let (left, derivative) = half_turned(g, c);
    let stretch = 2.0 * (1.0 + c.norm_squared());
    let Ic = I_B * c;
    (left - Ic * stretch, derivative - I_B * stretch - Ic * c.transpose() * 4.0)
}

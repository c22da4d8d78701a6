//! The trapezoidal rule (Crank & Nicolson 1947), implicit, order 2: y₁ − y₀ = h/2 (f(y₀) + f(y₁)) on position, velocity,
//! angular velocity in body axes and quaternion; the quaternion is made a unit one after the step.
//!
//! It is conjugate to the midpoint rule: energy and momentum are kept by neither step, but come back.

use super::newton;
use super::phase::{fall, to_world};
use crate::measure::work::Work;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// One step of a body under a constant acceleration; its parabola is exact.
pub fn step(body: &Body, at: &mut BodyState, acceleration: &Vector3<f64>, step_s: f64, work: &mut Work) {
    fall(at, acceleration, step_s);
    let old_B = at.q_WB.inverse_transform_vector(&at.w_WB);
    let new_B = if body.isotropic { old_B } else { new_velocity_B(body, &old_B, step_s, work) };
    // q₁ − q₀ = h/4 (q₀ ω₀ + q₁ ω₁), solved for q₁; the inverse is the conjugate up to a length.
    let quarter = |w_B: &Vector3<f64>| Quaternion::from_parts(1.0, w_B * (step_s / 4.0));
    let q_WB = at.q_WB.into_inner() * quarter(&old_B) * quarter(&-new_B).conjugate();
    at.q_WB = UnitQuaternion::new_normalize(q_WB);
    at.w_WB = to_world(&at.q_WB, &new_B);
}

/// I (ω₁ − ω₀) = h/2 (I ω₀ × ω₀ + I ω₁ × ω₁).
fn new_velocity_B(body: &Body, old_B: &Vector3<f64>, step_s: f64, work: &mut Work) -> Vector3<f64> {
    let I = &body.I_B;
    let half = step_s / 2.0;
    work.gyroscopic += 1;
    let known = I * old_B + (I * old_B).cross(old_B) * half;
    newton::root(*old_B, |w| {
        work.gyroscopic += 1;
        let Iw = I * w;
        (Iw - Iw.cross(w) * half - known, I - (Iw.cross_matrix() - w.cross_matrix() * I) * half)
    })
}

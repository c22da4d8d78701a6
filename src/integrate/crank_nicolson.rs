//! The trapezoidal rule (Crank & Nicolson 1947), implicit, order 2: y₁ − y₀ = h/2 (f(y₀) + f(y₁)) on position,
//! velocity, angular velocity in body axes and quaternion; the quaternion is made a unit one after the step.
//!
//! It is conjugate to the midpoint rule: energy and momentum are kept by neither step, but come back.

use super::drive::Drive;
use super::implicit::Reached;
use super::phase::{fall, to_world};
use super::rotation::gyroscopic_torque_B;
use crate::math::newton;
use crate::model::Body;
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// End of a step between the drives at its start and its end; None where the step has no solution.
pub fn driven(
    body: &Body,
    start: &BodyState,
    [before, after]: &[Drive; 2],
    h: f64,
    work: &mut Work,
) -> Option<Reached> {
    let mut end = *start;
    fall(&mut end, &((before.acceleration + after.acceleration) / 2.0), h);
    let mean_torque_B = (before.torque_B + after.torque_B) / 2.0;
    let old_B = start.q_WB.inverse_transform_vector(&start.w_WB);
    let new_B = new_velocity_B(body, &old_B, &mean_torque_B, h, work)?;
    // q₁ − q₀ = h/4 (q₀ ω₀ + q₁ ω₁), solved for q₁; the inverse is the conjugate up to a length.
    let quarter = |w_B: &Vector3<f64>| Quaternion::from_parts(1.0, w_B * (h / 4.0));
    let q_WB = start.q_WB.into_inner() * quarter(&old_B) * quarter(&-new_B).conjugate();
    end.q_WB = UnitQuaternion::new_normalize(q_WB);
    end.w_WB = to_world(&end.q_WB, &new_B);
    Some(Reached { end, seen: end })
}

/// I (ω₁ − ω₀) = h/2 (I ω₀ × ω₀ + I ω₁ × ω₁) + h τ.
fn new_velocity_B(
    body: &Body,
    old_B: &Vector3<f64>,
    torque_B: &Vector3<f64>,
    h: f64,
    work: &mut Work,
) -> Option<Vector3<f64>> {
    let I = &body.I_B;
    if body.spins_steadily {
        return Some(old_B + body.I_B_inverse * torque_B * h);
    }
    let half = h / 2.0;
    work.gyroscopic += 1;
    let known = I * old_B + gyroscopic_torque_B(body, old_B) * half + torque_B * h;
    newton::root(*old_B, |w| {
        work.gyroscopic += 1;
        let Iw = I * w;
        (Iw - Iw.cross(w) * half - known, I - (Iw.cross_matrix() - w.cross_matrix() * I) * half)
    })
}

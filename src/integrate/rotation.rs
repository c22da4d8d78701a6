//! Turns of a body (L11): the slide's Rodrigues update, and one that conserves angular momentum.

use crate::model::Body;
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

/// Quotient sin x / x.
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { libm::sin(x) / x }
}

/// Rotation dR = E + sin θ/θ W + (1 − cos θ)/θ² W², with W = \[θ⃗\]×. The slide prints ω where the angle ω Δt is meant.
/// 1 − cos θ is written as 2 sin²(θ/2), which does not cancel as θ → 0.
pub fn rodrigues(angle: &Vector3<f64>) -> Matrix3<f64> {
    let theta = angle.norm();
    let W = angle.cross_matrix();
    let half = sinc(theta / 2.0);
    Matrix3::identity() + W * sinc(theta) + W * W * (half * half / 2.0)
}

/// Rotation by the same angle as a unit quaternion.
pub fn exponential(angle: &Vector3<f64>) -> UnitQuaternion<f64> {
    let half = angle.norm() / 2.0;
    let axis = angle * (sinc(half) / 2.0);
    UnitQuaternion::new_unchecked(Quaternion::from_parts(libm::cos(half), axis))
}

/// Turns the body by R ← dR R, literally.
pub fn turn_literally(at: &mut BodyState, w_WB: &Vector3<f64>, step_s: f64) {
    let R_WB = rodrigues(&(w_WB * step_s)) * at.q_WB.to_rotation_matrix().into_inner();
    at.q_WB = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(R_WB));
    at.q_WB.renormalize();
}

/// Turns the body by ω_mid Δt, where ω_mid = I(R_mid)⁻¹ L and R_mid is half-way: the implicit midpoint rule for Ṙ =
/// \[I⁻¹L\]× R at constant L. Order 2, symmetric in time.
pub fn turn_at_momentum(body: &Body, at: &mut BodyState, L_W: &Vector3<f64>, step_s: f64, work: &mut Work) {
    /// The fixed point contracts by about |ω|Δt/2 an iteration; beyond it the step is too long for any rule.
    const MOST: u32 = 30;
    let w_at = |q: &UnitQuaternion<f64>| q * (body.I_B_inverse * q.inverse_transform_vector(L_W));
    let mut w_mid = w_at(&at.q_WB);
    if !body.spins_steadily {
        work.gyroscopic += 1;
        for _ in 0..MOST {
            let next = w_at(&(exponential(&(w_mid * (step_s / 2.0))) * at.q_WB));
            let change = (next - w_mid).amax();
            w_mid = next;
            if change <= 4.0 * f64::EPSILON * w_mid.amax() {
                break;
            }
        }
    }
    at.q_WB = exponential(&(w_mid * step_s)) * at.q_WB;
    at.q_WB.renormalize();
}

/// Angular velocity ω = I⁻¹ L at the present attitude.
pub fn w_from_momentum(body: &Body, at: &BodyState, L_W: &Vector3<f64>) -> Vector3<f64> {
    body.I_W_inverse(at) * L_W
}

/// Torque I ω × ω that the rotation itself puts into Euler's equation I ω̇ = I ω × ω + τ in body axes.
pub fn gyroscopic_torque_B(body: &Body, w_B: &Vector3<f64>) -> Vector3<f64> {
    (body.I_B * w_B).cross(w_B)
}

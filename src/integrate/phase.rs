//! Motion of a body as one vector y with ẏ = f(y), for the methods that know nothing of rotations; and the parabola.

use super::drive::Drive;
use super::rotation::gyroscopic_torque_B;
use crate::model::Body;
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3};

/// Vector of p and v in the world, ω in body axes, and q (x, y, z, w).
pub type Phase = SVector<f64, 13>;

pub fn phase(at: &BodyState) -> Phase {
    let mut y = Phase::zeros();
    y.fixed_rows_mut::<3>(0).copy_from(&at.p_WB);
    y.fixed_rows_mut::<3>(3).copy_from(&at.v_WB);
    y.fixed_rows_mut::<3>(6).copy_from(&at.q_WB.inverse_transform_vector(&at.w_WB));
    y.fixed_rows_mut::<4>(9).copy_from(&at.q_WB.coords);
    y
}

/// State of a phase; the quaternion is made a unit one.
pub fn state(y: &Phase) -> BodyState {
    let q_WB = UnitQuaternion::new_normalize(quaternion(y));
    let (p_WB, v_WB) = (y.fixed_rows::<3>(0).into_owned(), y.fixed_rows::<3>(3).into_owned());
    BodyState { p_WB, q_WB, v_WB, w_WB: to_world(&q_WB, &w_B(y)) }
}

/// Angular velocity of the world that turns back into this one. |q| = 1 only to rounding, so that there and back is not
/// quite the same, and not by chance: without the correction a tumbling bar gains some 1e-16 of its energy a step.
pub fn to_world(q_WB: &UnitQuaternion<f64>, w_B: &Vector3<f64>) -> Vector3<f64> {
    let w_WB = q_WB * w_B;
    w_WB + q_WB * (w_B - q_WB.inverse_transform_vector(&w_WB))
}

/// Rates ṗ = v, v̇ = a, ω̇ = I⁻¹ (I ω × ω + τ), q̇ = ½ q ω.
pub fn rate(body: &Body, drive: &Drive, y: &Phase, work: &mut Work) -> Phase {
    let mut rate = Phase::zeros();
    rate.fixed_rows_mut::<3>(0).copy_from(&y.fixed_rows::<3>(3));
    rate.fixed_rows_mut::<3>(3).copy_from(&drive.acceleration);
    if drive.turns(body) {
        work.gyroscopic += u64::from(!body.spins_steadily);
        let torque_B = gyroscopic_torque_B(body, &w_B(y)) + drive.torque_B;
        rate.fixed_rows_mut::<3>(6).copy_from(&(body.I_B_inverse * torque_B));
    }
    let turning = quaternion(y) * Quaternion::from_imag(w_B(y)) / 2.0;
    rate.fixed_rows_mut::<4>(9).copy_from(&turning.coords);
    rate
}

fn w_B(y: &Phase) -> Vector3<f64> {
    y.fixed_rows::<3>(6).into_owned()
}

fn quaternion(y: &Phase) -> Quaternion<f64> {
    Quaternion::from(y.fixed_rows::<4>(9).into_owned())
}

/// Moves position and velocity by a constant acceleration. The trapezoidal and the midpoint rule are one for a velocity
/// that is linear in time, and exact.
pub fn fall(at: &mut BodyState, acceleration: &Vector3<f64>, step_s: f64) {
    let old = at.v_WB;
    at.v_WB += acceleration * step_s;
    at.p_WB += (old + at.v_WB) * (step_s / 2.0);
}

//! Common part of the two methods that keep the angular momentum: half of the drive, then a turn without torque, then
//! the other half (G. Strang, SIAM J. Numer. Anal. 5 (1968) 506; for a rigid body McLachlan & Zanna 2005).
//!
//! A turn's unknown is the rotation of one step, c = n tan(θ/2) (Cayley's or Rodrigues' vector); the momentum L is a
//! constant of the world, so that only the attitude can err.

use super::chain::Chain;
use super::drive::Drive;
use super::phase::fall;
use super::rotation::exponential;
use crate::math::newton;
use crate::model::{Body, Model};
use crate::state::BodyState;
use crate::work::Work;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// The method's equation for c, given h Π and the inertia in body axes, with its derivative.
pub type Equation = fn(&Vector3<f64>, &Matrix3<f64>, &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>);

/// Angular momenta L of the bodies of an island.
pub fn momenta(island: &Chain, model: &Model) -> Vec<Vector3<f64>> {
    island.bodies(model).zip(&island.at).map(|(body, at)| momentum_W(body, &at.q_WB, &at.w_WB)).collect()
}

/// Takes bodies over a step that nothing but gravity acts on. `momenta` holds the L of each, the method's own and never
/// worked out again from ω, which would add a rounding a step. False where a turn has no solution.
pub fn step_free(
    equation: Equation,
    island: &mut Chain,
    model: &Model,
    h: f64,
    momenta: &[Vector3<f64>],
    work: &mut Work,
) -> bool {
    for ((body, at, drive), L_W) in island.each(model).zip(momenta) {
        fall(at, &drive.acceleration, h);
        if body.spins_steadily {
            // ω is constant: nothing to solve, and the attitude is exact.
            at.q_WB = exponential(&(at.w_WB * h)) * at.q_WB;
            at.q_WB.renormalize();
            continue;
        }
        let Some(c) = turn(equation, body, &at.q_WB, L_W, h, work) else { return false };
        at.q_WB *= cayley(&c);
        at.q_WB.renormalize();
        at.w_WB = velocity_W(body, &at.q_WB, L_W);
    }
    true
}

/// End of half a step of one drive, the turn, and half a step of the other, and the middle of the turn; None where it
/// has no solution.
pub fn kick_turn_kick(
    equation: Equation,
    body: &Body,
    start: &BodyState,
    [first, second]: [&Drive; 2],
    h: f64,
    work: &mut Work,
) -> Option<[BodyState; 2]> {
    let v = start.v_WB + first.acceleration * (h / 2.0);
    let L_W = momentum_W(body, &start.q_WB, &start.w_WB) + start.q_WB * (first.torque_B * (h / 2.0));
    let (half, w_mean_B) = half_turn(equation, body, &start.q_WB, &L_W, h, work)?;
    let mut middle = BodyState { p_WB: start.p_WB + v * (h / 2.0), q_WB: start.q_WB * half, v_WB: v, w_WB: L_W };
    middle.w_WB = middle.q_WB * w_mean_B;
    let mut end = BodyState { p_WB: start.p_WB + v * h, q_WB: middle.q_WB * half, ..middle };
    end.q_WB.renormalize();
    end.v_WB = v + second.acceleration * (h / 2.0);
    end.w_WB = velocity_W(body, &end.q_WB, &(L_W + end.q_WB * (second.torque_B * (h / 2.0))));
    Some([end, middle])
}

/// Half of a step's rotation, and its mean angular velocity, both in body axes.
fn half_turn(
    equation: Equation,
    body: &Body,
    q_WB: &UnitQuaternion<f64>,
    L_W: &Vector3<f64>,
    h: f64,
    work: &mut Work,
) -> Option<(UnitQuaternion<f64>, Vector3<f64>)> {
    if body.spins_steadily {
        let w_B = body.I_B_inverse * q_WB.inverse_transform_vector(L_W);
        return Some((exponential(&(w_B * (h / 2.0))), w_B));
    }
    let c = turn(equation, body, q_WB, L_W, h, work)?;
    // tan(θ/4) = tan(θ/2) / (1 + √(1 + tan²(θ/2))).
    Some((cayley(&(c / (1.0 + (1.0 + c.norm_squared()).sqrt()))), c * (2.0 / h)))
}

/// The Cayley vector of a turn without torque; None if the equation has no solution.
pub fn turn(
    equation: Equation,
    body: &Body,
    q_WB: &UnitQuaternion<f64>,
    L_W: &Vector3<f64>,
    h: f64,
    work: &mut Work,
) -> Option<Vector3<f64>> {
    let g = q_WB.inverse_transform_vector(L_W) * h;
    newton::root(body.I_B_inverse * g / 2.0, |c| {
        work.gyroscopic += 1;
        equation(&g, &body.I_B, c)
    })
}

/// Common term of both equations, (1 + c²) (1 + \[c\]×)⁻¹ g = g + g × c + (g·c) c, and its derivative.
pub fn half_turned(g: &Vector3<f64>, c: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let value = g + g.cross(c) + c * g.dot(c);
    (value, g.cross_matrix() + Matrix3::from_diagonal_element(g.dot(c)) + c * g.transpose())
}

pub fn cayley(c: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::from_parts(1.0, *c) / (1.0 + c.norm_squared()).sqrt())
}

/// Angular momentum I ω in the world.
pub fn momentum_W(body: &Body, q_WB: &UnitQuaternion<f64>, w_WB: &Vector3<f64>) -> Vector3<f64> {
    q_WB * (body.I_B * q_WB.inverse_transform_vector(w_WB))
}

/// Angular velocity ω whose `momentum_W` is L. I I⁻¹ is not quite 1, and by the same factor in every step.
pub fn velocity_W(body: &Body, q_WB: &UnitQuaternion<f64>, L_W: &Vector3<f64>) -> Vector3<f64> {
    let inverse = |L_W: &Vector3<f64>| q_WB * (body.I_B_inverse * q_WB.inverse_transform_vector(L_W));
    let w_WB = inverse(L_W);
    w_WB + inverse(&(L_W - momentum_W(body, q_WB, &w_WB)))
}

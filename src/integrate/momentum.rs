//! What the two methods that keep the angular momentum share. Their unknown is the rotation of one step, c = n tan(θ/2)
//! (Cayley's or Rodrigues' vector); the momentum L is a constant of the world, so that only the attitude can err.

use super::newton;
use super::rotation::exponential;
use crate::measure::work::Work;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// The method's equation for c, given h Π and the inertia in body axes, with its derivative.
pub type Equation = fn(&Vector3<f64>, &Matrix3<f64>, &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>);

/// R ← R cay(c), ω = I⁻¹ L.
pub fn turn(equation: Equation, body: &Body, at: &mut BodyState, step_s: f64, work: &mut Work) {
    if body.isotropic {
        // ω is constant: nothing to solve, and the attitude is exact.
        at.q_WB = exponential(&(at.w_WB * step_s)) * at.q_WB;
        at.q_WB.renormalize();
        return;
    }
    let L_W = momentum_W(body, &at.q_WB, &at.w_WB);
    let g = at.q_WB.inverse_transform_vector(&L_W) * step_s;
    let c = newton::root(body.I_B_inverse * g / 2.0, |c| {
        work.gyroscopic += 1;
        equation(&g, &body.I_B, c)
    });
    at.q_WB *= cayley(&c);
    at.q_WB.renormalize();
    at.w_WB = velocity_W(body, &at.q_WB, &L_W);
}

/// What both equations are made of: (1 + c²) (1 + \[c\]×)⁻¹ g = g + g × c + (g·c) c, and its derivative.
pub fn half_turned(g: &Vector3<f64>, c: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let value = g + g.cross(c) + c * g.dot(c);
    (value, g.cross_matrix() + Matrix3::from_diagonal_element(g.dot(c)) + c * g.transpose())
}

fn cayley(c: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::new_unchecked(Quaternion::from_parts(1.0, *c) / (1.0 + c.norm_squared()).sqrt())
}

fn momentum_W(body: &Body, q_WB: &UnitQuaternion<f64>, w_WB: &Vector3<f64>) -> Vector3<f64> {
    q_WB * (body.I_B * q_WB.inverse_transform_vector(w_WB))
}

/// The ω whose `momentum_W` is L. I I⁻¹ is not quite 1, and by the same factor in every step: without the correction L
/// would drift by some rounding a step, with it L walks at random.
fn velocity_W(body: &Body, q_WB: &UnitQuaternion<f64>, L_W: &Vector3<f64>) -> Vector3<f64> {
    let inverse = |L_W: &Vector3<f64>| q_WB * (body.I_B_inverse * q_WB.inverse_transform_vector(L_W));
    let w_WB = inverse(L_W);
    w_WB + inverse(&(L_W - momentum_W(body, q_WB, &w_WB)))
}

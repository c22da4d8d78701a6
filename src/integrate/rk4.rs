//! The classical Runge–Kutta method, order 4 (Kutta 1901), on position, velocity, angular velocity in body axes and
//! quaternion; the quaternion is made a unit one after the step. A parabola is exact.

use super::phase::{Phase, phase, rate, state};
use crate::measure::work::Work;
use crate::model::Body;
use crate::state::BodyState;
use nalgebra::Vector3;

/// One step of a body under a constant acceleration.
pub fn step(body: &Body, at: &mut BodyState, acceleration: &Vector3<f64>, step_s: f64, work: &mut Work) {
    let mut f = |y: &Phase| rate(body, acceleration, y, work);
    let y = phase(at);
    let k1 = f(&y);
    let k2 = f(&(y + k1 * (step_s / 2.0)));
    let k3 = f(&(y + k2 * (step_s / 2.0)));
    let k4 = f(&(y + k3 * step_s));
    *at = state(&(y + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (step_s / 6.0)));
}

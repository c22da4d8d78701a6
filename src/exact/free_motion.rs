//! A body that meets nothing: the way of its centre of mass by `point_motion.rs`, its rotation by `free_rotation.rs`.

use super::facts::{Lacks, point};
use super::form::{ClosedForm, ExactMotion};
use super::free_rotation::FreeRotation;
use super::point_motion::PointMotion;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{Matrix3, Vector3};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Parabola and torque-free rotation of any body, by Jacobi elliptic functions.",
    source: "van Zon & Schofield, JCP 225 (2007) 145",
    scenes: "Gravity, and constant or cosine forces of the world at the centre of mass; no air, no pins, no contact.",
    motion,
};

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let (way, rotation) = (point(model, index, at)?, turning(&model.bodies[index], at));
    Ok(ExactMotion::of(move |t_s| way.at(t_s), move |t_s| rotation.at(t_s)))
}

/// Rotation without torque.
pub(super) fn turning(body: &Body, at: &BodyState) -> FreeRotation {
    FreeRotation::new(&body.I_B, &at.q_WB, &at.w_WB)
}

/// Even motion of a driven body.
pub(super) fn even(at: &BodyState) -> ExactMotion {
    let still = Vector3::zeros();
    let way = PointMotion { position_m: at.p_WB, velocity_m_s: at.v_WB, constant_m_s2: still, harmonics: Vec::new() };
    let rotation = FreeRotation::new(&Matrix3::identity(), &at.q_WB, &at.w_WB);
    ExactMotion::of(move |t_s| way.at(t_s), move |t_s| rotation.at(t_s))
}

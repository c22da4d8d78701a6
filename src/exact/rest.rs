//! Bodies that stay where they are.

use super::facts::Lacks;
use super::form::{ClosedForm, ExactMotion};
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector3;

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "All bodies stay where they are.",
    source: "Newton's first law",
    scenes: "Every body at rest at the start; for piles and slopes that hold.",
    motion,
};

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let (body, at) = (&model.bodies[index], start.bodies[index]);
    let still = at.v_WB == Vector3::zeros() && at.w_WB == Vector3::zeros();
    if still { Ok(ExactMotion::new(move |_| at)) } else { Err(format!("`{}` at rest at the start", body.name)) }
}

//! Closed forms as others see them: what lists say of one, and the motion that it gives.

use super::facts::Lacks;
use crate::model::Model;
use crate::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};

/// The facts of a closed form; texts are Markdown, in whole sentences.
#[derive(Clone, Copy)]
pub struct ClosedForm {
    /// The motion.
    pub what: &'static str,
    pub source: &'static str,
    /// The scenes that it is the motion of.
    pub scenes: &'static str,
    /// The motion of one of the model's bodies from its start, or what the scene should have.
    pub(super) motion: fn(&Model, &State, usize) -> Result<ExactMotion, Lacks>,
}

/// The exact motion of one body.
pub struct ExactMotion {
    at: Box<dyn Fn(f64) -> BodyState + Send>,
    /// Time up to which it is the motion, in seconds.
    pub holds_until_s: f64,
}

impl ExactMotion {
    /// A motion that holds for ever.
    pub(super) fn new(at: impl Fn(f64) -> BodyState + Send + 'static) -> Self {
        ExactMotion { at: Box::new(at), holds_until_s: f64::INFINITY }
    }

    /// A motion from two functions of time: position and velocity of the centre of mass, and apart from them the
    /// attitude and its rate.
    pub(super) fn of(
        way: impl Fn(f64) -> (Vector3<f64>, Vector3<f64>) + Send + 'static,
        turning: impl Fn(f64) -> (UnitQuaternion<f64>, Vector3<f64>) + Send + 'static,
    ) -> Self {
        ExactMotion::new(move |t_s| {
            let ((p_WB, v_WB), (q_WB, w_WB)) = (way(t_s), turning(t_s));
            BodyState { p_WB, q_WB, v_WB, w_WB }
        })
    }

    pub(super) fn until(self, holds_until_s: f64) -> Self {
        ExactMotion { holds_until_s, ..self }
    }

    pub fn at(&self, t_s: f64) -> BodyState {
        (self.at)(t_s)
    }
}

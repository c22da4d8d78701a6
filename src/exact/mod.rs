//! Closed forms and references: `state_at(t)`, one case a file, cited.

mod dd;
pub mod free_motion;
pub mod free_rotation;
pub mod heavy_top;
pub mod jacobi;
pub mod linear_drag;
pub mod pendulum;
pub mod point_motion;
mod principal;
pub mod quadratic_drag;
pub mod symmetric_body;
mod top_phase;
mod top_roots;

use crate::experiment::types::Exact;
use crate::model::Model;
use crate::state::State;
use free_motion::FreeMotion;

/// The exact motion from a given start.
pub enum Reference {
    FreeMotion(FreeMotion),
}

impl Reference {
    pub fn new(which: Exact, model: &Model, start: &State) -> Self {
        match which {
            Exact::FreeMotion => Reference::FreeMotion(FreeMotion::new(model, start)),
        }
    }

    /// The exact state at a time after the start.
    pub fn state_at(&self, t_s: f64) -> State {
        match self {
            Reference::FreeMotion(motion) => motion.state_at(t_s),
        }
    }
}

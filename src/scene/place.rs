//! Start in the first step of a contact: `place: at-contact`.
//!
//! A body that has flown from afar is found inside the floor by anything from nothing to what its lowest point moves in
//! one step, all depths equally likely, as its fall knows nothing of the steps. Drawing that depth spares the flight.

use crate::collide::faces;
use crate::experiment::types::{Experiment, Place};
use crate::model::Body;
use crate::model::container::{Container, Face};
use crate::state::BodyState;
use nalgebra::Vector3;

/// Most draws before giving up. Half of all velocities approach: a thousand that do not are no accident.
pub const MOST_DRAWS: u32 = 1000;

/// Floor that bodies land on, and the length of a step.
pub struct Landing<'a> {
    floor: &'a Face,
    step_s: f64,
}

impl<'a> Landing<'a> {
    /// Landing, if the experiment asks for it. The floor is the face most against gravity; without gravity, y is up.
    pub fn new(experiment: &Experiment, container: Option<&'a Container>) -> Option<Self> {
        experiment.scene.random.as_ref()?.place.filter(|place| *place == Place::AtContact)?;
        let up = (-Vector3::from(experiment.scene.gravity_m_s2)).try_normalize(0.0).unwrap_or_else(Vector3::y);
        Some(Landing { floor: container?.floor(&up)?, step_s: experiment.clock().step_s })
    }

    /// The first drawn state whose lowest point approaches the floor, shifted there, and how deep that point is. `draw`
    /// gives a state and the part of a step that has passed since the contact.
    pub fn first(&self, body: &Body, mut draw: impl FnMut() -> (BodyState, f64)) -> Option<(BodyState, f64)> {
        (0..MOST_DRAWS).find_map(|_| {
            let (state, part) = draw();
            self.shifted(body, state, part)
        })
    }

    fn shifted(&self, body: &Body, mut at: BodyState, part: f64) -> Option<(BodyState, f64)> {
        let (r_BC_W, gap_m) = faces::nearest(body, &at, self.floor)?;
        let approach = -self.floor.normal.dot(&(at.v_WB + at.w_WB.cross(&r_BC_W)));
        let depth_m = part * approach * self.step_s;
        at.p_WB -= self.floor.normal * (gap_m + depth_m);
        (approach > 0.0).then_some((at, depth_m))
    }
}

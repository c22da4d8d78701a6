//! Refusal of bodies that overlap at the start.

use super::error::BuildError;
use crate::collide::{Contact, Detector, Reach};
use crate::experiment::copies::described_as;
use crate::model::Model;
use crate::state::State;
use crate::work::Work;

/// Refuses bodies that overlap at the start; `allowed_m` is how deep each body has been put into the floor on purpose.
pub(super) fn refuse_overlap(model: &Model, state: &State, allowed_m: &[f64]) -> Result<(), BuildError> {
    /// Depth, of the body's size, that is rounding: a body placed on the floor is not inside it.
    const ROUNDING: f64 = 1e-9;
    let mut contacts = Vec::new();
    Detector::default().detect(model, state, &Reach::INSIDE, &mut contacts, &mut Work::default());
    let allowed = |contact: &Contact| {
        let size_m = contact.ends().map(|(i, ..)| model.bodies[i].bounding_radius_m).fold(0.0, f64::max);
        let placed_m = if contact.other.is_none() { allowed_m[contact.body] } else { 0.0 };
        placed_m + ROUNDING * size_m
    };
    let inside = contacts.iter().filter(|contact| -contact.gap_m > allowed(contact));
    let Some(contact) = inside.reduce(|a, b| if b.gap_m < a.gap_m { b } else { a }) else { return Ok(()) };
    let (name, depth) = (&model.bodies[contact.body].name, -contact.gap_m);
    let (whom, what) = match contact.other {
        None => ("the container".into(), format!("{name} inside a face by {depth:.3e} m")),
        Some(other) => {
            let other = &model.bodies[other].name;
            (format!("`{other}`"), format!("{name} and {other} inside each other by {depth:.3e} m"))
        }
    };
    Err(BuildError {
        path: format!("scene.bodies.{}.position_m", described_as(name)),
        expected: format!("no overlap with {whom} at the start"),
        found: what,
    })
}

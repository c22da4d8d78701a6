//! The constants of a run: bodies, their mass properties and contact geometry, the container, gravity, applied forces,
//! pins.
//!
//! Frames (L7): W is the world (the lecture's Σ), B the body's axes with the centre of mass as origin (ᴳΣ in body
//! axes); Bo is the origin of the body frame as the experiment file places it (ᴼΣ).

mod body;
pub mod container;
pub mod loads;
// The noun of the room has the room's name.
#[allow(clippy::module_inception)]
mod model;
pub mod pins;
pub mod surface;

pub use body::{Body, Geometry, pose_of_solid};
pub use model::Model;

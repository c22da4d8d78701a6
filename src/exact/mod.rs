//! Closed forms and references: `state_at(t)`, one case a file, cited; `scene` says which scenes they are the motion
//! of.

pub mod arc;
mod attitude;
pub mod ball;
mod closed;
mod contact_scene;
pub mod dome;
mod dome_scene;
mod facts;
pub mod falling_rod;
mod following;
pub mod free_rotation;
pub mod heavy_top;
pub mod inverted_pendulum;
pub mod ladder;
pub mod linear_drag;
pub mod pendulum;
pub mod point_motion;
mod principal;
pub mod quadratic_drag;
pub mod rimless_wheel;
pub mod rocking_block;
mod scene;
pub mod sliding;
pub mod stick_slip;
pub mod symmetric_body;
mod top_phase;
mod top_roots;
mod toppling_scene;
mod touching;
pub mod turntable;
mod wheel_scene;

pub use closed::{Closed, named};
pub use facts::Lacks;

//! Closed forms, one a file, cited: the formula, the scenes that it is the motion of, and what lists say of it.

pub mod arc;
mod attitude;
pub mod ball;
mod closed;
pub mod dome;
mod facts;
pub mod falling_rod;
mod following;
mod form;
mod free_motion;
pub mod free_rotation;
pub mod heavy_top;
pub mod inverted_pendulum;
pub mod ladder;
pub mod linear_drag;
pub mod pendulum;
pub mod point_motion;
mod principal;
pub mod quadratic_drag;
mod rest;
pub mod rimless_wheel;
pub mod rocking_block;
pub mod sliding;
pub mod stick_slip;
pub mod symmetric_body;
mod top_phase;
mod top_roots;
mod touching;
pub mod turntable;

pub use closed::{Closed, form, named};
pub use facts::Lacks;
pub use form::ClosedForm;

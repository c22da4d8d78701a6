//! Closed forms against references of more digits.

mod free_rotation;
mod heavy_top;
mod pendulum;
mod point;
mod scenes;
mod symmetric_body;

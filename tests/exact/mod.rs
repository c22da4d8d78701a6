//! Closed forms against references of more digits.

mod ball;
mod contact;
mod falling_rod;
mod free_rotation;
mod heavy_top;
mod pendulum;
mod point;
mod rocking_block;
mod scenes;
mod sliding;
mod symmetric_body;
mod turntable;

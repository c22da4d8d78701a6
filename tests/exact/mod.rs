//! Closed forms against references of more digits.

mod ball;
mod contact;
mod dome;
mod falling_rod;
mod free_rotation;
mod heavy_top;
mod ladder;
mod pendulum;
mod point;
mod rimless_wheel;
mod rocking_block;
mod scenes;
mod sliding;
mod stick_slip;
mod symmetric_body;
mod turntable;

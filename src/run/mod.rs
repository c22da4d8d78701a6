//! The main loop, the bare loop below it, and states between steps.

pub mod advance;
mod main_loop;
pub mod ticks;

pub use main_loop::{Ended, run};

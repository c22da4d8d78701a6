//! What is recorded is in the file: both formats are read back with their own libraries.

mod ahead;
mod flight;
mod instants;
mod mcap;
mod modes;
#[cfg(feature = "rerun")]
mod rerun;
mod schema;
#[cfg(feature = "rerun")]
mod size;
mod stopped;
mod story;
mod synthetic;
mod torn;
#[cfg(feature = "rerun")]
mod viewer;
mod writer;

//! What is recorded is in the file: both formats are read back with their own libraries.

mod mcap;
mod modes;
#[cfg(feature = "rerun")]
mod rerun;
mod schema;
mod synthetic;
mod writer;

//! What is recorded is in the file: both formats are read back with their own libraries.

mod mcap;
#[cfg(feature = "rerun")]
mod rerun;
mod schema;
mod synthetic;
mod writer;

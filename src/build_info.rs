//! The program that made a row or a recording.

pub const PROGRAM: &str = concat!("gotai ", env!("CARGO_PKG_VERSION"));

/// Hash of the sources, the dependencies and the compiler.
pub const BUILD: &str = env!("GOTAI_BUILD");

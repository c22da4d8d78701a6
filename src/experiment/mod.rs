//! The YAML vocabulary: types, defaults with reasons, overrides, errors with file:line and key path.

pub mod types;

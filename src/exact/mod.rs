//! Closed forms and references: state_at(t), one case a file, cited.

mod dd;
pub mod free_rotation;
pub mod jacobi;
mod principal;

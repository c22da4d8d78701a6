//! A case from its start to what was measured: which method runs, against what, and how far to trust it.

pub mod choose;
mod measure;
pub mod reference;
pub mod sensitivity;
pub mod trial;

pub use measure::{Place, Recording, Studied, measure};

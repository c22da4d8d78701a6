//! A scene is built: from one resolved experiment to its constant `Model` and first `State`.
//!
//! Both come from one builder: pins are anchored where the start puts them, and the zero of the potential energy may be
//! the lowest start.

mod body;
mod build;
mod error;
mod first;
mod overlap;
mod pins;
mod place;
pub mod random;

pub use build::{build, is_sound_whatever_the_seed};
pub use error::BuildError;

//! The judges: energy, momentum, the law of contact, geometry, divergence, computed from states and contacts alone.
//!
//! Nothing here imports a method or takes a solver's word: what an impulse did to a body is worked out again from the
//! impulse, the arm and the mass properties.

mod again;
pub mod contact_matrix;
pub mod critical_step;
mod difference;
mod dissipation;
pub mod divergence;
pub mod energy;
pub mod error;
mod exchange;
pub mod geometry;
mod judge;
mod kept;
pub mod momentum;
pub mod more;
mod moving;
mod pinned;
mod push;
pub mod reference;
pub mod residual;
mod springs;
mod squeezed;
mod work;

pub use judge::Judge;

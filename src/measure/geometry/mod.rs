//! The judge of geometry: how deep bodies overlap, whether they passed through each other on the way, and whether an
//! impulse was there for a contact that was not.
//!
//! It stands outside of contact detection. It knows solids by their definition, and shares types with the contact test
//! but none of its code: a fault there cannot hide here.

mod boxes;
mod expand;
mod figure;
mod ghost;
mod ledger;
mod leg;
mod near;
mod nearest;
mod overlap;
mod parting;
mod passage;
mod posed;
mod segments;
mod track;

pub use ledger::GeometryLedger;
pub use overlap::overlap;
pub use parting::Parting;

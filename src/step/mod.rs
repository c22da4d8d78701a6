//! The exchangeable unit: one step of the whole system, a page each.
//!
//! A `match` on the method picks it, once a run. A free product of integrators and contact solvers would permit
//! nonsense and forbid substeps and events.

mod blow;
mod closing;
mod drift;
mod event_driven;
mod event_passage;
mod foreseen;
mod free;
mod held;
mod lecture;
mod moments;
mod penalty;
mod push_out;
mod rebounds;
mod regroup;
mod scratch;
mod stepper;
mod still;
mod stretch;
mod time_stepping;
mod turning;

pub use stepper::Stepper;

//! Run time against error: every method of `bench:` at each of its steps or tolerances.
//!
//! `plan` resolves all trials before the first run, `run` makes a row of one: the error from a judged run, the time
//! from a loop that only steps (`timing.rs`), both of which must end in the same bits. `table.rs` is what the rows say
//! together. `peer.rs` times one scene for a comparison with other engines.

mod contender;
pub mod peer;
pub mod timing;

pub use contender::{Contender, NotDeterministic, Ran, plan, run};

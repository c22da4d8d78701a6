//! Rows against `expect:`. Knows columns and expectations, never the simulator: whatever wrote the rows is judged
//! alike.
//!
//! `known` refuses what cannot be judged before anything runs, `judge` gives the verdicts, `trend` holds the two tests.

mod judge;
mod known;
mod schema;

pub use judge::{Judged, judge};
pub use known::{numbers as refuse_no_numbers, refuse_unknown};
pub use schema::{Cells, Schema, cells_of};

//! Rows against `expect:`. Knows columns and expectations, never the simulator: whatever wrote the rows is judged
//! alike.
//!
//! `known` refuses what cannot be judged before anything runs, `judge` gives the verdicts, `failing` names the cases
//! that are out of bounds, `signed` finds bounds that pass what they seem to guard against.

mod failing;
mod judge;
mod known;
mod schema;
mod signed;

pub use failing::{Failing, MOST, broken, in_turn};
pub use judge::{Judged, judge, short};
pub use known::{numbers as refuse_no_numbers, refuse_unknown};
pub use schema::{Cells, Schema, cells_of};
pub use signed::{OneSided, one_sided};

//! Rows against `expect:`. Knows columns and expectations, never the simulator: whatever wrote the rows is judged
//! alike.
//!
//! `known` refuses what cannot be judged before anything runs, `judge` gives the verdicts, `failing` names the cases
//! that are out of bounds, `signed` finds bounds that pass what they seem to guard against; `compare` sets two folders
//! of results against each other.

mod compare;
mod failing;
mod join;
mod judge;
mod known;
mod numbers;
mod rounding;
mod schema;
mod signed;

pub use compare::{Change, CompareBy, Compared, FactorBound, Incomparable, Regression, TOLERATED, compare};
pub use failing::{Failing, MOST, broken};
pub use join::Side;
pub use judge::{Judged, in_turn, judge};
pub use known::{numbers as refuse_no_numbers, refuse_unknown};
pub use numbers::short;
pub use rounding::Magnitudes;
pub use schema::{Cells, Schema, cells_of};
pub use signed::{OneSided, one_sided};

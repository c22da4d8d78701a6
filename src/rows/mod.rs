//! Rows: what a run measured, the tables of them, the plan that they belong to. Knows numbers and names alone.

mod body_row;
pub mod columns;
pub mod doubts;
mod measured;
pub mod plan_file;
mod row;
pub mod table;
pub mod trials;

pub use body_row::BodyRow;
pub use measured::{Measured, finite};
pub use row::{Row, cells, count};

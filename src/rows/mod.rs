//! Rows: what a run measured, the tables of them, the plan that they belong to. Knows numbers and names alone.

pub mod columns;
mod measured;
pub mod plan_file;
mod row;
pub mod table;
pub mod trials;

pub use measured::{Measured, finite};
pub use row::{Row, cells, count};

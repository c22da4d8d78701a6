//! Axes → ordered cases → rows: expanded and checked before the first run, run on all cores, kept as they end.
//!
//! `plan` resolves the axes into cases, `store` keeps plan, journal and tables in a folder, `recordings` picks the
//! cases that are recorded, `runner` does it, `search` bisects.

pub mod build;
pub mod cell;
pub mod plan;
pub mod planned;
pub mod recordings;
pub mod runner;
pub mod search;
pub mod store;

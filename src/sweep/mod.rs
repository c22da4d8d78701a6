//! Axes → ordered cases → rows: expanded and checked before the first run, run on all cores, kept as they end.
//!
//! `plan` resolves the axes into cases, `store` keeps plan, journal and tables in a folder, `recordings` picks the
//! cases that are recorded, `runner` does it, `search` bisects, `folder` reads what is there.

pub mod build;
pub mod cell;
pub mod folder;
pub mod journal;
pub mod kept;
pub mod leftovers;
mod names;
pub mod plan;
pub mod planned;
pub mod recorded;
pub mod recordings;
pub mod runner;
pub mod search;
pub mod store;
pub mod unneeded;

//! The YAML vocabulary: types, defaults with reasons, overrides, errors with file:line and key path.
//!
//! `ExperimentFile::load` reads a file with its `--set`s; `experiment` and `case` give resolved `Experiment`s.

mod about;
mod accuracy;
pub mod axes;
pub mod bench;
mod checks;
pub mod copies;
mod defaults;
mod described;
mod either;
mod emit;
pub mod error;
pub mod expect;
mod extends;
mod facts;
pub mod file;
pub mod filter;
mod given;
mod integrator;
pub mod key_path;
mod later;
mod limits;
mod loads;
mod merge;
mod method;
pub mod nearest;
pub mod overrides;
pub mod positions;
pub mod predicate;
mod reading;
mod scene;
pub mod schema;
pub mod search;
mod skips;
mod solver;
mod source;
mod sweep;
pub mod tolerances;
mod tree;
pub mod types;
mod validate;
mod validate_body;
mod validate_loads;
pub mod value_de;
mod variants;
pub mod vocabulary;

pub use emit::to_yaml;
pub use error::ExperimentError;
pub use file::ExperimentFile;
pub use given::Given;
pub use tree::{Number, Value};

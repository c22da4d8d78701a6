//! Recorders, which write to files what a run shows.
//!
//! The simulating thread fills `sample::Batch`es and hands them to `writer::Writer`, whose thread feeds every
//! `Recorder`. `schema` names topics, fields and units once for all of them.

mod ahead_file;
mod aside;
mod effort;
pub mod flight;
pub mod foxglove_layout;
#[cfg(feature = "rerun")]
mod gather;
pub mod head;
mod limited;
pub mod mcap;
pub mod mend;
pub mod name;
pub mod pictures;
pub mod read;
mod recorder;
#[cfg(feature = "rerun")]
pub mod rerun;
mod ring;
pub mod sample;
pub mod sampler;
mod scene;
pub mod schema;
pub mod series;
pub mod story;
mod watch;
pub mod writer;

pub use recorder::{RecordError, Recorder};

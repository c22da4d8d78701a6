//! The command line: one file per command. No default of the physics lives here.

mod args;
mod bench;
mod check;
mod checked;
mod clean;
mod command;
mod cut;
mod error;
mod explain;
mod export;
mod ghosts;
mod junit;
pub mod later;
mod list;
mod output;
mod progress;
mod remarks;
mod repair;
mod replay;
mod report;
mod reporting;
mod rows;
mod run;
mod shown;
mod status;
mod sweep;
mod sweeping;
mod table;
mod view;
mod viewer;

pub use command::Cli;
pub use error::CliError;

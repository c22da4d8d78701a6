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
mod frames;
mod ghosts;
mod interrupted;
mod junit;
pub mod later;
mod list;
mod live;
mod output;
mod progress;
mod remarks;
mod repair;
mod replay;
mod rows;
mod run;
mod shown;
mod status;
mod steered;
mod sweep;
mod sweeping;
mod table;
mod view;
mod viewer;

pub use command::Cli;
pub use error::CliError;

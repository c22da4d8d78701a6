//! Diagrams from rows. Knows the columns of result files and how to draw, never the simulator.

pub mod bench;
pub mod diagram;

//! An `Experiment` (YAML) expands into `Case`s; each Case builds a constant `Model` and a first `State`; `run` advances
//! the State with a `Stepper`, shows every step to the judges and the recorders, ends in an `Outcome` and writes one
//! `Row`; `report` and `check` read only files.

pub mod experiment;
pub mod record;
pub mod sweep;

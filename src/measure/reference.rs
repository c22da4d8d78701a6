//! A reference run as data: its states at equally spaced times, each with how far a second run at another tolerance is
//! from it, and the errors of a run against them.
//!
//! The two runs of a motion that lets errors grow part at some time: from then on neither is a reference. Errors are
//! those of the last of these times that a run has met before.

use super::error::Errors;
use crate::rows::{BodyRow, Measured, finite};
use crate::state::State;
use serde::{Deserialize, Serialize};

/// Of the end: of two, so that the steps of most clocks meet some.
pub const PARTS: u64 = 64;

/// What `reference-<id>.json` holds. Numbers read back are those written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reference {
    pub id: String,
    /// Hash of the program that made it.
    pub build: String,
    pub tolerance: f64,
    /// Of the second run.
    pub second_tolerance: f64,
    /// The runs have parted where a body of one is farther from the other's.
    pub parting_m: f64,
    /// The first of the times there; null: they never part.
    pub parted_s: Option<f64>,
    /// Why one of the runs ended before its time.
    pub criterion: Option<String>,
    /// At the start and after every 64th part of the time.
    pub samples: Vec<Sample>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sample {
    pub time_s: f64,
    /// The largest distance of a body between the two runs.
    pub uncertainty_m: f64,
    pub bodies: Vec<BodyRow>,
}

impl Sample {
    pub fn new(state: &State, uncertainty_m: f64) -> Self {
        Sample { time_s: state.time_s, uncertainty_m, bodies: state.bodies.iter().map(BodyRow::from).collect() }
    }

    fn state(&self) -> State {
        State { step: 0, time_s: self.time_s, bodies: self.bodies.iter().map(BodyRow::state).collect() }
    }
}

impl Reference {
    /// Samples before the runs part.
    fn good(&self) -> &[Sample] {
        let parted = |sample: &Sample| self.parted_s.is_some_and(|parted_s| sample.time_s >= parted_s);
        &self.samples[..self.samples.iter().take_while(|sample| !parted(sample)).count()]
    }

    /// The last time at which the two runs agree.
    pub fn until_s(&self) -> f64 {
        self.good().last().map_or(0.0, |sample| sample.time_s)
    }
}

/// A run against its reference.
pub struct Against<'a> {
    good: &'a [Sample],
    pub until_s: f64,
    pub last: Option<Met>,
}

/// A time of the reference that a run has met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    pub time_s: f64,
    pub uncertainty_m: f64,
    pub errors: Errors,
}

impl<'a> Against<'a> {
    pub fn new(reference: &'a Reference) -> Self {
        Against { good: reference.good(), until_s: reference.until_s(), last: None }
    }

    /// After the `part`-th of the equal parts of the time.
    pub fn observe(&mut self, part: u64, state: &State) {
        if let Some(sample) = self.good.get(part as usize) {
            let errors = Errors::between(state, &sample.state());
            self.last = Some(Met { time_s: sample.time_s, uncertainty_m: sample.uncertainty_m, errors });
        }
    }

    /// Writes the errors at the last time that the run has met, and how far the reference is good.
    pub fn write(&self, measured: &mut Measured) {
        measured.reference_until_s = finite(self.until_s);
        if let Some(met) = self.last {
            met.errors.write(met.time_s, measured);
            measured.reference_uncertainty_m = finite(met.uncertainty_m);
        }
    }
}

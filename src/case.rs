//! One point of a sweep: a resolved experiment and its id.

use crate::digest::sha256;
use crate::experiment::types::{Experiment, Planning, Record};
use crate::shared::Shared;
use serde_json::{Map, Value};

#[derive(Clone, Debug)]
pub struct Case {
    /// Hash of the resolved configuration, which alone it depends on.
    pub id: String,
    /// Value on every axis, as the result columns show it.
    pub axes: Shared<Map<String, Value>>,
    /// The resolved experiment; of a search, that of its first run.
    pub experiment: Experiment,
}

impl Case {
    pub fn new(experiment: Experiment, axes: Map<String, Value>) -> Self {
        Case { id: id(&[canonical(&experiment)]), axes: axes.into(), experiment }
    }

    /// A case of many runs that make one row: `ends` are the experiments at both ends of a bracket, of everything that
    /// is tried together; `rule` says how they are searched.
    ///
    /// # Panics
    /// Without an experiment.
    pub fn of_search(rule: String, ends: Vec<Experiment>, axes: Map<String, Value>) -> Self {
        let mut parts: Vec<_> = ends.iter().map(canonical).collect();
        parts.push(rule.into_bytes());
        let experiment = ends.into_iter().next();
        let experiment = experiment.expect("a search has an end");
        Case { id: id(&parts), axes: axes.into(), experiment }
    }
}

/// JSON of everything that decides the motion: not the question, nor what is recorded of it,
/// nor what is skipped.
pub fn canonical(experiment: &Experiment) -> Vec<u8> {
    let plan = Planning::default();
    let decisive = Experiment { question: None, record: Record::default(), plan, ..experiment.clone() };
    serde_json::to_vec(&decisive).unwrap_or_default()
}

/// Id of these parts: 64 bits of their hash.
pub fn id(parts: &[Vec<u8>]) -> String {
    sha256(parts.concat(), 8)
}

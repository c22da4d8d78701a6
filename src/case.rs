//! One point of a sweep: a resolved experiment and its id.

use crate::experiment::types::{Experiment, Record};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};

#[derive(Clone, Debug)]
pub struct Case {
    /// Depends on the resolved configuration alone.
    pub id: String,
    /// Value on every axis, as the result columns show it.
    pub axes: Map<String, Value>,
    pub experiment: Experiment,
}

impl Case {
    pub fn new(experiment: Experiment, axes: Map<String, Value>) -> Self {
        Case { id: id(&experiment), axes, experiment }
    }
}

/// 64 bits of a hash over everything that decides the motion: not the question, nor what is recorded of it.
fn id(experiment: &Experiment) -> String {
    let decisive = Experiment { question: None, record: Record::default(), sweep: None, ..experiment.clone() };
    let canonical = serde_json::to_vec(&decisive).unwrap_or_default();
    hex(&Sha256::digest(canonical)[..8])
}

/// Lower-case hexadecimal.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|b| format!("{b:02x}")).collect()
}

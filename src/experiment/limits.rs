//! The vocabulary of `limits:` and `reference:`: how much a run may cost, and what it is measured against. A part of
//! `types.rs`.

use super::tolerances::SMALLEST_GLOBAL;
use serde::{Deserialize, Serialize};

/// Limits of a run, each without a limit where it is absent. A run that needs more ends as `stalled`, by the criterion
/// `limit`; what it has computed stays.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Limits {
    /// Wall time of stepping, in seconds. What such a run says depends on the machine; steps and events do not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wall_s: Option<f64>,
    /// Number of steps, or of the stretches of a method that follows events.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
    /// Number of impacts and changes of contact, of a method that follows events.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub events: Option<u64>,
}

/// A run of `event-driven` that errors are measured against, where there is no closed form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ReferenceRun {
    pub tolerance: f64,
}

impl Default for ReferenceRun {
    /// A tolerance of ten times the smallest, so that a second run can be finer.
    fn default() -> Self {
        ReferenceRun { tolerance: 10.0 * SMALLEST_GLOBAL }
    }
}

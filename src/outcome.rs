//! How a run ended, and why.

use serde::{Deserialize, Serialize};

/// How a run ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// Reached its end time.
    #[default]
    Finished,
    /// Met a divergence criterion: a result.
    Diverged,
    /// Could not go on: a result.
    Stalled,
    /// The program failed: a panic.
    Failed,
}

impl Outcome {
    pub const ALL: [Outcome; 4] = [Outcome::Finished, Outcome::Diverged, Outcome::Stalled, Outcome::Failed];

    /// As files write it.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::Finished => "finished",
            Outcome::Diverged => "diverged",
            Outcome::Stalled => "stalled",
            Outcome::Failed => "failed",
        }
    }
}

/// Why a run stopped; the column `criterion`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    NotFinite,
    Energy,
    Escape,
    Speed,
    Penetration,
    /// A step could not be made to its tolerance: the run has stalled.
    NotConverged,
    /// Sliding has no finite force that goes on, and no impulse ends it.
    Painleve,
    /// One of `limits:` is used up.
    Limit,
}

impl Criterion {
    pub const ALL: [Criterion; 8] = [
        Criterion::NotFinite,
        Criterion::Energy,
        Criterion::Escape,
        Criterion::Speed,
        Criterion::Penetration,
        Criterion::NotConverged,
        Criterion::Painleve,
        Criterion::Limit,
    ];

    pub fn name(self) -> &'static str {
        match self {
            Criterion::NotFinite => "not-finite",
            Criterion::Energy => "energy",
            Criterion::Escape => "escape",
            Criterion::Speed => "speed",
            Criterion::Penetration => "penetration",
            Criterion::NotConverged => "not-converged",
            Criterion::Painleve => "painleve",
            Criterion::Limit => "limit",
        }
    }
}

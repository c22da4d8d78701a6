//! Outcome of a run, and the criterion that stopped it.

use serde::{Deserialize, Serialize};

/// Outcome of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// End time reached.
    #[default]
    Finished,
    /// Divergence criterion met: a result.
    Diverged,
    /// No way to go on: a result.
    Stalled,
    /// Failure of the program: a panic.
    Failed,
}

impl Outcome {
    pub const ALL: [Outcome; 4] = [Outcome::Finished, Outcome::Diverged, Outcome::Stalled, Outcome::Failed];

    /// Word of the outcome in files.
    pub fn name(self) -> &'static str {
        match self {
            Outcome::Finished => "finished",
            Outcome::Diverged => "diverged",
            Outcome::Stalled => "stalled",
            Outcome::Failed => "failed",
        }
    }
}

/// Reason why a run stopped; the column `criterion`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    NotFinite,
    Energy,
    Escape,
    Speed,
    Penetration,
    /// Step that could not be made to its tolerance: the run has stalled.
    NotConverged,
    /// Slip that no finite force lets go on, and no impulse ends.
    Painleve,
    /// Limit of `limits:` that is used up.
    Limit,
    /// A signal: the run was to end at once.
    Interrupted,
}

impl Criterion {
    pub const ALL: [Criterion; 9] = [
        Criterion::NotFinite,
        Criterion::Energy,
        Criterion::Escape,
        Criterion::Speed,
        Criterion::Penetration,
        Criterion::NotConverged,
        Criterion::Painleve,
        Criterion::Limit,
        Criterion::Interrupted,
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
            Criterion::Interrupted => "interrupted",
        }
    }
}

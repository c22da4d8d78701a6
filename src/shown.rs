//! What a step shows to those who judge it.

use crate::collide::SolvedContact;
use crate::state::State;

/// What the last step was, for those who judge it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// Of the clock, with impulses at its start or in its middle.
    Step,
    /// An impact, which takes no time.
    Blow,
    /// Of equal length, between events that were too many.
    Short { step_s: f64 },
    /// A smooth motion with forces of contact, which `moments` shows.
    Motion,
}

/// A state on the way of a smooth motion, the impulses of its contacts in the time that it stands for, and that time.
#[derive(Clone, Debug)]
pub struct Moment {
    pub state: State,
    pub contacts: Vec<SolvedContact>,
    pub weight_s: f64,
}

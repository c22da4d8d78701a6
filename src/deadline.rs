//! When a run has to be over: whatever works long inside one step asks.

use std::time::{Duration, Instant};

/// A moment of the clock on the wall; none: there is no hurry, and asking costs nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deadline(Option<Instant>);

impl Deadline {
    /// So many seconds from now; what is farther than a clock goes is never.
    pub fn after_s(left_s: f64) -> Self {
        let left = Duration::try_from_secs_f64(left_s.max(0.0)).ok();
        Deadline(left.and_then(|left| Instant::now().checked_add(left)))
    }

    /// What is not done by now is to be left, and the step with it.
    pub fn is_over(&self) -> bool {
        self.0.is_some_and(|at| Instant::now() >= at)
    }
}

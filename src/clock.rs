//! The clock of a run: equal steps up to an end.

use crate::state::State;

/// Equal steps up to an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    pub steps: u64,
    pub end_s: f64,
    pub step_s: f64,
}

impl Clock {
    /// A clock of n = max(1, round(end/step)) equal steps of end/n.
    pub fn new(step_s: f64, end_s: f64) -> Self {
        let steps = ((end_s / step_s).round() as u64).max(1);
        Clock { steps, end_s, step_s: end_s / steps as f64 }
    }

    /// Moves a state to the next step. Its time follows from the count of steps, so that no rounding adds up.
    pub fn advance(&self, state: &mut State) {
        self.advance_by(state, 1);
    }

    /// The same by several steps at once.
    pub fn advance_by(&self, state: &mut State, steps: u64) {
        state.step += steps;
        let passed_s = self.end_s * state.step as f64 / self.steps as f64;
        state.time_s = if state.step == self.steps { self.end_s } else { passed_s };
    }
}

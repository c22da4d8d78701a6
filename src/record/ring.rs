//! The last steps of a run, kept until it is known whether they decide: what happens between two samples is not lost.

use crate::collide::SolvedContact;
use crate::state::State;
use std::collections::VecDeque;

/// Most steps that are kept.
const STEPS: usize = 200;
/// Most memory of them, in bytes, whatever the number of bodies and contacts.
const BYTES: usize = 4 << 20;

/// A step that has not been recorded.
pub struct KeptStep {
    pub state: State,
    /// The state at which its contacts act.
    pub acted: State,
    pub contacts: Vec<SolvedContact>,
    /// Length of the step that their impulses are of.
    pub step_s: f64,
}

impl KeptStep {
    fn bytes(&self) -> usize {
        2 * size_of_val(self.state.bodies.as_slice()) + size_of_val(self.contacts.as_slice())
    }
}

/// The last steps that were not recorded, the oldest first.
#[derive(Default)]
pub struct Ring {
    kept: VecDeque<KeptStep>,
    /// Memory to be filled again.
    spare: Vec<KeptStep>,
    bytes: usize,
}

impl Ring {
    /// Keeps a step, by its end and the state at which its contacts act, and lets the oldest go where there is no room.
    pub fn keep(&mut self, [state, acted]: [&State; 2], contacts: &[SolvedContact], step_s: f64) {
        let mut kept = match self.spare.pop() {
            Some(mut kept) => {
                kept.state.copy_from(state);
                kept.acted.copy_from(acted);
                kept.contacts.clear();
                kept
            }
            None => KeptStep { state: state.clone(), acted: acted.clone(), contacts: Vec::new(), step_s },
        };
        kept.contacts.extend_from_slice(contacts);
        kept.step_s = step_s;
        self.bytes += kept.bytes();
        self.kept.push_back(kept);
        while self.kept.len() > STEPS || (self.bytes > BYTES && self.kept.len() > 1) {
            self.let_go();
        }
    }

    /// Keeps this step alone.
    pub fn keep_one(&mut self, states: [&State; 2], contacts: &[SolvedContact], step_s: f64) {
        self.clear();
        self.keep(states, contacts, step_s);
    }

    pub fn clear(&mut self) {
        while !self.kept.is_empty() {
            self.let_go();
        }
    }

    /// Whether a step is among those that are kept.
    pub fn holds(&self, step: u64) -> bool {
        self.kept.iter().any(|kept| kept.state.step == step)
    }

    /// Hands over every step since `step`, the oldest first, and keeps the earlier ones.
    pub fn take_since(&mut self, step: u64, mut to: impl FnMut(&KeptStep)) {
        let from = self.kept.iter().position(|kept| kept.state.step >= step).unwrap_or(self.kept.len());
        for kept in self.kept.drain(from..) {
            self.bytes -= kept.bytes();
            to(&kept);
            self.spare.push(kept);
        }
    }

    fn let_go(&mut self) {
        if let Some(kept) = self.kept.pop_front() {
            self.bytes -= kept.bytes();
            self.spare.push(kept);
        }
    }
}

//! The last steps of a run, kept until it is known whether they decide: what happens between two samples is not lost.
//!
//! States and impulses are kept as they are; what a recording shows of them is worked out when they are asked for.

use crate::collide::SolvedContact;
use crate::state::{BodyState, State};

/// Most steps that are kept.
const STEPS: usize = 200;
/// Most memory of them, in bytes, whatever the number of bodies and contacts.
const BYTES: usize = 4 << 20;

/// A step that has not been recorded: its end, and what its contacts did.
#[derive(Clone, Debug, Default)]
pub struct KeptStep {
    pub step: u64,
    pub time_s: f64,
    /// Kinetic and potential energy.
    pub energy_j: [f64; 2],
    pub bodies: Vec<BodyState>,
    pub contacts: Vec<SolvedContact>,
    /// Length of the step that their impulses are of.
    pub step_s: f64,
    /// Instant at which they act, and the bodies then; none where nothing acts, or at the step's end.
    pub acted_s: f64,
    pub acted: Vec<BodyState>,
}

impl KeptStep {
    fn keep(&mut self, [state, acted]: [&State; 2], contacts: &[SolvedContact], step_s: f64, energy_j: [f64; 2]) {
        (self.step, self.time_s, self.acted_s) = (state.step, state.time_s, acted.time_s);
        (self.step_s, self.energy_j) = (step_s, energy_j);
        fill(&mut self.bodies, &state.bodies);
        fill(&mut self.contacts, contacts);
        let is_elsewhere = !contacts.is_empty() && acted.time_s != state.time_s;
        fill(&mut self.acted, if is_elsewhere { &acted.bodies } else { &[] });
    }

    /// Room of two states and the contacts.
    fn bytes(&self) -> usize {
        2 * size_of_val(self.bodies.as_slice()) + size_of_val(self.contacts.as_slice())
    }
}

fn fill<T: Copy>(to: &mut Vec<T>, from: &[T]) {
    to.clear();
    to.extend_from_slice(from);
}

/// The last steps that were not recorded, the oldest first. (In places that are filled again and again.)
#[derive(Default)]
pub struct Ring {
    places: Vec<KeptStep>,
    /// Place of the oldest, and their number.
    first: usize,
    len: usize,
    bytes: usize,
}

impl Ring {
    /// Keeps a step, by its end and the state at which its contacts act, and lets the oldest go where there is no room.
    pub fn keep(&mut self, states: [&State; 2], contacts: &[SolvedContact], step_s: f64, energy_j: [f64; 2]) {
        if self.len == STEPS {
            self.let_go();
        } else if self.len == self.places.len() {
            self.places.rotate_left(self.first);
            self.first = 0;
            self.places.push(KeptStep::default());
        }
        let place = self.place(self.len);
        let kept = &mut self.places[place];
        kept.keep(states, contacts, step_s, energy_j);
        self.bytes += kept.bytes();
        self.len += 1;
        while self.bytes > BYTES && self.len > 1 {
            self.let_go();
        }
    }

    /// Keeps this step alone.
    pub fn keep_one(&mut self, states: [&State; 2], contacts: &[SolvedContact], step_s: f64, energy_j: [f64; 2]) {
        self.clear();
        self.keep(states, contacts, step_s, energy_j);
    }

    pub fn clear(&mut self) {
        (self.len, self.bytes) = (0, 0);
    }

    /// Whether a step is among those that are kept.
    pub fn holds(&self, step: u64) -> bool {
        (0..self.len).any(|i| self.places[self.place(i)].step == step)
    }

    /// Hands over every step since `step`, the oldest first, and keeps the earlier ones.
    pub fn take_since(&mut self, step: u64, mut to: impl FnMut(&KeptStep)) {
        let from = (0..self.len).find(|i| self.places[self.place(*i)].step >= step).unwrap_or(self.len);
        for i in from..self.len {
            let kept = &self.places[self.place(i)];
            self.bytes -= kept.bytes();
            to(kept);
        }
        self.len = from;
    }

    fn let_go(&mut self) {
        self.bytes -= self.places[self.first].bytes();
        self.first = self.place(1);
        self.len -= 1;
    }

    /// Place of the step that is so many behind the oldest.
    fn place(&self, i: usize) -> usize {
        let place = self.first + i;
        if place < self.places.len() { place } else { place - self.places.len() }
    }
}

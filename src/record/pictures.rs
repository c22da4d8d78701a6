//! Pictured of a picture: contacts and the bodies that they act on stand in it at one time.
//!
//! A step's contacts act at its beginning, or within it, and the bodies move on afterwards: a sample, which is the end
//! of its step, shows neither where a contact was nor what it pushed.

use super::sample::Batch;
use crate::rows::BodyRow;

/// Pictured of a batch, in the order of its samples.
#[derive(Default)]
pub struct Pictured {
    /// Step and time of every picture of the bodies.
    pub step: Vec<u64>,
    pub time_s: Vec<f64>,
    /// All bodies of the first picture, then of the second, …
    pub bodies: Vec<BodyRow>,
    /// Step and time of each sample's contacts.
    pub contacts_step: Vec<u64>,
    pub contacts_s: Vec<f64>,
}

/// Pictures of a run, from batch to batch.
#[derive(Clone, Default)]
pub struct Pictures {
    last: (u64, f64),
    /// Bodies of the last sample, if no picture shows them yet: what comes next decides whether one does.
    hidden: Vec<BodyRow>,
}

impl Pictures {
    /// The pictures of a batch: the bodies where contacts act on them, and samples without contacts as they are.
    pub fn of(&mut self, batch: &Batch) -> Pictured {
        let mut all = Pictured::default();
        for sample in batch.samples() {
            let own = (sample.step, sample.time_s);
            let follows = sample.acted_s == self.last.1 && self.last.1 < sample.time_s;
            let at = if follows {
                self.show_hidden(&mut all);
                self.hidden.extend_from_slice(sample.bodies);
                self.last
            } else if sample.acted.is_empty() {
                self.hidden.clear();
                show(&mut all, own, sample.bodies);
                own
            } else {
                self.hidden.clear();
                show(&mut all, (sample.step, sample.acted_s), sample.acted);
                self.hidden.extend_from_slice(sample.bodies);
                (sample.step, sample.acted_s)
            };
            all.contacts_step.push(at.0);
            all.contacts_s.push(at.1);
            self.last = own;
        }
        all
    }

    /// The last picture: the end of the run, if it is not shown yet.
    pub fn end(&mut self) -> Pictured {
        let mut all = Pictured::default();
        self.show_hidden(&mut all);
        all
    }

    fn show_hidden(&mut self, all: &mut Pictured) {
        if !self.hidden.is_empty() {
            show(all, self.last, &self.hidden);
            self.hidden.clear();
        }
    }
}

fn show(all: &mut Pictured, (step, time_s): (u64, f64), bodies: &[BodyRow]) {
    all.step.push(step);
    all.time_s.push(time_s);
    all.bodies.extend_from_slice(bodies);
}

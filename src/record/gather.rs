//! Batches that are put together before they are written, for a format whose batches have a head for every body.

use super::sample::{Batch, Ending, Event};
use super::{RecordError, Recorder};

/// Bodies whose batches are written as they come: a head of a chunk is about 1 kB, and batches come twice a second.
const BODIES: usize = 64;

/// A recorder that is given several batches as one: the more bodies, the more of them.
pub struct Gatherer {
    file: Box<dyn Recorder>,
    pending: Batch,
    /// Batches that wait, and how many of them may.
    waiting: usize,
    most: usize,
    begun: bool,
}

impl Gatherer {
    /// In front of a file of so many entities of bodies.
    pub fn new(file: Box<dyn Recorder>, bodies: usize) -> Self {
        Gatherer { file, pending: Batch::default(), waiting: 0, most: bodies / BODIES, begun: false }
    }

    fn write_pending(&mut self) -> Result<(), RecordError> {
        self.waiting = 0;
        if self.pending.is_empty() {
            return Ok(());
        }
        let written = self.file.write(&self.pending);
        self.pending.clear();
        written
    }
}

impl Recorder for Gatherer {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError> {
        // The first one shows how the run begins, at once.
        if self.pending.is_empty() && (!self.begun || self.most == 0 || batch.is_full()) {
            self.begun = true;
            return self.file.write(batch);
        }
        self.pending.append(batch);
        self.waiting += 1;
        if self.waiting > self.most || self.pending.is_full() { self.write_pending() } else { Ok(()) }
    }

    fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.write_pending()?;
        self.file.event(event)
    }

    fn bytes(&self) -> u64 {
        self.file.bytes()
    }

    fn finish(mut self: Box<Self>, ending: &Ending) -> Result<(), RecordError> {
        self.write_pending()?;
        self.file.finish(ending)
    }
}

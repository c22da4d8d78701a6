//! Batches that are put together before they are written, for a format whose batches have a head for every body.

use super::sample::{Batch, Ending, Event};
use super::{RecordError, Recorder};

/// Samples and bytes that are written at once. Of fewer bytes, an .rrd of 1,000 bodies would be mostly heads of chunks
/// (measured, with a third: 85 MB for 600 samples of 1,024 bodies).
const SAMPLES: usize = 1_000;
const BYTES: usize = 6 << 20;

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
    /// Number of samples and of events since the last write that stand ahead in the file, and room for those that wait
    /// and do not.
    ahead: [usize; 2],
    behind: Batch,
}

impl Gatherer {
    /// In front of a file of so many entities of bodies.
    pub fn new(file: Box<dyn Recorder>, bodies: usize) -> Self {
        Gatherer {
            file,
            pending: Batch::default(),
            waiting: 0,
            most: bodies / BODIES,
            begun: false,
            ahead: [0; 2],
            behind: Batch::default(),
        }
    }

    fn write_pending(&mut self) -> Result<(), RecordError> {
        (self.waiting, self.ahead) = (0, [0; 2]);
        if self.pending.is_empty() {
            return Ok(());
        }
        let written = self.file.write(&self.pending);
        self.pending.clear();
        written
    }
}

fn is_much(batch: &Batch) -> bool {
    batch.len() >= SAMPLES || batch.bytes() >= BYTES
}

impl Recorder for Gatherer {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError> {
        // The first one, which shows how the run begins, stands ahead until the second comes: of a short run the rest.
        let is_first = !std::mem::replace(&mut self.begun, true);
        if self.pending.is_empty() && !is_first && (self.most == 0 || is_much(batch)) {
            self.ahead = [0; 2];
            return self.file.write(batch);
        }
        self.pending.append(batch);
        if is_first {
            return Ok(());
        }
        self.waiting += 1;
        if self.waiting > self.most || is_much(&self.pending) { self.write_pending() } else { Ok(()) }
    }

    fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.write_pending()?;
        self.file.event(event)
    }

    fn ahead(&mut self, batch: &Batch) -> Result<(), RecordError> {
        let waiting = [self.pending.len(), self.pending.events.len()];
        if self.ahead[0] < waiting[0] || self.ahead[1] < waiting[1] {
            self.behind.clear();
            self.behind.append_since(&self.pending, self.ahead);
            self.ahead = waiting;
            self.file.ahead(&self.behind)?;
        }
        self.ahead = [self.ahead[0] + batch.len(), self.ahead[1] + batch.events.len()];
        self.file.ahead(batch)
    }

    fn bytes(&self) -> u64 {
        self.file.bytes()
    }

    fn finish(mut self: Box<Self>, ending: &Ending) -> Result<(), RecordError> {
        self.write_pending()?;
        self.file.finish(ending)
    }
}

//! Limit of a file's size: samples that are there by their rate alone are thinned so that the whole run fits.

use super::sample::{Batch, Ending, Event, Header, Sample, Streams};
use super::{RecordError, Recorder};
use crate::rows::BodyRow;

/// Part of the limit that samples by rate share, in proportion to time; the rest is for what decides and for the end.
const BY_RATE: f64 = 0.7;
/// Part up to which what decides is written.
const DECISIVE: f64 = 0.93;
/// Part that the beginning has at once.
const AT_ONCE: f64 = 0.02;
/// Bytes of a number in a file before it is known better: most of what an f64 has.
const FIRST_GUESS: f64 = 6.0;

/// A recorder in front of a file that may grow to a number of bytes.
///
/// It asks how large the file is, and estimates what is to come by what has been written: the same run makes the same
/// file.
pub struct Limited {
    file: Box<dyn Recorder>,
    streams: Streams,
    most: f64,
    end_s: f64,
    /// Size of the file when its first batch had been written, and numbers written since, of them by rate.
    head: Option<u64>,
    numbers: f64,
    by_rate: f64,
    /// Whether each sample of a batch stays, and those that do.
    stays: Vec<bool>,
    kept: Batch,
    left_out: u64,
    /// Time and bodies of the last sample, if it is left out: the next one may rely on it to show where its contacts
    /// act.
    hidden: Option<(f64, Vec<BodyRow>)>,
}

impl Limited {
    /// In front of the file of such a run.
    pub fn new(file: Box<dyn Recorder>, header: &Header) -> Self {
        Limited {
            streams: header.streams,
            most: header.most_bytes as f64,
            end_s: header.end_s,
            // What is written already, of a format that writes its head at once.
            head: Some(file.bytes()).filter(|bytes| *bytes > 0),
            file,
            numbers: 0.0,
            by_rate: 0.0,
            stays: Vec::new(),
            kept: Batch::default(),
            left_out: 0,
            hidden: None,
        }
    }

    /// Bytes of a number in this file.
    fn bytes_a_number(&self) -> f64 {
        let written = self.file.bytes().saturating_sub(self.head.unwrap_or(0)) as f64;
        if self.numbers > 0.0 && written > 0.0 { written / self.numbers } else { FIRST_GUESS }
    }

    /// Writes the samples that stay.
    fn write_some(&mut self, batch: &Batch, stays: &[bool]) -> Result<(), RecordError> {
        self.kept.clear();
        for (sample, stay) in batch.samples().zip(stays) {
            if *stay {
                let hidden = self.hidden.take();
                let lacks = sample.acted.is_empty() && !sample.contacts.is_empty();
                let acted = match &hidden {
                    Some((time_s, bodies)) if lacks && *time_s == sample.acted_s => &bodies[..],
                    _ => sample.acted,
                };
                self.kept.push(&Sample { acted, ..sample }, self.streams);
            } else {
                self.left_out += 1;
                let (_, mut bodies) = self.hidden.take().unwrap_or_default();
                bodies.clear();
                bodies.extend_from_slice(sample.bodies);
                self.hidden = Some((sample.time_s, bodies));
            }
        }
        self.kept.events.extend_from_slice(&batch.events);
        self.file.write(&self.kept)
    }

    /// Whether there is room for a sample: with it there are so many bytes, of them so many by rate. What decides
    /// leaves room for what is still due by rate.
    fn fits(&self, sample: &Sample<'_>, bytes: f64, by_rate: f64) -> bool {
        let part = if self.end_s > 0.0 { (sample.time_s / self.end_s).clamp(0.0, 1.0) } else { 1.0 };
        match sample.by_rate {
            true => by_rate <= (AT_ONCE + BY_RATE * part) * self.most && bytes <= DECISIVE * self.most,
            false => bytes <= (DECISIVE - BY_RATE * (1.0 - part)) * self.most,
        }
    }
}

/// Numbers in a sample, about.
fn numbers(sample: &Sample<'_>) -> f64 {
    const OF_A_BODY: usize = 13;
    const OF_ACTED: usize = 7;
    const OF_A_CONTACT: usize = 14;
    /// Of a sample whatever is in it: energies, times, heads of messages, pictures.
    const OF_ALL: usize = 30;
    let count =
        OF_A_BODY * sample.bodies.len() + OF_ACTED * sample.acted.len() + OF_A_CONTACT * sample.contacts.len() + OF_ALL;
    count as f64
}

impl Recorder for Limited {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError> {
        let each = self.bytes_a_number();
        let written = self.file.bytes() as f64;
        let (mut more, mut more_by_rate) = (0.0, 0.0);
        let mut stays = std::mem::take(&mut self.stays);
        stays.clear();
        for sample in batch.samples() {
            let own = numbers(&sample);
            let own_by_rate = if sample.by_rate { own } else { 0.0 };
            let by_rate = each * (self.by_rate + more_by_rate + own_by_rate);
            let stay = self.head.is_none() || self.fits(&sample, written + each * (more + own), by_rate);
            if stay {
                more += own;
                more_by_rate += own_by_rate;
            }
            stays.push(stay);
        }
        let done = match self.hidden.is_none() && stays.iter().all(|stay| *stay) {
            true => self.file.write(batch),
            false => self.write_some(batch, &stays),
        };
        self.stays = stays;
        match self.head {
            None => self.head = Some(self.file.bytes()),
            Some(_) => {
                self.numbers += more;
                self.by_rate += more_by_rate;
            }
        }
        done
    }

    fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.file.event(event)
    }

    /// Where there is room still, without a choice: whether a sample stays is decided when it is written.
    fn ahead(&mut self, batch: &Batch) -> Result<(), RecordError> {
        if self.file.bytes() as f64 <= DECISIVE * self.most { self.file.ahead(batch) } else { Ok(()) }
    }

    fn bytes(&self) -> u64 {
        self.file.bytes()
    }

    fn finish(self: Box<Self>, ending: &Ending) -> Result<(), RecordError> {
        let Limited { file, left_out, .. } = *self;
        file.finish(&Ending { left_out, ..ending.clone() })
    }
}

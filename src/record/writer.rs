//! Writer on a recording thread of its own, so that the simulation pays for filling a batch and nothing else.
//!
//! Batches circulate: filled by the simulating thread, sent, written, sent back empty. When the disk is slower than the
//! simulation, the simulation waits; memory stays bounded. A write that fails does not stop the simulation: the first
//! error is remembered and `finish` returns it.

use super::ahead_file::AheadFile;
use super::aside::Aside;
use super::limited::Limited;
use super::name::RecordingName;
use super::sample::{Batch, Ending, Event, Header, Streams};
use super::{RecordError, Recorder, foxglove_layout, schema};
use crate::panics;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Batches in circulation: one being filled, one being written, two between, so that neither thread waits for the
/// other's pauses.
const BATCHES: usize = 4;

/// Most messages under way; more than `BATCHES` leaves room for events.
const QUEUE: usize = 16;

/// Time after which samples of a batch that is still being filled are written ahead of it: a kill loses those of this
/// time, and what the thread has not come to yet.
const AHEAD: Duration = Duration::from_millis(150);
/// The same of the first: what a file opens with. (A run that is shorter does not pay for it.)
const AHEAD_FIRST: Duration = Duration::from_millis(20);

enum Message {
    Aside(Box<Aside>),
    Batch(Batch),
    Event(Event),
    Finish(Ending),
}

/// Length and SHA-256 of a file that is complete, added up while it was written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileSum {
    pub target: Target,
    pub bytes: u64,
    pub sha256: String,
}

/// Sums of the files that are complete.
type Sums = Arc<Mutex<Vec<FileSum>>>;

/// What makes a recorder, on the recording thread.
type Begin = Box<dyn FnOnce() -> Result<Box<dyn Recorder>, RecordError> + Send>;

/// The batch being filled, and its number: so many were filled before it.
#[derive(Default)]
struct Filling {
    batch: Batch,
    number: u64,
}

fn locked(filling: &Mutex<Filling>) -> MutexGuard<'_, Filling> {
    filling.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writer that hands batches and events, in order, to recorders on a thread of its own.
///
/// Dropped without `finish`, it waits for what was sent and leaves the files incomplete.
pub struct Writer {
    filling: Arc<Mutex<Filling>>,
    made: usize,
    full: SyncSender<Message>,
    empty: Receiver<Batch>,
    sums: Sums,
    thread: Option<JoinHandle<Result<(), RecordError>>>,
}

impl Writer {
    /// A writer to these recorders, on a thread of its own.
    ///
    /// # Errors
    /// The machine has no thread to give.
    pub fn start(sinks: Vec<Box<dyn Recorder>>) -> Result<Writer, RecordError> {
        let begins = sinks.into_iter().map(|sink| Box::new(|| Ok(sink)) as Begin).collect();
        Self::begin(begins, Sums::default())
    }

    /// The same to recorders that begin on that thread: a head may take longer than a short run.
    fn begin(sinks: Vec<Begin>, sums: Sums) -> Result<Writer, RecordError> {
        let filling = Arc::default();
        let (full, inbox) = sync_channel(QUEUE);
        let (outbox, empty) = sync_channel(BATCHES);
        let thread = std::thread::Builder::new()
            .name("record".to_owned())
            .spawn({
                let filling = Arc::clone(&filling);
                move || record(sinks, &filling, &inbox, &outbox)
            })
            .map_err(|error| RecordError::new(Path::new("recordings"), format!("no recording thread: {error}")))?;
        Ok(Writer { filling, made: 1, full, empty, sums, thread: Some(thread) })
    }

    /// Lets the thread work out what samples that follow leave to it.
    pub fn work_aside(&mut self, aside: Aside) {
        let _ = self.full.send(Message::Aside(Box::new(aside)));
    }

    /// Fills the batch: what is given pushes one entry to each column of a stream that is on, for each sample. Sends
    /// the batch when it is full.
    pub fn fill(&mut self, push: impl FnOnce(&mut Batch)) {
        let mut filling = locked(&self.filling);
        push(&mut filling.batch);
        let is_full = filling.batch.is_full();
        drop(filling);
        if is_full {
            self.send_batch();
        }
    }

    /// Sends what there is, full or not, so that a kill does not lose it; says whether there was something.
    pub fn flush(&mut self) -> bool {
        self.send_batch()
    }

    /// Adds something that happened, after the samples so far.
    pub fn event(&mut self, event: Event) {
        self.send_batch();
        // The thread only ends early when a recorder panics; `finish` reports that.
        let _ = self.full.send(Message::Event(event));
    }

    /// Writes the rest and closes the files, and says how long each is and what its checksum is. The first error wins,
    /// also over the success of other files.
    ///
    /// # Errors
    /// The first failure of the machine in any write, or a panic of the recording thread.
    pub fn finish(mut self, ending: Ending) -> Result<Vec<FileSum>, RecordError> {
        self.send_batch();
        let _ = self.full.send(Message::Finish(ending));
        self.join()?;
        Ok(std::mem::take(&mut self.sums.lock().unwrap_or_else(PoisonError::into_inner)))
    }

    fn send_batch(&mut self) -> bool {
        if locked(&self.filling).batch.is_empty() {
            return false;
        }
        let next = self.next_batch();
        let mut filling = locked(&self.filling);
        filling.number += 1;
        let batch = std::mem::replace(&mut filling.batch, next);
        drop(filling);
        let _ = self.full.send(Message::Batch(batch));
        true
    }

    fn next_batch(&mut self) -> Batch {
        if let Ok(batch) = self.empty.try_recv() {
            return batch;
        }
        if self.made < BATCHES {
            self.made += 1;
            return Batch::default();
        }
        self.empty.recv().unwrap_or_default()
    }

    fn join(&mut self) -> Result<(), RecordError> {
        match self.thread.take().map(JoinHandle::join) {
            Some(Ok(result)) => result,
            Some(Err(panic)) => {
                let text = format!("the recording thread panicked: {}", panics::message(panic.as_ref()));
                Err(RecordError::new(Path::new("recordings"), text))
            }
            None => Ok(()),
        }
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        if self.thread.is_some() {
            // Closing the channel ends the thread; waiting for it keeps files from changing after the run.
            self.full = sync_channel(0).0;
            let _ = self.join();
        }
    }
}

/// The recording thread. A recorder that fails is dropped, the others go on.
fn record(
    begins: Vec<Begin>,
    filling: &Mutex<Filling>,
    inbox: &Receiver<Message>,
    outbox: &SyncSender<Batch>,
) -> Result<(), RecordError> {
    let mut first = Ok(());
    let mut sinks = Vec::new();
    for begin in begins {
        match begin() {
            Ok(sink) => sinks.push(sink),
            Err(error) => first = first.and(Err(error)),
        }
    }
    let mut aside: Option<Box<Aside>> = None;
    let mut ahead = Ahead::default();
    let mut due = Instant::now() + AHEAD_FIRST;
    loop {
        if due <= Instant::now() {
            ahead.look(filling, aside.as_deref_mut());
            each(&mut sinks, &mut first, |sink| sink.ahead(&ahead.batch));
            due = Instant::now() + AHEAD;
        }
        let message = match inbox.recv_timeout(due.saturating_duration_since(Instant::now())) {
            Ok(message) => message,
            Err(RecvTimeoutError::Timeout) => continue,
            Err(RecvTimeoutError::Disconnected) => return first,
        };
        match message {
            Message::Aside(worker) => aside = Some(worker),
            Message::Batch(mut batch) => {
                ahead.next();
                if let Some(aside) = &mut aside {
                    aside.complete(&mut batch);
                }
                each(&mut sinks, &mut first, |sink| sink.write(&batch));
                batch.clear();
                // There is room for every batch; a simulation that ended does not want it back.
                let _ = outbox.try_send(batch);
            }
            Message::Event(event) => {
                ahead.restart();
                each(&mut sinks, &mut first, |sink| sink.event(&event));
            }
            Message::Finish(ending) => {
                for sink in sinks {
                    let result = sink.finish(&ending);
                    first = first.and(result);
                }
                return first;
            }
        }
    }
}

/// What is written ahead of the batch being filled.
#[derive(Default)]
struct Ahead {
    /// Number of batches that were written.
    written: u64,
    /// Samples and events of the one being filled that were written ahead.
    shown: [usize; 2],
    batch: Batch,
}

impl Ahead {
    /// Takes what is new in the batch being filled, unless the one before it is still under way.
    fn look(&mut self, filling: &Mutex<Filling>, aside: Option<&mut Aside>) {
        self.batch.clear();
        let filling = locked(filling);
        if filling.number == self.written && (aside.is_some() || !filling.batch.is_raw) {
            self.batch.append_since(&filling.batch, self.shown);
            self.shown = [filling.batch.len(), filling.batch.events.len()];
        }
        drop(filling);
        if let Some(aside) = aside {
            aside.complete_ahead(&mut self.batch);
        }
    }

    /// The batch that was being filled is there as a whole.
    fn next(&mut self) {
        self.written += 1;
        self.restart();
    }

    /// What is written takes the place of what stood ahead.
    fn restart(&mut self) {
        self.shown = [0; 2];
    }
}

fn each(
    sinks: &mut Vec<Box<dyn Recorder>>,
    first: &mut Result<(), RecordError>,
    mut act: impl FnMut(&mut dyn Recorder) -> Result<(), RecordError>,
) {
    sinks.retain_mut(|sink| match act(sink.as_mut()) {
        Ok(()) => true,
        Err(error) => {
            if first.is_ok() {
                *first = Err(error);
            }
            false
        }
    });
}

/// Text between the id and the ending of a file that is being written.
pub const PARTIAL: &str = ".partial.";

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    Rerun,
    Mcap,
}

impl Target {
    pub const ALL: [Target; 2] = [Target::Rerun, Target::Mcap];

    /// Kinds that this build can write.
    pub const AVAILABLE: &[Target] =
        if cfg!(feature = "rerun") { &[Target::Rerun, Target::Mcap] } else { &[Target::Mcap] };

    /// Ending of the file's name.
    pub fn extension(self) -> &'static str {
        match self {
            Target::Rerun => "rrd",
            Target::Mcap => "mcap",
        }
    }

    /// Path of a recording of this name. (A name holds dots of its own.)
    pub fn path(self, dir: &Path, name: &str) -> PathBuf {
        dir.join(format!("{name}.{}", self.extension()))
    }
}

/// Starts the recordings of a case in a directory that must exist. Until `finish` a file is called
/// `<case>.partial.<ending>`, so that a file with the name that the header gives is complete. A viewer that listens at
/// a port of this machine shows the run too; if it does not, the run goes on without it.
///
/// # Errors
/// A file cannot be made, a kind is not in this build, or there is no thread.
pub fn open(targets: &[Target], dir: &Path, live: Option<u16>, header: &Header) -> Result<Writer, RecordError> {
    let header = Arc::new(header.clone());
    let sums = Sums::default();
    let mut sinks: Vec<Begin> = Vec::new();
    // The head of an .mcap is written sooner: it does not wait for that of an .rrd.
    let mut targets = targets.to_vec();
    targets.sort_by_key(|target| *target == Target::Rerun);
    for target in targets {
        let partial = dir.join(format!("{}{PARTIAL}{}", header.case, target.extension()));
        if !Target::AVAILABLE.contains(&target) {
            return Err(RecordError::new(&partial, "this build has no Rerun (cargo feature `rerun`)"));
        }
        let file = AheadFile::create(&partial).map_err(|error| RecordError::caused(&partial, &error))?;
        let (dir, header, sums) = (dir.to_path_buf(), Arc::clone(&header), Arc::clone(&sums));
        sinks.push(Box::new(move || {
            let recorder = begun(target, file.clone(), &partial, &header)?;
            Ok(Box::new(Renamed { recorder, file, sums, target, partial, dir, name: header.name.clone() }))
        }));
    }
    if let Some(viewer) = live.and_then(|port| in_viewer(port, &header)) {
        sinks.push(Box::new(|| Ok(viewer)));
    }
    Writer::begin(sinks, sums)
}

#[cfg(feature = "rerun")]
fn in_viewer(port: u16, header: &Header) -> Option<Box<dyn Recorder>> {
    let viewer = super::rerun::live::Live::connect(port).ok()?;
    Some(Box::new(super::rerun::RerunRecorder::live(viewer, header).ok()?))
}

#[cfg(not(feature = "rerun"))]
fn in_viewer(_: u16, _: &Header) -> Option<Box<dyn Recorder>> {
    None
}

/// A recorder of a kind, whose head is in its file.
fn begun(target: Target, file: AheadFile, path: &Path, header: &Header) -> Result<Box<dyn Recorder>, RecordError> {
    match target {
        Target::Mcap => {
            let recorder = super::mcap::McapRecorder::begin(file, path, header)?;
            lay_out(path, header)?;
            Ok(Box::new(Limited::new(Box::new(recorder), header)))
        }
        #[cfg(feature = "rerun")]
        Target::Rerun => {
            let recorder = super::rerun::RerunRecorder::in_file(file, path, header)?;
            let heads = recorder.heads();
            let limited = Limited::new(Box::new(recorder), header);
            Ok(Box::new(super::gather::Gatherer::new(Box::new(limited), heads)))
        }
        #[cfg(not(feature = "rerun"))]
        Target::Rerun => Err(RecordError::new(path, "this build has no Rerun (cargo feature `rerun`)")),
    }
}

/// File by which a folder of results is known.
const PLAN: &str = "plan.json";

/// Foxglove's layout beside the recordings of a folder of results, once.
fn lay_out(recording: &Path, header: &Header) -> Result<(), RecordError> {
    let layout = recording.with_file_name(schema::LAYOUT_FILE);
    let all = Streams { bodies: true, contacts: true, forces: true, energy: true, velocities: true };
    if layout.exists() || !recording.with_file_name(PLAN).exists() {
        return Ok(());
    }
    std::fs::write(&layout, foxglove_layout::layout(all, header)).map_err(|error| RecordError::caused(&layout, &error))
}

/// Gives a file its name when it is complete and the outcome is known.
struct Renamed {
    recorder: Box<dyn Recorder>,
    file: AheadFile,
    sums: Sums,
    target: Target,
    partial: PathBuf,
    dir: PathBuf,
    name: RecordingName,
}

impl Recorder for Renamed {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError> {
        self.recorder.write(batch)
    }

    fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.recorder.event(event)
    }

    fn ahead(&mut self, batch: &Batch) -> Result<(), RecordError> {
        self.recorder.ahead(batch)
    }

    fn bytes(&self) -> u64 {
        self.recorder.bytes()
    }

    fn finish(self: Box<Self>, ending: &Ending) -> Result<(), RecordError> {
        let Renamed { recorder, file, sums, target, partial, dir, name } = *self;
        recorder.finish(ending)?;
        let complete = target.path(&dir, &name.ended(ending.outcome));
        std::fs::rename(&partial, &complete).map_err(|error| RecordError::caused(&complete, &error))?;
        let (bytes, sha256) = file.sum();
        sums.lock().unwrap_or_else(PoisonError::into_inner).push(FileSum { target, bytes, sha256 });
        Ok(())
    }
}

use super::synthetic::{self as s, ALL};
use gotai::record::sample::{Batch, Ending, Event, Severity};
use gotai::record::writer::{Target, Writer, open};
use gotai::record::{RecordError, Recorder};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// What a recorder saw, in order: steps, events, the end.
#[derive(Clone, Debug, PartialEq)]
enum Seen {
    Step(u64),
    Event(String),
    Finish,
}

/// Remembers what it sees; fails or panics at a step.
#[derive(Clone, Default)]
struct Memory {
    seen: Arc<Mutex<Vec<Seen>>>,
    /// Where each batch's column lies: one place a batch in circulation.
    places: Arc<Mutex<BTreeSet<usize>>>,
    slow: bool,
    fail_at: Option<u64>,
    panic_at: Option<u64>,
}

impl Recorder for Memory {
    fn write(&mut self, batch: &Batch) -> Result<(), RecordError> {
        if self.slow {
            std::thread::sleep(Duration::from_millis(2));
        }
        if self.fail_at.is_some_and(|step| batch.step.contains(&step)) {
            return Err(RecordError::new(Path::new("memory"), "full"));
        }
        assert!(!self.panic_at.is_some_and(|step| batch.step.contains(&step)), "out of order");
        self.places.lock().unwrap().insert(batch.step.as_ptr() as usize);
        self.seen.lock().unwrap().extend(batch.step.iter().map(|&step| Seen::Step(step)));
        Ok(())
    }

    fn event(&mut self, event: &Event) -> Result<(), RecordError> {
        self.seen.lock().unwrap().push(Seen::Event(event.text.clone()));
        Ok(())
    }

    fn finish(self: Box<Self>, _: &Ending) -> Result<(), RecordError> {
        self.seen.lock().unwrap().push(Seen::Finish);
        Ok(())
    }
}

fn fill(writer: &mut Writer, samples: std::ops::Range<u64>) {
    for i in samples {
        writer.fill(|batch| s::push(batch, i, ALL));
    }
}

fn event(text: &str) -> Event {
    Event { step: 0, time_s: 0.0, severity: Severity::Info, text: text.to_owned() }
}

fn expected(samples: u64) -> Vec<Seen> {
    (0..samples).map(Seen::Step).chain([Seen::Finish]).collect()
}

#[test]
fn a_slow_recorder_gets_every_sample_in_order_from_few_batches() {
    let memory = Memory { slow: true, ..Memory::default() };
    let mut writer = Writer::start(vec![Box::new(memory.clone())]).unwrap();
    fill(&mut writer, 0..50_500);
    writer.finish(s::ending()).unwrap();
    assert!(*memory.seen.lock().unwrap() == expected(50_500));
    // Four batches circulate; a fresh one may grow elsewhere once more in its first rounds.
    let places = memory.places.lock().unwrap().len();
    assert!(places <= 8, "{places} places for 51 batches");
}

#[test]
fn events_come_between_the_samples_they_happened_between() {
    let memory = Memory::default();
    let mut writer = Writer::start(vec![Box::new(memory.clone())]).unwrap();
    fill(&mut writer, 0..2);
    writer.event(event("a"));
    fill(&mut writer, 2..3);
    writer.event(event("b"));
    writer.finish(s::ending()).unwrap();
    let expected = [
        Seen::Step(0),
        Seen::Step(1),
        Seen::Event("a".to_owned()),
        Seen::Step(2),
        Seen::Event("b".to_owned()),
        Seen::Finish,
    ];
    assert_eq!(*memory.seen.lock().unwrap(), expected);
}

#[test]
fn a_failed_write_is_reported_at_the_end_and_hurts_nobody_else() {
    let (good, bad) = (Memory::default(), Memory { fail_at: Some(3000), ..Memory::default() });
    let mut writer = Writer::start(vec![Box::new(bad.clone()), Box::new(good.clone())]).unwrap();
    fill(&mut writer, 0..20_000);
    assert_eq!(writer.finish(s::ending()).unwrap_err().reason, "full");
    assert!(*good.seen.lock().unwrap() == expected(20_000));
    assert!(!bad.seen.lock().unwrap().contains(&Seen::Finish));
}

#[test]
fn a_panic_of_a_recorder_is_an_error_of_the_writer() {
    let bad = Memory { panic_at: Some(3000), ..Memory::default() };
    let mut writer = Writer::start(vec![Box::new(bad)]).unwrap();
    fill(&mut writer, 0..50_000);
    writer.event(event("nobody listens"));
    let reason = writer.finish(s::ending()).unwrap_err().reason;
    assert!(reason.contains("out of order"), "{reason}");
}

#[test]
fn a_file_has_its_final_name_when_it_is_complete() {
    let dir = crate::scratch::folder();
    let names = || {
        let names =
            std::fs::read_dir(dir.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        // Foxglove's layout stands beside them.
        names.filter(|name| !name.ends_with(".json")).collect::<BTreeSet<_>>()
    };
    let named = |name: &str| Target::AVAILABLE.iter().map(|t| format!("{name}.{}", t.extension())).collect();

    let mut writer = open(Target::AVAILABLE, dir.path(), None, &s::header(ALL)).unwrap();
    fill(&mut writer, 0..5000);
    assert_eq!(names(), named("0123456789abcdef.partial"));
    writer.finish(s::ending()).unwrap();
    assert_eq!(names(), named(s::NAME));
}

#[test]
fn a_writer_that_is_dropped_leaves_its_files_partial() {
    let dir = crate::scratch::folder();
    let mut writer = open(&[Target::Mcap], dir.path(), None, &s::header(ALL)).unwrap();
    fill(&mut writer, 0..5000);
    drop(writer);
    assert!(dir.path().join("0123456789abcdef.partial.mcap").exists());
    assert!(!Target::Mcap.path(dir.path(), s::NAME).exists());
}

#[test]
fn a_directory_that_cannot_be_written_is_an_error() {
    let dir = crate::scratch::folder();
    let file = dir.path().join("file");
    std::fs::write(&file, "").unwrap();
    for place in [dir.path().join("missing"), file] {
        for &target in Target::AVAILABLE {
            let error = open(&[target], &place, None, &s::header(ALL)).err().unwrap();
            assert!(error.to_string().contains("0123456789abcdef.partial"), "{error}");
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error_and_the_run_goes_on() {
    let dir = crate::scratch::folder();
    for &target in Target::AVAILABLE {
        let partial = dir.path().join(format!("0123456789abcdef.partial.{}", target.extension()));
        std::os::unix::fs::symlink("/dev/full", partial).unwrap();
        let result = open(&[target], dir.path(), None, &s::header(ALL)).and_then(|mut writer| {
            fill(&mut writer, 0..20_000);
            writer.finish(s::ending())
        });
        let error = result.unwrap_err().to_string();
        assert!(error.contains("No space left"), "{error}");
        assert!(!target.path(dir.path(), s::NAME).exists());
    }
}

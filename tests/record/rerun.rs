use super::synthetic::{self as s, ALL, NONE};
use ::re_chunk::Chunk;
use ::re_log_encoding::Decoder;
use ::re_log_types::{LogMsg, StoreKind};
use ::re_sdk_types::archetypes::{Points3D, Scalars, TextDocument};
use gotai::record::Recorder;
use gotai::record::rerun::RerunRecorder;
use gotai::record::sample::{Event, Severity, Streams};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

fn record(path: &Path, n: u64, streams: Streams) {
    let mut recorder = RerunRecorder::create(path, &s::header(streams)).unwrap();
    for start in (0..n).step_by(300) {
        recorder.write(&s::batch(start..n.min(start + 300), streams)).unwrap();
    }
    let event = Event { step: n, time_s: s::time_s(n), severity: Severity::Info, text: "the end".to_owned() };
    recorder.event(&event).unwrap();
    Box::new(recorder).finish().unwrap();
}

fn messages(path: &Path) -> Vec<LogMsg> {
    let decoder = Decoder::<LogMsg>::decode_eager(BufReader::new(File::open(path).unwrap())).unwrap();
    decoder.map(Result::unwrap).collect()
}

/// What is said of the run: the chunks of the one recording in the file.
fn read(path: &Path) -> Vec<Chunk> {
    let mut stores = std::collections::BTreeSet::new();
    let mut chunks = Vec::new();
    for message in messages(path) {
        if let LogMsg::ArrowMsg(store, chunk) = &message
            && store.kind() == StoreKind::Recording
        {
            stores.insert(store.clone());
            chunks.push(Chunk::from_arrow_msg(chunk).unwrap());
        }
    }
    assert_eq!(stores.len(), 1, "one recording a file");
    chunks
}

/// Rows by entity, without what is said once.
fn rows(store: &[Chunk]) -> BTreeMap<String, usize> {
    let mut rows = BTreeMap::new();
    for chunk in store.iter().filter(|chunk| !chunk.is_static()) {
        *rows.entry(chunk.entity_path().to_string()).or_default() += chunk.num_rows();
    }
    rows
}

fn scalars(store: &[Chunk], path: &str) -> Vec<f64> {
    let chunks = store.iter().filter(|chunk| chunk.entity_path().to_string() == path);
    let component = Scalars::descriptor_scalars().component;
    chunks.flat_map(|chunk| chunk.iter_slices::<f64>(component).map(|row| row[0]).collect::<Vec<_>>()).collect()
}

#[test]
fn an_rrd_holds_every_sample() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    record(&path, 1000, ALL);
    let store = read(&path);

    let expected = [
        ("/contact/count", 1000),
        ("/contact/force", 1000),
        ("/energy/kinetic", 1000),
        ("/energy/potential", 1000),
        ("/energy/total", 1000),
        ("/log", 1),
        ("/penetration", 1000),
        ("/world/bodies/cube\\[0\\]", 1000),
        ("/world/contacts", 1000),
        ("/world/forces", 1000),
    ];
    assert_eq!(rows(&store), expected.map(|(path, rows)| (path.to_owned(), rows)).into());

    let same = |path: &str, value: fn(u64) -> f64| {
        let expected: Vec<_> = (0..1000).map(value).collect();
        assert_eq!(scalars(&store, path), expected, "{path}");
    };
    same("/energy/kinetic", |i| s::energy(i).kinetic_j);
    same("/energy/potential", |i| s::energy(i).potential_j);
    same("/energy/total", |i| s::energy(i).total_j);
    same("/penetration", |i| s::energy(i).penetration_m);
    same("/contact/count", |i| s::contacts(i).len() as f64);
}

#[test]
fn every_sample_has_its_own_number_of_contact_points() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    record(&path, 1000, ALL);
    let store = read(&path);
    let component = Points3D::descriptor_positions().component;
    let chunks = store.iter().filter(|chunk| chunk.entity_path().to_string() == "/world/contacts");
    let lengths: Vec<_> =
        chunks.flat_map(|chunk| chunk.iter_slices::<[f32; 3]>(component).map(<[_]>::len).collect::<Vec<_>>()).collect();
    assert_eq!(lengths, (0..1000).map(|i| s::contacts(i).len()).collect::<Vec<_>>());
}

#[test]
fn streams_that_are_off_leave_no_entity() {
    let dir = crate::scratch::folder();
    // All entities, also those with nothing but a style.
    let entities = |streams| {
        let path = dir.path().join("a.rrd");
        record(&path, 10, streams);
        let store = read(&path);
        let paths = store.iter().map(|chunk| chunk.entity_path().to_string());
        let mut paths: Vec<_> = paths.filter(|path| !path.starts_with("/__properties")).collect();
        paths.sort();
        paths.dedup();
        paths
    };
    let always = ["/config", "/log", "/world", "/world/container"];
    assert_eq!(entities(NONE), always);
    let with = |more: &[&str]| {
        let mut paths: Vec<_> = always.iter().chain(more).map(|path| (*path).to_owned()).collect();
        paths.sort();
        paths
    };
    assert_eq!(entities(Streams { bodies: true, ..NONE }), with(&["/world/bodies/cube\\[0\\]"]));
    assert_eq!(entities(Streams { contacts: true, ..NONE }), with(&["/contact/count", "/world/contacts"]));
    assert_eq!(entities(Streams { forces: true, ..NONE }), with(&["/contact/force", "/world/forces"]));
    let energy = ["/energy/kinetic", "/energy/potential", "/energy/total", "/penetration"];
    assert_eq!(entities(Streams { energy: true, ..NONE }), with(&energy));
}

#[test]
fn the_layout_comes_first_and_the_configuration_is_shown() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    record(&path, 10, ALL);
    let messages = messages(&path);
    assert_eq!(messages[0].store_id().kind(), StoreKind::Blueprint);
    let activation = messages.iter().position(|message| matches!(message, LogMsg::BlueprintActivationCommand(_)));
    let last_of_layout = messages.iter().rposition(|message| message.store_id().kind() == StoreKind::Blueprint);
    assert_eq!(activation, last_of_layout);

    let store = read(&path);
    let config = store.iter().find(|chunk| chunk.entity_path().to_string() == "/config").unwrap();
    let text = format!("{:?}", config.components().get_array(TextDocument::descriptor_text().component));
    assert!(text.contains("name: bouncing"), "{text}");
}

#[test]
fn a_killed_recording_keeps_every_batch_that_was_written() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    let mut recorder = RerunRecorder::create(&path, &s::header(ALL)).unwrap();
    recorder.write(&s::batch(0..1000, ALL)).unwrap();
    // No destructor runs, as after SIGKILL.
    std::mem::forget(recorder);
    assert_eq!(rows(&read(&path))["/energy/total"], 1000);
}

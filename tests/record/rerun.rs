use super::synthetic::{self as s, ALL, NONE};
use ::rerun::external::re_log_encoding::Decoder;
use ::rerun::log::LogMsg;
use ::rerun::{ChunkStore, ChunkStoreConfig, StoreKind};
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
    Box::new(recorder).finish(&s::ending()).unwrap();
}

fn read(path: &Path) -> ChunkStore {
    let mut file = File::open(path).unwrap();
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::ALL_DISABLED, &mut file).unwrap();
    let mut recordings = stores.into_values().filter(|store| store.id().kind() == StoreKind::Recording);
    let store = recordings.next().unwrap();
    assert!(recordings.next().is_none(), "one recording a file");
    store
}

/// Rows by entity, without what is said once.
fn rows(store: &ChunkStore) -> BTreeMap<String, usize> {
    let mut rows = BTreeMap::new();
    for chunk in store.iter_physical_chunks().filter(|chunk| !chunk.is_static()) {
        *rows.entry(chunk.entity_path().to_string()).or_default() += chunk.num_rows();
    }
    rows
}

fn scalars(store: &ChunkStore, path: &str) -> Vec<f64> {
    let chunks = store.iter_physical_chunks().filter(|chunk| chunk.entity_path().to_string() == path);
    let component = ::rerun::Scalars::descriptor_scalars().component;
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
    let component = ::rerun::Points3D::descriptor_positions().component;
    let chunks = store.iter_physical_chunks().filter(|chunk| chunk.entity_path().to_string() == "/world/contacts");
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
        let paths = store.iter_physical_chunks().map(|chunk| chunk.entity_path().to_string());
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
fn name_axes_and_outcome_are_properties() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    record(&path, 10, ALL);
    let store = read(&path);
    let said = |entity: &str| -> String {
        let chunks = store.iter_physical_chunks().filter(|chunk| chunk.entity_path().to_string() == entity);
        chunks.map(|chunk| format!("{:?}", chunk.components())).collect()
    };
    // The one that the head gave is replaced.
    let names = said("/__properties");
    assert!(names.contains(s::NAME) && !names.contains("0.5_fine.01234567"), "{names}");
    let run = said("/__properties/gotai");
    let expected = ["scene.friction", "method", "outcome", "diverged", "criterion", "energy", "end_time_s", "steps"];
    for part in expected.into_iter().chain(["warnings", s::WARNING]) {
        assert!(run.contains(part), "{part}: {run}");
    }
    assert!(!run.contains("notes"), "{run}");
}

#[test]
fn the_layout_comes_first_and_the_configuration_is_shown() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    record(&path, 10, ALL);
    let decoder = Decoder::<LogMsg>::decode_eager(BufReader::new(File::open(&path).unwrap())).unwrap();
    let messages: Vec<_> = decoder.map(Result::unwrap).collect();
    assert_eq!(messages[0].store_id().kind(), StoreKind::Blueprint);
    let activation = messages.iter().position(|message| matches!(message, LogMsg::BlueprintActivationCommand(_)));
    let last_of_layout = messages.iter().rposition(|message| message.store_id().kind() == StoreKind::Blueprint);
    assert_eq!(activation, last_of_layout);

    let store = read(&path);
    let config = store.iter_physical_chunks().find(|chunk| chunk.entity_path().to_string() == "/config").unwrap();
    let text = format!("{:?}", config.components().get_array(::rerun::TextDocument::descriptor_text().component));
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

use super::synthetic::{self as s, ALL, NONE};
use ::rerun::external::re_log_encoding::Decoder;
use ::rerun::log::LogMsg;
use ::rerun::{ChunkStore, ChunkStoreConfig, StoreKind};
use gotai::record::Recorder;
use gotai::record::rerun::RerunRecorder;
use gotai::record::sample::{Event, Severity, Streams};
use gotai::record::story::{Decisive, markdown};
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

/// Rows by entity, and the page that a recording opens with.
pub fn whole(path: &Path) -> (BTreeMap<String, usize>, String) {
    let store = read(path);
    let component = ::rerun::TextDocument::descriptor_text().component;
    let chunks = store.iter_physical_chunks().filter(|chunk| chunk.entity_path().to_string() == "/headline");
    let pages: Vec<String> = chunks
        .flat_map(|chunk| chunk.iter_slices::<String>(component).map(|row| row[0].to_string()).collect::<Vec<_>>())
        .collect();
    // The first one is of a run that is not finished.
    (rows(&store), pages.into_iter().find(|page| !page.starts_with("# Not finished")).unwrap())
}

/// The messages of a file, of one that was cut too.
fn all(path: &Path) -> Vec<LogMsg> {
    let decoder = Decoder::<LogMsg>::decode_eager(BufReader::new(File::open(path).unwrap()));
    decoder.map(|messages| messages.map_while(Result::ok).collect()).unwrap_or_default()
}

/// Number of layouts in a file.
pub fn layouts(path: &Path) -> usize {
    all(path).iter().filter(|message| matches!(message, LogMsg::BlueprintActivationCommand(_))).count()
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
        ("/contact/friction_use", 1000),
        ("/energy/gains", 1),
        ("/energy/kinetic", 1000),
        ("/energy/potential", 1000),
        ("/energy/total", 1000),
        ("/log", 1),
        ("/log/decisive", 2),
        ("/log_energy/gains", 1),
        ("/log_energy/limit", 2),
        ("/log_energy/total", 1000),
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
    let always = ["/", "/config", "/headline", "/log", "/log/decisive", "/world", "/world/container", "/world/ground"];
    assert_eq!(entities(NONE), always);
    fn with(always: &[&str], more: &[impl AsRef<str>]) -> Vec<String> {
        let more = more.iter().map(|path| path.as_ref().to_owned());
        let mut paths: Vec<_> = always.iter().map(|path| (*path).to_owned()).chain(more).collect();
        paths.sort();
        paths
    }
    assert_eq!(
        entities(Streams { bodies: true, ..NONE }),
        with(
            &always,
            &["axes", "axes/names", "bodies/cube\\[0\\]", "bodies/cube\\[0\\]/edges", "bodies/cube\\[0\\]/nodes"]
                .map(|part| format!("/world/{part}"))
        )
    );
    let moving = entities(Streams { bodies: true, velocities: true, ..NONE });
    assert!(moving.iter().any(|path| path == "/world/velocities"), "{moving:?}");
    assert_eq!(entities(Streams { contacts: true, ..NONE }), with(&always, &["/contact/count", "/world/contacts"]));
    assert_eq!(
        entities(Streams { forces: true, ..NONE }),
        with(&always, &["/contact/force", "/contact/friction_use", "/world/forces"])
    );
    let energy = [
        "/energy/gains",
        "/energy/kinetic",
        "/energy/potential",
        "/energy/total",
        "/log_energy/gains",
        "/log_energy/limit",
        "/log_energy/total",
        "/penetration",
    ];
    assert_eq!(entities(Streams { energy: true, ..NONE }), with(&always, &energy));
}

#[test]
fn decisive_instants_stand_in_the_log() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    record(&path, 10, ALL);
    let store = read(&path);
    let texts: String = store
        .iter_physical_chunks()
        .filter(|chunk| chunk.entity_path().to_string() == "/log/decisive")
        .map(|chunk| format!("{} rows: {:?}", chunk.num_rows(), chunk.components()))
        .collect();
    let turns = s::ending().story.turns;
    let decisive: Vec<_> = turns.iter().filter(|turn| turn.what != Decisive::End).collect();
    assert!(!decisive.is_empty() && texts.starts_with(&format!("{} rows", decisive.len())), "{texts}");
    for turn in decisive {
        assert!(texts.contains(turn.what.name()) && texts.contains(&turn.text), "{texts}");
    }
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
fn layouts_are_complete_and_the_configuration_is_shown() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    record(&path, 10, ALL);
    let messages = all(&path);
    assert_eq!(messages[0].store_id().kind(), StoreKind::Recording);
    // A short one is laid out once, by what knows the story; a longer one before too, for whoever looks at it or when
    // it is cut. Each layout ends with what makes it the active one.
    let longer = dir.path().join("b.rrd");
    record(&longer, 1200, ALL);
    for (file, count) in [(&path, 1), (&longer, 2)] {
        let messages = all(file);
        let mut layouts = messages.iter().filter(|message| message.store_id().kind() == StoreKind::Blueprint);
        assert!(layouts.next_back().is_some_and(|last| matches!(last, LogMsg::BlueprintActivationCommand(_))));
        assert_eq!(self::layouts(file), count);
    }
    // No other recording has it.
    let applications: std::collections::BTreeSet<_> =
        messages.iter().map(|message| message.store_id().application_id().to_string()).collect();
    assert_eq!(applications, ["gotai 0-5_fine-01234567".to_string()].into());

    let store = read(&path);
    let config = store.iter_physical_chunks().find(|chunk| chunk.entity_path().to_string() == "/config").unwrap();
    let text = format!("{:?}", config.components().get_array(::rerun::TextDocument::descriptor_text().component));
    assert!(text.contains("name: bouncing"), "{text}");
    let pages = store.iter_physical_chunks().filter(|chunk| chunk.entity_path().to_string() == "/headline");
    let pages: String = pages.map(|page| format!("{:?}", page.components())).collect();
    for part in ["Diverged at t = 0.25 s", "Does it bounce?", "first contact", "1 → 40000 J", s::WARNING, "residual"]
    {
        assert!(pages.contains(part), "{part}: {pages}");
    }
    assert!(!pages.contains("Not finished"), "the page of a cut recording is replaced: {pages}");
}

#[test]
fn names_and_questions_do_not_break_the_tables_of_the_page() {
    assert_eq!(markdown("a|b *c* `d` _e_ work_unsolved [0]"), r"a\|b \*c\* \`d\` \_e\_ work_unsolved \[0\]");
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.rrd");
    let header = gotai::record::sample::Header { question: "is |x| < *y*?".to_owned(), ..s::header(ALL) };
    let mut recorder = RerunRecorder::create(&path, &header).unwrap();
    recorder.write(&s::batch(0..10, ALL)).unwrap();
    let mut ending = s::ending();
    ending.story.turns[0].text = "left|right and container".to_owned();
    Box::new(recorder).finish(&ending).unwrap();
    let store = read(&path);
    let pages = store.iter_physical_chunks().filter(|chunk| chunk.entity_path().to_string() == "/headline");
    let pages: String = pages.map(|page| format!("{:?}", page.components())).collect();
    for part in [r"is \\|x\\| \\< \\*y\\*?", r"left\\|right and container"] {
        assert!(pages.contains(part), "{part}: {pages}");
    }
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

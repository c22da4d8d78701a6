use super::synthetic::{self as s, ALL, NONE};
use ::mcap::{MessageStream, Summary, read::Options};
use foxglove::messages::{FrameTransforms, Log, SceneUpdate};
use gotai::record::mcap::McapRecorder;
use gotai::record::sample::{Event, Severity, Streams};
use gotai::record::{Recorder, schema};
use prost::Message;
use std::collections::BTreeMap;
use std::path::Path;

/// Records samples 0..n in batches of 300, with one event after the last.
fn record(path: &Path, n: u64, streams: Streams) {
    let mut recorder = McapRecorder::create(path, &s::header(streams)).unwrap();
    for start in (0..n).step_by(300) {
        recorder.write(&s::batch(start..n.min(start + 300), streams)).unwrap();
    }
    let event = Event { step: n, time_s: s::time_s(n), severity: Severity::Warning, text: "the end".to_owned() };
    recorder.event(&event).unwrap();
    Box::new(recorder).finish(&s::ending()).unwrap();
}

/// Encoded messages by topic, in the order of the file, with their log times.
type Topics = BTreeMap<String, Vec<(u64, Vec<u8>)>>;

fn read(bytes: &[u8]) -> Topics {
    let mut topics = Topics::new();
    // A file that ends early gives its complete chunks, then one error.
    let stream = MessageStream::new_with_options(bytes, Options::IgnoreEndMagic.into()).unwrap();
    for message in stream.map_while(Result::ok) {
        assert_eq!(message.channel.message_encoding, "protobuf");
        assert_eq!(message.log_time, message.publish_time);
        let schema = message.channel.schema.as_ref().unwrap();
        assert!(prost_types::FileDescriptorSet::decode(&schema.data[..]).is_ok(), "{}", schema.name);
        topics.entry(message.channel.topic.clone()).or_default().push((message.log_time, message.data.to_vec()));
    }
    topics
}

fn decode<T: Message + Default>(topics: &Topics, topic: &str) -> Vec<T> {
    topics[topic].iter().map(|(_, data)| T::decode(&data[..]).unwrap()).collect()
}

#[test]
fn an_mcap_holds_every_sample_to_the_last_bit() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.mcap");
    record(&path, 1000, ALL);
    let topics = read(&std::fs::read(&path).unwrap());

    let bodies: Vec<schema::Bodies> = decode(&topics, schema::BODIES);
    let contacts: Vec<schema::Contacts> = decode(&topics, schema::CONTACTS);
    let energies: Vec<schema::Energy> = decode(&topics, schema::ENERGY);
    assert_eq!((bodies.len(), contacts.len(), energies.len()), (1000, 1000, 1000));
    for i in 0..1000 {
        let (body, energy, expected) = (&bodies[i as usize], &energies[i as usize], s::energy(i));
        assert_eq!((body.step, body.time_s.to_bits()), (i, s::time_s(i).to_bits()));
        assert_eq!(body.bodies[0].name, "cube[0]");
        assert_eq!(body.bodies[0].position_m, s::body(i).position_m);
        assert_eq!(body.bodies[0].orientation_xyzw, s::body(i).orientation_xyzw);
        assert_eq!(body.bodies[0].velocity_m_s, s::body(i).velocity_m_s);
        assert_eq!(body.bodies[0].angular_velocity_rad_s, s::body(i).angular_velocity_rad_s);
        assert_eq!(energy.kinetic_j.to_bits(), expected.kinetic_j.to_bits());
        assert_eq!(energy.potential_j.to_bits(), expected.potential_j.to_bits());
        assert_eq!(energy.total_j.to_bits(), expected.total_j.to_bits());
        assert_eq!(energy.penetration_m.to_bits(), expected.penetration_m.to_bits());
        let expected = s::contacts(i);
        assert_eq!(contacts[i as usize].contacts.len(), expected.len());
        for (contact, expected) in contacts[i as usize].contacts.iter().zip(&expected) {
            assert_eq!((contact.body.as_str(), contact.other.as_str()), ("cube[0]", "container"));
            assert_eq!(contact.point_m, expected.point_m);
            assert_eq!(contact.normal, expected.normal);
            assert_eq!(contact.force_n, expected.force_n);
            assert_eq!(contact.gap_m, expected.gap_m);
        }
    }
    let counts: std::collections::BTreeSet<_> = contacts.iter().map(|message| message.contacts.len()).collect();
    assert!(counts.contains(&0) && counts.len() > 1, "the synthetic run has varying contacts: {counts:?}");
    assert!(topics[schema::ENERGY].iter().zip(0..).all(|((log_time, _), i)| *log_time == i * 1_000_000));
}

#[test]
fn pictures_come_at_display_rate_and_surfaces_once() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.mcap");
    record(&path, 1000, ALL);
    let topics = read(&std::fs::read(&path).unwrap());

    let frames: Vec<FrameTransforms> = decode(&topics, schema::TRANSFORMS);
    // One second at 1000 Hz, shown at 60 Hz.
    assert_eq!(frames.len(), 60);
    assert_eq!(frames[0].transforms[0].child_frame_id, "cube[0]");
    // The world's y is the z of a frame for viewers that want it.
    let root = &frames[0].transforms[1];
    assert_eq!((root.parent_frame_id.as_str(), root.child_frame_id.as_str()), ("root", "world"));
    let q = root.rotation.unwrap();
    assert!((2.0 * (q.y * q.z + q.w * q.x) - 1.0).abs() < 1e-15, "{q:?}");
    let scene: Vec<SceneUpdate> = decode(&topics, schema::SCENE);
    assert_eq!(scene.len(), 1);
    let ids: Vec<_> = scene[0].entities.iter().map(|entity| (entity.id.as_str(), entity.frame_id.as_str())).collect();
    assert_eq!(ids, [("container", "world"), ("cube[0]", "cube[0]")]);
    assert_eq!(scene[0].entities[1].triangles[0].indices.len(), 36);
    // Contacts are drawn while there are some, and cleared once.
    let contacts: Vec<SceneUpdate> = decode(&topics, schema::SCENE_CONTACTS);
    let drawn: Vec<_> = contacts.iter().map(|update| update.entities[0].arrows.len()).collect();
    assert!(drawn.windows(2).all(|pair| pair != [0, 0]), "{drawn:?}");
    assert!(drawn.contains(&0) && drawn.iter().any(|&n| n > 0), "{drawn:?}");
    for arrow in contacts.iter().flat_map(|update| &update.entities[0].arrows) {
        let q = arrow.pose.as_ref().unwrap().orientation.unwrap();
        let norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
        assert!((norm - 1.0).abs() < 1e-12, "{q:?}");
    }
    let log: Vec<Log> = decode(&topics, schema::LOG);
    assert_eq!(log.iter().map(|log| log.message.as_str()).collect::<Vec<_>>(), ["the end"]);
}

#[test]
fn configuration_and_versions_are_attached() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.mcap");
    record(&path, 10, ALL);
    let bytes = std::fs::read(&path).unwrap();
    let summary = Summary::read(&bytes).unwrap().unwrap();

    let attachment = ::mcap::read::attachment(&bytes, &summary.attachment_indexes[0]).unwrap();
    assert_eq!(attachment.name, "experiment.yaml");
    assert_eq!(attachment.data, s::CONFIG.as_bytes());
    // A torn file has the first one, a whole file both.
    let metadata = |i: usize| ::mcap::read::metadata(&bytes, &summary.metadata_indexes[i]).unwrap();
    let (start, end) = (metadata(0), metadata(2));
    assert_eq!((start.name.as_str(), end.name.as_str()), ("gotai.start", "gotai"));
    // The bodies' surfaces, and Foxglove's layout.
    let meshes: BTreeMap<String, String> = serde_json::from_str(&start.metadata["meshes"]).unwrap();
    let named = |name: &str| {
        let index = summary.attachment_indexes.iter().find(|index| index.name == name).unwrap();
        String::from_utf8(::mcap::read::attachment(&bytes, index).unwrap().data.into_owned()).unwrap()
    };
    let surface = named(&meshes["cube[0]"]);
    let lines = |kind: &str| surface.lines().filter(|line| line.starts_with(kind)).count();
    assert_eq!((lines("v "), lines("f ")), (8, 12));
    let layout: serde_json::Value = serde_json::from_str(&named(schema::LAYOUT_FILE)).unwrap();
    assert_eq!(layout["configById"]["3D!scene"]["followTf"], schema::ROOT);
    let expected = [
        ("case", "0123456789abcdef"),
        ("build", "0123abcd"),
        ("step_s", "0.001"),
        ("scene.friction", "0.5"),
        ("method", "fine"),
    ];
    for (key, value) in expected {
        assert_eq!((start.metadata[key].as_str(), end.metadata[key].as_str()), (value, value), "{key}");
    }
    let expected = [
        ("name", s::NAME),
        ("outcome", "diverged"),
        ("criterion", "energy"),
        ("end_time_s", "0.25"),
        ("steps", "250"),
        ("warnings", s::WARNING),
    ];
    for (key, value) in expected {
        assert_eq!((start.metadata.get(key), end.metadata[key].as_str()), (None, value), "{key}");
    }
    assert!(!end.metadata.contains_key("notes"));
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let dir = crate::scratch::folder();
    let files = ["a.mcap", "b.mcap"].map(|name| {
        record(&dir.path().join(name), 500, ALL);
        std::fs::read(dir.path().join(name)).unwrap()
    });
    assert!(files[0] == files[1]);
}

#[test]
fn streams_that_are_off_leave_no_topic() {
    let dir = crate::scratch::folder();
    let topics = |streams| {
        let path = dir.path().join("a.mcap");
        record(&path, 100, streams);
        let bytes = std::fs::read(&path).unwrap();
        let summary = Summary::read(&bytes).unwrap().unwrap();
        let mut topics: Vec<_> = summary.channels.values().map(|channel| channel.topic.clone()).collect();
        topics.sort();
        (topics, read(&bytes))
    };
    let (names, messages) = topics(NONE);
    assert_eq!(names, ["/log", "/scene"]);
    let scene: Vec<SceneUpdate> = decode(&messages, schema::SCENE);
    assert_eq!(scene[0].entities.len(), 1, "the container alone");
    assert_eq!(topics(Streams { energy: true, ..NONE }).0, ["/energy", "/log", "/scene"]);
    assert_eq!(topics(Streams { bodies: true, ..NONE }).0, ["/bodies", "/log", "/scene", "/tf"]);

    let (names, messages) = topics(Streams { contacts: true, ..NONE });
    assert_eq!(names, ["/contacts", "/log", "/scene", "/scene/contacts"]);
    let contacts: Vec<schema::Contacts> = decode(&messages, schema::CONTACTS);
    assert!(contacts[0].contacts.iter().all(|contact| contact.force_n.is_empty() && contact.normal.len() == 3));

    let (names, messages) = topics(Streams { forces: true, ..NONE });
    assert_eq!(names, ["/forces", "/log", "/scene", "/scene/contacts"]);
    let forces: Vec<schema::Contacts> = decode(&messages, schema::FORCES);
    assert!(forces[0].contacts.iter().all(|contact| contact.force_n.len() == 3 && contact.normal.is_empty()));
}

#[test]
fn a_killed_recording_keeps_every_batch_that_was_written() {
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.mcap");
    let mut recorder = McapRecorder::create(&path, &s::header(ALL)).unwrap();
    for start in [0, 1000, 2000] {
        recorder.write(&s::batch(start..start + 1000, ALL)).unwrap();
    }
    // No destructor runs, as after SIGKILL.
    std::mem::forget(recorder);
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!(read(&bytes)[schema::ENERGY].len(), 3000);

    let cut = read(&bytes[..bytes.len() - 10]);
    let energies: Vec<schema::Energy> = decode(&cut, schema::ENERGY);
    assert!(energies.len() > 2000, "{}", energies.len());
    assert!(energies.iter().zip(0..).all(|(energy, i)| energy.step == i));
}

#[test]
fn a_batch_that_does_not_fit_the_header_is_an_error() {
    let dir = crate::scratch::folder();
    let mut recorder = McapRecorder::create(&dir.path().join("a.mcap"), &s::header(ALL)).unwrap();
    let mut batch = s::batch(0..10, ALL);
    batch.contacts.pop();
    assert!(recorder.write(&batch).unwrap_err().to_string().contains("contacts"));
    let without_energy = s::batch(0..10, Streams { energy: false, ..ALL });
    assert!(recorder.write(&without_energy).unwrap_err().to_string().contains("energy"));
}

#[test]
fn force_arrows_stay_in_the_picture() {
    let arrows = s::header(ALL).force_arrows();
    assert_eq!(arrows.vector_m([0.0, 10.0, 0.0]), [0.0, 0.2, 0.0]);
    let [x, y, z] = arrows.vector_m([0.0, -1e9, 0.0]);
    assert!(x == 0.0 && z == 0.0 && (y + s::header(ALL).arrow_longest_m).abs() < 1e-12, "{y}");
}

/// Another reader, with nothing but the file: its schemas and its index are for others too.
#[test]
fn python_decodes_every_message() {
    let Some(python) = crate::tools::python_with("mcap_protobuf") else { return };
    let dir = crate::scratch::folder();
    let path = dir.path().join("a.mcap");
    record(&path, 1000, ALL);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/record/decode_mcap.py");
    let output = std::process::Command::new(python).arg(script).arg(&path).output().unwrap();
    let (text, error) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{error}");
    for topic in [schema::BODIES, schema::CONTACTS, schema::ENERGY] {
        assert!(text.contains(&format!("{:8} {topic} (", 1000)), "{topic}: {text}");
    }
    assert!(text.contains(&format!("last: step 999, t = {:?} s", s::time_s(999))), "{text}");
}

//! A recording says what happened: its events, the steps around them, and the maxima of its row.

use crate::cli::{json, run};
use crate::scratch;
use gotai::record::read::{ReadBack, recording_of};
use gotai::record::sample::Severity;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::PathBuf;

/// Runs an experiment of these settings; its row, its folder, the file and what is read back from it.
pub fn recorded(args: &[&str]) -> (Value, scratch::Folder, PathBuf, ReadBack) {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let d = json(&[&["run"], args, &["--record", "mcap", "--json", "--out", out]].concat());
    let file = folder.path().join(format!("{}.mcap", d["recording"].as_str().unwrap()));
    let recording = recording_of(&file).unwrap().unwrap();
    (d, folder, file, recording)
}

const BALL: &str = "scene:
  gravity_m_s2: [0, -10, 0]
  restitution: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.1 } }, mass_kg: 1, position_m: [0, 1.35, 0] }]
method: event-driven
time: { end_s: 1.2 }
record: { every_s: 0.11 }
";

/// An explosion of the lecture's cube.
pub const EXPLODES: [&str; 9] = [
    "configs/lecture/demo.yaml",
    "--set",
    "method={lecture: {}}",
    "--set",
    "time.step_s=0.04",
    "--set",
    "record.every_s=0.4",
    "--set",
    "scene.bodies.cube.mesh.nodes_per_edge=5",
];

#[test]
fn an_explosion_is_told_from_its_cause_to_its_end() {
    let (d, _folder, _, recording) = recorded(&EXPLODES);
    assert_eq!(d["outcome"], "diverged");
    let events = &recording.samples.events;
    let said = |part: &str| events.iter().filter(|event| event.text.contains(part)).collect::<Vec<_>>();
    assert!(said("impact: cube hits container at ")[0].severity == Severity::Info);
    assert!(said("gain of energy: ")[0].severity == Severity::Warning);
    assert!(said("diverged: energy at t = ")[0].severity == Severity::Error);
    // Every step at the end, of a run that is shorter than what is kept.
    let steps: BTreeSet<u64> = recording.samples.step.iter().copied().collect();
    let last = d["steps"].as_u64().unwrap();
    assert!(last < 200 && steps == (0..=last).collect(), "{steps:?}");
    assert!(recording.samples.time_s.is_sorted());
}

#[test]
fn the_maxima_of_a_row_are_in_its_recording() {
    // Every hundredth step is a sample: what the row tells happened between them.
    let sets = ["--set", "record.every_s=0.2", "--set", "time.end_s=2"];
    let (d, _folder, _, recording) = recorded(&[&["configs/lecture/demo.yaml"][..], &sets].concat());
    assert_eq!(d["outcome"], "finished");
    let samples = &recording.samples;
    let contacts = samples.contacts_len.iter().max().copied();
    assert_eq!(contacts.map(u64::from), d["contacts_max"].as_u64());
    let deepest = samples.energy.iter().map(|energy| energy.penetration_m).fold(0.0, f64::max);
    assert_eq!(Some(deepest), d["penetration_max_m"].as_f64());
    // Not every step is there: 11 samples, and those about impacts.
    assert!((11..400).contains(&samples.len()), "{}", samples.len());
    // Metadata has the row, but for what a clock makes.
    let said = |key: &str| recording.said.get(key).and_then(|text| text.parse::<f64>().ok());
    assert_eq!(said("residual_max"), d["residual_max"].as_f64());
    assert!(!recording.said.keys().any(|key| key.starts_with("wall_")), "{:?}", recording.said.keys());
}

#[test]
fn methods_that_follow_events_log_their_own() {
    let folder = scratch::folder();
    let config = folder.path().join("ball.yaml");
    std::fs::write(&config, BALL).unwrap();
    let (d, _folder, _, recording) = recorded(&[config.to_str().unwrap()]);
    assert_eq!(d["outcome"], "finished");
    let impacts = recording.samples.events.iter().filter(|event| event.text.starts_with("impact: ball hits container"));
    // A fall of 1.25 m takes half a second, and the next arc, at half the speed, another half.
    let times_s: Vec<f64> = impacts.map(|event| event.time_s).collect();
    assert!(times_s.len() == 2, "{times_s:?}");
    assert!((times_s[0] - 0.5).abs() < 1e-8 && (times_s[1] - 1.0).abs() < 1e-8, "{times_s:?}");
    // They are samples too, at the same instant.
    assert!(times_s.iter().all(|t| recording.samples.time_s.iter().any(|sample| (sample - t).abs() < 1e-9)));
}

#[test]
fn series_are_exported_to_the_last_bit() {
    let (d, folder, file, recording) = recorded(&EXPLODES);
    let (code, out, err) = run(&["export", file.to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    let files: Vec<&str> = out.lines().collect();
    assert_eq!(files.len(), 3, "{out}");
    let text = std::fs::read_to_string(files[0]).unwrap();
    let mut lines = text.lines();
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    let column = |name: &str| columns.iter().position(|column| *column == name).unwrap();
    let last: Vec<f64> = lines.last().unwrap().split(',').map(|cell| cell.parse().unwrap()).collect();
    assert_eq!(Some(last[column("total_j")]), d["energy_end_j"].as_f64());
    assert_eq!(Some(last[column("cube.position_m.y")]), d["bodies"][0]["position_m"][1].as_f64());
    assert_eq!(text.lines().count(), 1 + recording.samples.len());
    let (code, out, err) = run(&["export", folder.path().to_str().unwrap(), "--format", "parquet"]);
    assert!(code == 0 && out.lines().all(|file| file.ends_with(".parquet")), "{err}");
    let (code, _, err) = run(&["export", "Cargo.toml"]);
    assert!(code == 2 && err.contains("Cargo.toml: expected a recording"), "{err}");
}

#[test]
fn a_torn_recording_is_mended() {
    let (_, folder, file, recording) = recorded(&EXPLODES);
    let bytes = std::fs::read(&file).unwrap();
    let torn = folder.path().join("torn.mcap");
    std::fs::write(&torn, &bytes[..bytes.len() - 40]).unwrap();
    let (code, out, err) = run(&["repair", torn.to_str().unwrap()]);
    assert_eq!(code, 0, "{err}");
    let mended = std::fs::read(folder.path().join("torn.repaired.mcap")).unwrap();
    let until = format!("it ends at t = {} s", recording.until_s().unwrap());
    assert!(out.contains("messages; ") && out.contains(&until), "{out}");
    assert!(mcap::Summary::read(&mended).unwrap().is_some());
    let again = recording_of(&folder.path().join("torn.repaired.mcap")).unwrap().unwrap();
    assert_eq!(again.samples.step, recording.samples.step);
    let (code, _, err) = run(&["repair", "Cargo.toml"]);
    assert!(code == 2 && err.contains("expected a recording"), "{err}");
}

#[cfg(feature = "rerun")]
#[test]
fn a_run_of_an_axis_is_one_recording_of_all() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let axis = ["--axis", "method=[{lecture: {}}, time-stepping]", "--set", "time.end_s=0.4"];
    let d = json(&[&["run", "configs/lecture/demo.yaml"][..], &axis, &["--json", "--out", out]].concat());
    assert_eq!(d["rows"].as_array().unwrap().len(), 2);
    let name = d["recording"].as_str().unwrap();
    assert!(name.starts_with("ghosts_lecture_time-stepping."), "{name}");
    let file = std::fs::File::open(folder.path().join(format!("{name}.rrd"))).unwrap();
    let stores = ::rerun::ChunkStore::from_rrd_reader(
        &::rerun::ChunkStoreConfig::ALL_DISABLED,
        &mut std::io::BufReader::new(file),
    );
    let stores = stores.unwrap();
    let store = stores.values().find(|store| store.id().kind() == ::rerun::StoreKind::Recording).unwrap();
    let entities: BTreeSet<String> =
        store.iter_physical_chunks().map(|chunk| chunk.entity_path().to_string()).collect();
    for entity in ["/energy/lecture", "/energy/time-stepping", "/world/cases/lecture/cube", "/headline"] {
        assert!(entities.contains(entity) || entities.contains(&entity.replace('-', "\\-")), "{entity}: {entities:?}");
    }
    // They are shown together again from the folder; without a viewer that is all.
    let output = crate::cli::gotai(&["view", out]).env("PATH", "").output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(folder.path().join("replays").join(format!("{name}.rrd")).exists());
}

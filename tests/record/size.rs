//! How large files become, and what is said of what they leave out.

use super::story::recorded;
use super::synthetic::{self as s, ALL};
use gotai::record::Recorder;
use gotai::record::rerun::RerunRecorder;
use gotai::record::sample::{Batch, ContactSample, EnergySample, Header, contact_mode};
use gotai::rows::BodyRow;

const BODIES: usize = 1_000;
const CONTACTS: usize = 4_000;
const SAMPLES: usize = 600;

/// A number that looks random, from −1 to 1.
fn noise(i: usize) -> f64 {
    let x = libm::sin(i as f64 * 12.9898) * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

/// All bodies and contacts move, as in a pile that is stirred: nothing is like the sample before.
fn batch(from: usize, to: usize) -> Batch {
    let mut batch = Batch::default();
    for i in from..to {
        batch.step.push(i as u64);
        batch.time_s.push(i as f64 / 60.0);
        batch.bodies.extend((0..BODIES).map(|body| {
            let at = |k: usize| noise(8 * body + k) + 1e-2 * noise(1_000_003 * i + 8 * body + k);
            BodyRow {
                position_m: [at(0), at(1), at(2)],
                orientation_xyzw: [at(3), at(4), at(5), at(6)],
                ..BodyRow::default()
            }
        }));
        batch.contacts_len.push(CONTACTS as u32);
        batch.contacts.extend((0..CONTACTS).map(|contact| {
            let at = |k: usize| noise(1_000_003 * i + 500_000 + 8 * contact + k);
            let (normal, force_n) = ([0.0, 1.0, 0.0], [at(3), 9.8 + at(4), at(5)]);
            let (mode, friction_use) = contact_mode(force_n, normal, 0.5);
            let (body, point_m) = ((contact % BODIES) as u32, [at(0), at(1), at(2)]);
            ContactSample { body, other: None, point_m, normal, force_n, gap_m: 0.0, friction_use, mode }
        }));
        batch.energy.push(EnergySample { kinetic_j: 1.0, potential_j: 1.0, total_j: 2.0, penetration_m: 0.0 });
    }
    batch
}

fn header(most_bytes: u64) -> Header {
    let mut header = Header { end_s: 10.0, most_bytes, ..s::header(ALL) };
    let body = header.bodies[0].clone();
    header.bodies =
        (0..BODIES).map(|i| gotai::record::sample::BodyHeader { name: format!("cube[{i}]"), ..body.clone() }).collect();
    header
}

#[test]
fn a_thousand_bodies_for_ten_seconds_fit_into_60_mb() {
    let folder = crate::scratch::folder();
    let path = folder.path().join("a.rrd");
    let mut file = RerunRecorder::create(&path, &header(1 << 40)).unwrap();
    for from in (0..SAMPLES).step_by(15) {
        file.write(&batch(from, from + 15)).unwrap();
    }
    assert!(file.heads() <= 8, "{} entities of one shape in eight colours", file.heads());
    Box::new(file).finish(&s::ending()).unwrap();
    let megabytes = std::fs::metadata(&path).unwrap().len() as f64 / 1e6;
    assert!(megabytes < 60.0, "{megabytes}"); // 92 bytes of numbers a body and a contact: 55 MB, less what repeats
}

#[test]
fn a_page_says_what_is_left_out() {
    let sets = ["--set", "record.every_s=0", "--set", "record.max_mb=0.25", "--set", "time.end_s=4"];
    let (_, _folder, file, recording) = recorded(&[&["configs/lecture/demo.yaml"][..], &sets].concat());
    assert!(std::fs::metadata(&file).unwrap().len() <= 250_000);
    let ending = recording.ending.unwrap();
    assert!(ending.left_out > 0 && ending.left_out.to_string() == recording.said["left_out"]);
    // What is due is left out evenly: no tenth of the run lacks all of it.
    let tenths: std::collections::BTreeSet<u64> = recording.samples.time_s.iter().map(|t| (t / 0.4) as u64).collect();
    assert!(tenths.len() >= 10, "{tenths:?}");
}

/// What an .mcap alone is shown as is what its run would have written.
#[test]
fn an_mcap_opens_as_its_rrd_would() {
    let (_, folder, _, _) = recorded(&super::story::EXPLODES);
    let out = folder.path().to_str().unwrap();
    let view = crate::cli::gotai(&["view", out]).env("PATH", "").output().unwrap();
    assert_eq!(view.status.code(), Some(3), "{}", String::from_utf8_lossy(&view.stderr));
    let rrd_of = |dir: &std::path::Path| {
        let mut files = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
        files.find(|path| path.extension().is_some_and(|ending| ending == "rrd")).unwrap()
    };
    let made = rrd_of(&folder.path().join("replays"));
    let again = crate::scratch::folder();
    let to = again.path().to_str().unwrap();
    crate::cli::json(&[&["run"], &super::story::EXPLODES[..], &["--record", "rerun", "--json", "--out", to]].concat());
    let own = rrd_of(again.path());
    let (made, own) = (super::rerun::whole(&made), super::rerun::whole(&own));
    // Pictures of the bodies that another one at the same time stands for are left out by either.
    let but_bodies = |rows: &std::collections::BTreeMap<String, usize>| {
        let others = rows.iter().filter(|(entity, _)| !entity.starts_with("/world/bodies"));
        others.map(|(entity, count)| (entity.clone(), *count)).collect::<Vec<_>>()
    };
    assert_eq!(but_bodies(&made.0), but_bodies(&own.0));
    assert_eq!(made.1, own.1);
}

/// Recordings of one name, of two folders: a case of two builds, say.
#[test]
fn cases_of_one_name_are_told_apart_by_their_folders() {
    let (_, first, a, _) = recorded(&super::story::EXPLODES);
    let second = crate::scratch::folder();
    let b = second.path().join(a.file_name().unwrap());
    std::fs::copy(&a, &b).unwrap();
    let view = crate::cli::gotai(&["view", a.to_str().unwrap(), b.to_str().unwrap()]).env("PATH", "").output().unwrap();
    let err = String::from_utf8_lossy(&view.stderr);
    assert!(view.status.code() == Some(3) && !err.contains("another scene"), "{err}");
    let mut files = std::fs::read_dir(first.path()).unwrap().map(|entry| entry.unwrap().path());
    let made = files.find(|path| path.extension().is_some_and(|ending| ending == "rrd")).unwrap();
    let (rows, page) = super::rerun::whole(&made);
    for folder in [first.path(), second.path()] {
        let name = folder.file_name().unwrap().to_str().unwrap();
        assert!(page.contains(&gotai::record::story::markdown(&format!(" in {name}"))), "{page}");
        assert!(rows.keys().any(|entity| entity.starts_with("/energy/") && entity.contains(name)), "{:?}", rows.keys());
    }
}

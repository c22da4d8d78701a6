//! What is left of a recording whose program was killed, and what the commands say of it.

use super::story::{EXPLODES, recorded};
use super::synthetic::{self as s, ALL};
use crate::cli::{gotai, run};
use crate::scratch;
use gotai::record::Recorder;
use gotai::record::mcap::McapRecorder;
use gotai::record::read::{ReadBack, recording_of};
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A pile that takes tens of milliseconds a step: no batch of 1,000 samples is full for a minute.
const SLOW: [&str; 4] = ["run", "configs/stack/pile.yaml", "--set", "scene.bodies.cube.copies.grid=[4,4,4]"];

fn partial(dir: &Path) -> Option<PathBuf> {
    let mut files = std::fs::read_dir(dir).ok()?.filter_map(|entry| Some(entry.ok()?.path()));
    files.find(|path| path.to_string_lossy().ends_with(".partial.mcap"))
}

#[test]
fn a_kill_of_a_slow_scene_loses_little() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let to = if cfg!(feature = "rerun") { "both" } else { "mcap" };
    let arguments = [&SLOW[..], &["--record", to, "--quiet", "--out", out]].concat();
    let mut child = gotai(&arguments).stdout(Stdio::null()).spawn().unwrap();
    let started = Instant::now();
    let samples = |recording: &ReadBack| recording.samples.len();
    let read = || partial(folder.path()).and_then(|path| recording_of(&path).ok().flatten());
    while (read().as_ref().map_or(0, samples) < 3 || !shows(folder.path()))
        && started.elapsed() < Duration::from_secs(60)
    {
        std::thread::sleep(Duration::from_millis(50));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let recording = read().unwrap();
    assert!((3..1000).contains(&samples(&recording)) && recording.is_cut, "{}", samples(&recording));
    // Both open.
    let mcap = partial(folder.path()).unwrap();
    for file in [mcap.clone(), mcap.with_extension("rrd")].into_iter().take(if to == "both" { 2 } else { 1 }) {
        let (code, out, err) = run(&["repair", file.to_str().unwrap()]);
        assert!(code == 0 && out.contains("it ends at t = "), "{}: {out}{err}", file.display());
    }
}

/// Time at which a copy of a file ends; None of one without a sample.
fn ends_at(file: &Path, dir: &Path) -> Option<f64> {
    let copy = dir.join(file.file_name()?);
    std::fs::copy(file, &copy).ok()?;
    let (_, out, err) = run(&["repair", copy.to_str()?]);
    format!("{out}{err}").split("ends at t = ").nth(1)?.split(' ').next()?.parse().ok()
}

/// At every step, so that batches take the place of what stands ahead many times a second.
#[test]
fn what_was_read_before_a_kill_is_there_after_it() {
    let to = if cfg!(feature = "rerun") { "both" } else { "mcap" };
    let sets = [
        "--set",
        "time.end_s=1e5",
        "--set",
        "record.every_s=0",
        "--set",
        "record.max_mb=1000",
        "--set",
        "plan={skip: []}",
    ];
    for kill in 0..6 {
        let (folder, copies) = (scratch::folder(), scratch::folder());
        let out = folder.path().to_str().unwrap();
        let begun = ["run", "configs/lecture/demo.yaml", "--record", to, "--quiet", "--out", out];
        let arguments = [&begun[..], &sets[..]].concat();
        let mut child = gotai(&arguments).stdout(Stdio::null()).spawn().unwrap();
        let started = Instant::now();
        while partial(folder.path()).is_none() && started.elapsed() < Duration::from_secs(60) {
            std::thread::sleep(Duration::from_millis(5));
        }
        std::thread::sleep(Duration::from_millis(200 + 137 * kill));
        let mcap = partial(folder.path()).unwrap();
        let files: Vec<PathBuf> =
            [mcap.clone(), mcap.with_extension("rrd")].into_iter().filter(|f| f.is_file()).collect();
        let read: Vec<Option<f64>> = files.iter().map(|file| ends_at(file, copies.path())).collect();
        child.kill().unwrap();
        child.wait().unwrap();
        for (file, before_s) in files.iter().zip(read) {
            let after_s = ends_at(file, copies.path());
            assert!(before_s.is_some() && after_s >= before_s, "{}: {before_s:?}, {after_s:?}", file.display());
        }
    }
}

/// The .rrd has samples too, if there is one.
#[cfg(feature = "rerun")]
fn shows(dir: &Path) -> bool {
    let whole = partial(dir).and_then(|mcap| gotai::record::rerun::mend::whole_of(&mcap.with_extension("rrd")).ok());
    whole.flatten().is_some()
}

#[cfg(not(feature = "rerun"))]
fn shows(_: &Path) -> bool {
    true
}

/// A recording cut behind its head, which holds as many samples.
fn cut_after(dir: &Path, samples: u64) -> PathBuf {
    let path = dir.join("cut.mcap");
    let mut recorder = McapRecorder::create(&path, &s::header(ALL)).unwrap();
    if samples > 0 {
        recorder.write(&s::batch(0..samples, ALL)).unwrap();
    }
    // No destructor runs, as after SIGKILL.
    std::mem::forget(recorder);
    path
}

#[test]
fn tables_of_a_cut_recording_say_so() {
    let (_, folder, file, recording) = recorded(&EXPLODES);
    let bytes = std::fs::read(&file).unwrap();
    let torn = folder.path().join("torn.mcap");
    std::fs::write(&torn, &bytes[..bytes.len() - 40]).unwrap();
    let (code, out, err) = run(&["export", torn.to_str().unwrap()]);
    let ends = format!("it ends at t = {} s", recording.until_s().unwrap());
    assert!(code == 0 && err.contains("the file was cut") && err.contains(&ends), "{err}");
    assert!(err.contains("gotai repair") && out.lines().count() == 3, "{out}{err}");
    // A whole one says nothing, a mended one that its run has no end.
    let (code, _, err) = run(&["export", file.to_str().unwrap()]);
    assert_eq!((code, err.as_str()), (0, ""));
}

#[test]
fn a_recording_with_nothing_in_it_leaves_no_table() {
    let folder = scratch::folder();
    let table = folder.path().join("cut.series.csv");
    std::fs::write(&table, "older").unwrap();
    let cut = cut_after(folder.path(), 0);
    let (code, out, err) = run(&["export", cut.to_str().unwrap()]);
    assert!(code == 2 && out.is_empty(), "{out}{err}");
    // What another file has made does not stand as if it were of this one, and is not lost.
    assert!(!table.exists() && folder.path().join("cut.series.csv.old").exists(), "{err}");
}

#[test]
fn nothing_is_mended_of_a_file_with_nothing_in_it() {
    let folder = scratch::folder();
    let file = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let mut files = vec![
        file("empty.mcap", b""),
        file("head.mcap", ::mcap::MAGIC),
        file("noise.mcap", &[::mcap::MAGIC, &[7; 400]].concat()),
        file("other.mcap", b"no recording"),
        cut_after(folder.path(), 0),
    ];
    if cfg!(feature = "rerun") {
        files.extend([file("empty.rrd", b""), file("three.rrd", b"RRF"), file("other.rrd", b"no recording at all")]);
    }
    for file in files {
        let (code, out, err) = run(&["repair", file.to_str().unwrap()]);
        assert!(code == 2 && out.is_empty(), "{}: {out}{err}", file.display());
    }
    let made = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(made.into_iter().all(|name| !name.to_string_lossy().contains("repaired")));
}

/// A file of the format that another program has written is not ours to mend.
#[test]
fn a_whole_file_of_another_program_is_refused() {
    let folder = scratch::folder();
    let path = folder.path().join("foreign.mcap");
    let mut writer = ::mcap::Writer::new(std::io::BufWriter::new(std::fs::File::create(&path).unwrap())).unwrap();
    let channel = writer.add_channel(0, "/chatter", "json", &Default::default()).unwrap();
    let header = ::mcap::records::MessageHeader { channel_id: channel, sequence: 0, log_time: 0, publish_time: 0 };
    writer.write_to_known_channel(&header, b"{}").unwrap();
    writer.finish().unwrap();
    drop(writer);
    for command in ["view", "export", "repair"] {
        let (code, out, err) = run(&[command, path.to_str().unwrap()]);
        assert!(code == 2 && out.is_empty() && err.contains("expected a recording of gotai"), "{command}: {out}{err}");
    }
}

#[test]
fn what_is_no_recording_is_not_opened() {
    let folder = scratch::folder();
    for (name, bytes) in
        [("empty.rrd", &b""[..]), ("three.rrd", b"RRF"), ("other.rrd", b"no recording"), ("empty.mcap", b"")]
    {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let (code, _, err) = run(&["view", path.to_str().unwrap()]);
        assert!(code == 2 && err.contains("expected a recording of gotai"), "{name}: {err}");
    }
}

/// An .rrd is made of an .mcap before a viewer is looked for.
#[cfg(feature = "rerun")]
#[test]
fn a_cut_recording_is_shown_with_a_line() {
    let (_, folder, file, _) = recorded(&EXPLODES);
    let bytes = std::fs::read(&file).unwrap();
    let torn = folder.path().join("torn.mcap");
    std::fs::write(&torn, &bytes[..bytes.len() - 40]).unwrap();
    let view = |path: &Path| {
        let output = gotai(&["view", path.to_str().unwrap()]).env("PATH", "").output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, err) = view(&torn);
    assert!(code == Some(3) && err.contains("the file was cut; it ends at t = "), "{err}");
    let made = |dir: &Path| {
        let files = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path());
        files.into_iter().find(|path| path.extension().is_some_and(|ending| ending == "rrd"))
    };
    let shown = made(folder.path()).unwrap();
    // The same of an .rrd, and the folder's only row.
    let bytes = std::fs::read(&shown).unwrap();
    assert!(!view(&shown).1.contains("was cut"));
    let torn = folder.path().join("torn.rrd");
    std::fs::write(&torn, &bytes[..bytes.len() - 40]).unwrap();
    assert!(view(&torn).1.contains("the file was cut; it ends at t = "));
    let (code, out, err) = run(&["repair", torn.to_str().unwrap()]);
    assert!(code == 0 && out.contains("messages; it ends at t = "), "{out}{err}");
    assert_eq!(view(folder.path()).0, Some(3));
    assert!(made(&folder.path().join("replays")).is_some());
}

//! Runs that a signal ends: what they have recorded is whole, and there is no row.

use crate::cli::gotai;
use crate::scratch;
use gotai::record::read::recording_of;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

const ENDLESS: [&str; 6] = ["run", "configs/lecture/demo.yaml", "--set", "time.end_s=1e5", "--record", "both"];

fn stopped_by(signal: &str) -> (Option<i32>, Vec<PathBuf>) {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap().to_string();
    let to = if cfg!(feature = "rerun") { &ENDLESS[..] } else { &ENDLESS[..4] };
    let arguments = [to, &["--quiet", "--out", &out]].concat();
    let mut child = gotai(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let files = || -> Vec<PathBuf> {
        let entries = std::fs::read_dir(folder.path()).map(|all| all.flatten().map(|entry| entry.path()).collect());
        entries.unwrap_or_default()
    };
    let began = || files().iter().any(|path| path.to_string_lossy().ends_with(".partial.mcap"));
    let started = Instant::now();
    while !began() && started.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(300));
    Command::new("kill").args([format!("-{signal}"), child.id().to_string()]).status().unwrap();
    let code = child.wait().unwrap().code();
    let recordings = files().into_iter().filter(|path| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        matches!(ending, Some("mcap" | "rrd"))
    });
    let recordings: Vec<PathBuf> = recordings.collect();
    let mcap = recordings.iter().find(|path| path.extension().is_some_and(|ending| ending == "mcap")).unwrap();
    let recording = recording_of(mcap).unwrap().unwrap();
    assert!(!recording.is_cut && recording.samples.len() > 1, "{}", recording.samples.len());
    let ending = recording.ending.unwrap();
    assert_eq!(ending.criterion.as_deref(), Some("interrupted"));
    assert_eq!(recording.samples.time_s.last(), Some(&ending.end_time_s));
    assert!(!folder.path().join("rows.csv").exists());
    (code, recordings)
}

#[cfg(unix)]
#[test]
fn a_run_that_is_interrupted_leaves_whole_recordings_and_no_row() {
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let (found, recordings) = stopped_by(signal);
        assert_eq!(found, Some(code), "{signal}");
        assert_eq!(recordings.len(), if cfg!(feature = "rerun") { 2 } else { 1 }, "{recordings:?}");
        let named = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().starts_with("demo_stalled.");
        assert!(recordings.iter().all(named), "{recordings:?}");
    }
}

#[test]
fn a_run_goes_on_without_a_viewer() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let arguments = ["run", "configs/smoke.yaml", "--set", "method=time-stepping", "--record", "mcap", "--out", out];
    let output = gotai(&[&arguments[..], &["--live=1"]].concat()).env("PATH", "").output().unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{err}");
    assert!(err.contains("the run goes on without a viewer"), "{err}");
}

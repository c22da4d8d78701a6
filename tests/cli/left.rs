//! What a kill or a full disk leaves, and what the commands say of it.

use super::{json, run};
use crate::scratch;
use gotai::record::read::recording_of;
use serde_json::Value;

const DEMO: [&str; 4] = ["run", "configs/lecture/demo.yaml", "--set", "time.end_s=1.2"];

#[test]
fn a_recording_that_cannot_be_written_is_said_in_the_one_document() {
    let folder = scratch::folder();
    let out = folder.path().join("out");
    let args = [&DEMO[..], &["--json", "--record", "mcap", "--out", out.to_str().unwrap()]].concat();
    let name = json(&args)["recording"].as_str().unwrap().to_string();
    // A folder has taken its name.
    let file = out.join(format!("{name}.mcap"));
    std::fs::remove_file(&file).unwrap();
    std::fs::create_dir_all(file.join("taken")).unwrap();
    let (code, text, err) = run(&args);
    assert_eq!((code, text.lines().count()), (3, 1), "{text}{err}");
    let document: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&document["exit_code"], &document["outcome"]), (&Value::from(3), &Value::from("finished")));
    assert!(document["error"].is_string() && document["recording"].is_null(), "{document}");
}

#[test]
fn half_written_recordings_are_named_with_what_mends_them() {
    let folder = scratch::folder();
    let out = folder.path().join("out & x");
    let given = out.to_str().unwrap();
    let short = ["--set", "time.end_s=0.2"];
    json(&[&["sweep", "configs/smoke.yaml", "--record", "none", "--json", "--out", given][..], &short].concat());
    for (rows, partials) in [("", 0), ("", 1), ("", 2)] {
        std::fs::write(out.join("journal.jsonl"), rows).unwrap();
        if partials > 0 {
            std::fs::write(out.join(format!("{partials:016x}.partial.mcap")), "cut").unwrap();
        }
        for command in ["view", "export"] {
            let (code, _, err) = run(&[command, given]);
            assert!(code == 2 && !err.contains("--where"), "{err}");
            let mend = format!("`gotai repair '{given}/{:016x}.partial.mcap'`", 1);
            assert_eq!(err.contains(&mend), partials > 0, "{command} {partials}: {err}");
            assert_eq!(err.contains("2 were cut"), partials == 2, "{command} {partials}: {err}");
        }
    }
    let (code, _, err) = run(&["repair", given]);
    assert!(code == 2 && err.contains("found a folder") && err.contains("gotai repair '"), "{err}");
}

/// A message may have a later time than the last sample that is whole.
#[test]
fn a_mended_recording_ends_where_its_last_sample_is() {
    let folder = scratch::folder();
    let args = [&DEMO[..], &["--json", "--record", "mcap", "--out", folder.path().to_str().unwrap()]].concat();
    let name = json(&args)["recording"].as_str().unwrap().to_string();
    let bytes = std::fs::read(folder.path().join(format!("{name}.mcap"))).unwrap();
    let torn = folder.path().join("torn.mcap");
    for part in [0.5, 0.6, 0.7, 0.8, 0.9] {
        std::fs::write(&torn, &bytes[..(bytes.len() as f64 * part) as usize]).unwrap();
        let (code, text, err) = run(&["repair", torn.to_str().unwrap()]);
        assert_eq!(code, 0, "{err}");
        let mended = recording_of(&folder.path().join("torn.repaired.mcap")).unwrap().unwrap();
        let until = mended.until_s().map_or("it holds no sample".into(), |t| format!("it ends at t = {t} s"));
        assert!(text.contains(&until), "{part}: {until}: {text}");
    }
}

#[cfg(feature = "rerun")]
#[test]
fn a_cut_rrd_is_said_to_be_cut() {
    let folder = scratch::folder();
    let args = [&DEMO[..], &["--json", "--record", "rerun", "--out", folder.path().to_str().unwrap()]].concat();
    let name = json(&args)["recording"].as_str().unwrap().to_string();
    let bytes = std::fs::read(folder.path().join(format!("{name}.rrd"))).unwrap();
    let torn = folder.path().join("torn.rrd");
    for (length, said) in [(bytes.len() - 40, "found an .rrd that was cut"), (20, "cut in its head")] {
        std::fs::write(&torn, &bytes[..length]).unwrap();
        let (code, _, err) = run(&["export", torn.to_str().unwrap()]);
        assert!(code == 2 && err.contains(said), "{said}: {err}");
    }
}

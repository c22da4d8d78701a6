//! A folder of results as a colleague gets it: which question, which method, which case exploded, show it again.

use super::{ROOT, gotai, json, run};
use crate::scratch;
use gotai::sweep::journal::{Entry, Journal, line};
use parquet::file::reader::{FileReader, SerializedFileReader};
use serde_json::{Value, json as value};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

const STABILITY: &str = "configs/lecture/stability.yaml";

/// The lecture's map, 2 × 3 × 2 cases of 4 s; some explode.
fn small_map<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let map = [
        "sweep",
        STABILITY,
        "--out",
        out,
        "--axis",
        "scene.bodies.body=[cube 125, ico 162]",
        "--axis",
        "time.step_s=[0.002, 0.02, 0.05]",
        "--axis",
        "seed=0..1",
    ];
    [&map[..], more].concat()
}

fn files(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let all = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file());
    all.map(|path| (path.file_name().unwrap().to_str().unwrap().to_string(), std::fs::read(path).unwrap())).collect()
}

#[test]
fn a_folder_tells_its_question_and_shows_a_case_again() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    json(&small_map(out, &["--json", "--record", "mcap"]));
    let status = json(&["status", out, "--json"]);
    assert_eq!(status["question"], "Which mesh explodes at which time step?");
    assert_eq!(
        (&status["methods"], &status["cases"], &status["recordings"]),
        (&value!(["lecture"]), &12.into(), &12.into())
    );
    // The plan holds the axes, experiment.yaml makes the same plan again.
    let plan: Value = serde_json::from_slice(&std::fs::read(folder.path().join("plan.json")).unwrap()).unwrap();
    assert_eq!((&plan["format"], plan.get("cases")), (&3.into(), None));
    assert_eq!(plan["axes"][0], value!({ "path": "scene.bodies.body", "values": ["cube 125", "ico 162"] }));
    let kept = folder.path().join("experiment.yaml");
    let again = json(&["sweep", kept.to_str().unwrap(), "--out", out, "--json", "--record", "mcap"]);
    assert_eq!(again["ran"], 0);
    // Which exploded?
    let exploded = json(&["rows", out, "--where", "outcome=diverged", "--sort", "-time.step_s", "--json"]);
    let exploded = exploded.as_array().unwrap();
    assert!(!exploded.is_empty() && exploded.len() < 12, "{exploded:?}");
    let steps: Vec<f64> = exploded.iter().map(|row| row["time.step_s"].as_f64().unwrap()).collect();
    assert!(steps.is_sorted_by(|a, b| a >= b), "{steps:?}");
    // Show it again: the same, bit for bit, recorded at every step, and no row is touched.
    let before = files(folder.path());
    let id = exploded[0]["case"].as_str().unwrap();
    assert!(before.keys().any(|name| name.contains("_diverged.") && name.contains(&id[..8])), "{id}");
    let shown = json(&["run", out, "--case", &id[..12], "--json", "--record", "mcap"]);
    assert_eq!((&shown["case"], &shown["outcome"], &shown["differing"]), (&id.into(), &"diverged".into(), &value!([])));
    assert!(before == files(folder.path()));
    let replays = files(&folder.path().join("replays"));
    let name = format!("{}.mcap", shown["recording"].as_str().unwrap());
    assert!(replays.keys().eq([&name]) && before.contains_key(&name));
    let status = json(&["status", out, "--json"]);
    assert_eq!(status["bytes"]["replays"], replays[&name].len());
    // At 2 ms, five times as many samples as the sweep has recorded beside the steps about events.
    let fine = json(&["rows", out, "--where", "time.step_s=0.002", "--columns", "case,recording", "--json"])[0].clone();
    json(&["run", out, "--case", fine["case"].as_str().unwrap(), "--json", "--record", "mcap"]);
    let fine = format!("{}.mcap", fine["recording"].as_str().unwrap());
    let replay = folder.path().join("replays").join(&fine);
    assert!(std::fs::metadata(&replay).unwrap().len() > 3 * before[&fine].len() as u64 / 2);
    std::fs::remove_file(replay).unwrap();
    // Dropped again, and nothing else.
    let cleaned = json(&["clean", out, "--json"]);
    assert_eq!(
        (&cleaned["files"], &cleaned["rows"], &cleaned["bytes"]),
        (&1.into(), &0.into(), &replays[&name].len().into())
    );
    assert!(!folder.path().join("replays").exists());
    let recordings = |files: BTreeMap<String, Vec<u8>>| -> Vec<_> {
        files.into_iter().filter(|(name, _)| name.ends_with("mcap")).collect()
    };
    assert!(recordings(before) == recordings(files(folder.path())));
    assert_eq!(json(&["status", out, "--json"])["rows_hash"], status["rows_hash"]);
}

/// A colleague's recording holds its configuration.
#[test]
fn a_recording_is_run_again_from_itself() {
    let folder = scratch::folder();
    let out = folder.path().join("a");
    let out = out.to_str().unwrap();
    let set = "scene.bodies.cube.mass_kg=1e-5";
    let first = json(&["run", "configs/lecture/demo.yaml", "--out", out, "--set", set, "--json"]);
    let name = format!("{}.mcap", first["recording"].as_str().unwrap());
    let mailed = folder.path().join(&name);
    std::fs::copy(Path::new(out).join(&name), &mailed).unwrap();
    let there = folder.path().join("b");
    let again = json(&["run", mailed.to_str().unwrap(), "--out", there.to_str().unwrap(), "--json"]);
    for key in ["case", "bodies", "energy_drift_rel", "work_sweeps", "recording"] {
        assert_eq!(first[key], again[key], "{key}");
    }
    // What is no recording of ours says so.
    std::fs::write(&mailed, "no recording").unwrap();
    let (code, _, err) = run(&["run", mailed.to_str().unwrap()]);
    assert!(code == 2 && err.contains("expected a recording of gotai, found no experiment in it"), "{code} {err}");
}

#[test]
fn a_row_of_a_search_shows_its_run_at_search_low() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let search = "sweep.search={critical: time.step_s, between: [0.001, 0.05], until: {outcome: diverged}}";
    let meshes = "scene.bodies.body=[cube 27, ico 162]";
    let fixed = ["--set", "seed=0", "--set", "time.step_s=0.01", "--set", search, "--axis", meshes];
    let args = [&["sweep", STABILITY, "--out", out, "--json"], &fixed[..]].concat();
    let Value::Array(rows) = json(&args)["rows"].clone() else { panic!("no rows") };
    for row in &rows {
        let shown = json(&["run", out, "--case", &row["case"].as_str().unwrap()[..8], "--json"]);
        assert_eq!(shown["differing"], value!([]));
        assert_eq!(shown["steps"], row["steps"]);
    }
}

#[test]
fn a_row_of_another_build_is_run_and_what_differs_is_said() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    json(&small_map(out, &["--json", "--record", "mcap"]));
    let journal = folder.path().join("journal.jsonl");
    let mut entries: Vec<Entry> = Journal::read(folder.path()).unwrap().rows.into_values().collect();
    entries.sort_by_key(|entry| entry.case.clone());
    for entry in &mut entries[..2] {
        entry.build = "abcdef012345".into();
    }
    entries[0].measured.contacts_max += 1;
    std::fs::write(&journal, entries.iter().map(line).collect::<String>()).unwrap();
    let shown = json(&["run", out, "--case", &entries[0].case, "--json", "--record", "none"]);
    let contacts = entries[0].measured.contacts_max;
    assert_eq!(shown["differing"], value!([["contacts_max", contacts, contacts - 1]]));
    assert_eq!(shown["row_build"], "abcdef012345");
    let (code, _, err) = run(&["run", out, "--case", &entries[1].case, "--record", "none"]);
    assert!(code == 0 && err.contains("the same as the row of another build (abcdef012345, this is "), "{err}");
    // Its own row that is not met is a fault of the program.
    entries[2].measured.contacts_max += 1;
    std::fs::write(&journal, entries.iter().map(line).collect::<String>()).unwrap();
    let (code, _, err) = run(&["run", out, "--case", &entries[2].case, "--record", "none"]);
    assert!(code == 3 && err.contains("the recorded run differs"), "{code} {err}");
    // They count as missing until they are taken, or dropped.
    assert_eq!(json_of(&["status", out, "--json"], 1)["of_another_build"], 2);
    assert_eq!(json(&["status", out, "--json", "--keep"])["missing"], 0);
    assert_eq!(json(&["clean", out, "--json"])["rows"], 2);
    assert_eq!(json_of(&["status", out, "--json"], 1)["of_another_build"], 0);
}

fn json_of(args: &[&str], expected: i32) -> Value {
    let (code, out, err) = run(args);
    assert_eq!(code, expected, "{err}");
    serde_json::from_str(&out).unwrap()
}

#[test]
fn what_is_asked_wrongly_of_a_folder_is_said_clearly() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    json(&small_map(out, &["--json", "--record", "none", "--set", "time.end_s=0.1"]));
    let all = json(&["rows", out, "--columns", "case", "--json"]);
    let ids: Vec<&str> = all.as_array().unwrap().iter().map(|row| row["case"].as_str().unwrap()).collect();
    let shared = (1..16).find_map(|len| {
        let begins = |id: &&&str| ids.iter().filter(|other| other[..1] == id[..1]).count() > 1;
        (len == 1).then(|| ids.iter().find(begins).map(|id| &id[..1]))?
    });
    let shared = shared.expect("of 12 ids two begin with the same digit");
    let both: Vec<&&str> = ids.iter().filter(|id| id.starts_with(shared)).take(2).collect();
    let cases: [(&[&str], &[&str]); 12] = [
        (&["run", out, "--case", shared], &["expected enough digits for one row", both[0], both[1]]),
        (&["run", out, "--case", "xyz"], &["expected the first digits of a row's id", "gotai rows"]),
        (&["run", out, "--case", ""], &["expected the first digits of a row's id"]),
        (&["run", out], &["found a folder of results", "--case ID", "gotai sweep"]),
        (&["run", "configs/lecture"], &["found a folder", "gotai sweep configs/lecture"]),
        (&["run", out, "--case", ids[0], "--set", "seed=1"], &["--set", "as it was"]),
        (&["run", "configs/lecture/demo.yaml", "--case", ids[0]], &["found no plan.json in it"]),
        (&["rows", out, "--where", "outcme=diverged"], &["--where", "`outcme`", "did you mean `outcome`?"]),
        (&["rows", out, "--where", "outcome=fnished"], &["expected one of finished, diverged, stalled, failed"]),
        (&["rows", out, "--where", "seed=7"], &["--where seed=7", "expected one of 0, 1"]),
        (&["rows", out, "--where", "seed"], &["expected COLUMN=VALUE", "found `seed`"]),
        (&["sweep", out], &["found a folder of results", "experiment.yaml --out"]),
    ];
    for (args, messages) in cases {
        let (code, said, err) = run(args);
        assert_eq!((code, said.as_str(), err.trim_end().lines().count()), (2, "", 1), "{args:?}: {err}");
        for message in messages {
            assert!(err.contains(message), "{args:?}: {message}: {err}");
        }
    }
    // A configuration that was changed by hand is not the one that was run.
    let kept = folder.path().join("experiment.yaml");
    let text = std::fs::read_to_string(&kept).unwrap();
    std::fs::write(&kept, text.replace("friction: 0.3", "friction: 0.2")).unwrap();
    let (code, _, err) = run(&["status", out]);
    assert!(
        code == 2 && err.contains("plan.json is not what experiment.yaml beside it makes; `gotai sweep "),
        "{code} {err}"
    );
}

#[test]
fn rows_are_chosen_sorted_and_printed() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    json(&small_map(out, &["--json", "--record", "none"]));
    let (code, csv, _) =
        run(&["rows", out, "--columns", "time.step_s,seed,energy_drift_rel", "--sort", "seed,-time.step_s", "--csv"]);
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!((code, lines.len(), lines[0]), (0, 13, "time.step_s,seed,energy_drift_rel"));
    let firsts: Vec<&str> = lines[1..].iter().map(|line| line.rsplit_once(',').unwrap().0).collect();
    let expected =
        [0, 1].map(|seed| ["0.05", "0.02", "0.002"].map(|step| [format!("{step},{seed}"), format!("{step},{seed}")]));
    assert_eq!(firsts, expected.concat().concat());
    // The same numbers as in the table, to the last bit.
    let mut table = csv::Reader::from_path(folder.path().join("rows.csv")).unwrap();
    let column = table.headers().unwrap().iter().position(|name| name == "energy_drift_rel").unwrap();
    let mut drifts: Vec<String> = table.records().map(|row| row.unwrap()[column].to_string()).collect();
    let mut printed: Vec<String> = lines[1..].iter().map(|line| line.rsplit_once(',').unwrap().1.to_string()).collect();
    drifts.sort();
    printed.sort();
    assert_eq!(drifts, printed);
    let count = |filters: &[&str]| {
        let filters: Vec<&str> = filters.iter().flat_map(|filter| ["--where", filter]).collect();
        json(&[&["rows", out, "--json"], &filters[..]].concat()).as_array().unwrap().len()
    };
    assert_eq!(count(&["time.step_s<=0.02", "seed=1"]), 4);
    assert_eq!(count(&["scene.bodies.body=ico 162"]), 6);
    let id = json(&["rows", out, "--columns", "case", "--json"])[3]["case"].as_str().unwrap()[..8].to_string();
    assert_eq!(count(&[&format!("case={id}")]), 1);
    assert_eq!(count(&["scene.bodies.body!=ico 162", "time.step_s>0.02"]), 2);
    assert_eq!(
        json(&["rows", out, "--columns", "all", "--json"])[0].as_object().unwrap().len(),
        csv_width(folder.path())
    );
    let (_, text, _) = run(&["rows", out]);
    assert!(text.contains("ico 162") && text.lines().all(|line| line.chars().count() <= 140), "{text}");
}

fn csv_width(dir: &Path) -> usize {
    csv::Reader::from_path(dir.join("rows.csv")).unwrap().headers().unwrap().len()
}

#[test]
fn parquet_says_question_units_program_and_format() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    json(&small_map(out, &["--json", "--record", "none", "--set", "time.end_s=0.1"]));
    let file = SerializedFileReader::new(File::open(folder.path().join("rows.parquet")).unwrap()).unwrap();
    let said = file.metadata().file_metadata().key_value_metadata().unwrap();
    let said: BTreeMap<_, _> = said.iter().map(|said| (said.key.as_str(), said.value.clone().unwrap())).collect();
    assert_eq!(said["question"], "Which mesh explodes at which time step?");
    assert_eq!((said["program"].as_str(), said["format"].as_str()), (gotai::build_info::PROGRAM, "3"));
    assert_eq!(said["rows_hash"], json(&["status", out, "--json"])["rows_hash"].as_str().unwrap());
    let units: Value = serde_json::from_str(&said["units"]).unwrap();
    for (column, unit) in [("time.step_s", "s"), ("energy_start_j", "J"), ("penetration_max_m", "m"), ("wall_s", "s")] {
        assert_eq!(units[column], unit, "{column}");
    }
    assert!(units.get("energy_drift_rel").is_none() && units.get("steps").is_none(), "{units}");
}

/// Whoever kills it, and when: the same rows in the end, every recording whole, nothing half-written left.
#[test]
fn thirty_kills_change_no_row_and_leave_no_half_file() {
    let (whole, killed) = (scratch::folder(), scratch::folder());
    let [a, b] = [&whole, &killed].map(|folder| folder.path().to_str().unwrap());
    let more = ["--quiet", "--set", "record.every_s=0", "--set", "record.cases=all"];
    assert_eq!(run(&small_map(a, &more)).0, 0);
    let mut random = 12345_u64;
    for _ in 0..30 {
        random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let mut child = gotai(&small_map(b, &more)).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(2 + (random >> 33) % 120));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert_eq!(run(&small_map(b, &more)).0, 0);
    let hash = |out: &str| json(&["status", out, "--json"])["rows_hash"].clone();
    assert_eq!(hash(a), hash(b));
    let (whole, killed) = (files(whole.path()), files(killed.path()));
    assert!(whole.keys().eq(killed.keys()), "{:?} {:?}", whole.keys(), killed.keys());
    let mcaps = |files: BTreeMap<String, Vec<u8>>| -> BTreeMap<_, _> {
        files.into_iter().filter(|(name, _)| name.ends_with(".mcap")).collect()
    };
    let (whole, killed) = (mcaps(whole), mcaps(killed));
    assert!(whole.len() == 12 && whole == killed);
}

/// Default folder: what is set and which axes are given, in their order.
#[test]
fn axes_on_the_command_line_are_in_the_name_of_the_folder() {
    let folder = scratch::folder();
    let config = format!("{ROOT}/configs/smoke.yaml");
    let args = ["sweep", &config, "--record", "none", "--quiet"];
    let given = ["--axis", "seed=0..1", "--set", "time.end_s=0.1", "--axis", "method=[free, penalty]"];
    let output = gotai(&[&args[..], &given].concat()).current_dir(folder.path()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let out = folder.path().join("recordings/smoke+seed=0..1+time.end-s=0.1+method=-free--penalty-");
    let rows = std::fs::read_to_string(out.join("rows.csv")).unwrap();
    // The order of the file, the label of the file's own value, and the new axis last.
    let firsts: Vec<_> =
        rows.lines().map(|line| line.split(',').skip(1).take(2).collect::<Vec<_>>().join(" ")).collect();
    assert_eq!(firsts, ["method seed", "free 0", "free 1", "penalty 0", "penalty 1"]);
}

/// What it cannot read it says, what it does not know it leaves alone, and it makes no table emptier for nothing.
#[test]
fn clean_drops_what_gotai_has_left_and_nothing_else() {
    let folder = scratch::folder();
    let (dir, out) = (folder.path(), folder.path().to_str().unwrap());
    json(&small_map(out, &["--json", "--record", "mcap", "--set", "time.end_s=0.1"]));
    let recording = files(dir).into_keys().find(|name| name.ends_with(".mcap")).unwrap();
    std::fs::create_dir(dir.join("replays")).unwrap();
    let users =
        ["replays/notes.txt", "reference-paper.json", "reference-0123.json", "Fig3.mcap"].map(|name| dir.join(name));
    users.iter().for_each(|path| std::fs::write(path, "mine").unwrap());
    std::fs::copy(dir.join(&recording), dir.join(format!("paper-{recording}"))).unwrap();
    for half in ["0123456789abcdef.partial.mcap", "plan.partial", "reference-0123456789abcdef.json"] {
        std::fs::write(dir.join(half), "half").unwrap();
    }
    assert_eq!(json(&["clean", out, "--json"])["files"], 3);
    assert!(users.iter().all(|path| path.exists()) && dir.join(format!("paper-{recording}")).exists());
    // Its journal on another system, with ends of lines translated, is the same journal.
    let before = json(&["status", out, "--json"])["rows_hash"].clone();
    let journal = dir.join("journal.jsonl");
    let text = std::fs::read_to_string(&journal).unwrap();
    std::fs::write(&journal, text.replace('\n', "\r\n")).unwrap();
    let cleaned = json(&["clean", out, "--json"]);
    assert_eq!((&cleaned["files"], &cleaned["rows"], &cleaned["unreadable_lines"]), (&0.into(), &0.into(), &0.into()));
    assert_eq!(json(&["status", out, "--json"])["rows_hash"], before);
    // Without it the tables are all there is.
    std::fs::remove_file(&journal).unwrap();
    json(&["clean", out, "--json"]);
    assert_eq!(std::fs::read_to_string(dir.join("rows.csv")).unwrap().lines().count(), 13);
    std::fs::write(&journal, text.replacen("finished", "FINISHED", 1)).unwrap();
    assert_eq!(json(&["clean", out, "--json"])["unreadable_lines"], 1);
}

#[test]
fn a_folder_of_somebody_else_is_left_alone() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    for name in ["experiment.yaml", "plan.json"] {
        let mine = folder.path().join(name);
        std::fs::write(&mine, "mine: 1 # with a comment").unwrap();
        let (code, _, err) = run(&["sweep", "configs/smoke.yaml", "--out", out]);
        assert!(code == 2 && err.contains("that no gotai has written"), "{code} {err}");
        assert_eq!(std::fs::read_to_string(&mine).unwrap(), "mine: 1 # with a comment");
        std::fs::remove_file(mine).unwrap();
    }
}

/// Of two at once one is told so, and what is written is whole.
#[test]
fn a_row_is_shown_again_by_one_program_at_a_time() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let long = ["--json", "--record", "none", "--axis", "seed=[0]", "--axis", "scene.bodies.body=[ico 162]"];
    let steps = ["--axis", "time.step_s=[2e-5]", "--out", out];
    let swept = json(&[&["sweep", STABILITY], &long[..], &steps[..]].concat());
    let case = swept["rows"][0]["case"].as_str().unwrap();
    let args = ["run", out, "--case", case, "--record", "mcap", "--quiet"];
    let mut first = gotai(&args).stdout(Stdio::null()).spawn().unwrap();
    let partial = folder.path().join(format!("replays/{case}.partial.mcap"));
    while !partial.exists() && first.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    let (code, _, err) = run(&args);
    let (cleaned, _, busy) = run(&["clean", out]);
    let was_running = first.try_wait().unwrap().is_none();
    assert!(first.wait().unwrap().success());
    if was_running {
        assert!(code == 3 && err.contains("another gotai is at work here"), "{code} {err}");
        assert!(cleaned == 3 && busy.contains("another gotai is at work here"), "{cleaned} {busy}");
    }
    let whole = folder.path().join(format!("replays/{}.mcap", json(&args_json(&args))["recording"].as_str().unwrap()));
    assert!(mcap::Summary::read(&std::fs::read(whole).unwrap()).unwrap().is_some());
}

fn args_json<'a>(args: &[&'a str]) -> Vec<&'a str> {
    args.iter().copied().chain(["--json"]).collect()
}

#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_exit_code_3() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    json(&small_map(out, &["--json", "--record", "none", "--set", "time.end_s=0.1"]));
    let full = File::options().write(true).open("/dev/full").unwrap();
    let output = gotai(&["rows", out, "--csv"]).stdout(full).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
}

/// In few letters no number and no word of a row is broken: columns that have no room are named instead, and what is
/// asked for stays.
#[test]
fn rows_fit_a_terminal() {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    json(&small_map(out, &["--json", "--record", "none", "--no-report", "--set", "time.end_s=0.2"]));
    let of = |args: &[&str]| {
        let output = gotai(&[&["rows", out], args].concat()).env("COLUMNS", "60").output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
        (text(output.stdout), text(output.stderr))
    };
    let (text, err) = of(&["--sort", "-energy_rise_max_rel"]);
    assert!(text.lines().all(|line| line.chars().count() <= 60), "{text}");
    let first = text.lines().find(|line| line.contains("cube 125")).unwrap();
    for part in ["cube 125", "finished", "0.2"] {
        assert!(first.contains(part), "{part}: {text}");
    }
    assert!(text.contains("rise_") && !text.contains("drift_"), "{text}");
    assert!(err.contains("no room for energy_drift_rel") && err.contains("--columns"), "{err}");
    // Twelve rows below a head of few lines.
    assert!((13..18).contains(&text.lines().count()), "{text}");
    let (text, err) = of(&["--columns", "case,penetration_max_m,residual_max"]);
    assert!(text.lines().count() > 12 && !err.contains("no room"), "{text}{err}");
}

//! What a person sees: recordings opened in a headless viewer show their headline, their plots and their bodies, of
//! any size.

use crate::cli::{json, run};
use crate::scratch;
use crate::tools;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Size of the pictures, and the part of them that the 3-D view takes, by the layout's shares.
const SIZE: (u32, u32) = (1280, 800);
const SCENE: [u32; 4] = [10, 60, 620, 570];
const HEADLINE: [u32; 4] = [660, 80, 1250, 115];
const ENERGY: [u32; 4] = [670, 385, 1270, 585];

/// A picture as it is on the screen.
struct Picture {
    width: u32,
    pixels: Vec<[u8; 3]>,
}

impl Picture {
    fn read(path: &Path) -> Picture {
        let image = image_of(path);
        assert_eq!((image.0, image.1), SIZE);
        Picture { width: image.0, pixels: image.2 }
    }

    fn all(&self, [x0, y0, x1, y1]: [u32; 4]) -> impl Iterator<Item = (u32, [u8; 3])> + '_ {
        let row = move |y: u32| (x0..x1).map(move |x| (y, self.pixels[(y * self.width + x) as usize]));
        (y0..y1).flat_map(row)
    }

    /// Number of pixels in a part that are as bright as text.
    fn bright(&self, part: [u32; 4]) -> usize {
        self.all(part).filter(|(_, [r, g, b])| *r > 200 && *g > 200 && *b > 200).count()
    }

    /// Part of a view's height between the lowest and the highest pixel of these.
    fn height(&self, part: [u32; 4], is_it: impl Fn([u8; 3]) -> bool) -> f64 {
        self.height_of_rows(part, 1, is_it)
    }

    /// The same of rows that have at least so many of them: a body's way is a thin line.
    fn height_of_rows(&self, part: [u32; 4], least: usize, is_it: impl Fn([u8; 3]) -> bool) -> f64 {
        let wide = |y: &u32| {
            let row = [part[0], *y, part[2], *y + 1];
            self.all(row).filter(|(_, pixel)| is_it(*pixel)).count() >= least
        };
        let rows = || (part[1]..part[3]).filter(wide);
        let (low, high) = (rows().min().unwrap_or(0), rows().max().unwrap_or(0));
        f64::from(high - low) / f64::from(part[3] - part[1])
    }
}

/// Width, height and pixels of a PNG of eight bits.
fn image_of(path: &Path) -> (u32, u32, Vec<[u8; 3]>) {
    let decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    let channels = info.color_type.samples();
    let pixels = bytes[..info.buffer_size()].chunks(channels).map(|p| [p[0], p[1], p[2]]).collect();
    (info.width, info.height, pixels)
}

/// What the viewer shows of a recording at a time.
fn shown(rerun: &Path, file: &Path, seconds: &str) -> Picture {
    // The viewer comes from Python's packages.
    let python = tools::tool("python3").unwrap();
    let picture = file.with_extension("png");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/record/view.py");
    let mut command = Command::new(python);
    command.arg(script).arg(file).arg(&picture).arg(seconds).arg(format!("{}x{}", SIZE.0, SIZE.1)).env("RERUN", rerun);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Picture::read(&picture)
}

/// Blue, as the first body is: brighter than the ground.
fn is_body([r, g, b]: [u8; 3]) -> bool {
    b > 70 && u32::from(b) > 13 * u32::from(r) / 10 && b > g
}

fn of_run(args: &[&str]) -> (scratch::Folder, PathBuf) {
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let d = json(&[&["run"], args, &["--record", "rerun", "--json", "--out", out]].concat());
    let file = folder.path().join(format!("{}.rrd", d["recording"].as_str().unwrap()));
    (folder, file)
}

#[test]
fn a_recording_opens_on_what_happened() {
    let Some(rerun) = tools::viewer() else { return };
    let (_folder, file) = of_run(&super::story::EXPLODES);
    let picture = shown(&rerun, &file, "0.3");
    assert!(picture.bright(HEADLINE) > 400, "a headline: {}", picture.bright(HEADLINE));
    let lines = picture.all(ENERGY).filter(|(_, [r, _, b])| *r > 150 && *b < 120).count();
    assert!(lines > 100, "a plot of the energy: {lines}");
    let height = picture.height(SCENE, is_body);
    assert!((0.15..0.8).contains(&height), "{height}");
}

/// A cube of this edge that falls on its corner, in units in which the motion is the same.
fn cube(edge_m: f64) -> String {
    let unit_s = edge_m.sqrt();
    format!(
        "question: Does size matter?\nscene:\n  container: {{ plane: {{ normal: [0, 1, 0] }} }}\n  bodies:\n    - \
         {{ name: cube, shape: {{ box: {{ size_m: [{edge_m:?}, {edge_m:?}, {edge_m:?}] }} }}, mass_kg: 1, position_m: \
         [0, {:?}, 0] }}\ntime: {{ step_s: {:?}, end_s: {:?} }}\nrecord: {{ every_s: {:?} }}\n",
        1.2 * edge_m,
        0.01 * unit_s,
        unit_s,
        0.01 * unit_s
    )
}

#[test]
fn bodies_of_any_size_are_in_view() {
    let Some(rerun) = tools::viewer() else { return };
    // Nearer than the viewer's near plane as it is, and farther away than it looks.
    for edge_m in [1e-3, 1e3] {
        let folder = scratch::folder();
        let config = folder.path().join("cube.yaml");
        std::fs::write(&config, cube(edge_m)).unwrap();
        let (_folder, file) = of_run(&[config.to_str().unwrap()]);
        let picture = shown(&rerun, &file, "0");
        let height = picture.height(SCENE, is_body);
        assert!((0.15..0.8).contains(&height), "{edge_m} m: {height}");
        assert!(picture.bright(HEADLINE) > 400);
    }
}

/// A body, an arrow or a way: neither the ground nor the container, which are grey.
fn is_vivid(pixel: [u8; 3]) -> bool {
    let most = pixel.iter().max().copied().unwrap_or(0);
    let least = pixel.iter().min().copied().unwrap_or(0);
    most - least > 45
}

/// Scenes of one kind each: what is set, or a file of its own, and the time at which it is looked at.
const KINDS: [(&str, &str, &[&str], &str); 9] = [
    (
        "the experiment to start from",
        "",
        &["configs/start.yaml", "--set", "time.step_s=0.005", "--set", "seed=1"],
        "0.8",
    ),
    (
        "a stack of ten",
        "",
        &[
            "configs/stack/stack.yaml",
            "--set",
            "scene.bodies.top.mass_kg=1",
            "--set",
            "method.time-stepping.scheme=semi-implicit",
            "--set",
            "time.end_s=0.1",
        ],
        "0.05",
    ),
    (
        "a disc of 10 cm",
        "question: Does it fall?
scene:
  friction: 0.3
  container: { box: { size_m: [2, 2, 2] } }
  bodies: [{ name: disc, shape: { cylinder: { radius_m: 0.05, height_m: 0.01 } }, mass_kg: 0.2, position_m: [0, 0.3, 0],
    orientation: { axis: [1, 0, 0.3], angle_deg: 60 }, velocity_m_s: [0.4, 0, 0.1] }]
time: { step_s: 0.002, end_s: 0.6 }
",
        &[],
        "0.3",
    ),
    (
        "a body without a shape",
        "question: Does it turn over?
scene:
  gravity_m_s2: [0, 0, 0]
  bodies: [{ name: racket, shape: none, mass_kg: 1, inertia_kg_m2: [1, 2, 3], angular_velocity_body_rad_s: [0.01, 5, 0] }]
method: free
time: { step_s: 0.01, end_s: 2 }
",
        &[],
        "1",
    ),
    (
        "a top on a pin",
        "question: Does it precess?
scene:
  gravity_m_s2: [0, -9.81, 0]
  bodies: [{ name: top, shape: none, mass_kg: 1, inertia_kg_m2: [0.02, 0.01, 0.02], position_m: [0.1, 0.17320508075688773, 0],
    orientation: { axis: [0, 0, 1], angle_deg: -30 }, angular_velocity_body_rad_s: [0, 60, 0] }]
  pins: [{ body: top, point_m: [0, -0.2, 0] }]
method: free
time: { step_s: 1e-3, end_s: 1 }
",
        &[],
        "0.5",
    ),
    (
        "a ball that rolls far",
        "question: Does it roll?
scene:
  friction: 0.5
  container: { plane: { normal: [0, 1, 0] } }
  bodies: [{ name: ball, shape: { sphere: { radius_m: 0.25 } }, mass_kg: 1, position_m: [0, 0.25, 0], velocity_m_s: [5, 0, 0],
    angular_velocity_rad_s: [0, 0, -20] }]
time: { step_s: 0.01, end_s: 10 }
",
        &[],
        "5",
    ),
    (
        "an escape",
        "question: Does it stay?
scene:
  container: { box: { size_m: [2, 2, 2] } }
  bodies: [{ name: cube, shape: { box: { size_m: [0.3, 0.3, 0.3] } }, mesh: { nodes_per_edge: 3 }, mass_kg: 1,
    position_m: [-0.5, 1, 0], velocity_m_s: [30, 10, 3] }]
method: { lecture: {} }
time: { step_s: 0.02, end_s: 1 }
",
        &[],
        "0.02",
    ),
    (
        "an explosion that nothing stops",
        "",
        &[
            "configs/lecture/demo.yaml",
            "--set",
            "method={lecture: {}}",
            "--set",
            "time.step_s=0.04",
            "--set",
            "scene.bodies.cube.mesh.nodes_per_edge=5",
            "--set",
            "diverge={energy_factor: null, escape: false}",
        ],
        "2.3",
    ),
    ("a pile", "", &["configs/stack/pile.yaml", "--set", "time.end_s=0.1"], "0.1"),
];

#[test]
fn every_kind_of_scene_is_in_view() {
    let Some(rerun) = tools::viewer() else { return };
    for (kind, text, args, seconds) in KINDS {
        let folder = scratch::folder();
        let config = folder.path().join("scene.yaml");
        std::fs::write(&config, text).unwrap();
        let own = [config.to_str().unwrap()];
        let (_folder, file) = of_run(if text.is_empty() { args } else { &own });
        // Several bodies are of several colours; of one, its arrows are no part.
        let is_it = if kind.contains("stack") || kind.contains("pile") { is_vivid } else { is_body };
        // A body's way is a thin line.
        let least = match kind {
            _ if kind.contains("explosion") => 25,
            _ if kind.contains("disc") || kind.contains("rolls") => 8,
            _ => 1,
        };
        let height = |picture: &Picture| picture.height_of_rows(SCENE, least, is_it);
        let is_framed = |picture: &Picture| (0.15..0.8).contains(&height(picture));
        // On a busy machine a viewer may still be laying out.
        let tries = std::iter::repeat_with(|| shown(&rerun, &file, seconds)).take(3);
        let mut pictures: Vec<Picture> = Vec::new();
        for picture in tries {
            pictures.push(picture);
            if pictures.last().is_some_and(is_framed) {
                break;
            }
        }
        let picture = pictures.pop().unwrap();
        assert!(is_framed(&picture), "{kind}: {}", height(&picture));
        assert!(picture.bright(HEADLINE) > 300, "{kind}: a headline: {}", picture.bright(HEADLINE));
    }
}

#[test]
fn two_cases_are_in_view_together() {
    let Some(rerun) = tools::viewer() else { return };
    let folder = scratch::folder();
    let out = folder.path().to_str().unwrap();
    let axis = ["--axis", "method=[lecture, time-stepping]", "--set", "time.end_s=1", "--set", "time.step_s=0.01"];
    let d = json(&[&["run", "configs/lecture/demo.yaml"][..], &axis, &["--json", "--out", out]].concat());
    let file = folder.path().join(format!("{}.rrd", d["recording"].as_str().unwrap()));
    let picture = shown(&rerun, &file, "0.9");
    let is_orange = |[r, g, b]: [u8; 3]| r > 150 && g > 70 && b < 90 && r > g;
    let is_green = |[r, g, b]: [u8; 3]| g > 90 && g > r && u32::from(g) > 12 * u32::from(b) / 10;
    for (colour, height) in [("orange", picture.height(SCENE, is_orange)), ("green", picture.height(SCENE, is_green))] {
        assert!((0.1..0.8).contains(&height), "{colour}: {height}");
    }
    assert!(picture.bright(HEADLINE) > 150);
}

/// What a program has said of a run that a viewer was shown for some seconds: exit code, stderr, recordings.
fn shown_live(rerun: &Path, seconds: &str, args: &[&str]) -> serde_json::Value {
    let folder = scratch::folder();
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/record/live.py");
    let mut command = Command::new(tools::tool("python3").unwrap());
    command.args([script, seconds, env!("CARGO_BIN_EXE_gotai")]).args(args).env("RERUN", rerun);
    command.args(["--live=PORT", "--record", "mcap", "--out", folder.path().to_str().unwrap()]);
    let output = command.current_dir(env!("CARGO_MANIFEST_DIR")).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_viewer_shows_a_run_while_it_goes_on_and_the_run_goes_on_without_it() {
    let Some(rerun) = tools::viewer() else { return };
    let demo = ["run", "configs/lecture/demo.yaml", "--set", "time.end_s=1"];
    let shown = shown_live(&rerun, "60", &demo);
    assert_eq!(shown["code"], 0, "{shown}");
    let known = shown["known"].as_str().unwrap();
    assert!(known.contains("gotai demo") && known.contains("1000000000"), "all of it: {known}");
    // A run of some seconds, whose viewer is closed before.
    let long = ["--set", "time.end_s=100", "--set", "time.step_s=1e-4", "--set", "plan={skip: []}"];
    let longer = [&["run", "configs/lecture/demo.yaml"], &long[..]].concat();
    let shown = shown_live(&rerun, "0.5", &longer);
    assert_eq!(shown["code"], 0, "{shown}");
    assert!(shown["said"].as_str().unwrap().contains("the run went on without it"), "{shown}");
}

#[test]
fn a_film_shows_the_decisive_stretch() {
    let Some(rerun) = tools::viewer() else { return };
    let (folder, file) = of_run(&super::story::EXPLODES);
    let frames = folder.path().join("frames");
    let film = folder.path().join("film.gif");
    let arguments =
        ["view", file.to_str().unwrap(), "--frames", frames.to_str().unwrap(), "--gif", film.to_str().unwrap()];
    let output = crate::cli::gotai(&[&arguments[..], &["--pictures", "3", "--size", "640x400"]].concat())
        .env("GOTAI_VIEWER", rerun)
        .output()
        .unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && err.contains("ffmpeg"), "{err}");
    let pictures: Vec<_> = (0..3).map(|i| image_of(&frames.join(format!("{i:04}.png")))).collect();
    assert!(pictures.iter().all(|(width, height, _)| (*width, *height) == (640, 400)));
    assert!(pictures[0].2 != pictures[2].2, "it moves");
    assert!(std::fs::read(film).unwrap().starts_with(b"GIF89a"));
}

/// A program of this version at a path.
#[cfg(unix)]
fn viewer_of(folder: &Path, version: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let program = folder.join(version);
    std::fs::write(&program, format!("#!/bin/sh\n[ \"$1\" = --version ] && echo rerun-cli {version}\nexit 0\n"))
        .unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    program
}

#[cfg(unix)]
#[test]
fn an_older_viewer_is_exit_code_3_and_a_newer_one_a_line() {
    let (folder, file) = of_run(&["configs/smoke.yaml", "--set", "time.end_s=0.1", "--set", "method=time-stepping"]);
    for (version, code, said) in [("0.30.1", 3, "is older than"), ("0.36.3", 0, ""), ("0.99.0", 0, "is newer than")] {
        let mut command = crate::cli::gotai(&["view", file.to_str().unwrap()]);
        let output = command.env("GOTAI_VIEWER", viewer_of(folder.path(), version)).output().unwrap();
        let err = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(code) && err.contains(said), "{version}: {err}");
        assert_eq!(err.lines().count(), if code == 0 && !said.is_empty() { 2 } else { 1 }, "{err}");
    }
}

/// No viewer is needed to be told that there is none.
#[test]
fn no_viewer_is_exit_code_3_with_the_line_that_installs_one() {
    let (_folder, file) = of_run(&["configs/smoke.yaml", "--set", "time.end_s=0.1", "--set", "method=time-stepping"]);
    let output = crate::cli::gotai(&["view", file.to_str().unwrap()]).env("PATH", "").output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(3), "{err}");
    assert!(err.contains("pip install rerun-sdk==0.36.3"), "{err}");
    let (code, _, err) = run(&["view", "Cargo.toml"]);
    assert_eq!(code, 2, "{err}");
}

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
        let rows = || self.all(part).filter(|(_, pixel)| is_it(*pixel)).map(|(y, _)| y);
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

/// A cube of this edge that falls, in units in which the motion is the same.
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
    // Nearer than the viewer's near plane as it is.
    let edge_m = 1e-3;
    let folder = scratch::folder();
    let config = folder.path().join("cube.yaml");
    std::fs::write(&config, cube(edge_m)).unwrap();
    let (_folder, file) = of_run(&[config.to_str().unwrap()]);
    let picture = shown(&rerun, &file, "0");
    let height = picture.height(SCENE, is_body);
    assert!((0.15..0.8).contains(&height), "{height}");
    assert!(picture.bright(HEADLINE) > 400);
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

//! One engine of a comparison: a scene and a method in plain words, timed, the end of the run as one line of numbers.
//!
//! The scene is text, one item a line, SI units, as `benches/peer.rs` shows; it becomes an experiment file, so that
//! what a user cannot write a comparison cannot either. `RESULT` is of stepping alone, the best of the repeats; of a
//! method that makes its own steps, the step is their mean.

use super::timing;
use crate::experiment::{ExperimentError, ExperimentFile};
use crate::state::BodyState;
use crate::study::choose;
use crate::sweep::build::build;
use crate::sweep::plan::single_case;
use serde_json::{Map, Value, json};
use std::fmt::Write;
use std::path::Path;

/// Reason why there is no result: a scene or a setting that is wrong, or a run that does not come to its end.
#[derive(Debug, thiserror::Error)]
pub enum PeerError {
    #[error("line {line}: expected {expected}, found `{found}`")]
    Line { line: usize, expected: &'static str, found: String },
    #[error("{0}: expected one of method, tolerance, scheme, solver, each as key=value")]
    Setting(String),
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    #[error("stalled at {0} s")]
    Stalled(f64),
}

/// The line of the result of a timed scene; `settings` are `key=value`.
///
/// # Errors
/// The scene or a setting is wrong, or the run does not come to its end.
pub fn run(scene: &str, repeats: u32, step_s: f64, settings: &[String]) -> Result<String, PeerError> {
    let mut experiment = read(scene)?;
    experiment["time"]["step_s"] = json!(step_s);
    experiment["method"] = method(settings)?;
    let file = ExperimentFile::from_text(Path::new("scene"), &experiment.to_string(), &[])?;
    let written = single_case(&file)?.experiment;
    let (model, start) = build(&file, &[], &written)?;
    let chosen = choose::method(&written, &model, &start);
    let timed = timing::time(&chosen, &model, &start, repeats.max(1));
    let end = &timed.end;
    if end.time_s < chosen.experiment.time.end_s {
        return Err(PeerError::Stalled(end.time_s));
    }
    let step_s = end.time_s / end.step as f64;
    let mut line = format!("RESULT {step_s:?} {} {:?} {}", end.step, timed.best_s, end.bodies.len());
    for BodyState { p_WB: p, q_WB: q, v_WB: v, w_WB: w } in &end.bodies {
        for x in [p.x, p.y, p.z, q.w, q.i, q.j, q.k, v.x, v.y, v.z, w.x, w.y, w.z] {
            // Writing into memory cannot fail.
            let _ = write!(line, " {x:?}");
        }
    }
    Ok(line)
}

/// `method` and the settings below it, as the experiment file has them.
fn method(settings: &[String]) -> Result<Value, PeerError> {
    let (mut word, mut below) = ("time-stepping".to_string(), Map::new());
    for setting in settings {
        let wrong = || PeerError::Setting(setting.clone());
        let (key, value) = setting.split_once('=').ok_or_else(wrong)?;
        match key {
            "method" => word = value.to_string(),
            "tolerance" => drop(below.insert(key.to_string(), json!(value.parse::<f64>().map_err(|_| wrong())?))),
            "scheme" | "solver" => drop(below.insert(key.to_string(), json!(value))),
            _ => return Err(wrong()),
        }
    }
    Ok(json!({ word: below }))
}

/// The experiment file of a scene, without method and step.
fn read(scene: &str) -> Result<Value, PeerError> {
    let (mut bodies, mut planes) = (Vec::new(), Vec::new());
    let mut experiment = json!({ "scene": { "allow_overlap": true }, "time": {} });
    for (i, text) in scene.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
        let line = Line { number: i + 1, text };
        match text.split_whitespace().next().unwrap_or_default() {
            "scene" => experiment["question"] = json!(text.trim()),
            "duration" => experiment["time"]["end_s"] = json!(line.numbers::<1>(1)?[0]),
            "gravity" => experiment["scene"]["gravity_m_s2"] = json!(line.numbers::<3>(1)?),
            "mu" => experiment["scene"]["friction"] = json!(line.numbers::<1>(1)?[0]),
            "restitution" => experiment["scene"]["restitution"] = json!(line.numbers::<1>(1)?[0]),
            "plane" => {
                let [x, y, z, offset_m] = line.numbers(1)?;
                planes.push(json!({ "normal": [x, y, z], "offset_m": offset_m }));
            }
            "body" => bodies.push(body(&line, bodies.len())?),
            _ => return Err(line.expected("scene, duration, gravity, mu, restitution, plane or body")),
        }
    }
    experiment["scene"]["bodies"] = json!(bodies);
    if !planes.is_empty() {
        experiment["scene"]["container"] = json!({ "planes": planes });
    }
    Ok(experiment)
}

/// `body SHAPE a b c  m  Ix Iy Iz  px py pz  qw qx qy qz  vx vy vz  wx wy wz`.
fn body(line: &Line, index: usize) -> Result<Value, PeerError> {
    let [a, b, c, mass_kg, ix, iy, iz, px, py, pz, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz] = line.numbers(2)?;
    let shape = match line.text.split_whitespace().nth(1) {
        Some("sphere") => json!({ "sphere": { "radius_m": a } }),
        // Half extents.
        Some("box") => json!({ "box": { "size_m": [2.0 * a, 2.0 * b, 2.0 * c] } }),
        Some("ellipsoid") => json!({ "ellipsoid": { "semi_axes_m": [a, b, c] } }),
        Some("none") => json!("none"),
        _ => return Err(line.expected("a body of shape sphere, box, ellipsoid or none")),
    };
    Ok(json!({
        "name": format!("body{index}"), "shape": shape, "mass_kg": mass_kg, "inertia_kg_m2": [ix, iy, iz],
        "position_m": [px, py, pz], "orientation": { "quaternion_xyzw": [qx, qy, qz, qw] },
        "velocity_m_s": [vx, vy, vz], "angular_velocity_rad_s": [wx, wy, wz],
    }))
}

/// A line of the scene, numbered from 1.
struct Line<'a> {
    number: usize,
    text: &'a str,
}

impl Line<'_> {
    /// Numbers behind the first `words` words of the line, which has no others.
    fn numbers<const N: usize>(&self, words: usize) -> Result<[f64; N], PeerError> {
        let numbers = self.text.split_whitespace().skip(words).map(str::parse::<f64>);
        let numbers: Vec<f64> = numbers.collect::<Result<_, _>>().map_err(|_| self.expected("numbers"))?;
        numbers.try_into().map_err(|_| self.expected("another count of numbers"))
    }

    fn expected(&self, expected: &'static str) -> PeerError {
        PeerError::Line { line: self.number, expected, found: self.text.to_string() }
    }
}

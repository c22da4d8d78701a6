//! What Foxglove needs beside messages: a layout (3-D, plots, log), and the bodies' surfaces as files.

use super::sample::{BodyHeader, Header, Streams};
use super::schema::{self, Rgb};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Foxglove's layout for recordings of these streams, and of scenes as large as this one, as JSON.
pub fn layout(streams: Streams, header: &Header) -> String {
    let plot = |title: &str, lines: &[(String, Option<Rgb>)]| {
        let paths: Vec<Value> = lines
            .iter()
            .map(|(path, colour)| {
                let colour = colour.map(|[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
                json!({ "value": path, "enabled": true, "timestampMethod": "receiveTime", "color": colour })
            })
            .collect();
        json!({
            "foxglovePanelTitle": title, "paths": paths, "showLegend": true, "legendDisplay": "floating",
            "showXAxisLabels": true, "showYAxisLabels": true, "isSynced": true, "xAxisVal": "timestamp",
        })
    };
    let energies = schema::ENERGY_SERIES.iter().filter(|series| !series.is_length());
    let energies: Vec<_> =
        energies.map(|series| (format!("{}.{}_j", schema::ENERGY, series.name), Some(series.colour))).collect();
    let penetration = [(format!("{}.penetration_m", schema::ENERGY), Some(schema::FORCE_COLOUR))];
    let contacts = if streams.contacts { schema::CONTACTS } else { schema::FORCES };
    let contacts = [(format!("{contacts}.count"), Some(schema::CONTAINER_COLOUR))];
    let mut panels = serde_json::Map::new();
    let [x, y, z] = middle(header);
    let floor_m = header.planes.first().filter(|([_, up, _], _)| *up == 1.0).map_or(z, |(_, offset_m)| *offset_m);
    let scene = json!({
        "foxglovePanelTitle": "scene", "followTf": schema::ROOT, "followMode": "follow-none",
        "cameraState": camera(header),
        "scene": { "backgroundColor": "#1a1d22", "transforms": { "visible": false } },
        "topics": { schema::SCENE: { "visible": true }, schema::SCENE_CONTACTS: { "visible": true } },
        "layers": { "grid": {
            "layerId": "foxglove.Grid", "visible": true, "frameId": schema::ROOT, "divisions": 10,
            "size": header.scene_size_m(), "position": [x, y, floor_m],
        } },
    });
    panels.insert("3D!scene".into(), scene);
    panels.insert("RosOut!events".into(), json!({ "topicToRender": schema::LOG, "minLogLevel": 1, "searchTerms": [] }));
    let mut plots = Vec::new();
    if streams.energy {
        panels.insert("Plot!energy".into(), plot("energy [J]", &energies));
        panels.insert("Plot!penetration".into(), plot("penetration [m]", &penetration));
        plots.extend(["Plot!energy", "Plot!penetration"]);
    }
    if streams.any_contact() {
        panels.insert("Plot!contacts".into(), plot("contacts at once", &contacts));
        plots.push("Plot!contacts");
    }
    let below = |first: Value, second: Value, percent: f64| {
        let split = json!({ "direction": "column", "first": first, "second": second });
        with(split, "splitPercentage", json!(percent))
    };
    let left = below(json!("3D!scene"), json!("RosOut!events"), 75.0);
    let stacked = |plots: &[&str]| {
        let mut rest = plots.iter().rev();
        let last = rest.next().map(|name| json!(name))?;
        let stack =
            rest.zip(2..).fold(last, |stack, (name, count)| below(json!(name), stack, 100.0 / f64::from(count)));
        Some(stack)
    };
    let whole = match stacked(&plots) {
        Some(right) => json!({ "direction": "row", "first": left, "second": right, "splitPercentage": 60.0 }),
        None => left,
    };
    let layout = json!({
        "configById": panels, "globalVariables": {}, "userNodes": {}, "playbackConfig": { "speed": 1.0 },
        "layout": whole,
    });
    format!("{layout:#}\n")
}

/// Middle of the scene in the frame whose z is up.
fn middle(header: &Header) -> [f64; 3] {
    let (low, high) = header.container_box_m().unwrap_or((header.ground.0, header.ground.0));
    let [x, y, z] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
    [x, -z, y]
}

/// A camera that has all of a scene in view, whatever its size: Foxglove's own is for some metres.
fn camera(header: &Header) -> Value {
    /// Distance from the middle, and the nearest and the farthest that are drawn, in lengths of the scene.
    const AWAY: f64 = 1.3;
    const DRAWN: [f64; 2] = [1e-3, 1e3];
    let size_m = header.scene_size_m();
    let [near, far] = DRAWN.map(|part| part * size_m);
    json!({
        "perspective": true, "distance": AWAY * size_m, "phi": 65.0, "thetaOffset": 30.0, "fovy": 45.0,
        "target": [0.0, 0.0, 0.0], "targetOffset": middle(header), "targetOrientation": [0.0, 0.0, 0.0, 1.0],
        "near": near, "far": far,
    })
}

/// An object with one key more.
fn with(mut object: Value, key: &str, value: Value) -> Value {
    object[key] = value;
    object
}

/// Surfaces of the bodies as Wavefront OBJ, relative to the centre of mass, in body axes, and the file of every body;
/// bodies that look the same share one.
pub fn surfaces_as_files(header: &Header) -> (Vec<(String, String)>, BTreeMap<String, String>) {
    let mut files: Vec<(String, String)> = Vec::new();
    let mut looks: Vec<&BodyHeader> = Vec::new();
    let mut of_bodies = BTreeMap::new();
    for body in &header.bodies {
        let alike = |look: &&BodyHeader| look.vertices_m == body.vertices_m && look.triangles == body.triangles;
        let i = looks.iter().position(alike).unwrap_or_else(|| {
            files.push((format!("{}/{}.obj", schema::MESHES, body.name), obj(body)));
            looks.push(body);
            looks.len() - 1
        });
        of_bodies.insert(body.name.clone(), files[i].0.clone());
    }
    (files, of_bodies)
}

fn obj(body: &BodyHeader) -> String {
    let mut text = String::from("# relative to the centre of mass, body axes, metres\n");
    for [x, y, z] in &body.vertices_m {
        let _ = writeln!(text, "v {x:?} {y:?} {z:?}");
    }
    for corners in &body.triangles {
        let [a, b, c] = corners.map(|corner| corner + 1);
        let _ = writeln!(text, "f {a} {b} {c}");
    }
    text
}

//! The head of a recording: the case, the whole configuration, what the bodies and the container look like.

use super::name::RecordingName;
use super::sample::{BodyHeader, Header};
use super::sampler::{steps_between, streams};
use crate::build_info::{BUILD, PROGRAM};
use crate::case::Case;
use crate::clock::Clock;
use crate::experiment::to_yaml;
use crate::experiment::types::{Container, ContainerBox, Plane};
use crate::model::{Body, Model};
use nalgebra::Vector3;

pub fn header(case: &Case, name: &RecordingName, model: &Model, clock: &Clock) -> Header {
    let record = &case.experiment.record;
    Header {
        case: case.id.clone(),
        name: name.clone(),
        title: title(case),
        axes: case.axes.iter().map(|(path, value)| (path.clone(), value.clone())).collect(),
        program: PROGRAM.to_string(),
        build: BUILD.to_string(),
        config_yaml: to_yaml(&case.experiment),
        step_s: clock.step_s,
        sample_every_s: steps_between(record, clock) as f64 * clock.step_s,
        streams: streams(record),
        bodies: model.bodies.iter().map(body_header).collect(),
        container_strips_m: container_strips(case.experiment.scene.container.as_ref(), model),
        arrow_m_per_n: arrow_m_per_n(model),
    }
}

fn title(case: &Case) -> String {
    let question = case.experiment.question.as_deref().unwrap_or("gotai run").trim();
    let axes: Vec<String> = case.axes.iter().map(|(path, value)| format!("{path} = {value}")).collect();
    if axes.is_empty() { question.to_string() } else { format!("{question} · {}", axes.join(", ")) }
}

fn body_header(body: &Body) -> BodyHeader {
    let (vertices, triangles) = body.surface();
    BodyHeader {
        name: body.name.clone(),
        vertices_m: vertices.iter().map(|v| (*v).into()).collect(),
        triangles,
        bounding_radius_m: body.bounding_radius_m,
    }
}

/// A body's weight is drawn as long as its radius; without gravity, that of the lecture.
fn arrow_m_per_n(model: &Model) -> f64 {
    const LECTURE_GRAVITY: f64 = 9.8;
    let gravity = model.gravity_m_s2.norm();
    let gravity = if gravity > 0.0 { gravity } else { LECTURE_GRAVITY };
    let longest = model.bodies.iter().map(|body| body.bounding_radius_m / (body.mass_kg * gravity)).fold(0.0, f64::max);
    if longest > 0.0 { longest } else { 1.0 }
}

/// Line strips: a box's edges, a square of each plane.
fn container_strips(container: Option<&Container>, model: &Model) -> Vec<Vec<[f64; 3]>> {
    let reach_m = 4.0 * model.bodies.iter().map(|body| body.bounding_radius_m).fold(0.5, f64::max);
    match container {
        None => Vec::new(),
        Some(Container::Box(size)) => box_strips(size),
        Some(Container::Plane(plane)) => vec![square(plane, reach_m)],
        Some(Container::Planes(planes)) => planes.iter().map(|plane| square(plane, reach_m)).collect(),
    }
}

/// Floor and ceiling, then the four uprights.
fn box_strips(container: &ContainerBox) -> Vec<Vec<[f64; 3]>> {
    let [x, y, z] = container.size_m.map(|edge| edge / 2.0);
    let c = container.center();
    let corner = |sx: f64, sy: f64, sz: f64| [c[0] + sx * x, c[1] + sy * y, c[2] + sz * z];
    let around = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
    let level = |sy: f64| around.iter().chain(&around[..1]).map(|(sx, sz)| corner(*sx, sy, *sz)).collect();
    let uprights = around.iter().map(|(sx, sz)| vec![corner(*sx, -1.0, *sz), corner(*sx, 1.0, *sz)]);
    [level(-1.0), level(1.0)].into_iter().chain(uprights).collect()
}

/// A square of half side `reach_m` in the plane, about the point of the plane nearest to the origin, with its cross.
fn square(plane: &Plane, reach_m: f64) -> Vec<[f64; 3]> {
    let normal = Vector3::from(plane.normal).normalize();
    let centre = normal * plane.offset_m;
    let t1 = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize() * reach_m;
    let t2 = normal.cross(&t1);
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, 1.0)];
    corners.iter().map(|(a, b)| (centre + t1 * *a + t2 * *b).into()).collect()
}

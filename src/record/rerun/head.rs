//! Head of an .rrd, once, before the first sample: layout, names, surfaces, colours, configuration.

use super::layout;
use super::names::{
    APPLICATION, CONFIG, CONTACT_COUNT, CONTACT_FORCE, CONTACTS, CONTAINER, FORCES, WORLD, energy_path,
};
use crate::record::name::RecordingName;
use crate::record::sample::{BodyHeader, Ending, Header};
use crate::record::schema::{self, Rgb};
use ::rerun::components::{Radius, Scalar, Text};
use ::rerun::log::LogMsg;
use ::rerun::sink::MemorySinkStorage;
use ::rerun::{
    AnyValues, Arrows3D, Color, ComponentIdentifier, EntityPath, LineStrips3D, Mesh3D, Points3D, RecordingStream,
    RecordingStreamBuilder, RecordingStreamResult, SeriesLines, StoreId, TextDocument, ViewCoordinates,
};
use std::error::Error;

/// Sizes on the screen, in points, so that they are legible at any zoom.
const POINT_RADIUS: f32 = 4.0;
const ARROW_RADIUS: f32 = 2.0;
const LINE_RADIUS: f32 = 1.0;
const PLOT_WIDTH: f32 = 1.5;

/// Most triangles of a body that is shaded by facet, 72 bytes each; above, corners are shared, half of that.
const FACETED_TRIANGLES: usize = 20_000;

/// Opacity of bodies, of 255: the forces on a body mostly point into it and should be seen.
const BODY_ALPHA: u8 = 190;

/// Name and first messages of the recording. `bodies` are the bodies' entities, in the header's order.
///
/// # Errors
/// Rerun's own.
pub fn messages(header: &Header, bodies: &[EntityPath]) -> Result<(StoreId, Vec<LogMsg>), Box<dyn Error>> {
    let (stream, memory) = stream(&recording_id(header))?;
    let store = memory.store_id().ok_or("Rerun made no recording")?;

    let mut messages = layout::messages(header)?;
    describe(header, &stream)?;
    if header.streams.bodies {
        for ((body, path), colour) in header.bodies.iter().zip(bodies).zip(schema::BODY_COLOURS.iter().cycle()) {
            stream.log_static(path.clone(), &surface(body, *colour))?;
        }
    }
    if !header.container_strips_m.is_empty() {
        stream.log_static(CONTAINER, &container(header))?;
    }
    styles(header, &stream)?;
    messages.extend(memory.take());
    Ok((store, messages))
}

/// Id of the recording, with the build in it: cases of another build have the same id, and the viewer would merge
/// recordings that share one.
pub fn recording_id(header: &Header) -> String {
    format!("{} {}", header.case, header.build)
}

/// Messages that the end of a run adds to the recording of this id: its name, and how the run ended.
pub fn ending(
    recording_id: &str,
    name: &RecordingName,
    ending: &Ending,
) -> RecordingStreamResult<impl Iterator<Item = LogMsg>> {
    let (stream, memory) = stream(recording_id)?;
    stream.send_recording_name(name.ended(ending.outcome))?;
    let run = AnyValues::default()
        .with_component::<Text>("outcome", [ending.outcome.name()])
        .with_component::<Scalar>("end_time_s", [ending.end_time_s])
        .with_component::<Scalar>("steps", [ending.steps as f64]);
    let run = ending.texts().fold(run, |run, (field, text)| run.with_component::<Text>(field, [text]));
    stream.send_property(schema::METADATA, &run)?;
    // The recording is there already: what opens one is left out.
    Ok(memory.take().into_iter().filter(|message| matches!(message, LogMsg::ArrowMsg(..))))
}

fn stream(recording_id: &str) -> RecordingStreamResult<(RecordingStream, MemorySinkStorage)> {
    RecordingStreamBuilder::new(APPLICATION).recording_id(recording_id).enabled(true).memory()
}

fn describe(header: &Header, stream: &RecordingStream) -> RecordingStreamResult<()> {
    stream.send_recording_name(header.name.begun())?;
    // A path is never empty, which is all that is asked of a name.
    let named = header.axes.iter().filter_map(|(path, value)| Some((ComponentIdentifier::try_new(path).ok()?, value)));
    let axes = named.fold(AnyValues::default(), |run, (field, value)| match value.as_f64() {
        Some(x) => run.with_component::<Scalar>(field, [x]),
        None => run.with_component::<Text>(field, [schema::text(value)]),
    });
    let run = axes
        .with_component::<Text>("case", [header.case.as_str()])
        .with_component::<Text>("title", [header.title.as_str()])
        .with_component::<Text>("program", [header.program.as_str()])
        .with_component::<Text>("build", [header.build.as_str()])
        .with_component::<Scalar>("step_s", [header.step_s]);
    stream.send_property(schema::METADATA, &run)?;
    let page = format!(
        "# {}\n\n{}, build {}\n\n```yaml\n{}\n```\n",
        header.title,
        header.program,
        header.build,
        header.config_yaml.trim_end()
    );
    stream.log_static(CONFIG, &TextDocument::from_markdown(page))?;
    stream.log_static(WORLD, &ViewCoordinates::RIGHT_HAND_Y_UP())
}

fn surface(body: &BodyHeader, [r, g, b]: Rgb) -> Mesh3D {
    let mesh = if body.triangles.len() <= FACETED_TRIANGLES { faceted(body) } else { smooth(body) };
    mesh.with_albedo_factor(*Color::from_unmultiplied_rgba(r, g, b, BODY_ALPHA))
}

/// Triangles with corners and normals of their own: edges show.
fn faceted(body: &BodyHeader) -> Mesh3D {
    let (mut vertices_m, mut normals) = (Vec::new(), Vec::new());
    for triangle in &body.triangles {
        let Some((corners, normal)) = corners_and_normal(body, triangle) else {
            continue;
        };
        vertices_m.extend(corners);
        normals.extend([normal; 3]);
    }
    Mesh3D::new(vertices_m).with_vertex_normals(normals)
}

/// Triangles that share corners, shaded by area-weighted normals.
fn smooth(body: &BodyHeader) -> Mesh3D {
    let mut normals = vec![[0.0; 3]; body.vertices_m.len()];
    for triangle in &body.triangles {
        let Some((_, normal)) = corners_and_normal(body, triangle) else {
            continue;
        };
        for &corner in triangle {
            let sum: &mut [f64; 3] = &mut normals[corner as usize];
            *sum = std::array::from_fn(|i| sum[i] + normal[i]);
        }
    }
    Mesh3D::new(&body.vertices_m).with_triangle_indices(&body.triangles).with_vertex_normals(normals)
}

/// The normal's length is twice the area; the viewer takes its direction. None: no such vertices.
fn corners_and_normal(body: &BodyHeader, triangle: &[u32; 3]) -> Option<([[f64; 3]; 3], [f64; 3])> {
    let corner = |i: usize| body.vertices_m.get(triangle[i] as usize).copied();
    let (a, b, c) = (corner(0)?, corner(1)?, corner(2)?);
    let (u, v) = (minus(b, a), minus(c, a));
    let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    Some(([a, b, c], normal))
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn container(header: &Header) -> LineStrips3D {
    let strips =
        header.container_strips_m.iter().map(|strip| strip.iter().map(|p| p.map(|x| x as f32)).collect::<Vec<_>>());
    LineStrips3D::new(strips)
        .with_colors([color(schema::CONTAINER_COLOUR)])
        .with_radii([Radius::new_ui_points(LINE_RADIUS)])
}

/// Colours, sizes and names of what follows sample by sample.
fn styles(header: &Header, stream: &RecordingStream) -> RecordingStreamResult<()> {
    let streams = header.streams;
    if streams.contacts {
        let style = Points3D::update_fields().with_colors([color(schema::CONTACT_COLOUR)]);
        stream.log_static(CONTACTS, &style.with_radii([Radius::new_ui_points(POINT_RADIUS)]))?;
        stream.log_static(CONTACT_COUNT, &line("contacts", schema::CONTAINER_COLOUR))?;
    }
    if streams.forces {
        let style = Arrows3D::update_fields().with_colors([color(schema::FORCE_COLOUR)]);
        stream.log_static(FORCES, &style.with_radii([Radius::new_ui_points(ARROW_RADIUS)]))?;
        stream.log_static(CONTACT_FORCE, &line("sum of |force| [N]", schema::FORCE_COLOUR))?;
    }
    if streams.energy {
        for series in &schema::ENERGY_SERIES {
            stream.log_static(energy_path(series), &line(series.label, series.colour))?;
        }
    }
    Ok(())
}

fn line(label: &str, colour: Rgb) -> SeriesLines {
    SeriesLines::new().with_names([label]).with_colors([color(colour)]).with_widths([PLOT_WIDTH])
}

fn color([r, g, b]: Rgb) -> Color {
    Color::from_rgb(r, g, b)
}

//! What an .rrd says once, before the first sample: layout, names, surfaces, colours, configuration.

use super::store::Store;
use super::{CONFIG, CONTACT_COUNT, CONTACT_FORCE, CONTACTS, CONTAINER, FORCES, WORLD, energy_path, layout};
use crate::record::sample::{BodyHeader, Header};
use crate::record::schema::{self, Rgb};
use ::re_chunk::{ChunkError, EntityPath};
use ::re_log_types::{LogMsg, StoreId};
use ::re_sdk_types::AnyValues;
use ::re_sdk_types::archetypes::{
    Arrows3D, LineStrips3D, Mesh3D, Points3D, RecordingInfo, SeriesLines, TextDocument, ViewCoordinates,
};
use ::re_sdk_types::components::{Color, Radius, Scalar, Text};
use std::error::Error;

/// Sizes on the screen, in points, so that they are legible at any zoom.
const POINT_RADIUS: f32 = 4.0;
const ARROW_RADIUS: f32 = 2.0;
const LINE_RADIUS: f32 = 1.0;
const PLOT_WIDTH: f32 = 1.5;

/// Up to this many triangles a body is shaded by facet, 72 bytes each; above, corners are shared, half of that.
const FACETED_TRIANGLES: usize = 20_000;

/// Opacity of bodies, of 255: the forces on a body mostly point into it and should be seen.
const BODY_ALPHA: u8 = 190;

/// The recording's name and its first messages. `bodies`: the bodies' entities, in the header's order.
pub fn messages(header: &Header, bodies: &[EntityPath]) -> Result<(StoreId, Vec<LogMsg>), Box<dyn Error>> {
    // Cases of another build have the same id; the viewer would merge recordings that share one.
    let id = format!("{} {}", header.case, header.build);
    let mut store = Store::recording(id);
    describe(header, &mut store)?;
    if header.streams.bodies {
        for ((body, path), colour) in header.bodies.iter().zip(bodies).zip(schema::BODY_COLOURS.iter().cycle()) {
            store.say(path.clone(), &surface(body, *colour))?;
        }
    }
    if !header.container_strips_m.is_empty() {
        store.say(CONTAINER, &container(header))?;
    }
    styles(header, &mut store)?;
    let id = store.id().clone();
    let mut messages = layout::messages(header)?;
    messages.extend(store.into_messages());
    Ok((id, messages))
}

fn describe(header: &Header, store: &mut Store) -> Result<(), ChunkError> {
    store.say(EntityPath::properties(), &RecordingInfo::update_fields().with_name(header.title.as_str()))?;
    let run = AnyValues::default()
        .with_component::<Text>("case", [header.case.as_str()])
        .with_component::<Text>("title", [header.title.as_str()])
        .with_component::<Text>("program", [header.program.as_str()])
        .with_component::<Text>("build", [header.build.as_str()])
        .with_component::<Scalar>("step_s", [header.step_s]);
    store.say(EntityPath::properties().join(&EntityPath::from(schema::METADATA)), &run)?;
    let page = format!(
        "# {}\n\n{}, build {}\n\n```yaml\n{}\n```\n",
        header.title,
        header.program,
        header.build,
        header.config_yaml.trim_end()
    );
    store.say(CONFIG, &TextDocument::from_markdown(page))?;
    store.say(WORLD, &ViewCoordinates::RIGHT_HAND_Y_UP())
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
fn styles(header: &Header, store: &mut Store) -> Result<(), ChunkError> {
    let streams = header.streams;
    if streams.contacts {
        let style = Points3D::update_fields().with_colors([color(schema::CONTACT_COLOUR)]);
        store.say(CONTACTS, &style.with_radii([Radius::new_ui_points(POINT_RADIUS)]))?;
        store.say(CONTACT_COUNT, &line("contacts", schema::CONTAINER_COLOUR))?;
    }
    if streams.forces {
        let style = Arrows3D::update_fields().with_colors([color(schema::FORCE_COLOUR)]);
        store.say(FORCES, &style.with_radii([Radius::new_ui_points(ARROW_RADIUS)]))?;
        store.say(CONTACT_FORCE, &line("sum of |force| [N]", schema::FORCE_COLOUR))?;
    }
    if streams.energy {
        for series in &schema::ENERGY_SERIES {
            store.say(energy_path(series), &line(series.label, series.colour))?;
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

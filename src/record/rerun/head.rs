//! Head of an .rrd, once, before the first sample: layout, names, surfaces, colours, configuration.

use super::camera::{Camera, camera, followed_half_m, scale};
use super::crowd::{DrawnBodies, EDGED_BODIES};
use super::names::{
    AXES, CONFIG, CONTACT_COUNT, CONTACT_FORCE, CONTACTS, CONTAINER, ENERGY_UNIT, FLIGHT, FORCES, FRICTION_USE, GAINS,
    GROUND, HEADLINE, LIMIT, LOG_ENERGY_TOTAL, LOG_GAINS, STRETCH, TRAILS, VELOCITIES, WORLD, application, energy_path,
    followed_path,
};
use super::out::{Appended, times};
use super::seen::{Seen, log_part};
use super::statics::Statics;
use super::{headline, layout};
use crate::record::sample::{BodyHeader, Ending, Header, cross, dot, norm};
use crate::record::schema::{self, Rgb};
use crate::record::story::{brief, markdown};
use ::rerun::components::{Radius, Scalar, Text};
use ::rerun::log::LogMsg;
use ::rerun::{
    AnyValues, Arrows3D, Color, ComponentIdentifier, EntityPath, LineStrips3D, Mesh3D, Points3D, SeriesLines,
    SeriesPoints, StoreId, TextDocument, Transform3D, ViewCoordinates,
};
use std::error::Error;

/// Sizes on the screen, in points, so that they are legible at any zoom.
const POINT_RADIUS: f32 = 4.0;
const NODE_RADIUS: f32 = 1.5;
const ARROW_RADIUS: f32 = 2.0;
const LINE_RADIUS: f32 = 1.0;
const EDGE_RADIUS: f32 = 0.6;
const PLOT_WIDTH: f32 = 1.5;
const MARK_SIZE: f32 = 4.0;

/// Most triangles of a body that is shaded by facet, 72 bytes each; above, corners are shared, half of that.
const FACETED_TRIANGLES: usize = 20_000;
/// Most triangles of a body whose edges are drawn.
const EDGED_TRIANGLES: usize = 4_000;

/// Opacity of the ground, of 255: what is below it, and forces on it, should be seen.
const GROUND_ALPHA: u8 = 70;

/// Half the length of a way, in radii of its body, from which it is a bar in the picture of a camera that goes along.
const BAR: f64 = 9.0;

/// Cosine of the angle between two facets below which their edge is one of the body's.
const SHARP: f64 = 0.94;

/// Colours of what stands beside the bodies.
const GROUND_COLOUR: Rgb = [110, 120, 140];
const EDGE_COLOUR: Rgb = [24, 28, 36];
const LIGHT_EDGE_COLOUR: Rgb = [190, 205, 225];
const VELOCITY_COLOUR: Rgb = [235, 238, 245];
const LIMIT_COLOUR: Rgb = [225, 87, 89];
const AXES_COLOURS: [Rgb; 3] = [[235, 80, 80], [100, 210, 90], [90, 140, 250]];
/// Paler, for the world's: they are no part of what moves.
const WORLD_COLOURS: [Rgb; 3] = [[205, 165, 165], [165, 205, 165], [165, 175, 205]];

/// Name and first messages of the recording. `bodies` are the bodies' entities; one that is shown live has no end yet.
///
/// # Errors
/// Rerun's own.
pub fn messages(
    header: &Header,
    bodies: &[DrawnBodies],
    is_live: bool,
) -> Result<(StoreId, Vec<LogMsg>), Box<dyn Error>> {
    let store = store(header)?;
    let mut stream = Statics::new(store.clone());
    stream.begin(&header.name.begun())?;
    describe(header, &mut stream, is_live)?;
    if header.streams.bodies {
        let mut looks = Looks::default();
        for DrawnBodies { path, bodies, colour } in bodies {
            let body = &header.bodies[bodies[0]];
            let look = looks.of(body);
            stream.log(path.clone(), &look.surface(*colour, u8::MAX))?;
            if header.bodies.len() <= EDGED_BODIES {
                details(body, look, path, &mut stream)?;
            }
        }
    }
    walls(header, &mut stream)?;
    ground(header, header.ground.0, header.ground.1, &mut stream)?;
    styles(header, &mut stream)?;
    Ok((store, stream.messages()))
}

/// Id of the recording, with the build in it: cases of another build have the same id, and the viewer would merge
/// recordings that share one.
fn recording_id(header: &Header) -> String {
    format!("{} {}", header.case, header.build)
}

/// Messages that the end of a run adds to its recording: its name, how the run ended, the page and the layout that it
/// opens with, and what could not be drawn before.
///
/// # Errors
/// Rerun's own.
pub fn ending(header: &Header, ending: &Ending, seen: &Seen) -> Result<Vec<LogMsg>, Box<dyn Error>> {
    let mut stream = Statics::new(store(header)?);
    stream.name(&header.name.ended(ending.outcome))?;
    let run = AnyValues::default()
        .with_component::<Text>("outcome", [ending.outcome.name()])
        .with_component::<Scalar>("end_time_s", [ending.end_time_s])
        .with_component::<Scalar>("steps", [ending.steps as f64])
        .with_component::<Scalar>(STRETCH, ending.story.stretch_s);
    let run = ending.texts().fold(run, |run, (field, text)| run.with_component::<Text>(field, [text]));
    let row = ending
        .row
        .iter()
        .filter(|(column, _)| !["outcome", "criterion", "end_time_s", "steps"].contains(&column.as_str()));
    let named = row.filter_map(|(column, cell)| Some((ComponentIdentifier::try_new(column).ok()?, cell)));
    let run = named.fold(run, |run, (column, cell)| match cell.as_f64() {
        Some(x) => run.with_component::<Scalar>(column, [x]),
        None => run.with_component::<Text>(column, [schema::text(cell)]),
    });
    stream.property(schema::METADATA, &run)?;
    stream.log(HEADLINE, &TextDocument::from_markdown(headline::page(header, ending)))?;
    if let Some(flight) = &ending.flight {
        stream.log(FLIGHT, &TextDocument::from_markdown(headline::flight_page(flight)))?;
    }
    let camera = camera(header, seen, ending.story.calm_until_s);
    if let Some(camera) = camera {
        ground(header, camera.middle, 1.6 * camera.half_m, &mut stream)?;
        axes(header, camera, &mut stream)?;
    }
    if camera.is_some_and(|camera| camera.follows) {
        followed(header, &mut stream)?;
    }
    // A long one that the camera goes along with would be a bar through the picture.
    let radius_m = header.bodies.first().map_or(0.0, |body| body.bounding_radius_m);
    if !camera.is_some_and(|camera| camera.follows && camera.half_m > BAR * radius_m) {
        trails(header, seen, camera, &mut stream)?;
    }
    marks(header, ending, seen, &mut stream)?;
    let mut messages = layout::messages(header, Some((ending, seen, camera)))?;
    messages.extend(stream.messages());
    Ok(messages)
}

fn store(header: &Header) -> Result<StoreId, Box<dyn Error>> {
    Ok(StoreId::recording(application(&header.name.begun())?, recording_id(header)))
}

fn describe(header: &Header, stream: &mut Statics, is_live: bool) -> Appended {
    // A path is never empty, which is all that is asked of a name.
    let named = header.axes.iter().filter_map(|(path, value)| Some((ComponentIdentifier::try_new(path).ok()?, value)));
    let axes = named.fold(AnyValues::default(), |run, (field, value)| match value.as_f64() {
        Some(x) => run.with_component::<Scalar>(field, [x]),
        None => run.with_component::<Text>(field, [schema::text(value)]),
    });
    let run = axes
        .with_component::<Text>("schema", [schema::VERSION])
        .with_component::<Text>("case", [header.case.as_str()])
        .with_component::<Text>("title", [header.title.as_str()])
        .with_component::<Text>("program", [header.program.as_str()])
        .with_component::<Text>("build", [header.build.as_str()]);
    let run = run.with_component::<Scalar>(ENERGY_UNIT, [header.energy_unit.1]);
    let run = header.step_s.into_iter().fold(run, |run, step_s| run.with_component::<Scalar>("step_s", [step_s]));
    stream.property(schema::METADATA, &run)?;
    // Longer than what a text in it may have.
    let longest = header.config_yaml.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(3.max(longest + 1));
    let page = format!(
        "# {}\n\n{}, build {}\n\n{fence}yaml\n{}\n{fence}\n",
        markdown(&header.title),
        header.program,
        header.build,
        header.config_yaml.trim_end()
    );
    stream.log(CONFIG, &TextDocument::from_markdown(page))?;
    stream.log(HEADLINE, &TextDocument::from_markdown(headline::begun(header, is_live)))?;
    stream.log("/", &ViewCoordinates::RIGHT_HAND_Y_UP())?;
    stream.log(WORLD, &ViewCoordinates::RIGHT_HAND_Y_UP())?;
    let scale = scale(header);
    if scale != 1.0 {
        stream.log(WORLD, &Transform3D::from_scale(scale as f32))?;
    }
    Ok(())
}

/// What a body looks like: its surface, and lines on it.
pub struct Look {
    mesh: Mesh3D,
    lines: Vec<Vec<[f32; 3]>>,
}

impl Look {
    fn of(body: &BodyHeader) -> Self {
        let is_faceted = body.triangles.len() <= FACETED_TRIANGLES && !is_round(body);
        let strips = if body.triangles.len() <= EDGED_TRIANGLES { edges(body) } else { Vec::new() };
        Look {
            mesh: if is_faceted { faceted(body) } else { smooth(body) },
            lines: strips.iter().map(|strip| strip.iter().map(|p| p.map(|x| x as f32)).collect()).collect(),
        }
    }

    /// The surface in a colour of this opacity.
    pub fn surface(&self, [r, g, b]: Rgb, alpha: u8) -> Mesh3D {
        self.mesh.clone().with_albedo_factor(*Color::from_unmultiplied_rgba(r, g, b, alpha))
    }
}

/// Looks of bodies one after the other, worked out once for those that look like the one before.
#[derive(Default)]
pub struct Looks<'a>(Option<(&'a BodyHeader, Look)>);

impl<'a> Looks<'a> {
    pub fn of(&mut self, body: &'a BodyHeader) -> &Look {
        let is_alike = |other: &BodyHeader| {
            other.touches_with_nodes == body.touches_with_nodes
                && other.has_no_shape == body.has_no_shape
                && other.vertices_m == body.vertices_m
                && other.triangles == body.triangles
        };
        let known = self.0.take().filter(|(other, _)| is_alike(other));
        &self.0.insert(known.unwrap_or_else(|| (body, Look::of(body)))).1
    }
}

/// Whether no edge of it is sharp.
fn is_round(body: &BodyHeader) -> bool {
    body.triangles.len() <= FACETED_TRIANGLES && !body.touches_with_nodes && sharp_edges(body).is_empty()
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
    Some(([a, b, c], cross(u, v)))
}

/// What makes a turn visible: edges, nodes that touch, places on pins, and of a body without a shape its axes.
pub fn details(body: &BodyHeader, look: &Look, path: &EntityPath, stream: &mut Statics) -> Appended {
    let below = |name: &str| path.join(&EntityPath::from_single_string(name));
    if !look.lines.is_empty() {
        // What has no shape is seen by its lines.
        let edge_colour = if body.has_no_shape { LIGHT_EDGE_COLOUR } else { EDGE_COLOUR };
        let lines = LineStrips3D::new(look.lines.iter().cloned());
        let lines = lines.with_colors([color(edge_colour)]).with_radii([Radius::new_ui_points(EDGE_RADIUS)]);
        stream.log(below("edges"), &lines)?;
    }
    if body.touches_with_nodes {
        let nodes = Points3D::new(body.vertices_m.iter().map(|p| p.map(|x| x as f32)));
        let nodes = nodes.with_colors([color(EDGE_COLOUR)]).with_radii([Radius::new_ui_points(NODE_RADIUS)]);
        stream.log(below("nodes"), &nodes)?;
    }
    if !body.pins_m.is_empty() {
        let arms = LineStrips3D::new(body.pins_m.iter().map(|p| vec![[0.0f32; 3], p.map(|x| x as f32)]));
        let arms = arms.with_colors([color(schema::CONTAINER_COLOUR)]).with_radii([Radius::new_ui_points(LINE_RADIUS)]);
        stream.log(below("arms"), &arms)?;
        let pins = Points3D::new(body.pins_m.iter().map(|p| p.map(|x| x as f32)));
        let pins =
            pins.with_colors([color(schema::CONTAINER_COLOUR)]).with_radii([Radius::new_ui_points(POINT_RADIUS)]);
        stream.log(below("pins"), &pins)?;
    }
    if body.has_no_shape {
        let axis = |i: usize| {
            let reach_m = body.vertices_m.iter().map(|v| v[i]).fold(0.0, f64::max);
            std::array::from_fn::<f32, 3, _>(|k| if k == i { (1.4 * reach_m) as f32 } else { 0.0 })
        };
        let axes = Arrows3D::from_vectors([0, 1, 2].map(axis)).with_colors(AXES_COLOURS.map(color));
        stream.log(below("axes"), &axes.with_radii([Radius::new_ui_points(ARROW_RADIUS)]))?;
    }
    Ok(())
}

/// An edge of a mesh: its ends, and the normals of the facets that meet there.
struct Edge {
    ends: [[f64; 3]; 2],
    normals: Vec<[f64; 3]>,
}

/// Every edge once, in an order that goes by places alone.
fn all_edges(body: &BodyHeader) -> Vec<Edge> {
    let place = |p: [f64; 3]| p.map(|x| if x == 0.0 { 0 } else { x.to_bits() });
    let mut sides = Vec::with_capacity(3 * body.triangles.len());
    for triangle in &body.triangles {
        let Some((corners, normal)) = corners_and_normal(body, triangle) else { continue };
        let length = norm(normal);
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let mut ends = [place(corners[a]), place(corners[b])];
            ends.sort_unstable();
            sides.push((ends, [corners[a], corners[b]], normal.map(|x| x / length)));
        }
    }
    // Facets may have corners of their own at the same place. (Stable: the first of its sides gives an edge its ends.)
    sides.sort_by_key(|(places, ..)| *places);
    let edges = sides.chunk_by(|a, b| a.0 == b.0);
    edges.map(|same| Edge { ends: same[0].1, normals: same.iter().map(|side| side.2).collect() }).collect()
}

fn sharp_edges(body: &BodyHeader) -> Vec<Vec<[f64; 3]>> {
    // What has no shape is drawn as an ellipsoid.
    if body.has_no_shape {
        return Vec::new();
    }
    let is_sharp = |normals: &[[f64; 3]]| !matches!(normals, [a, b] if dot(*a, *b) > SHARP);
    let edges = all_edges(body).into_iter();
    edges.filter(|edge| is_sharp(&edge.normals)).map(|edge| edge.ends.to_vec()).collect()
}

/// Lines on a body: of a mesh its squares, of another one the sharp edges, of a round one its three great circles.
fn edges(body: &BodyHeader) -> Vec<Vec<[f64; 3]>> {
    if body.touches_with_nodes {
        // The diagonal of a square of the mesh lies in a face and along no axis.
        const FLAT: f64 = 0.9999;
        let is_diagonal = |[a, b]: [[f64; 3]; 2], normals: &[[f64; 3]]| {
            let along = minus(b, a);
            let oblique = along.iter().filter(|x| x.abs() > 1e-9 * norm(along)).count() > 1;
            oblique && matches!(normals, [a, b] if dot(*a, *b) > FLAT)
        };
        let edges = all_edges(body).into_iter();
        return edges.filter(|edge| !is_diagonal(edge.ends, &edge.normals)).map(|edge| edge.ends.to_vec()).collect();
    }
    let sharp = sharp_edges(body);
    if sharp.is_empty() { great_circles(body) } else { sharp }
}

/// Three loops about a round body, a little outside.
fn great_circles(body: &BodyHeader) -> Vec<Vec<[f64; 3]>> {
    const POINTS: usize = 48;
    const OUTSIDE: f64 = 1.003;
    let end = |i: usize, pick: fn(f64, f64) -> f64, from: f64| body.vertices_m.iter().map(|v| v[i]).fold(from, pick);
    let low: [f64; 3] = std::array::from_fn(|i| end(i, f64::min, f64::INFINITY));
    let high: [f64; 3] = std::array::from_fn(|i| end(i, f64::max, f64::NEG_INFINITY));
    let circle = |(a, b): (usize, usize)| {
        let point = |k: usize| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * k as f64 / POINTS as f64);
            let turned = |i: usize| {
                if i == a {
                    cos
                } else if i == b {
                    sin
                } else {
                    0.0
                }
            };
            std::array::from_fn(|i| 0.5 * (low[i] + high[i]) + 0.5 * OUTSIDE * (high[i] - low[i]) * turned(i))
        };
        (0..=POINTS).map(point).collect()
    };
    [(0, 1), (1, 2), (2, 0)].map(circle).into()
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// The edges of a container of box form.
pub fn walls(header: &Header, stream: &mut Statics) -> Appended {
    if header.container_strips_m.is_empty() {
        return Ok(());
    }
    stream.log(CONTAINER, &container(header))
}

fn container(header: &Header) -> LineStrips3D {
    let strips =
        header.container_strips_m.iter().map(|strip| strip.iter().map(|p| p.map(|x| x as f32)).collect::<Vec<_>>());
    LineStrips3D::new(strips)
        .with_colors([color(schema::CONTAINER_COLOUR)])
        .with_radii([Radius::new_ui_points(LINE_RADIUS)])
}

/// The ground: a box's floor, squares of planes about the middle of the motion.
pub fn ground(header: &Header, middle: [f64; 3], half_m: f64, stream: &mut Statics) -> Appended {
    let squares: Vec<[[f64; 3]; 4]> = match header.container_box_m() {
        Some((low, high)) => {
            let corner = |x: f64, z: f64| [x, low[1], z];
            vec![[corner(low[0], low[2]), corner(low[0], high[2]), corner(high[0], high[2]), corner(high[0], low[2])]]
        }
        None => header.squares(middle, half_m),
    };
    if squares.is_empty() || half_m.is_nan() || half_m <= 0.0 {
        return Ok(());
    }
    let corners = squares.iter().flat_map(|square| [0, 1, 2, 0, 2, 3].map(|i: usize| square[i].map(|x| x as f32)));
    let [r, g, b] = GROUND_COLOUR;
    let mesh = Mesh3D::new(corners).with_albedo_factor(*Color::from_unmultiplied_rgba(r, g, b, GROUND_ALPHA));
    stream.log(GROUND, &mesh)?;
    if header.container_strips_m.is_empty() {
        let border = |square: &[[f64; 3]; 4]| [0, 1, 2, 3, 0].map(|i: usize| square[i].map(|x| x as f32)).to_vec();
        let lines = LineStrips3D::new(squares.iter().map(border)).with_colors([color(schema::CONTAINER_COLOUR)]);
        stream.log(CONTAINER, &lines.with_radii([Radius::new_ui_points(LINE_RADIUS)]))?;
    }
    Ok(())
}

/// A cube about the body that the camera goes along with, by two corners of it: nothing is drawn of a triangle without
/// area.
fn followed(header: &Header, stream: &mut Statics) -> Appended {
    let Some(body) = header.bodies.first() else { return Ok(()) };
    let half_m = followed_half_m(body.bounding_radius_m) as f32;
    let corners = [-half_m, half_m].into_iter().flat_map(|x| [[x; 3]; 3]);
    stream.log(followed_path(&body.name), &Mesh3D::new(corners))
}

/// Axes of the world's frame, at the foot of what is in view; none where the camera goes along and leaves them behind.
pub fn axes(header: &Header, camera: Camera, stream: &mut Statics) -> Appended {
    /// Parts of the longest side that is in view: their length, and how far outside they stand.
    const LENGTH: f64 = 0.16;
    const OUTSIDE: f64 = 0.1;
    if camera.follows {
        return Ok(());
    }
    let side_m = 2.0 * camera.half_m;
    let [x, y, z] = camera.low;
    let high_z = 2.0 * camera.middle[2] - z;
    let foot = [x - OUTSIDE * side_m, y, high_z + OUTSIDE * side_m];
    // On the ground, where that is level.
    let level = header.planes.first().filter(|(normal, _)| normal[1] > 0.999_999);
    let foot = level.map_or(foot, |(_, offset_m)| [foot[0], *offset_m, foot[2]]).map(|x| x as f32);
    let axis = |i: usize| std::array::from_fn::<f32, 3, _>(|k| if i == k { (LENGTH * side_m) as f32 } else { 0.0 });
    let arrows = Arrows3D::from_vectors([0, 1, 2].map(axis)).with_origins([foot; 3]);
    let arrows = arrows.with_colors(WORLD_COLOURS.map(color)).with_radii([Radius::new_ui_points(LINE_RADIUS)]);
    stream.log(AXES, &arrows)?;
    let tip = |i: usize| std::array::from_fn::<f32, 3, _>(|k| foot[k] + axis(i)[k]);
    let names = Points3D::new([0, 1, 2].map(tip)).with_labels(["x", "y", "z"]).with_show_labels(true);
    let names = names.with_colors(WORLD_COLOURS.map(color)).with_radii([Radius::new_ui_points(LINE_RADIUS)]);
    stream.log(format!("{AXES}/names"), &names)
}

/// The ways of the bodies as far as they are in view, each in its body's colour.
fn trails(header: &Header, seen: &Seen, camera: Option<Camera>, stream: &mut Statics) -> Appended {
    for (i, way) in seen.ways().filter(|_| header.streams.bodies) {
        let [r, g, b] = schema::BODY_COLOURS[i % schema::BODY_COLOURS.len()];
        let line = LineStrips3D::new([in_view(way, camera)]).with_colors([Color::from_unmultiplied_rgba(r, g, b, 140)]);
        let path = EntityPath::from(TRAILS).join(&EntityPath::from_single_string(&*header.bodies[i].name));
        stream.log(path, &line.with_radii([Radius::new_ui_points(LINE_RADIUS)]))?;
    }
    Ok(())
}

/// A way up to where a body is thrown out of the picture.
pub fn in_view(way: &[[f32; 3]], camera: Option<Camera>) -> Vec<[f32; 3]> {
    way.iter().copied().take_while(|p| camera.is_none_or(|camera| camera.follows || camera.is_near(*p))).collect()
}

/// Marks on the plots of energy: the limit of divergence, the steps that gained energy.
fn marks(header: &Header, ending: &Ending, seen: &Seen, stream: &mut Statics) -> Result<(), Box<dyn Error>> {
    if !header.streams.energy || seen.energy_j.is_empty() {
        return Ok(());
    }
    let start_j = ending.story.start_j;
    if let Some(factor) = header.energy_factor.filter(|_| !seen.log_energy.is_empty()) {
        stream.log(LIMIT, &line(&format!("diverged: × {}", brief(factor)), LIMIT_COLOUR))?;
        let ends = times(&[0, ending.steps], &[0.0, ending.end_time_s]);
        stream.series(LIMIT, &ends, &[libm::log10(factor); 2])?;
    }
    if ending.story.gains.is_empty() {
        return Ok(());
    }
    let style = || {
        let points = SeriesPoints::new().with_colors([color(LIMIT_COLOUR)]).with_names(["steps that gain energy"]);
        points.with_marker_sizes([MARK_SIZE])
    };
    stream.log(GAINS, &style())?;
    stream.log(LOG_GAINS, &style())?;
    let gains = &ending.story.gains;
    let series = |stream: &mut Statics, path: &'static str, value: &dyn Fn(f64) -> Option<f64>| {
        let valued = || gains.iter().filter_map(|gain| Some((gain, value(gain.after_j)?)));
        let steps: Vec<u64> = valued().map(|(gain, _)| gain.step).collect();
        let times_s: Vec<f64> = valued().map(|(gain, _)| gain.time_s).collect();
        let values: Vec<f64> = valued().map(|(_, value)| value).collect();
        if values.is_empty() { Ok(()) } else { stream.series(path, &times(&steps, &times_s), &values) }
    };
    series(stream, GAINS, &|after_j| Some(after_j / header.energy_unit.1))?;
    series(stream, LOG_GAINS, &|after_j| log_part(after_j, Some(start_j)).filter(|_| start_j > 0.0))
}

/// Colours, sizes and names of what follows sample by sample.
fn styles(header: &Header, stream: &mut Statics) -> Appended {
    let streams = header.streams;
    if streams.contacts {
        stream.log(CONTACTS, &Points3D::update_fields().with_radii([Radius::new_ui_points(POINT_RADIUS)]))?;
        stream.log(CONTACT_COUNT, &line("contacts", schema::CONTAINER_COLOUR))?;
    }
    if streams.forces {
        let style = Arrows3D::update_fields().with_colors([color(schema::FORCE_COLOUR)]);
        stream.log(FORCES, &style.with_radii([Radius::new_ui_points(ARROW_RADIUS)]))?;
        stream.log(CONTACT_FORCE, &line("sum of |force| [N]", schema::FORCE_COLOUR))?;
        let sliding = schema::mode_colour(crate::record::sample::ContactMode::Sliding);
        stream.log(FRICTION_USE, &line("largest |f_t| / μ f_n", sliding))?;
    }
    if streams.velocities {
        let style = Arrows3D::update_fields().with_colors([color(VELOCITY_COLOUR)]);
        stream.log(VELOCITIES, &style.with_radii([Radius::new_ui_points(LINE_RADIUS)]))?;
    }
    if streams.energy {
        for series in &schema::ENERGY_SERIES {
            let unit = if series.is_length() { "m" } else { header.energy_unit.0 };
            stream.log(energy_path(series), &line(&format!("{} [{unit}]", series.name), series.colour))?;
        }
        stream.log(LOG_ENERGY_TOTAL, &line("log₁₀ E / E₀", schema::BODY_COLOURS[1]))?;
    }
    Ok(())
}

/// The line of a plot.
pub fn line(label: &str, colour: Rgb) -> SeriesLines {
    SeriesLines::new().with_names([label]).with_colors([color(colour)]).with_widths([PLOT_WIDTH])
}

/// A colour without opacity of its own.
pub fn color([r, g, b]: Rgb) -> Color {
    Color::from_rgb(r, g, b)
}

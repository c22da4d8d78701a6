//! Foxglove's messages of a run: frames, surfaces, contact points and force arrows.

use super::sample::{Arrows, BodyHeader, ContactSample, Event, Header, Sample, Severity, Streams, norm};
use super::schema::{self, Rgb};
use crate::rows::BodyRow;
use foxglove::messages::line_primitive::Type::LineStrip;
use foxglove::messages::log::Level;
use foxglove::messages::{
    ArrowPrimitive, Color, FrameTransform, FrameTransforms, LinePrimitive, Log, Point3, Pose, Quaternion, SceneEntity,
    SceneUpdate, SpherePrimitive, Timestamp, TriangleListPrimitive, Vector3,
};

/// Diameter of a contact point, as a part of the scene's size.
const POINT_PART: f64 = 0.008;
/// Thickness of an arrow's shaft; its head is twice as thick and three times as long.
const SHAFT_PART: f64 = 0.004;
/// Container lines keep their width on the screen, in pixels.
const LINE_PIXELS: f64 = 2.0;

/// Picture of the run, and the messages that are filled again for every one.
pub struct Scene {
    streams: Streams,
    size_m: f64,
    arrows: Arrows,
    transforms: FrameTransforms,
    contacts: SceneUpdate,
    /// Whether the last picture had no contacts; nothing needs to be cleared then.
    blank: bool,
}

impl Scene {
    pub fn new(header: &Header) -> Self {
        let frame = |body: &BodyHeader| FrameTransform {
            parent_frame_id: schema::WORLD.to_owned(),
            child_frame_id: body.name.clone(),
            ..Default::default()
        };
        Scene {
            streams: header.streams,
            size_m: header.scene_size_m(),
            arrows: header.force_arrows(),
            transforms: FrameTransforms { transforms: header.bodies.iter().map(frame).chain([upright()]).collect() },
            contacts: SceneUpdate { entities: vec![entity("contacts", schema::WORLD)], ..Default::default() },
            blank: true,
        }
    }

    pub fn transforms(&mut self, bodies: &[BodyRow], time_ns: u64) -> &FrameTransforms {
        for (frame, body) in self.transforms.transforms.iter_mut().zip(bodies) {
            frame.timestamp = Some(timestamp(time_ns));
            frame.translation = Some(vector(body.position_m));
            let [x, y, z, w] = body.orientation_xyzw;
            frame.rotation = Some(Quaternion { x, y, z, w });
        }
        if let Some(upright) = self.transforms.transforms.last_mut() {
            upright.timestamp = Some(timestamp(time_ns));
        }
        &self.transforms
    }

    /// Contact points and force arrows; None when there is nothing to draw and nothing to clear.
    pub fn contacts(&mut self, sample: &Sample<'_>, time_ns: u64) -> Option<&SceneUpdate> {
        if sample.contacts.is_empty() && self.blank {
            return None;
        }
        self.blank = sample.contacts.is_empty();
        let (size_m, arrows) = (self.size_m, self.arrows);
        for entity in &mut self.contacts.entities {
            entity.timestamp = Some(timestamp(time_ns));
            entity.spheres.clear();
            entity.arrows.clear();
            if self.streams.contacts {
                entity.spheres.extend(sample.contacts.iter().map(|contact| sphere(contact, size_m)));
            }
            if self.streams.forces {
                let both = |contact: &ContactSample| [1.0, -1.0].map(|sign| arrow(contact, sign, size_m, arrows));
                entity.arrows.extend(sample.contacts.iter().flat_map(both));
            }
        }
        Some(&self.contacts)
    }
}

/// The container, and every body's surface in the body's frame, which only moves when bodies are recorded.
pub fn surfaces(header: &Header) -> SceneUpdate {
    let colours = schema::BODY_COLOURS.iter().cycle();
    let bodies = if header.streams.bodies { &header.bodies[..] } else { &[] };
    let bodies = bodies.iter().zip(colours).map(|(body, &colour)| SceneEntity {
        triangles: vec![TriangleListPrimitive {
            points: body.vertices_m.iter().map(|&p| point(p)).collect(),
            indices: body.triangles.iter().flatten().copied().collect(),
            color: Some(color(colour)),
            ..Default::default()
        }],
        ..entity(&body.name, &body.name)
    });
    let line = |strip: &[[f64; 3]]| LinePrimitive {
        r#type: LineStrip.into(),
        thickness: LINE_PIXELS,
        scale_invariant: true,
        points: strip.iter().map(|&p| point(p)).collect(),
        color: Some(color(schema::CONTAINER_COLOUR)),
        ..Default::default()
    };
    let (middle, half_m) = header.ground;
    let squares = if header.container_strips_m.is_empty() { header.squares(middle, half_m) } else { Vec::new() };
    let squares = squares.iter().map(|[a, b, c, d]| line(&[*a, *b, *c, *d, *a, *c]));
    let lines = header.container_strips_m.iter().map(|strip| line(strip)).chain(squares);
    let container = SceneEntity { lines: lines.collect(), ..entity(schema::CONTAINER, schema::WORLD) };
    let drawn = !container.lines.is_empty();
    SceneUpdate { entities: drawn.then_some(container).into_iter().chain(bodies).collect(), ..Default::default() }
}

pub fn log(event: &Event, time_ns: u64) -> Log {
    let level = match event.severity {
        Severity::Info => Level::Info,
        Severity::Warning => Level::Warning,
        Severity::Error => Level::Error,
    };
    Log {
        timestamp: Some(timestamp(time_ns)),
        level: level.into(),
        message: event.text.clone(),
        name: schema::METADATA.to_owned(),
        ..Default::default()
    }
}

/// The world, whose y is up, in a frame whose z is.
fn upright() -> FrameTransform {
    let half = 0.5_f64.sqrt();
    FrameTransform {
        parent_frame_id: schema::ROOT.to_owned(),
        child_frame_id: schema::WORLD.to_owned(),
        translation: Some(vector([0.0; 3])),
        rotation: Some(Quaternion { x: half, y: 0.0, z: 0.0, w: half }),
        ..Default::default()
    }
}

/// An entity that moves with its frame and stays until it is replaced.
fn entity(id: &str, frame: &str) -> SceneEntity {
    SceneEntity {
        timestamp: Some(timestamp(0)),
        frame_id: frame.to_owned(),
        id: id.to_owned(),
        frame_locked: true,
        ..Default::default()
    }
}

fn sphere(contact: &ContactSample, size_m: f64) -> SpherePrimitive {
    let diameter_m = POINT_PART * size_m;
    SpherePrimitive {
        pose: Some(Pose { position: Some(vector(contact.point_m)), orientation: Some(along_x([1.0, 0.0, 0.0])) }),
        size: Some(vector([diameter_m; 3])),
        color: Some(color(schema::mode_colour(contact.mode))),
    }
}

/// Arrow from the contact point along the force on the body, or along its reaction.
fn arrow(contact: &ContactSample, sign: f64, size_m: f64, arrows: Arrows) -> ArrowPrimitive {
    let vector_m = arrows.vector_m(contact.force_n.map(|f| sign * f));
    let length_m = norm(vector_m);
    let direction = if length_m > 0.0 { vector_m.map(|x| x / length_m) } else { [1.0, 0.0, 0.0] };
    let shaft_m = SHAFT_PART * size_m;
    let head_m = (3.0 * shaft_m).min(length_m);
    ArrowPrimitive {
        pose: Some(Pose { position: Some(vector(contact.point_m)), orientation: Some(along_x(direction)) }),
        shaft_length: length_m - head_m,
        shaft_diameter: shaft_m,
        head_length: head_m,
        head_diameter: 2.0 * shaft_m,
        color: Some(color(schema::FORCE_COLOUR)),
    }
}

/// The rotation that turns the x axis, along which arrows are drawn, into a unit vector.
fn along_x([x, y, z]: [f64; 3]) -> Quaternion {
    let half = (2.0 * (1.0 + x)).sqrt();
    // Opposite to the x axis the shortest turn is not unique, and close to it badly conditioned.
    if half < 1e-9 {
        return Quaternion { x: 0.0, y: 1.0, z: 0.0, w: 0.0 };
    }
    Quaternion { x: 0.0, y: -z / half, z: y / half, w: 0.5 * half }
}

fn vector([x, y, z]: [f64; 3]) -> Vector3 {
    Vector3 { x, y, z }
}

fn point([x, y, z]: [f64; 3]) -> Point3 {
    Point3 { x, y, z }
}

fn color([r, g, b]: Rgb) -> Color {
    let part = |channel| f64::from(channel) / 255.0;
    Color { r: part(r), g: part(g), b: part(b), a: 1.0 }
}

fn timestamp(time_ns: u64) -> Timestamp {
    // Seconds have 32 bits here: 136 years of simulated time, then the clock stops.
    let seconds = u32::try_from(time_ns / 1_000_000_000).unwrap_or(u32::MAX);
    Timestamp::new(seconds, (time_ns % 1_000_000_000) as u32)
}

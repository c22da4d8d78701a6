//! The head of a recording: the case, the whole configuration, what the bodies and the container look like.

use super::name::RecordingName;
use super::sample::{BodyHeader, Header};
use super::sampler::{steps_between, streams};
use crate::build_info::{BUILD, PROGRAM};
use crate::case::Case;
use crate::clock::Clock;
use crate::experiment::to_yaml;
use crate::experiment::types::{Container, ContainerBox, Plane};
use crate::measure::energy::Energy;
use crate::model::pins::{Anchor, Pin};
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::State;
use nalgebra::{Matrix3, Vector3};
use std::collections::BTreeMap;

pub fn header(case: &Case, name: &RecordingName, model: &Model, start: &State, clock: &Clock) -> Header {
    let record = &case.experiment.record;
    let container = case.experiment.scene.container.as_ref();
    let arrow_longest_m = arrow_longest_m(model, start);
    let (arrow_m_per_n, arrow_weight_n) = arrow(model, arrow_longest_m);
    Header {
        case: case.id.clone(),
        name: name.clone(),
        title: title(case),
        question: case.experiment.question.as_deref().unwrap_or_default().trim().to_string(),
        method: case.experiment.method.word().to_string(),
        axes: case.axes.iter().map(|(path, value)| (path.clone(), value.clone())).collect(),
        program: PROGRAM.to_string(),
        build: BUILD.to_string(),
        config_yaml: to_yaml(&case.experiment),
        step_s: (!case.experiment.method.follows_events()).then_some(clock.step_s),
        sample_every_s: steps_between(record, clock) as f64 * clock.step_s,
        streams: streams(record),
        bodies: (0..model.bodies.len()).map(|i| body_header(model, i, start, clock)).collect(),
        container_strips_m: container_strips(container),
        planes: planes(container),
        ground: ground(model, start, clock),
        arrow_m_per_n,
        arrow_weight_n,
        arrow_longest_m,
        arrow_m_per_m_s: arrow_m_per_m_s(model, start, arrow_longest_m),
        energy_unit: energy_unit(model, start),
        end_s: clock.end_s,
        most_bytes: (record.max_mb * 1e6) as u64,
        energy_factor: case.experiment.diverge.energy_factor,
    }
}

/// Unit in which energies are plotted: joules, with the prefix of their size.
fn energy_unit(model: &Model, start: &State) -> (&'static str, f64) {
    const UNITS: [(&str, f64); 12] = [
        ("fJ", 1e-15),
        ("pJ", 1e-12),
        ("nJ", 1e-9),
        ("µJ", 1e-6),
        ("mJ", 1e-3),
        ("J", 1.0),
        ("kJ", 1e3),
        ("MJ", 1e6),
        ("GJ", 1e9),
        ("TJ", 1e12),
        ("PJ", 1e15),
        ("EJ", 1e18),
    ];
    /// Sizes of an energy that an axis is labelled with in three characters, as plots of counts are: the axes of time
    /// of plots that are one above the other then begin at one place.
    const USUAL_J: std::ops::Range<f64> = 0.1..1e3;
    let energy = Energy::of(model, start);
    let size_j = energy.kinetic_j.abs().max(energy.potential_j.abs());
    if !(size_j > 0.0 && size_j.is_finite()) || USUAL_J.contains(&size_j) {
        return ("J", 1.0);
    }
    UNITS.into_iter().rev().find(|(_, unit_j)| *unit_j <= size_j).unwrap_or(UNITS[0])
}

fn title(case: &Case) -> String {
    let question = case.experiment.question.as_deref().unwrap_or("gotai run").trim();
    let axes: Vec<String> = case.axes.iter().map(|(path, value)| format!("{path} = {value}")).collect();
    if axes.is_empty() { question.to_string() } else { format!("{question} · {}", axes.join(", ")) }
}

fn body_header(model: &Model, i: usize, start: &State, clock: &Clock) -> BodyHeader {
    let body = &model.bodies[i];
    let pins_m: Vec<[f64; 3]> = model.pins.iter().flat_map(|pin| pinned_at(pin, i)).map(|r_B| r_B.into()).collect();
    let has_no_shape = matches!(body.geometry, Geometry::None);
    let is_fine = model.bodies.len() <= FINE_BODIES;
    let (vertices, triangles) = match &body.geometry {
        Geometry::None => of_inertia(body, &pins_m).unwrap_or_else(|| {
            let radius_m = point_radius_m(model, i, start, clock);
            ellipsoid(&Vector3::repeat(radius_m), &Matrix3::identity(), Vector3::zeros())
        }),
        Geometry::Solid { solid: Solid::Sphere { radius_m }, centre } if is_fine => {
            ellipsoid(&Vector3::repeat(*radius_m), &Matrix3::identity(), *centre)
        }
        Geometry::Solid { solid: Solid::Ellipsoid { semi_axes_m }, centre } if is_fine => {
            ellipsoid(semi_axes_m, &Matrix3::identity(), *centre)
        }
        Geometry::Solid { .. } | Geometry::Mesh { .. } => body.surface(),
    };
    let farthest_m = vertices.iter().map(|v| v.norm()).fold(0.0, f64::max);
    BodyHeader {
        name: body.name.clone(),
        has_no_shape,
        touches_with_nodes: matches!(body.geometry, Geometry::Mesh { .. }),
        pins_m,
        vertices_m: vertices.iter().map(|v| (*v).into()).collect(),
        triangles,
        bounding_radius_m: body.bounding_radius_m.max(farthest_m),
    }
}

/// Places on a body that a pin holds, from its centre of mass, body axes.
fn pinned_at(pin: &Pin, i: usize) -> Vec<Vector3<f64>> {
    let own = (pin.body == i).then_some(pin.r_B);
    let others = match pin.anchor {
        Anchor::Body(other, r_B) if other == i => Some(r_B),
        _ => None,
    };
    own.into_iter().chain(others).collect()
}

/// Points and triangles.
type Surface = (Vec<Vector3<f64>>, Vec<[u32; 3]>);

/// Most bodies whose round surfaces are drawn finely.
const FINE_BODIES: usize = 24;

/// Ellipsoid of the body's mass and moments of inertia, smaller in proportion where it would hide the places that a pin
/// holds; None of a point, whose moments mean nothing.
fn of_inertia(body: &Body, pins_m: &[[f64; 3]]) -> Option<Surface> {
    /// Part of the way to a pin that is drawn as body.
    const OF_PIN: f64 = 0.75;
    if body.isotropic && body.I_B == Matrix3::identity() * body.mass_kg {
        return None;
    }
    let principal = body.I_B.symmetric_eigen();
    let [a, b, c]: [f64; 3] = principal.eigenvalues.into();
    let squared = Vector3::new(b + c - a, c + a - b, a + b - c) * (2.5 / body.mass_kg);
    let longest = squared.max();
    if !(longest > 0.0 && longest.is_finite()) {
        return None;
    }
    // A disc of no thickness, or a rod, can still be seen.
    const THINNEST: f64 = 1e-3;
    let semi_axes = squared.map(|x| x.max(THINNEST * longest).sqrt());
    // How far outside of the ellipsoid a place is: 1 on it.
    let outside =
        |p: &[f64; 3]| (principal.eigenvectors.transpose() * Vector3::from(*p)).component_div(&semi_axes).norm();
    let nearest = pins_m.iter().map(outside).filter(|part| *part > 0.0).fold(f64::INFINITY, f64::min);
    Some(ellipsoid(&(semi_axes * (OF_PIN * nearest).min(1.0)), &principal.eigenvectors, Vector3::zeros()))
}

/// Radius of the ball that a point is drawn as: a part of its pendulum, or of the way that it sets out for.
fn point_radius_m(model: &Model, i: usize, start: &State, clock: &Clock) -> f64 {
    const OF_ARM: f64 = 0.08;
    const OF_WAY: f64 = 0.02;
    let body = &start.bodies[i];
    let arms = model.pins.iter().filter(|pin| pin.body == i).map(|pin| pin.r_B.norm() * OF_ARM);
    let others = model.bodies.iter().map(|body| body.bounding_radius_m * OF_ARM);
    let fall_m = 0.5 * model.gravity_m_s2.norm() * clock.end_s * clock.end_s;
    let way_m = (body.v_WB.norm() * clock.end_s).max(fall_m) * OF_WAY;
    let radius_m = arms.fold(0.0, f64::max).max(others.fold(0.0, f64::max));
    let radius_m = if radius_m > 0.0 { radius_m } else { way_m };
    if radius_m > 0.0 && radius_m.is_finite() { radius_m } else { OF_ARM }
}

/// An ellipsoid by its semi-axes along the columns of a matrix, as a picture has it.
fn ellipsoid(semi_axes: &Vector3<f64>, axes: &Matrix3<f64>, centre: Vector3<f64>) -> Surface {
    let (points, triangles) = finer(Solid::Sphere { radius_m: 1.0 }.triangles());
    (points.iter().map(|p| axes * p.component_mul(semi_axes) + centre).collect(), triangles)
}

/// A ball of radius 1 with four triangles for each.
fn finer((mut points, triangles): Surface) -> Surface {
    let mut middles: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let mut finer = Vec::with_capacity(4 * triangles.len());
    for [a, b, c] in triangles {
        let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
            *middles.entry([from.min(to), from.max(to)]).or_insert_with(|| {
                let middle = points[from as usize] + points[to as usize];
                points.push(middle.normalize());
                points.len() as u32 - 1
            })
        });
        finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    (points, finer)
}

/// Longest arrow that stays in a picture of the bodies: of one body some of its radii, of several half of what they
/// take up at the start.
fn arrow_longest_m(model: &Model, start: &State) -> f64 {
    const RADII: f64 = 1.5;
    let count = start.bodies.len().max(1) as f64;
    let middle = start.bodies.iter().map(|body| body.p_WB).sum::<Vector3<f64>>() / count;
    let apart_m = start.bodies.iter().map(|body| (body.p_WB - middle).norm()).fold(0.0, f64::max);
    let radius_m = model.bodies.iter().filter(|body| !body.driven).map(|body| body.bounding_radius_m);
    (RADII * radius_m.fold(0.0, f64::max)).max(apart_m)
}

/// Length of an arrow a newton, and the weight that one as long as its body's radius stands for: that of the body
/// whose arrows are the longest; shorter where the weight of all bodies together would not fit. Without gravity, a
/// weight on Earth, which nothing says.
fn arrow(model: &Model, longest_m: f64) -> (f64, Option<f64>) {
    const EARTH: f64 = 9.8;
    let gravity = model.gravity_m_s2.norm();
    let weighing = if gravity > 0.0 { gravity } else { EARTH };
    let per_n = |body: &Body| (body.bounding_radius_m / (body.mass_kg * weighing), body.mass_kg * weighing);
    let moving = || model.bodies.iter().filter(|body| !body.driven).map(per_n);
    let longest = moving().fold((0.0, 0.0), |a, b| if b.0 > a.0 { b } else { a });
    let all_n: f64 = moving().map(|(_, weight_n)| weight_n).sum();
    match longest {
        (per_n, weight_n) if per_n > 0.0 => {
            let fitting = if longest_m > 0.0 { per_n.min(longest_m / all_n) } else { per_n };
            (fitting, (gravity > 0.0).then_some(weight_n))
        }
        _ => (1.0, None),
    }
}

/// Length of an arrow for 1 m/s: half of the longest for the fastest body at the start, or for what falls as far as the
/// longest arrow reaches.
fn arrow_m_per_m_s(model: &Model, start: &State, longest_m: f64) -> f64 {
    let fall_m_s = (2.0 * model.gravity_m_s2.norm() * longest_m).sqrt();
    let usual_m_s = start.bodies.iter().map(|body| body.v_WB.norm()).fold(fall_m_s, f64::max);
    if usual_m_s > 0.0 && usual_m_s.is_finite() { 0.5 * longest_m / usual_m_s } else { 1.0 }
}

/// Line strips of a box's edges.
fn container_strips(container: Option<&Container>) -> Vec<Vec<[f64; 3]>> {
    match container {
        Some(Container::Box(size)) => box_strips(size),
        _ => Vec::new(),
    }
}

/// Middle of the bodies at the start, and how far from it the ground is to reach: some bodies' sizes, and the way that
/// they set out for, up to a few more.
fn ground(model: &Model, start: &State, clock: &Clock) -> ([f64; 3], f64) {
    const SIZES: f64 = 4.0;
    const MOST_SIZES: f64 = 16.0;
    let count = start.bodies.len().max(1) as f64;
    let middle = start.bodies.iter().map(|body| body.p_WB).sum::<Vector3<f64>>() / count;
    let size_m = model.largest_radius_m();
    let apart_m = start.bodies.iter().map(|body| (body.p_WB - middle).norm()).fold(0.0, f64::max);
    let fastest_m_s = start.bodies.iter().map(|body| body.v_WB.norm()).fold(0.0, f64::max);
    let way_m = (fastest_m_s * clock.end_s).min(MOST_SIZES * size_m);
    (middle.into(), apart_m + SIZES * size_m + way_m)
}

fn planes(container: Option<&Container>) -> Vec<([f64; 3], f64)> {
    let of = |plane: &Plane| {
        let length = Vector3::from(plane.normal).norm();
        (plane.normal.map(|x| x / length), plane.offset_m)
    };
    match container {
        None => Vec::new(),
        Some(Container::Box(size)) => vec![([0.0, 1.0, 0.0], size.center()[1] - 0.5 * size.size_m[1])],
        Some(Container::Plane(plane)) => vec![of(plane)],
        Some(Container::Planes(planes)) => planes.iter().map(of).collect(),
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

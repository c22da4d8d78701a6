//! Reader of .rrd files of ours: what is drawn and plotted, positions rounded to f32. Numbers for programs are in an
//! .mcap.

use super::mend::messages;
use super::names::{BODIES, ENERGY, ENERGY_UNIT, LOG, PENETRATION, SIM_TIME, STEP};
use crate::record::RecordError;
use crate::record::read::ReadBack;
use crate::record::sample::{Batch, EnergySample, Event, Severity};
use crate::rows::BodyRow;
use ::rerun::log::{Chunk, LogMsg};
use ::rerun::{Scalars, TextLog, Transform3D};
use std::collections::BTreeMap;
use std::path::Path;

/// One time of a recording; what was not written then is not a number.
struct Moment {
    step: u64,
    bodies: Vec<BodyRow>,
    energy: [f64; 4],
}

const NO_BODY: BodyRow = BodyRow {
    position_m: [f64::NAN; 3],
    orientation_xyzw: [f64::NAN; 4],
    velocity_m_s: [f64::NAN; 3],
    angular_velocity_rad_s: [f64::NAN; 3],
};

/// What an .rrd shows, in the order of time: poses of bodies that have an entity each, energies, events. None: it is no
/// .rrd, or nothing in it has a time.
///
/// # Errors
/// The file cannot be read.
pub fn rounded(path: &Path) -> Result<Option<ReadBack>, RecordError> {
    let Some(messages) = messages(path)? else { return Ok(None) };
    let mut unit_j = None;
    let chunks: Vec<Chunk> = messages
        .filter_map(|message| match message {
            LogMsg::ArrowMsg(_, message) => Chunk::from_arrow_msg(&message).ok(),
            _ => None,
        })
        .inspect(|chunk| unit_j = energy_unit_j(chunk).or(unit_j))
        .filter(|chunk| chunk.timelines().keys().any(|name| name.as_str() == SIM_TIME))
        .collect();
    let bodies = bodies(&chunks);
    let mut moments: BTreeMap<i64, Moment> = BTreeMap::new();
    let mut events = Vec::new();
    for chunk in &chunks {
        let entity = chunk.entity_path().to_string();
        let times = times(chunk);
        if entity == LOG {
            events.extend(log(chunk, &times));
            continue;
        }
        if let Some(body) = bodies.iter().position(|body| body_entity(body) == entity) {
            let places = chunk.iter_slices::<[f32; 3]>(Transform3D::descriptor_translation().component);
            for (i, place) in places.enumerate() {
                if let (Some(moment), [p]) = (at(&mut moments, &times, i, bodies.len()), place) {
                    moment.bodies[body].position_m = p.map(f64::from);
                }
            }
            let turns = chunk.iter_slices::<[f32; 4]>(Transform3D::descriptor_quaternion().component);
            for (i, turn) in turns.enumerate() {
                if let (Some(moment), [q]) = (at(&mut moments, &times, i, bodies.len()), turn) {
                    moment.bodies[body].orientation_xyzw = q.map(f64::from);
                }
            }
        } else if let Some(energy) = energy(&entity) {
            for (i, row) in chunk.iter_slices::<f64>(Scalars::descriptor_scalars().component).enumerate() {
                if let (Some(moment), [x]) = (at(&mut moments, &times, i, bodies.len()), row) {
                    moment.energy[energy] = *x;
                }
            }
        }
    }
    if moments.is_empty() && events.is_empty() {
        return Ok(None);
    }
    let unit_j = unit_j.unwrap_or(1.0);
    let mut batch = Batch { events, ..Batch::default() };
    for (ns, moment) in moments {
        batch.time_s.push(ns as f64 / 1e9);
        batch.step.push(moment.step);
        batch.bodies.extend(moment.bodies);
        let [kinetic, potential, total, penetration_m] = moment.energy;
        let [kinetic_j, potential_j, total_j] = [kinetic, potential, total].map(|energy| energy * unit_j);
        batch.energy.push(EnergySample { kinetic_j, potential_j, total_j, penetration_m });
    }
    Ok(Some(ReadBack { bodies, samples: batch, ..ReadBack::default() }))
}

/// The unit of energies, where a chunk tells it.
fn energy_unit_j(chunk: &Chunk) -> Option<f64> {
    let component = chunk.components_identifiers().find(|name| name.as_str() == ENERGY_UNIT)?;
    chunk.iter_slices::<f64>(component).find_map(|row| row.first().copied())
}

/// What there is at the time of a row.
fn at<'a>(
    moments: &'a mut BTreeMap<i64, Moment>,
    times: &[(i64, u64)],
    i: usize,
    bodies: usize,
) -> Option<&'a mut Moment> {
    let (ns, step) = times.get(i).copied()?;
    let blank = || Moment { step, bodies: vec![NO_BODY; bodies], energy: [f64::NAN; 4] };
    Some(moments.entry(ns).or_insert_with(blank))
}

/// Names of the bodies, as they stand in the paths of their entities.
fn bodies(chunks: &[Chunk]) -> Vec<String> {
    let mut bodies: Vec<String> = Vec::new();
    let translation = Transform3D::descriptor_translation().component;
    for chunk in chunks.iter().filter(|chunk| chunk.components_identifiers().any(|name| name == translation)) {
        let entity = chunk.entity_path().to_string();
        let name =
            entity.strip_prefix(BODIES).and_then(|rest| rest.strip_prefix('/')).map(|name| name.replace('\\', ""));
        bodies.extend(name.filter(|name| !bodies.contains(name)));
    }
    bodies
}

fn body_entity(name: &str) -> String {
    super::names::body_path(name).to_string()
}

/// Place of a plotted energy among the four.
fn energy(entity: &str) -> Option<usize> {
    let name = entity.strip_prefix(ENERGY).and_then(|rest| rest.strip_prefix('/'));
    match name {
        Some("kinetic") => Some(0),
        Some("potential") => Some(1),
        Some("total") => Some(2),
        _ => (entity == PENETRATION).then_some(3),
    }
}

/// Time in nanoseconds and step of every row.
fn times(chunk: &Chunk) -> Vec<(i64, u64)> {
    let column = |timeline: &str| {
        let column = chunk.timelines().values().find(|column| column.timeline().name().as_str() == timeline);
        column.map(|column| column.times_raw().to_vec()).unwrap_or_default()
    };
    let steps = column(STEP);
    let step = |i: usize| steps.get(i).copied().and_then(|step| u64::try_from(step).ok()).unwrap_or(0);
    column(SIM_TIME).into_iter().enumerate().map(|(i, ns)| (ns, step(i))).collect()
}

fn log(chunk: &Chunk, times: &[(i64, u64)]) -> Vec<Event> {
    let texts = |component| {
        let rows = chunk.iter_slices::<String>(component);
        rows.map(|row| row.first().map(|text| text.to_string()).unwrap_or_default()).collect::<Vec<_>>()
    };
    let levels = texts(TextLog::descriptor_level().component);
    let texts = texts(TextLog::descriptor_text().component);
    let severity = |level: &str| match level {
        "WARN" => Severity::Warning,
        "ERROR" => Severity::Error,
        _ => Severity::Info,
    };
    let events = texts.into_iter().zip(levels).zip(times).map(|((text, level), (ns, step))| Event {
        step: *step,
        time_s: *ns as f64 / 1e9,
        severity: severity(&level),
        text,
    });
    events.collect()
}

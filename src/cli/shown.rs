//! Output of `run` about a run: a summary, or one JSON document with its columns, bodies and contacts.

use super::output::{counted, say};
use super::remarks::Remarks;
use crate::build_info::BUILD;
use crate::case::Case;
use crate::files::quoted;
use crate::model::{self, Model};
use crate::outcome::Outcome;
use crate::plan::Plan;
use crate::record::writer::Target;
use crate::rows::{BodyRow, Measured, Row};
use crate::run::Ended;
use crate::shown::ContactForce;
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::path::Path;

/// JSON of a run: the columns of its row, the state and contacts at the end, and remarks. `recording` is its name, if
/// there is one.
pub(super) fn document(case: &Case, recording: Option<&str>, model: &Model, ended: &Ended, remarks: &Remarks) -> Value {
    let row = Row {
        case: case.id.clone(),
        axes: case.axes.clone(),
        measured: ended.measured.clone().into(),
        recording: recording.map(str::to_string),
        build: BUILD.to_string(),
    };
    let mut document = serde_json::to_value(row).unwrap_or_default();
    document["bodies"] = bodies(model, ended);
    document["contacts"] = ended.forces.iter().map(|force| contact(model, force)).collect();
    remarks.put_into(&mut document);
    document
}

fn bodies(model: &Model, ended: &Ended) -> Value {
    let ends = || ended.forces.iter().flat_map(|force| force.contact.ends().map(move |end| (end, force.force_W)));
    let force_n = |i: usize| {
        let on_body = ends().filter(|((body, ..), _)| *body == i);
        on_body.map(|((.., sign), force_W)| force_W * sign).sum::<Vector3<f64>>()
    };
    let body = |(i, (body, at)): (usize, (&model::Body, &crate::state::BodyState))| {
        let row = BodyRow::from(at);
        json!({
            "name": body.name,
            "mass_kg": body.mass_kg,
            "position_m": row.position_m,
            "origin_m": numbers(&body.p_WBo(at)),
            "orientation_xyzw": row.orientation_xyzw,
            "velocity_m_s": row.velocity_m_s,
            "angular_velocity_rad_s": row.angular_velocity_rad_s,
            "contact_force_n": numbers(&force_n(i)),
        })
    };
    model.bodies.iter().zip(&ended.state.bodies).enumerate().map(body).collect()
}

fn contact(model: &Model, ContactForce { contact, force_W }: &ContactForce) -> Value {
    let other = contact.other.map_or("container", |other| &model.bodies[other].name);
    json!({
        "bodies": [model.bodies[contact.body].name, other],
        "point_m": numbers(&contact.p_WC),
        "normal": numbers(&contact.normal),
        "force_n": numbers(force_W),
        "gap_m": contact.gap_m,
    })
}

/// Components of a vector; null where one is not finite.
fn numbers(v: &Vector3<f64>) -> Value {
    v.iter().map(|x| json!(x)).collect()
}

pub(super) fn summary(id: &str, m: &Measured) -> String {
    let number = |x: Option<f64>| x.map_or("-".to_string(), |x| format!("{x:.6}"));
    // Of whatever size: six digits that say something.
    let telling = |x: Option<f64>| {
        x.map_or("-".to_string(), |x| match x.abs() {
            size if size == 0.0 || (1e-3..1e9).contains(&size) => format!("{x:.6}"),
            _ => format!("{x:.5e}"),
        })
    };
    let relative = |x: Option<f64>| x.map_or("-".to_string(), |x| format!("{x:.2e}"));
    let count = |x: Option<u64>| x.map_or("-".to_string(), |x| x.to_string());
    let how = match (&m.outcome, &m.criterion) {
        (Outcome::Finished, _) => "finished".to_string(),
        (outcome, criterion) => {
            format!("{outcome:?} ({})", criterion.as_deref().unwrap_or("no reason given")).to_lowercase()
        }
    };
    let lines = [
        ("case", id.to_string()),
        ("outcome", format!("{how} at {} s after {}", number(m.end_time_s), counted(m.steps as usize, "step"))),
        ("energy", format!("{} J → {} J", telling(m.energy_start_j), telling(m.energy_end_j))),
        ("energy drift, rise", format!("{}, {}", relative(m.energy_drift_rel), relative(m.energy_rise_max_rel))),
        ("momentum drift", relative(m.linear_momentum_drift_rel)),
        ("angular momentum drift", relative(m.angular_momentum_drift_rel)),
        ("penetration max, end", format!("{}, {} m", relative(m.penetration_max_m), relative(m.penetration_end_m))),
        ("residual max", relative(m.residual_max)),
        ("ghosts, passages", format!("{}, {}", relative(m.ghost_impulse_max_rel), count(m.passed_through))),
        ("contact gain max", number(m.contact_gain_max)),
        ("contacts max", m.contacts_max.to_string()),
        ("stepping", format!("{} s", number(m.wall_s))),
    ];
    let met = if m.tolerance_met.as_deref() == Some("no") { ", not what was asked for" } else { "" };
    let wrong_by = m.error_estimate_m.map_or("nobody knows how much".to_string(), |by_m| format!("{by_m:.2e} m"));
    let chosen = m.method_used.as_ref().map(|method| format!("{method}, wrong by {wrong_by}{met}"));
    let error = m.error_position_m.map(|error_m| format!("{error_m:.2e} m at {} s", number(m.error_time_s)));
    let more = [
        ("chosen", chosen),
        ("error of positions", error),
        ("sensitivity", m.sensitivity.map(|kappa| format!("{kappa:.2e}"))),
    ];
    let more = more.into_iter().filter_map(|(name, value)| Some((name, value?)));
    lines.into_iter().chain(more).map(|(name, value)| format!("{name:>24}  {value}")).collect::<Vec<_>>().join("\n")
}

/// Prints the stages that the scene needs, and those that are skipped, each with the reason.
pub(super) fn describe_plan(plan: &Plan) {
    for stage in &plan.stages {
        let how = if stage.runs { "runs" } else { "skipped" };
        say(format!("{}: {how} — {}", stage.name, stage.why));
    }
}

/// Says that a recording is there, and how to open it.
pub(super) fn to_open(path: &Path) -> String {
    let path = path.display().to_string();
    format!("wrote {path}   (open: gotai view {})", quoted(&path))
}

/// Prints where the recordings are, and how to open them.
pub(super) fn say_where(dir: &Path, name: &str, targets: &[Target]) {
    for target in targets {
        let path = target.path(dir, name);
        match target {
            Target::Rerun => say(to_open(&path)),
            Target::Mcap => say(format!("wrote {}", path.display())),
        }
    }
}

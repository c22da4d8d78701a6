//! `gotai run`: one experiment, its recordings, a summary.

use super::args::{ExperimentArgs, OutputArgs, RunArgs};
use super::error::CliError;
use super::output::{print, print_json};
use super::progress::Bar;
use crate::build_info::BUILD;
use crate::case::Case;
use crate::collide::SolvedContact;
use crate::files::make_folder;
use crate::model::{self, Model};
use crate::outcome::Outcome;
use crate::plan::Plan;
use crate::record::writer::Target;
use crate::rows::{Measured, Row};
use crate::run::Ended;
use crate::study::reference;
use crate::sweep::build::build;
use crate::sweep::plan::single_case;
use crate::sweep::runner::{Progress, run_case};
use clap::Args;
use nalgebra::Vector3;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Args)]
pub struct Command {
    /// The experiment file (YAML)
    config: PathBuf,
    #[command(flatten)]
    experiment: ExperimentArgs,
    #[command(flatten)]
    run: RunArgs,
    #[command(flatten)]
    output: OutputArgs,
}

impl Command {
    pub fn run(self) -> Result<ExitCode, CliError> {
        self.experiment.refuse_axes()?;
        let file = self.experiment.load(&self.config)?;
        let case = single_case(&file)?;
        let targets = self.run.targets(case.experiment.record.to)?;
        let dir = self.run.out.clone().unwrap_or_else(|| self.experiment.default_out(&self.config));
        if !targets.is_empty() {
            make_folder(&dir)?;
        }
        let (model, start) = build(&file, &[], &case.experiment)?;
        if self.output.verbose {
            describe_plan(&Plan::new(&model, &case.experiment.method));
        }
        if case.experiment.reference.is_some() {
            let bar = Bar::new(self.output.quiet);
            bar.begin("references", 1);
            reference::of(&dir, &case.experiment, &model, &start)?;
            bar.end();
        }
        let (ended, written) = run_case(&case, &model, start, &dir, &targets);
        if self.output.json {
            print_json(&document(&case, &model, &ended));
        } else {
            print(summary(&case, &ended.measured));
        }
        written?;
        if !self.output.quiet {
            say_where(&case, &dir, &targets);
        }
        Ok(ExitCode::from(u8::from(ended.measured.outcome == Outcome::Failed)))
    }
}

/// The columns of the row, and the state and contacts at the end.
fn document(case: &Case, model: &Model, ended: &Ended) -> Value {
    let row = Row {
        case: case.id.clone(),
        axes: case.axes.clone(),
        measured: ended.measured.clone(),
        build: BUILD.to_string(),
    };
    let mut document = serde_json::to_value(row).unwrap_or_default();
    document["bodies"] = bodies(model, ended);
    document["contacts"] = ended.contacts.iter().map(|solved| contact(model, ended, solved)).collect();
    document
}

fn bodies(model: &Model, ended: &Ended) -> Value {
    let force_n = |i: usize| {
        let ends =
            ended.contacts.iter().flat_map(|solved| solved.contact.ends().map(move |end| (end, solved.impulse_W)));
        let on_body = ends.filter(|((body, ..), _)| *body == i);
        on_body.map(|((.., sign), impulse_W)| impulse_W * sign).sum::<Vector3<f64>>() / ended.step_s
    };
    let body = |(i, (body, at)): (usize, (&model::Body, &crate::state::BodyState))| {
        json!({
            "name": body.name,
            "mass_kg": body.mass_kg,
            "position_m": numbers(&at.p_WB),
            "origin_m": numbers(&body.p_WBo(at)),
            "orientation_xyzw": at.q_WB.coords.iter().map(|x| json!(x)).collect::<Value>(),
            "velocity_m_s": numbers(&at.v_WB),
            "angular_velocity_rad_s": numbers(&at.w_WB),
            "contact_force_n": numbers(&force_n(i)),
        })
    };
    model.bodies.iter().zip(&ended.state.bodies).enumerate().map(body).collect()
}

fn contact(model: &Model, ended: &Ended, solved: &SolvedContact) -> Value {
    let other = solved.contact.other.map_or("container", |other| &model.bodies[other].name);
    json!({
        "bodies": [model.bodies[solved.contact.body].name, other],
        "point_m": numbers(&solved.contact.p_WC),
        "normal": numbers(&solved.contact.normal),
        "force_n": numbers(&(solved.impulse_W / ended.step_s)),
        "gap_m": solved.contact.gap_m,
    })
}

/// Not finite: null.
fn numbers(v: &Vector3<f64>) -> Value {
    v.iter().map(|x| json!(x)).collect()
}

fn summary(case: &Case, m: &Measured) -> String {
    let number = |x: Option<f64>| x.map_or("-".to_string(), |x| format!("{x:.6}"));
    let relative = |x: Option<f64>| x.map_or("-".to_string(), |x| format!("{x:.2e}"));
    let how = match (&m.outcome, &m.criterion) {
        (Outcome::Finished, _) => "finished".to_string(),
        (outcome, criterion) => {
            format!("{outcome:?} ({})", criterion.as_deref().unwrap_or("no reason given")).to_lowercase()
        }
    };
    let lines = [
        ("case", case.id.clone()),
        ("outcome", format!("{how} at {} s after {} steps", number(m.end_time_s), m.steps)),
        ("energy", format!("{} J → {} J", number(m.energy_start_j), number(m.energy_end_j))),
        ("energy drift, rise", format!("{}, {}", relative(m.energy_drift_rel), relative(m.energy_rise_max_rel))),
        ("momentum drift", relative(m.linear_momentum_drift_rel)),
        ("angular momentum drift", relative(m.angular_momentum_drift_rel)),
        ("penetration max, end", format!("{}, {} m", relative(m.penetration_max_m), relative(m.penetration_end_m))),
        ("contact gain max", number(m.contact_gain_max)),
        ("contacts max", m.contacts_max.to_string()),
        ("stepping", format!("{} s", number(m.wall_s))),
    ];
    let chosen = m.method_used.as_ref().map(|method| format!("{method}, wrong by {} m", relative(m.error_estimate_m)));
    let error = m.error_position_m.map(|error_m| format!("{error_m:.2e} m at {} s", number(m.error_time_s)));
    let more = [
        ("chosen", chosen),
        ("error of positions", error),
        ("sensitivity", m.sensitivity.map(|kappa| format!("{kappa:.2e}"))),
    ];
    let more = more.into_iter().filter_map(|(name, value)| Some((name, value?)));
    lines.into_iter().chain(more).map(|(name, value)| format!("{name:>24}  {value}")).collect::<Vec<_>>().join("\n")
}

/// What the scene needs, and what is skipped.
fn describe_plan(plan: &Plan) {
    for stage in &plan.stages {
        let how = if stage.runs { "runs" } else { "skipped" };
        eprintln!("{}: {how} — {}", stage.name, stage.why);
    }
}

fn say_where(case: &Case, dir: &Path, targets: &[Target]) {
    for target in targets {
        let path = dir.join(format!("{}.{}", case.id, target.extension()));
        match target {
            Target::Rerun => eprintln!("wrote {}   (open: rerun {0}, of rerun-sdk==0.36.3)", path.display()),
            Target::Mcap => eprintln!("wrote {}", path.display()),
        }
    }
}

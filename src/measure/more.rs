//! Columns that are measured only when `measure:` asks for them.

use super::contact_matrix::ContactMatrix;
use super::critical_step::CriticalStep;
use super::difference::Differences;
use crate::collide::SolvedContact;
use crate::experiment::types::{self as file, Experiment, Measure};
use crate::heading::{EACH_BODY, Heading};
use crate::model::{Body, Model};
use crate::rows::{BodyRow, columns};
use crate::state::State;
use serde_json::{Map, Value, json};

/// What has to be watched during the run; nothing unless it is asked for.
#[derive(Clone, Debug, Default)]
pub struct Watched {
    pub contact_matrix: Option<ContactMatrix>,
    pub critical_step: Option<CriticalStep>,
    pub differences: Option<Differences>,
}

impl Watched {
    pub fn new(measures: &[Measure]) -> Self {
        let asked = |measure| measures.contains(&measure);
        Watched {
            contact_matrix: asked(Measure::ContactMatrix).then(ContactMatrix::default),
            critical_step: asked(Measure::CriticalStep).then(CriticalStep::default),
            differences: asked(Measure::DifferenceQuotients).then(Differences::default),
        }
    }

    /// Nothing is asked for.
    pub fn is_empty(&self) -> bool {
        self.differences.is_none() && self.contact_matrix.is_none() && self.critical_step.is_none()
    }

    /// Of every step.
    pub fn observe_step(&mut self, before: &State, after: &State, step_s: f64) {
        if let Some(watch) = &mut self.differences {
            watch.observe(before, after, step_s);
        }
    }

    /// Of a step with contacts.
    pub fn observe(&mut self, before: &State, contacts: &[SolvedContact]) {
        if let Some(watch) = &mut self.contact_matrix {
            watch.observe(before, contacts);
        }
        if let Some(watch) = &mut self.critical_step {
            watch.observe(before, contacts);
        }
    }
}

/// The columns that an experiment asks for, from its model, its last state and what was watched on the way there.
pub fn cells(experiment: &Experiment, model: &Model, end: &State, watched: &Watched) -> Map<String, Value> {
    let of = |measure: &Measure| -> Vec<Value> {
        match measure {
            Measure::State => end.bodies.iter().flat_map(|at| BodyRow::from(at).numbers()).map(Value::from).collect(),
            Measure::Inertia => experiment.scene.bodies.iter().zip(&model.bodies).flat_map(inertia).collect(),
            Measure::ContactMatrix => watched.contact_matrix.iter().flat_map(|watch| watch.columns(model)).collect(),
            Measure::CriticalStep => {
                let settings = experiment.method.penalty();
                watched.critical_step.iter().flat_map(|watch| watch.columns(model, settings)).collect()
            }
            Measure::DifferenceQuotients => watched.differences.iter().flat_map(Differences::columns).collect(),
            Measure::Sensitivity => Vec::new(),
        }
    };
    // Measure by measure: what one of them leaves out shifts no column of another.
    let named = |measure: &Measure| names_of(*measure, experiment).into_iter().zip(of(measure));
    experiment.measure.iter().flat_map(named).collect()
}

/// Names of those columns, before anything has run.
pub fn names(experiment: &Experiment) -> Vec<String> {
    experiment.measure.iter().flat_map(|measure| names_of(*measure, experiment)).collect()
}

/// Body by body, as their values come.
fn names_of(measure: Measure, experiment: &Experiment) -> Vec<String> {
    let headings = headings(measure);
    if !headings.iter().any(|heading| heading.name.starts_with(EACH_BODY)) {
        return columns::names(headings);
    }
    let of_body = |body: &file::Body| headings.iter().flat_map(|h| h.names_of(&body.name)).collect::<Vec<_>>();
    experiment.scene.bodies.iter().flat_map(of_body).collect()
}

/// The columns that a word of `measure:` adds.
pub fn headings(measure: Measure) -> &'static [Heading] {
    match measure {
        Measure::State => &columns::STATE,
        Measure::Inertia => &columns::INERTIA,
        Measure::ContactMatrix => &columns::CONTACT_MATRIX,
        Measure::CriticalStep => &columns::CRITICAL_STEP,
        Measure::DifferenceQuotients => &columns::DIFFERENCE_QUOTIENTS,
        // A column of every row.
        Measure::Sensitivity => &[],
    }
}

/// As the run used them. A point without `inertia_kg_m2` has none.
fn inertia((described, body): (&file::Body, &Body)) -> Vec<Value> {
    let is_point = described.shape == file::Shape::None && described.inertia_kg_m2.is_none();
    let (p, I) = (&body.p_BoBcm, &body.I_B);
    let tensor = [I[(0, 0)], I[(1, 1)], I[(2, 2)], I[(0, 1)], I[(1, 2)], I[(2, 0)]];
    let tensor = tensor.map(|x| if is_point { Value::Null } else { json!(x) });
    [body.mass_kg, p.x, p.y, p.z].map(|x| json!(x)).into_iter().chain(tensor).collect()
}

//! Columns that are measured only when `measure:` asks for them.

use crate::experiment::types::{Experiment, Measure};
use crate::model::Model;
use crate::state::{BodyState, State};
use serde_json::{Map, Value, json};

/// The columns that an experiment asks for, from its model and its last state.
pub fn columns(experiment: &Experiment, model: &Model, end: &State) -> Map<String, Value> {
    let mut columns = Map::new();
    for measure in &experiment.measure {
        match measure {
            Measure::State => columns.extend(end_states(model, end)),
        }
    }
    columns
}

/// Names of those columns, before anything has run.
pub fn names(experiment: &Experiment) -> Vec<String> {
    let bodies = || experiment.scene.bodies.iter().map(|body| body.name.as_str());
    let of = |measure: &Measure| match measure {
        Measure::State => bodies().flat_map(state_names).collect::<Vec<_>>(),
    };
    experiment.measure.iter().flat_map(of).collect()
}

/// The vectors of a state and their components.
const STATE: [(&str, &[&str]); 4] = [
    ("position_m", &["x", "y", "z"]),
    ("orientation_xyzw", &["x", "y", "z", "w"]),
    ("velocity_m_s", &["x", "y", "z"]),
    ("angular_velocity_rad_s", &["x", "y", "z"]),
];

fn state_names(body: &str) -> Vec<String> {
    let components = |(vector, parts): (&str, &[&str])| {
        parts.iter().map(|part| format!("{body}.{vector}.{part}")).collect::<Vec<_>>()
    };
    STATE.into_iter().flat_map(components).collect()
}

/// Position of the centre of mass, attitude body → world, velocities in the world frame.
fn end_states(model: &Model, end: &State) -> Map<String, Value> {
    let numbers = |at: &BodyState| -> Vec<Value> {
        let parts = [at.p_WB.as_slice(), at.q_WB.coords.as_slice(), at.v_WB.as_slice(), at.w_WB.as_slice()];
        parts.concat().into_iter().map(|x| json!(x)).collect()
    };
    let bodies = model.bodies.iter().zip(&end.bodies);
    bodies.flat_map(|(body, at)| state_names(&body.name).into_iter().zip(numbers(at))).collect()
}

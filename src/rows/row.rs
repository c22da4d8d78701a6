//! One row a case: the outcome and what the judges measured. Columns as in the README.

use crate::outcome::Outcome;
use crate::work::Work;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Fields are columns, in this order; a number that means nothing here is null.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    pub case: String,
    /// Every axis by its path.
    #[serde(flatten)]
    pub axes: Map<String, Value>,
    #[serde(flatten)]
    pub measured: Measured,
    /// Hash of the program that made the row.
    pub build: String,
}

/// What a run measures, whatever sweep it belongs to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    pub outcome: Outcome,
    /// What stopped it; null when finished.
    pub criterion: Option<String>,
    pub end_time_s: Option<f64>,
    pub steps: u64,
    pub step_used_s: Option<f64>,
    pub method_used: Option<String>,
    pub tolerance_used: Option<f64>,
    pub energy_start_j: Option<f64>,
    pub energy_end_j: Option<f64>,
    pub energy_drift_rel: Option<f64>,
    pub energy_rise_max_rel: Option<f64>,
    pub linear_momentum_drift_rel: Option<f64>,
    pub angular_momentum_drift_rel: Option<f64>,
    pub penetration_max_m: Option<f64>,
    pub penetration_end_m: Option<f64>,
    pub pin_gap_max_m: Option<f64>,
    pub residual_max: Option<f64>,
    pub contact_gain_max: Option<f64>,
    pub error_position_m: Option<f64>,
    pub error_orientation_rad: Option<f64>,
    pub error_velocity_m_s: Option<f64>,
    pub error_angular_velocity_rad_s: Option<f64>,
    pub error_time_s: Option<f64>,
    pub error_estimate_m: Option<f64>,
    pub reference_uncertainty_m: Option<f64>,
    pub reference_until_s: Option<f64>,
    pub sensitivity: Option<f64>,
    pub contacts_max: u64,
    pub work_contact_tests: u64,
    pub work_contacts: u64,
    pub work_contact_solves: u64,
    pub work_sweeps: u64,
    pub work_unsolved: u64,
    pub work_newton_steps: u64,
    pub work_gyroscopic: u64,
    pub work_pin_solves: u64,
    pub work_inner_steps: u64,
    pub work_events: u64,
    pub work_fallbacks: u64,
    pub wall_s: Option<f64>,
    pub wall_search_s: Option<f64>,
    /// Columns that only some experiments have: `measure:`, the bracket of a search.
    #[serde(flatten)]
    pub more: Map<String, Value>,
}

impl Measured {
    /// A case that panicked, with its message.
    pub fn failed(message: String) -> Self {
        Measured { outcome: Outcome::Failed, criterion: Some(message), ..Measured::nothing() }
    }

    /// Every number null or 0.
    pub fn nothing() -> Self {
        Measured {
            outcome: Outcome::Finished,
            criterion: None,
            end_time_s: None,
            steps: 0,
            step_used_s: None,
            method_used: None,
            tolerance_used: None,
            energy_start_j: None,
            energy_end_j: None,
            energy_drift_rel: None,
            energy_rise_max_rel: None,
            linear_momentum_drift_rel: None,
            angular_momentum_drift_rel: None,
            penetration_max_m: None,
            penetration_end_m: None,
            pin_gap_max_m: None,
            residual_max: None,
            contact_gain_max: None,
            error_position_m: None,
            error_orientation_rad: None,
            error_velocity_m_s: None,
            error_angular_velocity_rad_s: None,
            error_time_s: None,
            error_estimate_m: None,
            reference_uncertainty_m: None,
            reference_until_s: None,
            sensitivity: None,
            contacts_max: 0,
            work_contact_tests: 0,
            work_contacts: 0,
            work_contact_solves: 0,
            work_sweeps: 0,
            work_unsolved: 0,
            work_newton_steps: 0,
            work_gyroscopic: 0,
            work_pin_solves: 0,
            work_inner_steps: 0,
            work_events: 0,
            work_fallbacks: 0,
            wall_s: None,
            wall_search_s: None,
            more: Map::new(),
        }
    }

    pub fn count_work(&mut self, work: &Work) {
        self.work_contact_tests = work.contact_tests;
        self.work_contacts = work.contacts;
        self.work_contact_solves = work.contact_solves;
        self.work_sweeps = work.sweeps;
        self.work_unsolved = work.unsolved;
        self.work_newton_steps = work.newton_steps;
        self.work_gyroscopic = work.gyroscopic;
        self.work_pin_solves = work.pin_solves;
        self.work_inner_steps = work.inner_steps;
        self.work_events = work.events;
        self.work_fallbacks = work.fallbacks;
    }

    /// The same but for the time it took: what two runs of one case must agree in.
    pub fn without_wall_time(&self) -> Self {
        Measured { wall_s: None, wall_search_s: None, ..self.clone() }
    }
}

/// Of a row, or a part of one, by the names of its columns.
pub fn cells(row: &impl Serialize) -> Map<String, Value> {
    match serde_json::to_value(row) {
        Ok(Value::Object(cells)) => cells,
        // Rows are structs of plain data.
        _ => Map::new(),
    }
}

/// Rows that ended so.
pub fn count(rows: &[Row], outcome: Outcome) -> usize {
    rows.iter().filter(|row| row.measured.outcome == outcome).count()
}

/// A number that JSON can hold.
pub fn finite(x: f64) -> Option<f64> {
    x.is_finite().then_some(x)
}

//! The rows of a bench and what they say together: the order of every method, and who is on the Pareto front.

use crate::math::order::{Order, fit_above};
use serde::{Deserialize, Serialize};

/// One row of a bench. Fields are columns of `bench.csv` and keys of `bench.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Path of the experiment file, without its ending.
    pub scene: String,
    pub engine: String,
    pub method: String,
    /// Length of the steps; null for a method that needs none.
    pub step_s: Option<f64>,
    /// Tolerance of the method; null without error control.
    pub tolerance: Option<f64>,
    /// Number of steps that the method made: those inside a clock's step where it controls its error.
    pub steps: u64,
    /// Absolute value of the column `error_kind`; null unless the run has finished.
    pub error: Option<f64>,
    pub error_kind: String,
    /// Time of the best repeat; null unless the run has finished.
    pub wall_s: Option<f64>,
    pub wall_median_s: Option<f64>,
    pub outcome: String,
    pub criterion: Option<String>,
}

impl Trial {
    /// Error and run time, of a row that has both.
    pub fn point(&self) -> Option<(f64, f64)> {
        Some((self.error?, self.wall_s?))
    }
}

/// The rows of each engine that no other row of it beats, engines in the order of their first rows, the fastest first.
pub fn best_of_each_engine(rows: &[Trial]) -> Vec<Trial> {
    let mut engines: Vec<&str> = Vec::new();
    for row in rows {
        if !engines.contains(&row.engine.as_str()) {
            engines.push(&row.engine);
        }
    }
    let mut best = Vec::new();
    for engine in engines {
        let own: Vec<Trial> = rows.iter().filter(|row| row.engine == engine).cloned().collect();
        let on_front = pareto(&own, 0.0);
        let mut front: Vec<Trial> =
            own.into_iter().zip(on_front).filter(|(_, is_on)| *is_on).map(|(row, _)| row).collect();
        front.sort_by(|a, b| a.wall_s.unwrap_or(f64::INFINITY).total_cmp(&b.wall_s.unwrap_or(f64::INFINITY)));
        best.extend(front);
    }
    best
}

/// Labels of the methods in the order of their first rows.
pub fn methods(rows: &[Trial]) -> Vec<&str> {
    let mut methods: Vec<&str> = Vec::new();
    for row in rows {
        if !methods.contains(&row.method.as_str()) {
            methods.push(&row.method);
        }
    }
    methods
}

/// Order of a method: of the error in the step, or in the mean of its own steps (proportional to 1 / their number),
/// above what is rounding.
pub fn order(rows: &[Trial], method: &str, floor: f64) -> Option<Order> {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for row in rows.iter().filter(|row| row.method == method) {
        let step = match (row.step_s, row.tolerance) {
            (Some(step_s), _) => step_s,
            (None, Some(_)) => 1.0 / row.steps as f64,
            (None, None) => continue,
        };
        if let Some(error) = row.error.filter(|_| points.iter().all(|(other, _)| *other != step)) {
            points.push((step, error));
        }
    }
    fit_above(&points, floor)
}

/// Whether each row is on the Pareto front: no other is at least as accurate and as fast, and one of both more; errors
/// that are rounding are alike. Closed forms do not compete: errors are measured against them.
pub fn pareto(rows: &[Trial], floor: f64) -> Vec<bool> {
    let competing = |row: &Trial| {
        let (error, wall_s) = row.point().filter(|_| row.step_s.or(row.tolerance).is_some())?;
        Some((error.max(floor), wall_s))
    };
    let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
    let is_beaten = |point| rows.iter().filter_map(competing).any(|other| beats(other, point));
    rows.iter().map(|row| competing(row).is_some_and(|point| !is_beaten(point))).collect()
}

/// The rows as CSV.
///
/// # Errors
/// None that a row of plain data can cause; the writer's own.
pub fn to_csv(rows: &[Trial]) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    writer.into_inner().map_err(|error| error.into_error().into())
}

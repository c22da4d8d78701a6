//! Rows to come: a case, or a search that makes one row.

use super::cell::Cell;
use super::names;
use crate::case::Case;
use crate::experiment::ExperimentFile;
use crate::experiment::types::Accuracy;
use crate::record::name::RecordingName;
use crate::record::writer::Target;
use crate::study::Recording;
use std::path::Path;

/// One row to come.
#[derive(Clone, Debug)]
pub struct Planned {
    pub case: Case,
    /// Point of the case: for every axis of the file the index of its value; empty without axes.
    pub point: Vec<usize>,
    /// Name of its recording.
    pub name: RecordingName,
    /// Search of many runs that make the row: a bisection, whose first run is the case's.
    pub search: Option<Box<Cell>>,
}

impl Planned {
    /// A case at a point of the axes of a file that is called `config`.
    pub fn new(file: &ExperimentFile, case: Case, point: Vec<usize>, config: &str) -> Self {
        let name = RecordingName::new(&names::values(file, &point, config), &case.id[..RecordingName::DIGITS]);
        Planned { case, point, name, search: None }
    }

    /// Puts all digits of its id into its name.
    pub fn with_whole_id(&mut self, file: &ExperimentFile, config: &str) {
        self.name = RecordingName::new(&names::values(file, &self.point, config), &self.case.id);
    }

    /// How long it is likely to take beside others, by counts alone: steps times what there is to move and to touch.
    pub fn likely_cost(&self) -> f64 {
        /// Stretches of a second, of a method that follows events, beside steps of others, each of which costs more.
        const STRETCHES_1_S: f64 = 1e3;
        let experiment = &self.case.experiment;
        let steps = match experiment.method.accuracy() {
            Accuracy::Step => experiment.clock().steps as f64,
            Accuracy::Tolerance(_) | Accuracy::Closed => STRETCHES_1_S * experiment.time.end_s,
        };
        let runs = self.search.as_ref().map_or(1, |cell| cell.expected_runs());
        steps * experiment.scene.bodies.len() as f64 * runs as f64
    }

    /// Recording of the case in a folder; None where there is no kind of file to record into.
    pub fn recording<'a>(&'a self, dir: &'a Path, targets: &'a [Target]) -> Option<Recording<'a>> {
        (!targets.is_empty()).then_some(Recording { dir, targets, case: &self.case, name: &self.name, live: None })
    }
}

//! ONE DOOR: a case from its start to what was measured. Sweep, search, run, check and bench all come through here, and
//! nobody else chooses, refers or looks for twins.

use super::choose::{self, Chosen};
use super::{reference, sensitivity};
use crate::case::Case;
use crate::experiment::types::Experiment;
use crate::model::Model;
use crate::record::RecordError;
use crate::record::head::header;
use crate::record::name::RecordingName;
use crate::record::sampler::Sampler;
use crate::record::writer::{FileSum, Target, open};
use crate::run::{self, Ended, ticks};
use crate::state::State;
use std::path::Path;

/// Place of a run: where it finds what it is measured against, and what it leaves beside its result.
#[derive(Clone, Copy, Default)]
pub struct Place<'a> {
    /// Folder in which references are kept; None where they are made for this run alone.
    pub references: Option<&'a Path>,
    /// Recording of the run; None where it is not recorded.
    pub recording: Option<Recording<'a>>,
}

/// Files and name of a run's recording.
#[derive(Clone, Copy)]
pub struct Recording<'a> {
    pub dir: &'a Path,
    pub targets: &'a [Target],
    pub case: &'a Case,
    pub name: &'a RecordingName,
    /// Port of a viewer on this machine that shows the run while it goes on.
    pub live: Option<u16>,
}

/// A run that has been measured.
pub struct Studied {
    pub ended: Ended,
    /// Experiment that has run.
    pub chosen: Chosen,
    /// Sums of the files of the recording, or its failure. A run that cannot be recorded still has its result.
    pub recorded: Result<Vec<FileSum>, RecordError>,
}

/// Result of an experiment, run from `start` to its end or its divergence.
pub fn measure(experiment: &Experiment, model: &Model, start: State, place: &Place) -> Studied {
    let reference = place.references.map_or_else(
        || reference::made(experiment, model, &start),
        |dir| reference::of_or_made(dir, experiment, model, &start),
    );
    let chosen = choose::method(experiment, model, &start);
    let (mut sampler, opened) =
        match place.recording.map(|recording| recording.open(&chosen, model, &start)).transpose() {
            Ok(sampler) => (sampler, Ok(())),
            Err(error) => (None, Err(error)),
        };
    let Chosen { experiment, method, .. } = &chosen;
    let mut ended = run::run(experiment, method, model, start.clone(), sampler.as_mut(), reference.as_ref());
    let recorded = opened.and_then(|()| sampler.map_or(Ok(Vec::new()), Sampler::finish));
    sensitivity::fill(&chosen, model, &start, &mut ended);
    chosen.describe(&mut ended.measured);
    Studied { ended, chosen, recorded }
}

impl Recording<'_> {
    fn open(&self, chosen: &Chosen, model: &Model, start: &State) -> Result<Sampler, RecordError> {
        let clock = ticks::ticks(&chosen.experiment);
        let header = header(self.case, self.name, model, start, &clock);
        let writer = open(self.targets, self.dir, self.live, &header)?;
        Ok(Sampler::new(writer, &chosen.experiment.record, &clock))
    }
}

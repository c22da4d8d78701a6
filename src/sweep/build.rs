//! One case of a file, built: its model, its first state, its place in the columns.

use crate::exact::{self, Closed};
use crate::experiment::axes::Axes;
use crate::experiment::types::Experiment;
use crate::experiment::{ExperimentError, ExperimentFile};
use crate::model::Model;
use crate::scene;
use crate::scene::BuildError;
use crate::state::State;
use serde_json::Value;

/// Cells of a point of the axes, as the result columns show it.
pub(super) fn columns(axes: &Axes, point: &[usize]) -> impl Iterator<Item = (String, Value)> {
    axes.axes.iter().zip(point).map(|(axis, &value)| (axis.path.clone(), axis.values[value].cell()))
}

/// Model and first state of the experiment at `point` (empty without axes).
///
/// # Errors
/// What only geometry shows, with the place in the file.
pub fn build(
    file: &ExperimentFile,
    point: &[usize],
    experiment: &Experiment,
) -> Result<(Model, State), ExperimentError> {
    let placed = |e: BuildError| file.error_at(point, &e.path, &e.expected, &e.found);
    let (model, start) = scene::build(experiment).map_err(placed)?;
    for (path, exact) in exact::named(experiment) {
        let lacking =
            |lacks| file.error_at(point, path, &format!("a scene with {lacks}"), &format!("`{}`", exact.word()));
        let until_s = Closed::new(exact, &model, &start).map_err(lacking)?.holds_until_s();
        if experiment.time.end_s > until_s {
            let expected = format!("at most {until_s}, up to where the closed form `{}` holds", exact.word());
            return Err(file.error_at(point, "time.end_s", &expected, &experiment.time.end_s.to_string()));
        }
    }
    Ok((model, start))
}

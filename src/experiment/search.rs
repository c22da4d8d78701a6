//! The vocabulary of `sweep.search`: the critical value of one key in every cell of the other axes. How it is found is
//! in `sweep/search.rs`.

use super::axes::{Axes, find_axis, float, of_the_experiment};
use super::checks::Result;
use super::error::{ExperimentError, Kind, number};
use super::key_path::{KeyPath, Path};
use super::overrides::split;
use super::predicate::{Predicate, PredicateText};
use super::tree::Number;

#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// The searched key, as written.
    pub critical: String,
    /// Segments of `critical`, split at its dots.
    pub segments: Vec<String>,
    pub between: [Number; 2],
    pub until: Predicate,
    /// Share of the runs over `over` of which `until` holds, from which on the value counts as critical.
    pub fraction: f64,
    /// Index of the axis whose values are tried together.
    pub over: Option<usize>,
    /// Width of the bracket that is left, relative.
    pub relative_width: f64,
}

/// The keys of a search as they are written.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename = "Search", deny_unknown_fields)]
pub struct SearchText {
    critical: String,
    between: [Number; 2],
    until: PredicateText,
    fraction: Option<f64>,
    over: Option<String>,
    relative_width: Option<f64>,
}

/// Relative width where none is given, a hundredth: what a log–log plot shows.
const RELATIVE_WIDTH: f64 = 0.01;
/// Least relative width; below it bisection only moves the last bits.
const NARROWEST: f64 = 1e-12;

/// Place of the search in the file.
pub fn search_path() -> KeyPath {
    KeyPath::of_keys(&["sweep", "search"])
}

impl SearchText {
    /// The search that the keys say, among these axes.
    ///
    /// # Errors
    /// A key that cannot be searched, or a bracket, condition, share, axis or width that is none.
    pub fn read(&self, axes: &Axes) -> Result<Search> {
        let base = search_path();
        let at = Path::Base(&base);
        let critical = at.key("critical").to_key_path();
        let segments = split(&self.critical).map_err(|error| error.at(critical.clone()))?;
        of_the_experiment(&segments[0], &self.critical, &critical)?;
        if axes.axes.iter().any(|axis| axis.path == self.critical) {
            let message = format!("`{}` is searched and an axis: expected one of them", self.critical);
            return Err(ExperimentError::new(Kind::Path, critical, message));
        }
        let over = self.over.as_ref().map(|name| over(name, axes, at.key("over"))).transpose()?;
        Ok(Search {
            critical: self.critical.clone(),
            segments,
            between: self.bracket(at.key("between"))?,
            until: self.until.read(at.key("until"))?,
            fraction: self.fraction(at)?,
            over,
            relative_width: self.relative_width(at.key("relative_width"))?,
        })
    }

    fn bracket(&self, at: Path) -> Result<[Number; 2]> {
        let [low, high] = self.between.each_ref().map(float);
        if low < high && low.is_finite() && high.is_finite() {
            return Ok(self.between.clone());
        }
        let found = format!("[{}, {}]", self.between[0], self.between[1]);
        Err(ExperimentError::unexpected(at.to_key_path(), "[low, high] with low < high", &found))
    }

    /// One half: as many runs meet the condition as do not.
    fn fraction(&self, at: Path) -> Result<f64> {
        let path = at.key("fraction").to_key_path();
        match (self.fraction, &self.over) {
            (None, _) => Ok(0.5),
            (Some(_), None) => {
                Err(ExperimentError::missing(at.key("over").to_key_path(), "the axis of the `fraction`"))
            }
            (Some(share), Some(_)) if share > 0.0 && share <= 1.0 => Ok(share),
            (Some(share), Some(_)) => {
                Err(ExperimentError::unexpected(path, "a share above 0 and up to 1", &number(share)))
            }
        }
    }

    fn relative_width(&self, at: Path) -> Result<f64> {
        let width = self.relative_width.unwrap_or(RELATIVE_WIDTH);
        if (NARROWEST..1.0).contains(&width) {
            return Ok(width);
        }
        let expected = format!("a number from {NARROWEST:e} to 1");
        Err(ExperimentError::unexpected(at.to_key_path(), &expected, &number(width)))
    }
}

fn over(name: &str, axes: &Axes, at: Path) -> Result<usize> {
    let axis = find_axis(&axes.axes, name, &at.to_key_path())?;
    if axes.groups.iter().any(|group| group.contains(&axis) && group.len() > 1) {
        let found = format!("`{name}`, which advances together with another");
        return Err(ExperimentError::unexpected(at.to_key_path(), "an axis on its own", &found));
    }
    Ok(axis)
}

//! An experiment file with its `--set`s: from text to resolved `Experiment`s, and from errors back to lines.

use super::axes::{Axes, axis_path, value_path};
use super::bench::{self, Bench};
use super::error::{ExperimentError, Kind};
use super::expect::{self, Expectation};
use super::key_path::KeyPath;
use super::overrides::{Override, assign, resolve, split};
use super::search::{Search, SearchText, search_path};
use super::source::{parse, read};
use super::types::Experiment;
use super::validate::{normalise_quaternions, validate};
use super::value_de::from_value;
use super::{copies, positions};
use serde::Deserialize;
use serde_yaml::{Mapping, Number, Value};
use std::path::{Path, PathBuf};

type Result<T> = std::result::Result<T, ExperimentError>;

/// A parsed experiment file, its overrides applied and its axes expanded. Plain data: share it between threads.
#[derive(Clone, Debug)]
pub struct ExperimentFile {
    path: PathBuf,
    /// What was read, for the lines of errors.
    text: String,
    /// Everything but `sweep`, `expect` and `bench`.
    tree: Value,
    axes: Axes,
    /// What changes from case to case, shorter paths first, so that `method.lecture.sweeps` changes what `method` has
    /// put there.
    order: Vec<Varied>,
    search: Option<Search>,
    expect: Vec<Expectation>,
    bench: Option<Bench>,
    sets: Vec<Applied>,
}

/// The axes of a sweep, still as written; `axes.rs` and `search.rs` read them.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Sweep {
    #[serde(default)]
    axes: Mapping,
    /// Groups of axes that advance side by side.
    #[serde(default)]
    together: Vec<Vec<String>>,
    /// One row a cell of the axes: the critical value of one more key.
    search: Option<SearchText>,
}

/// A value for another place than the file's own.
#[derive(Clone, Debug)]
pub struct Change {
    pub path: Vec<String>,
    pub value: Value,
    /// Where it is written; None: nowhere.
    pub written: Option<KeyPath>,
}

/// What changes from case to case.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Varied {
    /// By its index.
    Axis(usize),
    Searched,
}

/// A point of the axes, with a value of the searched key if there is one.
#[derive(Clone, Copy)]
struct Point<'a> {
    /// For every axis the index of its value.
    indices: &'a [usize],
    searched: Option<&'a Number>,
}

/// A `--set` and the topmost place it changed.
#[derive(Clone, Debug)]
struct Applied {
    text: String,
    path: Vec<String>,
    at: KeyPath,
}

impl ExperimentFile {
    /// Reads a file and applies `sets` (`PATH=VALUE`) in their order.
    ///
    /// # Errors
    /// Whatever can be wrong before a single case is resolved; `is_machine` tells a failing machine from wrong input.
    pub fn load(path: &Path, sets: &[String]) -> Result<ExperimentFile> {
        let text = read(path).map_err(|error| error.named(path))?;
        Self::from_text(path, &text, sets)
    }

    /// The same for a text; `path` is only how messages call it.
    ///
    /// # Errors
    /// As `load`.
    pub fn from_text(path: &Path, text: &str, sets: &[String]) -> Result<ExperimentFile> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let tree = parse(text).map_err(|error| error.named(path))?;
        let mut file = ExperimentFile {
            path: path.to_path_buf(),
            text: text.to_string(),
            tree,
            axes: Axes::default(),
            order: Vec::new(),
            search: None,
            expect: Vec::new(),
            bench: None,
            sets: Vec::new(),
        };
        for set in sets {
            file.apply(set).map_err(|error| by_set(error, set).named(path))?;
        }
        let read = file.expand_axes().and_then(|()| file.read_expectations()).and_then(|()| file.read_bench());
        read.map_err(|error| file.placed(error))?;
        file.refuse_overwritten_sets()?;
        Ok(file)
    }

    /// As the user named it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn axes(&self) -> &Axes {
        &self.axes
    }

    pub fn search(&self) -> Option<&Search> {
        self.search.as_ref()
    }

    pub fn expect(&self) -> &[Expectation] {
        &self.expect
    }

    pub fn bench(&self) -> Option<&Bench> {
        self.bench.as_ref()
    }

    /// The one experiment of a file without axes.
    ///
    /// # Errors
    /// Axes are left, or the experiment is wrong.
    pub fn experiment(&self) -> Result<Experiment> {
        self.refuse_axes(|_| false)?;
        self.case(&[])
    }

    /// The one experiment of a file without axes but those that are ignored, with some values changed.
    ///
    /// # Errors
    /// Axes are left, or the experiment is wrong; the message names the place where a change is written.
    pub fn changed(&self, changes: &[Change], is_ignored: impl Fn(&[String]) -> bool) -> Result<Experiment> {
        self.refuse_axes(is_ignored)?;
        let mut tree = self.tree.clone();
        for change in changes {
            assign(&mut tree, &change.path, change.value.clone()).map_err(|error| self.placed(error))?;
        }
        resolved(&tree).map_err(|error| {
            let path = &error.details().path;
            let keys = |change: &Change| KeyPath::of_keys(&change.path.iter().map(String::as_str).collect::<Vec<_>>());
            match changes.iter().rev().find(|change| path.starts_with(&keys(change))) {
                Some(Change { written: Some(written), path: above, .. }) => {
                    let at = written.clone().join(path.below(above.len()));
                    self.placed(error.at(at))
                }
                _ => self.placed(error),
            }
        })
    }

    fn refuse_axes(&self, is_ignored: impl Fn(&[String]) -> bool) -> Result<()> {
        let searched = self.search.iter().map(|search| (&search.critical, &search.segments));
        let axes = self.axes.axes.iter().map(|axis| (&axis.path, &axis.segments)).chain(searched);
        let left: Vec<&str> = axes.filter(|(_, at)| !is_ignored(at)).map(|(path, _)| path.as_str()).collect();
        if left.is_empty() {
            return Ok(());
        }
        let message = format!(
            "axes are left: {}; fix each of them with --set PATH=VALUE, or run all cases with `gotai sweep`",
            left.join(", ")
        );
        let mut error = ExperimentError::new(Kind::AxesLeft, KeyPath::of_keys(&["sweep", "axes"]), message);
        error.details_mut().known = left.iter().map(|path| path.to_string()).collect();
        Err(self.placed(error))
    }

    /// The experiment at a point of the grid: for every axis the index of its value, as `Axes::point` gives it.
    ///
    /// # Errors
    /// The experiment is wrong; the message names the axis or the case.
    ///
    /// # Panics
    /// `point` is not a point of this file's axes.
    pub fn case(&self, point: &[usize]) -> Result<Experiment> {
        self.resolved_at(Point { indices: point, searched: None })
    }

    /// The same, with a value of the searched key.
    ///
    /// # Errors
    /// As `case`.
    pub fn searched_case(&self, point: &[usize], value: &Number) -> Result<Experiment> {
        self.resolved_at(Point { indices: point, searched: Some(value) })
    }

    fn resolved_at(&self, point: Point) -> Result<Experiment> {
        let (tree, changes) = self.tree_at(point)?;
        resolved(&tree).map_err(|error| self.placed_in_case(error, point, &changes))
    }

    /// An error of someone who knows more than this module does (overlapping bodies, say), about the value at `path`
    /// (`scene.bodies.cube.position_m`) in the case at `point` (empty without axes).
    pub fn error_at(&self, point: &[usize], path: &str, expected: &str, found: &str) -> ExperimentError {
        let point = Point { indices: point, searched: self.search.as_ref().map(|search| &search.between[0]) };
        let (tree, changes) = match self.tree_at(point) {
            Ok(case) => case,
            Err(error) => return error,
        };
        match split(path) {
            Ok(segments) => {
                let error = ExperimentError::unexpected(resolve(&tree, &segments), expected, found);
                self.placed_in_case(error, point, &changes)
            }
            Err(error) => self.placed(error),
        }
    }

    fn apply(&mut self, text: &str) -> Result<()> {
        let Override { path, value } = Override::parse(text)?;
        let path = self.with_axis_key(path);
        let target = resolve(&self.tree, &path);
        self.remove_axis(&target);
        let at = assign(&mut self.tree, &path, value)?;
        self.sets.push(Applied { text: text.to_string(), path, at });
        Ok(())
    }

    /// After `sweep.axes` comes one key with dots in it: an axis that exists, else all that is left.
    fn with_axis_key(&self, mut path: Vec<String>) -> Vec<String> {
        if path.len() < 3 || path[0] != "sweep" || path[1] != "axes" {
            return path;
        }
        let known = axis_keys(&self.tree);
        let is_axis = |len: &usize| known.contains(&path[2..*len].join("."));
        let len = (3..=path.len()).rev().find(is_axis).unwrap_or(path.len());
        let key = path[2..len].join(".");
        path.splice(2..len, [key]);
        path
    }

    /// Setting what an axis varies, or what is searched, fixes it.
    fn remove_axis(&mut self, target: &KeyPath) {
        let is_target = |key: &String| split(key).is_ok_and(|path| resolve(&self.tree, &path).is_same(target));
        let removed: Vec<String> = axis_keys(&self.tree).into_iter().filter(is_target).collect();
        let is_searched = searched_key(&self.tree).filter(is_target).is_some();
        let Some(sweep) = self.tree.get_mut("sweep") else {
            return;
        };
        if let (true, Some(sweep)) = (is_searched, sweep.as_mapping_mut()) {
            sweep.shift_remove("search");
        }
        if let Some(Value::Mapping(search)) = sweep.get_mut("search") {
            // A single value is left of what was tried together.
            if search.get("over").is_some_and(|over| is_one_of(over, &removed)) {
                search.shift_remove("over");
                search.shift_remove("fraction");
            }
        }
        if let Some(Value::Mapping(axes)) = sweep.get_mut("axes") {
            axes.retain(|key, _| !is_one_of(key, &removed));
        }
        if let Some(Value::Sequence(groups)) = sweep.get_mut("together") {
            for group in groups.iter_mut().filter_map(Value::as_sequence_mut) {
                group.retain(|name| !is_one_of(name, &removed));
            }
        }
    }

    fn expand_axes(&mut self) -> Result<()> {
        let Some(mapping) = self.tree.as_mapping_mut() else {
            return Ok(());
        };
        let Some(sweep) = mapping.shift_remove("sweep") else {
            return Ok(());
        };
        let sweep: Sweep = from_value(&sweep, &KeyPath::of_keys(&["sweep"]))?;
        self.axes = Axes::read(&sweep.axes, &sweep.together)?;
        self.search = sweep.search.map(|search| search.read(&self.axes)).transpose()?;
        self.order = (0..self.axes.axes.len()).map(Varied::Axis).collect();
        self.order.extend(self.search.iter().map(|_| Varied::Searched));
        let (axes, search) = (&self.axes.axes, &self.search);
        self.order.sort_by_key(|varied| match varied {
            Varied::Axis(i) => axes[*i].segments.len(),
            Varied::Searched => search.as_ref().map_or(0, |search| search.segments.len()),
        });
        self.refuse_two_axes_of_one_path()
    }

    fn read_expectations(&mut self) -> Result<()> {
        let written = self.tree.as_mapping_mut().and_then(|mapping| mapping.shift_remove("expect"));
        self.expect = written.map_or(Ok(Vec::new()), |value| expect::read(&value))?;
        Ok(())
    }

    fn read_bench(&mut self) -> Result<()> {
        let written = self.tree.as_mapping_mut().and_then(|mapping| mapping.shift_remove("bench"));
        let own = self.tree.get("method");
        self.bench = written.map(|value| bench::read(&value, own)).transpose()?;
        Ok(())
    }

    /// `scene.bodies.0` and `scene.bodies.cube` may be the same thing, written twice.
    fn refuse_two_axes_of_one_path(&self) -> Result<()> {
        let axes = &self.axes.axes;
        let targets: Vec<KeyPath> = axes.iter().map(|axis| resolve(&self.tree, &axis.segments)).collect();
        for (i, target) in targets.iter().enumerate() {
            if let Some(first) = targets[..i].iter().position(|other| other.is_same(target)) {
                let message = format!("the axis `{}` varies the same value", axes[first].path);
                return Err(ExperimentError::new(Kind::Path, axis_path(&axes[i].path), message));
            }
        }
        let Some(search) = &self.search else {
            return Ok(());
        };
        let target = resolve(&self.tree, &search.segments);
        match targets.iter().position(|other| other.is_same(&target)) {
            None => Ok(()),
            Some(axis) => {
                let message = format!("`{}` is searched and an axis: expected one of them", axes[axis].path);
                Err(ExperimentError::new(Kind::Path, search_path().join(KeyPath::of_keys(&["critical"])), message))
            }
        }
    }

    /// A `--set` below an axis would be lost without a word when the axis puts its own value there.
    fn refuse_overwritten_sets(&self) -> Result<()> {
        for axis in &self.axes.axes {
            let target = resolve(&self.tree, &axis.segments);
            let is_below = |set: &&Applied| {
                let path = resolve(&self.tree, &set.path);
                path.starts_with(&target) && !path.is_same(&target)
            };
            if let Some(set) = self.sets.iter().find(is_below) {
                let message = format!("is an axis, whose values would overwrite this; set `{}` itself", axis.path);
                return Err(by_set(ExperimentError::new(Kind::Path, target, message), &set.text).named(&self.path));
            }
        }
        Ok(())
    }

    /// The tree of a case, and what each axis (by its index) changed in it.
    fn tree_at(&self, point: Point) -> Result<(Value, Vec<(Varied, KeyPath)>)> {
        let mut tree = self.tree.clone();
        let mut changes = Vec::with_capacity(self.order.len());
        for &varied in &self.order {
            let Some((segments, value)) = self.change(varied, point) else { continue };
            let at = assign(&mut tree, segments, value).map_err(|error| self.by_varied(error, varied, point))?;
            changes.push((varied, at));
        }
        Ok((tree, changes))
    }

    /// Where a point changes the tree, and to what.
    fn change(&self, varied: Varied, point: Point) -> Option<(&[String], Value)> {
        match varied {
            // A file without axes has no point: the axes stay as the file has them.
            Varied::Axis(i) => {
                let axis = &self.axes.axes[i];
                Some((&axis.segments, axis.values[*point.indices.get(i)?].value.clone()))
            }
            Varied::Searched => Some((&self.search.as_ref()?.segments, Value::Number(point.searched?.clone()))),
        }
    }

    /// The last axis that changed this place, else the case when the file alone has not this error, else the file.
    fn placed_in_case(&self, error: ExperimentError, point: Point, changes: &[(Varied, KeyPath)]) -> ExperimentError {
        let path = &error.details().path;
        if let Some((varied, _)) = changes.iter().rev().find(|(_, at)| path.starts_with(at)) {
            return self.by_varied(error, *varied, point);
        }
        let is_everywhere = changes.is_empty() || resolved(&self.tree).is_err_and(|other| other == error);
        let mut error = self.placed(error);
        if !is_everywhere {
            error.details_mut().case = Some(self.shown_case(point));
        }
        error
    }

    fn by_varied(&self, mut error: ExperimentError, varied: Varied, point: Point) -> ExperimentError {
        let path = error.details().path.clone();
        let written_at = match varied {
            Varied::Axis(i) => value_path(&self.axes.axes[i].path, point.indices[i]),
            Varied::Searched => search_path().join(KeyPath::of_keys(&["between"])),
        };
        error = self.placed(error.at(written_at)).at(path);
        error.details_mut().axis = self.shown_value(varied, point);
        error
    }

    fn shown_value(&self, varied: Varied, point: Point) -> Option<String> {
        match varied {
            Varied::Axis(i) => {
                let axis = &self.axes.axes[i];
                Some(format!("{} = {}", axis.path, axis.values[*point.indices.get(i)?].shown()))
            }
            Varied::Searched => Some(format!("{} = {}", self.search.as_ref()?.critical, point.searched?)),
        }
    }

    fn shown_case(&self, point: Point) -> String {
        let axes = (0..self.axes.axes.len()).map(Varied::Axis);
        let values = axes.chain([Varied::Searched]).filter_map(|varied| self.shown_value(varied, point));
        values.collect::<Vec<_>>().join(", ")
    }

    /// Where the value at the error's path came from: the last `--set` that touched it, else its line in the file.
    pub(crate) fn placed(&self, error: ExperimentError) -> ExperimentError {
        let path = error.details().path.clone();
        if let Some(set) = self.sets.iter().rev().find(|set| path.starts_with(&set.at)) {
            return by_set(error, &set.text).named(&self.path);
        }
        let mut error = error.named(&self.path);
        if let Some(position) = positions::nearest(&self.text, &path) {
            error.details_mut().line = Some(position.line);
            error.details_mut().column = Some(position.column);
        }
        error
    }
}

fn resolved(tree: &Value) -> Result<Experiment> {
    let mut experiment: Experiment = from_value(tree, &KeyPath::default())?;
    validate(&experiment)?;
    normalise_quaternions(&mut experiment);
    copies::expand(&mut experiment);
    Ok(experiment)
}

fn axis_keys(tree: &Value) -> Vec<String> {
    let axes = tree.get("sweep").and_then(|sweep| sweep.get("axes")).and_then(Value::as_mapping);
    axes.map(Mapping::keys).into_iter().flatten().filter_map(Value::as_str).map(str::to_string).collect()
}

fn searched_key(tree: &Value) -> Option<String> {
    Some(tree.get("sweep")?.get("search")?.get("critical")?.as_str()?.to_string())
}

fn is_one_of(value: &Value, words: &[String]) -> bool {
    value.as_str().is_some_and(|text| words.iter().any(|word| word == text))
}

fn by_set(mut error: ExperimentError, set: &str) -> ExperimentError {
    error.details_mut().set = Some(set.to_string());
    error
}

//! An experiment file with what flags change: from text to resolved `Experiment`s, and from errors back to lines.

use super::axes::{Axes, Axis, axis_path, value_path};
use super::bench::{self, Bench};
use super::copies;
use super::emit::emit;
use super::error::{ExperimentError, Kind};
use super::expect::{self, Expectation};
use super::extends::{Origins, with_bases};
use super::given::{Applied, Given, apply};
use super::key_path::KeyPath;
use super::overrides::{assign, resolve, split};
use super::search::{Search, search_path};
use super::source::read;
use super::sweep::Sweep;
use super::tree::{Number, Value};
use super::types::Experiment;
use super::validate::{is_time_valid, normalise_quaternions, validate};
use super::value_de::from_value;
use std::path::{Path, PathBuf};

type Result<T> = std::result::Result<T, ExperimentError>;

/// A parsed experiment file, its overrides applied and its axes expanded. Plain data: share it between threads.
#[derive(Clone, Debug)]
pub struct ExperimentFile {
    path: PathBuf,
    origins: Origins,
    /// All that was asked for: the file on its bases, with what the flags change.
    asked: Value,
    /// The tree without `sweep`, `expect` and `bench`.
    tree: Value,
    axes: Axes,
    /// Changes from case to case, shorter paths first, so that `method.lecture.sweeps` changes what `method` has put
    /// there.
    order: Vec<Varied>,
    search: Option<Search>,
    expect: Vec<Expectation>,
    bench: Option<Bench>,
    given: Vec<Applied>,
}

/// A value for another place than the file's own.
#[derive(Clone, Debug)]
pub struct Change {
    pub path: Vec<String>,
    pub value: Value,
    /// Place where it is written; None: nowhere.
    pub written: Option<KeyPath>,
}

/// One thing that changes from case to case.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Varied {
    /// An axis, by its index.
    Axis(usize),
    Searched,
}

/// What an axis changes that leaves everything else of a resolved experiment as it is.
#[derive(Clone, Copy)]
enum Light {
    Seed,
    Step,
}

impl Light {
    fn of(axis: &Axis) -> Option<Light> {
        match axis.path.as_str() {
            "seed" => Some(Light::Seed),
            "time.step_s" => Some(Light::Step),
            _ => None,
        }
    }

    /// None: a value that is none, or one that has to be read with more care.
    fn set(self, experiment: &mut Experiment, value: &Value) -> Option<()> {
        let Value::Number(number) = value else { return None };
        match self {
            Light::Seed => experiment.seed = number.as_u64()?,
            Light::Step => experiment.time.step_s = Some(number.as_f64().filter(|step_s| step_s.is_finite())?),
        }
        Some(())
    }
}

/// A point of the axes, with a value of the searched key if there is one.
#[derive(Clone, Copy)]
struct Point<'a> {
    /// Index of its value for every axis.
    indices: &'a [usize],
    searched: Option<&'a Number>,
}

impl ExperimentFile {
    /// The file with `sets` (`PATH=VALUE`) applied in their order.
    ///
    /// # Errors
    /// Whatever can be wrong before a single case is resolved; `is_machine` tells a failing machine from wrong input.
    pub fn load(path: &Path, sets: &[String]) -> Result<ExperimentFile> {
        Self::load_given(path, &all_sets(sets))
    }

    /// The file with flags of both kinds applied in their order.
    ///
    /// # Errors
    /// As `load`.
    pub fn load_given(path: &Path, given: &[Given]) -> Result<ExperimentFile> {
        let text = read(path).map_err(|error| error.named(path))?;
        Self::from_text_given(path, &text, given)
    }

    /// The file of a text; `path` is how messages call it, and what it extends is found from there.
    ///
    /// # Errors
    /// As `load`.
    pub fn from_text(path: &Path, text: &str, sets: &[String]) -> Result<ExperimentFile> {
        Self::from_text_given(path, text, &all_sets(sets))
    }

    /// The file of a text with flags of both kinds applied in their order.
    ///
    /// # Errors
    /// As `load`.
    pub fn from_text_given(path: &Path, text: &str, given: &[Given]) -> Result<ExperimentFile> {
        let (mut tree, origins) = with_bases(path, text)?;
        let mut applied = Vec::with_capacity(given.len());
        for given in given {
            let change = apply(&mut tree, given, &applied);
            applied.push(change.map_err(|error| given.blamed(error).named(path))?);
        }
        let mut file = ExperimentFile {
            path: path.to_path_buf(),
            origins,
            asked: tree.clone(),
            tree,
            axes: Axes::default(),
            order: Vec::new(),
            search: None,
            expect: Vec::new(),
            bench: None,
            given: applied,
        };
        let read = file.expand_axes().and_then(|()| file.read_expectations()).and_then(|()| file.read_bench());
        read.map_err(|error| file.placed(error))?;
        file.refuse_overwritten_sets()?;
        Ok(file)
    }

    /// Text of what was asked for: the file on its bases, with all that flags change. It says the same as they do
    /// together, without any of them.
    pub fn written(&self) -> String {
        emit(&self.asked)
    }

    /// Path of the file as the user named it.
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
        self.refuse_any_axis()?;
        self.case(&[])
    }

    /// Refuses a file that has axes.
    ///
    /// # Errors
    /// Axes are left.
    pub fn refuse_any_axis(&self) -> Result<()> {
        self.refuse_axes(|_| false)
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

    /// Whether some axis changes no more than the seed or the step, so that most cases are like others.
    pub fn has_light_axes(&self) -> bool {
        self.search.is_none() && self.axes.axes.iter().any(|axis| Light::of(axis).is_some())
    }

    /// The point without its values on the axes that change no more than the seed or the step: cases that have the same
    /// are like each other.
    pub fn likeness(&self, point: &[usize]) -> Vec<usize> {
        let axes = self.axes.axes.iter().zip(point);
        axes.filter(|(axis, _)| Light::of(axis).is_none()).map(|(_, value)| *value).collect()
    }

    /// The experiment at a point of the grid, from one at a point that it is like; they share the scene. None where it
    /// takes more, or has something wrong that `case` says.
    pub fn case_like(&self, like: &Experiment, point: &[usize]) -> Option<Experiment> {
        let mut experiment = like.clone();
        for (axis, value) in self.axes.axes.iter().zip(point) {
            Light::of(axis).map_or(Some(()), |light| light.set(&mut experiment, &axis.values[*value].value))?;
        }
        is_time_valid(&experiment).then_some(experiment)
    }

    /// The experiment at a point of the grid, with a value of the searched key.
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
            if let Some(set) = self.given.iter().find(is_below) {
                let message = format!("is an axis, whose values would overwrite this; set `{}` itself", axis.path);
                let error = ExperimentError::new(Kind::Path, target, message);
                return Err(set.given.blamed(error).named(&self.path));
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

    /// Path and value by which a point changes the tree.
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

    /// The error at the origin of the value at its path: the last flag that touched it, else its line in its file.
    /// Place at which a key stands, as messages begin with it: file and line, or the flag that it came from.
    pub fn place(&self, key: KeyPath) -> String {
        self.placed(ExperimentError::new(Kind::Unexpected, key, "")).details().place()
    }

    pub(crate) fn placed(&self, error: ExperimentError) -> ExperimentError {
        let path = &error.details().path;
        match self.given.iter().rev().find(|given| path.starts_with(&given.at)) {
            Some(given) => given.blamed(error).named(&self.path),
            None => self.origins.placed(error),
        }
    }
}

fn all_sets(sets: &[String]) -> Vec<Given> {
    sets.iter().cloned().map(Given::Set).collect()
}

fn resolved(tree: &Value) -> Result<Experiment> {
    let mut experiment: Experiment = from_value(tree, &KeyPath::default())?;
    validate(&experiment)?;
    normalise_quaternions(&mut experiment);
    copies::expand(&mut experiment);
    Ok(experiment)
}

//! Flags that change a file: `--set` and `--axis`.

use super::error::{ExperimentError, Kind};
use super::key_path::KeyPath;
use super::overrides::{Override, assign, resolve, split};
use super::tree::{self, Mapping, Value};

type Result<T> = std::result::Result<T, ExperimentError>;

/// A flag, with its `PATH=VALUE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Given {
    /// A `--set`: a value of the experiment, or anything else in the file.
    Set(String),
    /// An `--axis`: the values that a key takes.
    Axis(String),
}

impl Given {
    pub fn flag(&self) -> &'static str {
        match self {
            Given::Set(_) => "--set",
            Given::Axis(_) => "--axis",
        }
    }

    /// The text `PATH=VALUE`.
    pub fn text(&self) -> &str {
        match self {
            Given::Set(text) | Given::Axis(text) => text,
        }
    }

    /// The error with the flag that it is about.
    pub(super) fn blamed(&self, mut error: ExperimentError) -> ExperimentError {
        error.details_mut().flag = Some(self.flag());
        error.details_mut().set = Some(self.text().to_string());
        error
    }
}

/// A flag that has changed the tree.
#[derive(Clone, Debug)]
pub(super) struct Applied {
    pub given: Given,
    /// Path in the tree; an axis is one key below `sweep.axes`.
    pub path: Vec<String>,
    /// The topmost place that it changed.
    pub at: KeyPath,
    /// The value that it fixes or varies.
    target: KeyPath,
    /// Labels of the axis that varied the same before.
    labels: Vec<String>,
}

impl Applied {
    /// The error of its value. Where a word is unknown, an axis' labels are among those that are known.
    pub fn blamed(&self, mut error: ExperimentError) -> ExperimentError {
        let details = error.details_mut();
        let is_text = |found: &String| found.starts_with('`') || found.starts_with("the text `");
        let is_word = details.found.as_ref().is_some_and(is_text) && details.path.len() <= self.path.len() + 1;
        if is_word && !self.labels.is_empty() && matches!(details.kind, Kind::UnknownWord | Kind::Unexpected) {
            details.message += &format!(" (labels of this axis: {})", self.labels.join(", "));
            details.known.extend(self.labels.iter().cloned());
        }
        self.given.blamed(error)
    }
}

/// Makes a flag's change, after those that were made `before`.
///
/// # Errors
/// No path or value; a path that leads nowhere, or to an axis that another flag gives too.
pub(super) fn apply(tree: &mut Value, given: &Given, before: &[Applied]) -> Result<Applied> {
    let Override { path, mut value } = Override::parse(given.text())?;
    if path[0] == "extends" {
        let message = "expected only in a file, whose base is read before what is set";
        return Err(ExperimentError::new(Kind::Path, KeyPath::of_keys(&["extends"]), message));
    }
    let path = match given {
        Given::Set(_) => with_axis_key(tree, path),
        Given::Axis(_) => vec!["sweep".to_string(), "axes".to_string(), axis_key(tree, &path)],
    };
    let axis = varied_by(&path).map(split).transpose()?;
    let target = resolve(tree, axis.as_ref().unwrap_or(&path));
    refuse_second(given, &path, &target, before)?;
    let labelled = labelled(tree, &target);
    if axis.is_none() {
        let word = given.text().split_once('=').map_or("", |(_, word)| word.trim());
        let is_label = |label: &str| label == word || value.as_str() == Some(label);
        if let Some(item) = labelled.iter().find(|item| label(item).is_some_and(is_label)) {
            value = item.get("value").cloned().unwrap_or_default();
        }
        remove_axis(tree, &target);
    } else if let (3, Value::Sequence(items)) = (path.len(), &mut value) {
        for item in items {
            let word = shown(item);
            let same = labelled.iter().find(|labelled| label(labelled).is_some_and(|label| word == Some(label.into())));
            *item = same.unwrap_or(item).clone();
        }
    }
    let labels = labelled.iter().filter_map(label).map(str::to_string).collect();
    let at = assign(tree, &path, value)?;
    Ok(Applied { given: given.clone(), path, at, target, labels })
}

/// The key of the axis that a path leads to or into.
fn varied_by(path: &[String]) -> Option<&str> {
    match path {
        [sweep, axes, key, ..] if sweep == "sweep" && axes == "axes" => Some(key),
        _ => None,
    }
}

/// Path with one key after `sweep.axes`, which has dots in it: an axis that exists, else all that is left.
fn with_axis_key(tree: &Value, mut path: Vec<String>) -> Vec<String> {
    if varied_by(&path).is_none() {
        return path;
    }
    let known = axis_keys(tree);
    let is_axis = |len: &usize| known.contains(&path[2..*len].join("."));
    let len = (3..=path.len()).rev().find(is_axis).unwrap_or(path.len());
    let key = path[2..len].join(".");
    path.splice(2..len, [key]);
    path
}

/// Key by which the file writes the axis that varies the value at `path`, which is the name of a column too.
fn axis_key(tree: &Value, path: &[String]) -> String {
    let written = path.join(".");
    let same = axes_of(tree, &resolve(tree, path));
    if same.is_empty() || same.contains(&written) { written } else { same[0].clone() }
}

/// Refuses the second of two flags for one axis, of which one would be lost without a word.
fn refuse_second(given: &Given, path: &[String], target: &KeyPath, before: &[Applied]) -> Result<()> {
    let is_axis = |given: &Given| matches!(given, Given::Axis(_));
    let is_lost = |applied: &&Applied| {
        let is_above = path.len() < 3 && applied.path.starts_with(path);
        (is_axis(&applied.given) && (is_above || applied.target.is_same(target)))
            || (is_axis(given) && applied.target.is_same(target))
    };
    match before.iter().find(is_lost) {
        None => Ok(()),
        Some(Applied { given: other, .. }) => {
            let message = format!("also given by `{} {}`: expected one of the two", other.flag(), other.text());
            Err(ExperimentError::new(Kind::Path, target.clone(), message))
        }
    }
}

/// The values with labels on the axes that vary this value.
fn labelled(tree: &Value, target: &KeyPath) -> Vec<Value> {
    let keys = axes_of(tree, target);
    let lists = keys.iter().filter_map(|key| tree.get("sweep")?.get("axes")?.get(key.as_str())?.as_sequence());
    lists.flatten().filter(|item| label(item).is_some() && item.get("value").is_some()).cloned().collect()
}

fn label(item: &Value) -> Option<&str> {
    item.get("label")?.as_str()
}

/// A scalar, as a label would be written.
fn shown(item: &Value) -> Option<String> {
    (item.is_string() || item.is_number() || item.is_bool()).then(|| tree::shown(item))
}

/// Setting what an axis varies, or what is searched, fixes it.
fn remove_axis(tree: &mut Value, target: &KeyPath) {
    let removed = axes_of(tree, target);
    let is_searched = searched_key(tree).is_some_and(|key| leads_to(tree, &key, target));
    let Some(sweep) = tree.get_mut("sweep") else {
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

/// The axes that vary this value.
fn axes_of(tree: &Value, target: &KeyPath) -> Vec<String> {
    axis_keys(tree).into_iter().filter(|key| leads_to(tree, key, target)).collect()
}

fn leads_to(tree: &Value, key: &str, target: &KeyPath) -> bool {
    split(key).is_ok_and(|path| resolve(tree, &path).is_same(target))
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

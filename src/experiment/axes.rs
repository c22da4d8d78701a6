//! The axes of a sweep: from what is written to a grid of points, in the order written, the first axis slowest.

use super::error::{self, ExperimentError, Kind, describe, shortened};
use super::key_path::{KeyPath, Path, Segment};
use super::later::BESIDE_EXPERIMENT;
use super::overrides::split;
use super::tree::{Mapping, Number, Value, cell, compact_json, shown};
use super::value_de::from_value;
use serde::Deserialize;
use std::collections::HashMap;

type Result<T> = std::result::Result<T, ExperimentError>;

/// Most values on an axis. More is a slip in `step`, caught before it fills the memory.
const MOST_VALUES: u128 = 1_000_000;
/// Most cases of a plan; more is caught before an index overflows.
const MOST_CASES: usize = 1_000_000_000;

/// All axes of a file; none is a grid of one point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axes {
    /// Axes in the order written.
    pub axes: Vec<Axis>,
    /// Indices of the axes that advance together; every axis is in exactly one group, groups in the order of their
    /// first member.
    pub groups: Vec<Vec<usize>>,
}

/// One key path and the values it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Key path as written, which is also the name of the column.
    pub path: String,
    /// Segments of `path`, split at its dots.
    pub segments: Vec<String>,
    /// Values of the axis: at least one, none twice.
    pub values: Vec<AxisValue>,
}

/// One value of an axis; any subtree of the experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisValue {
    pub label: Option<String>,
    pub value: Value,
}

impl From<Number> for AxisValue {
    fn from(number: Number) -> Self {
        AxisValue { label: None, value: Value::Number(number) }
    }
}

impl AxisValue {
    /// Text of the value: its label, the scalar itself, or compact JSON.
    pub fn shown(&self) -> String {
        self.label.clone().unwrap_or_else(|| shown(&self.value))
    }

    /// Cell of the value in the axis' column of a row: numbers and booleans stay what they are, all else is text.
    pub fn cell(&self) -> serde_json::Value {
        self.label.as_deref().map_or_else(|| cell(&self.value), serde_json::Value::from)
    }
}

impl Axes {
    /// Axes from what stands in `sweep:`, and groups of them that advance side by side.
    ///
    /// # Errors
    /// An axis that is none, or has a value twice; a group of axes of different lengths; too many cases.
    pub fn read(axes: &Mapping, together: &[Vec<String>]) -> Result<Axes> {
        let axes = read_axes(axes)?;
        let groups = read_groups(together, &axes)?;
        let axes = Axes { axes, groups };
        axes.check_size()?;
        Ok(axes)
    }

    pub fn is_empty(&self) -> bool {
        self.axes.is_empty()
    }

    /// Number of points: 1 without axes.
    pub fn len(&self) -> usize {
        self.groups.iter().map(|group| self.group_len(group)).product()
    }

    /// Point `i` of the grid: for every axis the index of its value. `i` counts from 0 to `len()` and wraps there.
    pub fn point(&self, mut i: usize) -> Vec<usize> {
        let mut point = vec![0; self.axes.len()];
        for group in self.groups.iter().rev() {
            let len = self.group_len(group);
            for &axis in group {
                point[axis] = i % len;
            }
            i /= len;
        }
        point
    }

    fn group_len(&self, group: &[usize]) -> usize {
        group.first().map_or(1, |&axis| self.axes[axis].values.len())
    }

    fn check_size(&self) -> Result<()> {
        let lengths = || self.groups.iter().map(|group| self.group_len(group));
        let size = lengths().try_fold(1_usize, |size, len| size.checked_mul(len)).filter(|size| *size <= MOST_CASES);
        if size.is_some() {
            return Ok(());
        }
        let found = lengths().map(|len| len.to_string()).collect::<Vec<_>>().join(" × ");
        let path = KeyPath::of_keys(&["sweep", "axes"]);
        Err(ExperimentError::unexpected(path, &format!("at most {MOST_CASES} cases"), &found))
    }
}

/// Place of an axis in the file.
pub fn axis_path(key: &str) -> KeyPath {
    KeyPath::of_keys(&["sweep", "axes", key])
}

/// Place of a value of an axis in the file, if it is written there; else its axis is the nearest.
pub fn value_path(key: &str, index: usize) -> KeyPath {
    let mut path = axis_path(key);
    path.push(Segment::Item { index, name: None });
    path
}

fn read_axes(axes: &Mapping) -> Result<Vec<Axis>> {
    axes.iter().map(|(key, spec)| read_axis(key.as_str().unwrap_or_default(), spec)).collect()
}

/// Refuses what a file holds beside its experiment.
pub(super) fn of_the_experiment(first: &str, key: &str, at: &KeyPath) -> Result<()> {
    if !BESIDE_EXPERIMENT.contains(&first) {
        return Ok(());
    }
    let expected =
        format!("a key of the experiment, outside of {}", BESIDE_EXPERIMENT.map(|key| format!("`{key}`")).join(", "));
    Err(ExperimentError::unexpected(at.clone(), &expected, &format!("`{key}`")))
}

fn read_axis(key: &str, spec: &Value) -> Result<Axis> {
    let at = axis_path(key);
    let segments = split(key).map_err(|error| error.at(at.clone()))?;
    of_the_experiment(&segments[0], key, &at)?;
    // Its cases would be one and the same, and share a row.
    if segments[0] == "plan" {
        let expected = "a key that a case's id depends on; set it for all cases (`--set plan.skip=[]`)";
        return Err(ExperimentError::unexpected(at, expected, &format!("`{key}`")));
    }
    let values = match spec {
        Value::Sequence(items) => read_list(items, &at)?,
        Value::Mapping(_) => from_value::<Form>(spec, &at)?.values(&at)?,
        Value::String(text) if text.contains("..") => read_span(text, &at)?,
        other => {
            let expected = "a list of values ([a, b]), whole numbers from..to (0..39), or one of range, log, linear \
                            ({ log: { from: 1e-3, to: 1, count: 4 } })";
            return Err(ExperimentError::unexpected(at, expected, &describe(other)));
        }
    };
    if values.is_empty() {
        return Err(ExperimentError::unexpected(at, "at least one value", "none"));
    }
    refuse_repeats(key, &values)?;
    Ok(Axis { path: key.to_string(), segments, values })
}

/// `from..to`, short for `{ range: { from, to } }` of whole numbers.
fn read_span(text: &str, at: &KeyPath) -> Result<Vec<AxisValue>> {
    let ends = text.split_once("..").and_then(|(from, to)| Some((whole(from)?, whole(to)?)));
    let Some((from, to)) = ends.filter(|(from, to)| from <= to) else {
        let expected = "whole numbers from..to with from ≤ to, such as 0..39";
        return Err(ExperimentError::unexpected(at.clone(), expected, &format!("`{}`", shortened(text))));
    };
    check_count(from.abs_diff(to) + 1, Path::Base(at))?;
    Ok((from..=to).filter_map(to_number).map(AxisValue::from).collect())
}

/// A whole number, if YAML can hold it.
fn whole(text: &str) -> Option<i128> {
    let n = text.trim().parse().ok()?;
    to_number(n).map(|_| n)
}

pub(super) fn read_list(items: &[Value], at: &KeyPath) -> Result<Vec<AxisValue>> {
    let base = Path::Base(at);
    items.iter().enumerate().map(|(i, item)| read_item(item, base.item(i, None))).collect()
}

/// `label` is no key of the vocabulary, so a mapping that has it is a labelled value.
fn read_item(item: &Value, at: Path) -> Result<AxisValue> {
    if item.get("label").is_none() {
        return Ok(AxisValue { label: None, value: item.clone() });
    }
    let Labelled { label, value } = from_value(item, &at.to_key_path())?;
    Ok(AxisValue { label: Some(label), value })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Labelled {
    label: String,
    value: Value,
}

/// Two rows of one case, or two cases that a column cannot tell apart.
fn refuse_repeats(key: &str, values: &[AxisValue]) -> Result<()> {
    let (mut seen, mut shown) = (HashMap::new(), HashMap::new());
    for (i, value) in values.iter().enumerate() {
        let same = seen.insert(identity(&value.value), i).or(shown.insert(value.shown(), i));
        if let Some(first) = same {
            let message = format!("`{}` is on this axis twice (items {first} and {i})", value.shown());
            return Err(ExperimentError::new(Kind::Unexpected, value_path(key, i), message));
        }
    }
    Ok(())
}

/// Equal for equal values: 1 and 1.0 set the same thing.
fn identity(value: &Value) -> String {
    match value {
        Value::Number(number) => match number.as_f64() {
            Some(x) if !number.is_f64() || x.fract() != 0.0 => number.to_string(),
            Some(x) => format!("{x:.0}"),
            None => number.to_string(),
        },
        other => compact_json(other),
    }
}

/// The groups in the order of their first members: the named ones and, for every other axis, one of its own.
fn read_groups(together: &[Vec<String>], axes: &[Axis]) -> Result<Vec<Vec<usize>>> {
    let mut group_of: Vec<Option<usize>> = vec![None; axes.len()];
    for (g, names) in together.iter().enumerate() {
        for (i, name) in names.iter().enumerate() {
            let axis = find_axis(axes, name, &together_path(g, Some(i)))?;
            if group_of[axis].replace(g).is_some() {
                let message = format!("the axis `{name}` is named twice");
                return Err(ExperimentError::new(Kind::Unexpected, together_path(g, Some(i)), message));
            }
        }
        check_lengths(g, axes, &group_of)?;
    }
    let mut groups = Vec::new();
    for (axis, group) in group_of.iter().enumerate() {
        match group {
            None => groups.push(vec![axis]),
            Some(_) if group_of[..axis].contains(group) => {}
            Some(_) => groups.push((axis..axes.len()).filter(|other| group_of[*other] == *group).collect()),
        }
    }
    Ok(groups)
}

fn check_lengths(g: usize, axes: &[Axis], group_of: &[Option<usize>]) -> Result<()> {
    let members = || axes.iter().zip(group_of).filter(|(_, group)| **group == Some(g)).map(|(axis, _)| axis);
    let first = members().next().map_or(0, |axis| axis.values.len());
    if members().all(|axis| axis.values.len() == first) {
        return Ok(());
    }
    let found: Vec<String> = members().map(|axis| format!("{} of {}", axis.values.len(), axis.path)).collect();
    Err(ExperimentError::unexpected(together_path(g, None), "axes of the same length", &found.join(", ")))
}

pub(super) fn find_axis(axes: &[Axis], name: &str, at: &KeyPath) -> Result<usize> {
    let known: Vec<&str> = axes.iter().map(|axis| axis.path.as_str()).collect();
    let found = known.iter().position(|path| *path == name);
    found.ok_or_else(|| ExperimentError::unknown_word(at.clone(), name, &known))
}

fn together_path(group: usize, member: Option<usize>) -> KeyPath {
    let mut path = KeyPath::of_keys(&["sweep", "together"]);
    path.push(Segment::Item { index: group, name: None });
    if let Some(index) = member {
        path.push(Segment::Item { index, name: None });
    }
    path
}

/// An axis that is not a list.
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Form {
    Range(Range),
    Log(Spaced),
    Linear(Spaced),
}

/// Numbers `from`, `from + step`, … up to `to`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Range {
    from: Number,
    to: Number,
    #[serde(default = "one")]
    step: Number,
}

fn one() -> Number {
    Number::from(1)
}

/// Numbers from one end to the other, `count` of them, both ends exact, rising or falling.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Spaced {
    from: Number,
    to: Number,
    count: u32,
}

impl Form {
    fn values(&self, at: &KeyPath) -> Result<Vec<AxisValue>> {
        let base = Path::Base(at);
        let numbers = match self {
            Form::Range(range) => range.values(base.key("range"))?,
            Form::Log(spaced) => spaced.values(base.key("log"), logarithmic)?,
            Form::Linear(spaced) => spaced.values(base.key("linear"), linear)?,
        };
        Ok(numbers.into_iter().map(AxisValue::from).collect())
    }
}

impl Range {
    fn values(&self, at: Path) -> Result<Vec<Number>> {
        match (integer(&self.from), integer(&self.to), integer(&self.step)) {
            (Some(from), Some(to), Some(step)) => self.integers(from, to, step, at),
            _ => self.floats(at),
        }
    }

    fn integers(&self, from: i128, to: i128, step: i128, at: Path) -> Result<Vec<Number>> {
        self.check_step(step == 0, (to < from && step > 0) || (to > from && step < 0), at)?;
        let steps = ((to - from) / step).unsigned_abs();
        check_count(steps + 1, at)?;
        Ok((0..=steps as i128).filter_map(|i| to_number(from + i * step)).collect())
    }

    /// A last value that misses `to` by rounding is `to`.
    fn floats(&self, at: Path) -> Result<Vec<Number>> {
        const SLACK: f64 = 1e-9;
        let (from, to, step) = (float(&self.from), float(&self.to), float(&self.step));
        self.check_step(step == 0.0, (to < from && step > 0.0) || (to > from && step < 0.0), at)?;
        let steps = (to - from) / step;
        let whole = (steps + SLACK * steps.max(1.0)).floor();
        check_count((whole as u128).saturating_add(1), at)?;
        let hits_end = (steps - whole).abs() <= SLACK * steps.max(1.0);
        let value = |i: u64| {
            if hits_end && i as f64 == whole { to } else { decimal(from + i as f64 * step) }
        };
        Ok((0..=whole as u64).map(|i| Number::from(value(i))).collect())
    }

    fn check_step(&self, is_zero: bool, is_wrong_way: bool, at: Path) -> Result<()> {
        let way = format!("from {} to {}", self.from, self.to);
        let expected = match (is_zero, is_wrong_way) {
            (true, _) => "a step other than 0".to_string(),
            (_, true) => format!("a step that leads {way}"),
            _ => return Ok(()),
        };
        Err(ExperimentError::unexpected(at.key("step").to_key_path(), &expected, &self.step.to_string()))
    }
}

impl Spaced {
    /// `between(from, to, t)` is the value a part t of the way from `from` to `to`.
    fn values(&self, at: Path, between: fn(f64, f64, f64, Path) -> Result<f64>) -> Result<Vec<Number>> {
        check_count(u128::from(self.count), at)?;
        let (from, to) = (float(&self.from), float(&self.to));
        if self.count == 0 || (self.count == 1 && from != to) {
            let expected = if self.count == 0 { "at least 1" } else { "at least 2, as `from` and `to` differ" };
            let path = at.key("count").to_key_path();
            return Err(ExperimentError::unexpected(path, expected, &self.count.to_string()));
        }
        let last = self.count - 1;
        let value = |i: u32| match i {
            0 => between(from, to, 0.0, at).map(|_| from),
            i if i == last => Ok(to),
            i => between(from, to, f64::from(i) / f64::from(last), at).map(decimal),
        };
        let values = (0..self.count).map(value).collect::<Result<Vec<f64>>>()?;
        Ok(self.integers_if_all_are(&values))
    }

    /// Whole numbers where all are: from 2 to 32 in five logarithmic steps are five whole numbers, and stay so.
    fn integers_if_all_are(&self, values: &[f64]) -> Vec<Number> {
        let is_integer = integer(&self.from).is_some() && integer(&self.to).is_some();
        let as_integer = |x: &f64| (x.fract() == 0.0).then(|| to_number(*x as i128)).flatten();
        let integers = values.iter().map(as_integer).collect::<Option<Vec<Number>>>();
        integers.filter(|_| is_integer).unwrap_or_else(|| values.iter().map(|x| Number::from(*x)).collect())
    }
}

fn linear(from: f64, to: f64, t: f64, _: Path) -> Result<f64> {
    Ok(from + (to - from) * t)
}

/// `libm`, because the host's `pow` would give other cases on other machines.
fn logarithmic(from: f64, to: f64, t: f64, at: Path) -> Result<f64> {
    for (key, end) in [("from", from), ("to", to)] {
        if end <= 0.0 {
            let found = error::number(end);
            return Err(ExperimentError::unexpected(at.key(key).to_key_path(), "a number greater than 0", &found));
        }
    }
    let ratio = to / from;
    let is_normal = ratio.is_normal();
    Ok(if is_normal { from * libm::pow(ratio, t) } else { libm::pow(from, 1.0 - t) * libm::pow(to, t) })
}

/// A number to 15 significant digits: what a decimal step means (0.3), instead of the rounding of its multiples
/// (0.30000000000000004).
pub(crate) fn decimal(x: f64) -> f64 {
    format!("{x:.14e}").parse().unwrap_or(x)
}

fn check_count(count: u128, at: Path) -> Result<()> {
    if count <= MOST_VALUES {
        return Ok(());
    }
    let expected = format!("at most {MOST_VALUES} values");
    Err(ExperimentError::unexpected(at.to_key_path(), &expected, &count.to_string()))
}

fn integer(number: &Number) -> Option<i128> {
    number.as_i64().map(i128::from).or_else(|| number.as_u64().map(i128::from))
}

fn to_number(n: i128) -> Option<Number> {
    i64::try_from(n).map(Number::from).or_else(|_| u64::try_from(n).map(Number::from)).ok()
}

/// The number as f64. A `Number` always converts; the reader of values has refused what is not finite.
pub(crate) fn float(number: &Number) -> f64 {
    number.as_f64().unwrap_or(f64::NAN)
}

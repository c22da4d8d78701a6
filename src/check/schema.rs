//! The columns that rows will have, and rows as `check` reads them.

use super::rounding::Magnitudes;
use crate::experiment::axes::Axes;
use crate::experiment::filter::{Filter, is_same};
use crate::heading::Headings;
use crate::rows::columns::{STATE, names};
use crate::rows::{Measured, Row, cells};
use serde_json::{Map, Value};
use std::collections::HashMap;

/// A row by the names of its columns.
pub type Cells = Map<String, Value>;

/// The columns that rows will have, and the values on their axes.
#[derive(Clone, Debug)]
pub struct Schema {
    /// Axes that rows show, with their values in the order of the plan.
    pub axes: Vec<(String, Vec<Value>)>,
    /// Groups of axes that advance together.
    groups: Vec<Vec<String>>,
    /// All columns, axes among them.
    pub columns: Vec<String>,
    /// Sizes that rounding is relative to.
    pub magnitudes: Magnitudes,
}

impl Schema {
    /// The columns of a sweep's rows. `over` is the axis that a search has used up; `more` are the columns that only
    /// some experiments have.
    pub fn new(axes: &Axes, over: Option<usize>, more: &[String]) -> Self {
        let path = |i: &usize| axes.axes[*i].path.clone();
        let shown = (0..axes.axes.len()).filter(|i| over != Some(*i));
        let values = |i: usize| axes.axes[i].values.iter().map(|value| value.cell()).collect();
        let shown: Vec<_> = shown.map(|i| (path(&i), values(i))).collect();
        let mut columns = vec!["case".to_string()];
        columns.extend(shown.iter().map(|(path, _)| path.clone()));
        columns.extend(names(&Measured::headings()));
        columns.extend(more.iter().cloned());
        Schema {
            axes: shown,
            groups: axes.groups.iter().map(|group| group.iter().map(path).collect()).collect(),
            columns,
            magnitudes: Magnitudes::default(),
        }
    }

    /// The columns and values of both.
    pub fn or(mut self, other: Schema) -> Self {
        for (path, values) in other.axes {
            match self.axes.iter_mut().find(|(known, _)| *known == path) {
                Some((_, known)) => known.extend(values),
                None => self.axes.push((path, values)),
            }
        }
        let more: Vec<String> = other.columns.into_iter().filter(|name| !self.columns.contains(name)).collect();
        self.columns.extend(more);
        self
    }

    pub(super) fn axis(&self, name: &str) -> Option<&[Value]> {
        self.axes.iter().find(|(path, _)| path == name).map(|(_, values)| values.as_slice())
    }

    /// Names of the axes that vary independently of this one; they tell cells apart.
    pub(super) fn others(&self, axis: &str) -> Vec<&str> {
        let tied = self.groups.iter().find(|group| group.iter().any(|name| name == axis));
        let is_tied = |path: &str| path == axis || tied.is_some_and(|group| group.iter().any(|name| name == path));
        self.axes.iter().map(|(path, _)| path.as_str()).filter(|path| !is_tied(path)).collect()
    }

    /// Place of a row's value among the values of the axis.
    pub(super) fn level(&self, axis: &str, row: &Cells) -> Option<usize> {
        let cell = row.get(axis)?;
        self.axis(axis)?.iter().position(|value| is_same(value, cell))
    }

    /// Columns of a name, vector by vector: a column, all components of a vector (`cube.position_m`), or all vectors of
    /// all end states (`state`).
    pub(super) fn vectors(&self, name: &str) -> Vec<Vec<&str>> {
        if self.columns.iter().any(|column| column == name) {
            return vec![self.columns.iter().map(String::as_str).filter(|column| *column == name).collect()];
        }
        let mut vectors: Vec<(&str, Vec<&str>)> = Vec::new();
        for column in &self.columns {
            let Some((vector, "x" | "y" | "z" | "w")) = column.rsplit_once('.') else { continue };
            let is_state = STATE.iter().any(|part| part.is_of_a_body(vector));
            if vector != name && !(name == "state" && is_state) {
                continue;
            }
            match vectors.iter_mut().find(|(known, _)| *known == vector) {
                Some((_, components)) => components.push(column),
                None => vectors.push((vector, vec![column])),
            }
        }
        vectors.into_iter().map(|(_, components)| components).collect()
    }
}

/// Rows by the names of their columns.
pub fn cells_of(rows: &[Row]) -> Vec<Cells> {
    rows.iter().map(cells).collect()
}

pub(super) fn selected<'a>(rows: &[&'a Cells], filter: &Filter) -> Vec<&'a Cells> {
    rows.iter().copied().filter(|row| filter.takes(|name| row.get(name))).collect()
}

/// Groups of rows, or of what comes with a row, that agree in all of these axes; in the order of their first rows.
pub(super) fn strata<T>(rows: impl IntoIterator<Item = T>, cells: impl Fn(&T) -> &Cells, axes: &[&str]) -> Vec<Vec<T>> {
    let mut strata: Vec<Vec<T>> = Vec::new();
    let mut places = HashMap::new();
    for row in rows {
        let key: Vec<String> =
            axes.iter().map(|axis| cells(&row).get(*axis).map_or_else(String::new, Value::to_string)).collect();
        let place = *places.entry(key).or_insert(strata.len());
        if place == strata.len() {
            strata.push(Vec::new());
        }
        strata[place].push(row);
    }
    strata
}

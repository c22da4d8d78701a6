//! Rows of two folders of results side by side: joined by the values on the axes that both have.

use super::schema::Cells;
use crate::experiment::filter::is_same;
use crate::rows::plan_file::PlanAxis;
use serde_json::Value;
use std::collections::HashMap;

/// One of two folders of results, as it was written.
#[derive(Clone, Debug)]
pub struct Side {
    /// Name of the folder, as it was given.
    pub name: String,
    pub program: String,
    pub build: String,
    pub format: u32,
    /// Number of rows that its plan has.
    pub planned: usize,
    pub axes: Vec<PlanAxis>,
    pub rows: Vec<Cells>,
    /// Largest bounding radius of its bodies; None where nobody knows.
    pub size_m: Option<f64>,
}

/// Rows of two folders that agree in all common axes.
pub(super) struct Cell<'a> {
    pub a: Vec<&'a Cells>,
    pub b: Vec<&'a Cells>,
}

/// Relative difference up to which two values on an axis are the same one, as `where` has it.
const SAME: f64 = 1e-9;

impl Side {
    pub(super) fn axis(&self, path: &str) -> Option<&PlanAxis> {
        self.axes.iter().find(|axis| axis.path == path)
    }

    /// Whether its plan has all values of a place: a row of another one that is not there is missing then.
    pub(super) fn plans(&self, place: &Cells) -> bool {
        place.iter().all(|(path, value)| {
            let planned = self.axis(path).into_iter().flat_map(|axis| &axis.values);
            planned.chain(self.rows.iter().filter_map(|row| row.get(path))).any(|known| is_same(known, value))
        })
    }

    /// Number of rows that its plan has wherever the values on these axes are given; None where axes advance side by
    /// side, or where rows have been counted otherwise.
    pub(super) fn planned_in_a_cell(&self, axes: &[String]) -> Option<usize> {
        let count = |axis: &PlanAxis| axis.values.len();
        let is_grid = self.axes.iter().map(count).product::<usize>() == self.planned;
        is_grid.then(|| self.axes.iter().filter(|axis| !axes.contains(&axis.path)).map(count).product())
    }
}

/// Paths of the axes that both have, in the order of the first.
pub(super) fn common(a: &Side, b: &Side) -> Vec<String> {
    a.axes.iter().filter(|axis| b.axis(&axis.path).is_some()).map(|axis| axis.path.clone()).collect()
}

/// All rows by their values on these axes, those of A in its order before those that B alone has.
pub(super) fn cells<'a>(a: &'a Side, b: &'a Side, axes: &[String]) -> Vec<Cell<'a>> {
    let levels: Vec<Levels> = axes.iter().map(|path| Levels::of(path, a.rows.iter().chain(&b.rows))).collect();
    let key = |row: &Cells| -> Vec<String> {
        axes.iter().zip(&levels).map(|(path, levels)| levels.name(row.get(path).unwrap_or(&Value::Null))).collect()
    };
    let mut cells: Vec<Cell> = Vec::new();
    let mut places = HashMap::new();
    let rows = a.rows.iter().map(|row| (row, true)).chain(b.rows.iter().map(|row| (row, false)));
    for (row, is_of_a) in rows {
        let place = *places.entry(key(row)).or_insert(cells.len());
        if place == cells.len() {
            cells.push(Cell { a: Vec::new(), b: Vec::new() });
        }
        if is_of_a { &mut cells[place].a } else { &mut cells[place].b }.push(row);
    }
    cells
}

/// Numbers on an axis, each standing for those that are the same.
struct Levels(Vec<f64>);

impl Levels {
    fn of<'a>(path: &str, rows: impl Iterator<Item = &'a Cells>) -> Self {
        let mut numbers: Vec<f64> = rows.filter_map(|row| number(row.get(path)?)).collect();
        numbers.sort_by(f64::total_cmp);
        let is_same = |x: f64, first: f64| (x - first).abs() <= SAME * x.abs().max(first.abs());
        numbers.dedup_by(|x, first| is_same(*x, *first));
        Levels(numbers)
    }

    /// A name that all values have that are the same.
    fn name(&self, cell: &Value) -> String {
        match number(cell) {
            // The last one that is not larger: those that are the same follow it.
            Some(x) => format!("{:?}", self.0[self.0.partition_point(|first| *first <= x).max(1) - 1]),
            None => cell.as_str().map_or_else(|| cell.to_string(), |text| format!("\"{text}")),
        }
    }
}

/// A label may look like a number.
fn number(cell: &Value) -> Option<f64> {
    cell.as_f64().or_else(|| cell.as_str()?.parse().ok()).filter(|x| x.is_finite())
}

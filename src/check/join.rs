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
    /// Groups of axes that advance side by side.
    pub together: Vec<Vec<String>>,
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

    /// Axes of a group that advance side by side, this one among them; it alone where it varies independently.
    fn group(&self, path: &str) -> Vec<&PlanAxis> {
        let group = self.together.iter().find(|group| group.iter().any(|member| member == path));
        let is_of = |axis: &&PlanAxis| axis.path == path || group.is_some_and(|group| group.contains(&axis.path));
        self.axes.iter().filter(is_of).collect()
    }

    /// Whether its plan has all values of a place, those of axes that advance side by side at once: a row of another
    /// one that is not there is missing then.
    pub(super) fn plans(&self, place: &Cells) -> bool {
        place.iter().all(|(path, value)| {
            let of_rows = || self.rows.iter().filter_map(|row| row.get(path));
            let group = self.group(path);
            if group.len() < 2 {
                let planned = self.axis(path).into_iter().flat_map(|axis| &axis.values);
                return planned.chain(of_rows()).any(|known| is_same(known, value));
            }
            let is_there = |at: usize| {
                let mut given = group.iter().filter_map(|axis| Some((axis.values.get(at)?, place.get(&axis.path)?)));
                given.all(|(known, value)| is_same(known, value))
            };
            (0..group[0].values.len()).any(is_there)
        })
    }

    /// Number of rows that its plan has wherever the values on these axes are given; None where rows have been counted
    /// otherwise.
    pub(super) fn planned_in_a_cell(&self, axes: &[String]) -> Option<usize> {
        // Of axes that advance side by side the first counts for all.
        let leads = |axis: &&PlanAxis| self.group(&axis.path).first().is_some_and(|first| first.path == axis.path);
        let count = |axis: &PlanAxis| axis.values.len();
        let leaders = || self.axes.iter().filter(leads);
        let is_grid = leaders().map(count).product::<usize>() == self.planned;
        let is_given = |axis: &PlanAxis| self.group(&axis.path).iter().any(|member| axes.contains(&member.path));
        is_grid.then(|| leaders().filter(|axis| !is_given(axis)).map(count).product())
    }

    /// The axis of these that another one advances with.
    pub(super) fn led_by(&self, path: &str, axes: &[String]) -> Option<String> {
        let member = |axis: &&PlanAxis| axis.path != path && axes.contains(&axis.path);
        self.group(path).into_iter().find(member).map(|axis| axis.path.clone())
    }
}

/// Paths of the axes that both have, in the order of the first. An axis with other values on each side is none of them
/// where it only follows one that has the same: then it is what differs.
pub(super) fn common(a: &Side, b: &Side) -> Vec<String> {
    let has_same = |path: &str| {
        let (Some(a), Some(b)) = (a.axis(path), b.axis(path)) else { return false };
        let are_in = |these: &PlanAxis, those: &PlanAxis| {
            these.values.iter().any(|value| those.values.iter().any(|other| is_same(value, other)))
        };
        are_in(a, b)
    };
    let both: Vec<String> = a.axes.iter().map(|axis| axis.path.clone()).filter(|path| b.axis(path).is_some()).collect();
    let same: Vec<String> = both.iter().filter(|path| has_same(path)).cloned().collect();
    let follows = |path: &str| a.led_by(path, &same).is_some() && b.led_by(path, &same).is_some();
    both.into_iter().filter(|path| same.contains(path) || !follows(path)).collect()
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

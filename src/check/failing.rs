//! Cases that an unmet expectation names: those that are out of bounds, or against the trend, or of a cell that is; the
//! worst first.

use super::numbers::{count, levels, number, order_in, order_of, quantity_of, spread};
use super::schema::{Cells, Schema, selected, strata};
use crate::experiment::expect::{Expectation, What};
use crate::experiment::predicate::{Bounds, Column, Predicate, Quantity};
use serde::Serialize;
use serde_json::{Map, Value};

/// Most cases that an expectation, or all expectations of a file together, name: what a person can look at, and as many
/// recordings of some MB each.
pub const MOST: usize = 24;

/// Case that an unmet expectation names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Failing {
    pub case: String,
    /// Values on all axes.
    pub axes: Map<String, Value>,
    /// What was measured of it.
    pub column: String,
    /// Null where that is what is wrong.
    pub value: Value,
}

/// A row that an expectation names, how far it is off, and what shows it.
struct Named<'a> {
    row: &'a Cells,
    excess: f64,
    column: String,
    value: Value,
}

impl<'a> Named<'a> {
    fn new(row: &'a Cells, excess: f64, column: &str, value: Option<f64>) -> Self {
        Named { row, excess, column: column.to_string(), value: value.map_or(Value::Null, Value::from) }
    }
}

/// All cases that an unmet expectation names, by how far they are off; those without a value first, equal ones in plan
/// order. `rows` are those that it is about.
pub(super) fn failing(expectation: &Expectation, schema: &Schema, rows: &[&Cells]) -> Vec<Failing> {
    let mut named = match &expectation.what {
        What::Column { column, bounds, .. } => outside(rows, column, bounds),
        What::Fraction { of, bounds } => {
            of_share(rows, of, share(rows, of).is_none_or(|share| is_above(bounds, share)))
        }
        What::Trend { of, along, rising, .. } => against_trend(schema, rows, of, along, *rising),
        What::Order { column, against, bounds } => of_order(schema, rows, column, against, bounds),
        What::Equal { column, across, within_rel } => unequal(schema, rows, column, across, *within_rel),
        What::Compare { quantity, quantile, of, to, bounds, how } => {
            let (of, to) = (selected(rows, of), selected(rows, to));
            let above = quantity_of(*how, &of, &to, quantity, *quantile).is_none_or(|x| is_above(bounds, x));
            match quantity {
                Quantity::Fraction(predicate) => of_share(&of, predicate, above),
                Quantity::Column(column) => extreme(&of, &to, column, above),
            }
        }
    };
    named.sort_by(|a, b| b.excess.total_cmp(&a.excess));
    named.into_iter().map(|named| of_row(named, schema)).collect()
}

/// Cases that have failed themselves, in plan order.
pub fn broken(schema: &Schema, rows: &[Cells]) -> Vec<Failing> {
    let failed = rows.iter().filter(|row| row.get("outcome").and_then(Value::as_str) == Some("failed"));
    let named = |row| Named { row, excess: 0.0, column: "criterion".into(), value: cell(row, "criterion") };
    failed.map(|row| of_row(named(row), schema)).collect()
}

fn of_row(Named { row, column, value, .. }: Named, schema: &Schema) -> Failing {
    let axes = schema.axes.iter().map(|(path, _)| (path.clone(), cell(row, path))).collect();
    let case = row.get("case").and_then(Value::as_str).unwrap_or_default().to_string();
    Failing { case, axes, column, value }
}

fn cell(row: &Cells, name: &str) -> Value {
    row.get(name).cloned().unwrap_or_default()
}

fn outside<'a>(rows: &[&'a Cells], column: &Column, bounds: &Bounds) -> Vec<Named<'a>> {
    let name = column.to_string();
    let named = rows.iter().filter_map(|row| match number(column, row) {
        Err(_) => Some(Named::new(row, f64::INFINITY, &name, None)),
        Ok(x) => (!bounds.contain(x)).then(|| Named::new(row, excess(bounds, x), &name, Some(x))),
    });
    named.collect()
}

/// Rows of which it is true, or not, and those of which nobody can say.
fn of_share<'a>(rows: &[&'a Cells], of: &Predicate, true_ones: bool) -> Vec<Named<'a>> {
    let named = rows.iter().filter_map(|row| {
        let holds = of.holds(|name| row.get(name));
        let excess = match holds {
            None => f64::INFINITY,
            Some(holds) if holds == true_ones => 0.0,
            Some(_) => return None,
        };
        let (column, value) = shown(of, row);
        Some(Named { row, excess, column, value })
    });
    named.collect()
}

fn shown(of: &Predicate, row: &Cells) -> (String, Value) {
    match of {
        Predicate::Outcome(_) => ("outcome".into(), cell(row, "outcome")),
        Predicate::Criterion(_) => ("criterion".into(), cell(row, "criterion")),
        Predicate::Column { column, .. } => {
            (column.to_string(), column.value(|name| row.get(name)).map_or(Value::Null, Value::from))
        }
    }
}

/// Rows that are on the wrong side of the row before them, in their own cell of the other axes.
fn against_trend<'a>(schema: &Schema, rows: &[&'a Cells], of: &Quantity, along: &str, rising: bool) -> Vec<Named<'a>> {
    let measured = |row: &Cells| match of {
        Quantity::Column(column) => number(column, row).ok(),
        Quantity::Fraction(of) => of.holds(|name| row.get(name)).map(f64::from),
    };
    let named = |row: &'a Cells, excess: f64| match of {
        Quantity::Column(column) => Named::new(row, excess, &column.to_string(), measured(row)),
        Quantity::Fraction(of) => {
            let (column, value) = shown(of, row);
            Named { row, excess, column, value }
        }
    };
    let Ok(levels) = levels(schema, rows, along) else {
        return rows.iter().filter(|row| cell(row, along).is_null()).map(|row| named(row, f64::INFINITY)).collect();
    };
    let mut all: Vec<_> = rows.iter().filter(|row| measured(row).is_none()).map(|r| named(r, f64::INFINITY)).collect();
    let others = if schema.axis(along).is_some() { schema.others(along) } else { Vec::new() };
    let levelled = levels.iter().enumerate().flat_map(|(level, rows)| rows.iter().map(move |row| (level, *row)));
    for cell in strata(levelled, |(_, row)| row, &others) {
        for pair in cell.windows(2).filter(|pair| pair[0].0 < pair[1].0) {
            let (Some(before), Some(after)) = (measured(pair[0].1), measured(pair[1].1)) else { continue };
            let step = if rising { after - before } else { before - after };
            if step < 0.0 {
                all.push(named(pair[1].1, -step));
            }
        }
    }
    all
}

fn of_order<'a>(
    schema: &Schema,
    rows: &[&'a Cells],
    column: &Column,
    against: &str,
    bounds: &Bounds,
) -> Vec<Named<'a>> {
    let (x, others) = order_of(schema, against);
    let name = column.to_string();
    let mut all = Vec::new();
    for cell in strata(rows.iter().copied(), |row| row, &others) {
        let off = match order_in(schema, &cell, &x, column) {
            Ok(Some(order)) if bounds.contain(order.slope) => continue,
            Ok(Some(order)) => excess(bounds, order.slope),
            Ok(None) | Err(_) => f64::INFINITY,
        };
        all.extend(cell.iter().map(|row| Named::new(row, off, &name, number(column, row).ok())));
    }
    all
}

fn unequal<'a>(schema: &Schema, rows: &[&'a Cells], column: &str, across: &str, within_rel: f64) -> Vec<Named<'a>> {
    let mut all = Vec::new();
    for cell in strata(rows.iter().copied(), |row| row, &schema.others(across)) {
        let off = |vector: &Vec<&str>| match spread(&cell, vector) {
            _ if cell.len() < 2 => f64::INFINITY,
            spread => spread.unwrap_or(f64::INFINITY),
        };
        let vectors = schema.vectors(column);
        let Some(worst) = vectors.iter().max_by(|a, b| off(a).total_cmp(&off(b))) else { continue };
        if off(worst) > within_rel {
            let name = worst[0];
            all.extend(cell.iter().map(|row| Named {
                row,
                excess: off(worst),
                column: name.to_string(),
                value: self::cell(row, name),
            }));
        }
    }
    all
}

/// Rows that make one mean too large for the other: the largest of the one, or the smallest.
fn extreme<'a>(of: &[&'a Cells], to: &[&'a Cells], column: &Column, above: bool) -> Vec<Named<'a>> {
    let name = column.to_string();
    let missing = to.iter().filter(|row| number(column, row).is_err());
    let missing = missing.map(|row| Named::new(row, f64::INFINITY, &name, None));
    let own = of.iter().map(|row| match number(column, row) {
        Err(_) => Named::new(row, f64::INFINITY, &name, None),
        Ok(x) => Named::new(row, if above { x } else { -x }, &name, Some(x)),
    });
    missing.chain(own).collect()
}

fn share(rows: &[&Cells], of: &Predicate) -> Option<f64> {
    (!rows.is_empty()).then(|| count(rows, of).ok().map(|k| k as f64 / rows.len() as f64))?
}

/// Whether a number that is out of bounds is above them.
fn is_above(bounds: &Bounds, x: f64) -> bool {
    bounds.max.is_some_and(|max| x > max)
        || bounds.below.is_some_and(|below| x >= below)
        || bounds.within.is_some_and(|within| x > within)
}

/// Distance of a number from the bounds that it is outside of.
fn excess(bounds: &Bounds, x: f64) -> f64 {
    let lower =
        [bounds.min, bounds.above, bounds.within.map(|within| -within)].into_iter().flatten().map(|low| low - x);
    let upper = [bounds.max, bounds.below, bounds.within].into_iter().flatten().map(|high| x - high);
    let off = lower.chain(upper).fold(0.0, f64::max);
    if off.is_nan() { f64::INFINITY } else { off }
}

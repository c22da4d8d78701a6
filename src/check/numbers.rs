//! Numbers of rows: columns, shares, levels along an axis, and how they are said.

use super::schema::{Cells, Schema};
use crate::experiment::expect::Comparison;
use crate::experiment::predicate::{Column, Predicate, Quantity};
use crate::math::order::{Order, fit_above};
use serde_json::Value;

pub(super) fn compared(how: Comparison, of: f64, to: f64) -> f64 {
    match how {
        Comparison::Ratio => of / to,
        Comparison::Difference => of - to,
    }
}

/// Ratio or difference of what was measured of two groups of rows, if both have it.
pub(super) fn quantity_of(
    how: Comparison,
    of: &[&Cells],
    to: &[&Cells],
    quantity: &Quantity,
    q: Option<f64>,
) -> Option<f64> {
    Some(compared(how, value(of, quantity, q).ok()?, value(to, quantity, q).ok()?))
}

/// A share, or the mean or quantile of a column.
pub(super) fn value(rows: &[&Cells], quantity: &Quantity, q: Option<f64>) -> Result<f64, String> {
    if rows.is_empty() {
        return Err("no row is selected".into());
    }
    match quantity {
        Quantity::Fraction(of) => Ok(count(rows, of)? as f64 / rows.len() as f64),
        Quantity::Column(column) => {
            let values = numbers(rows, column)?;
            Ok(q.map_or_else(|| mean(&values), |q| quantile(&values, q)))
        }
    }
}

/// Rows by their level along the axis (or the column), in its order: of numbers by size, else as the axis is written.
pub(super) fn levels<'a>(schema: &Schema, rows: &[&'a Cells], along: &str) -> Result<Vec<Vec<&'a Cells>>, String> {
    let is_numeric = schema.axis(along).is_none_or(|values| values.iter().all(Value::is_number));
    let column = Column { name: along.to_string(), divided_by: None };
    let place = |row: &&Cells| match is_numeric {
        true => column.value(|name| row.get(name)),
        false => schema.level(along, row).map(|level| level as f64),
    };
    let missing = || format!("{along} is null in a row");
    let mut placed =
        rows.iter().map(|row| Ok((place(row).ok_or_else(missing)?, *row))).collect::<Result<Vec<_>, String>>()?;
    placed.sort_by(|a, b| a.0.total_cmp(&b.0));
    let same_level = |a: &(f64, &Cells), b: &(f64, &Cells)| a.0 == b.0;
    Ok(placed.chunk_by(same_level).map(|level| level.iter().map(|(_, row)| *row).collect()).collect())
}

/// What an order is measured against, and the axes that tell its cells apart.
pub(super) fn order_of<'a>(schema: &'a Schema, against: &str) -> (Column, Vec<&'a str>) {
    // The step that was made, where rounding to a whole number of steps has changed it.
    let x = Column::new(if against == "time.step_s" { "step_used_s" } else { against });
    (x, if schema.axis(against).is_some() { schema.others(against) } else { Vec::new() })
}

/// Size below which a column is rounding; of a quotient none is known.
pub(super) fn floor_of(schema: &Schema, column: &Column) -> f64 {
    if column.divided_by.is_some() { 0.0 } else { schema.magnitudes.floor(&column.name) }
}

/// Order of a column's sizes in a cell, above rounding; `Ok(None)` with fewer than two of them.
pub(super) fn order_in(schema: &Schema, cell: &[&Cells], x: &Column, column: &Column) -> Result<Option<Order>, String> {
    let sizes = numbers(cell, column)?.into_iter().map(f64::abs);
    let points: Vec<(f64, f64)> = numbers(cell, x)?.into_iter().zip(sizes).collect();
    Ok(fit_above(&points, floor_of(schema, column)))
}

/// Largest difference of a component over the rows, relative to the largest norm of the vector; of texts 0 or infinite.
pub(super) fn spread(rows: &[&Cells], vector: &[&str]) -> Option<f64> {
    let cells =
        |name: &str| rows.iter().map(|row| row.get(name).filter(|cell| !cell.is_null())).collect::<Option<Vec<_>>>();
    if let [name] = vector {
        let cells = cells(name)?;
        if !cells.iter().all(|cell| cell.is_number()) {
            return Some(if cells.windows(2).all(|pair| pair[0] == pair[1]) { 0.0 } else { f64::INFINITY });
        }
    }
    let columns = vector.iter().map(|name| numbers(rows, &Column::new(name)).ok()).collect::<Option<Vec<_>>>()?;
    let norm = |row: usize| columns.iter().map(|column| column[row] * column[row]).sum::<f64>().sqrt();
    let scale = (0..rows.len()).map(norm).fold(0.0, f64::max);
    let difference = |column: &Vec<f64>| {
        let (low, high) = extremes(column);
        high - low
    };
    let difference = columns.iter().map(difference).fold(0.0, f64::max);
    Some(if difference == 0.0 { 0.0 } else { difference / scale })
}

pub(super) fn count(rows: &[&Cells], of: &Predicate) -> Result<usize, String> {
    let hold = rows.iter().map(|row| of.holds(|name| row.get(name)).ok_or_else(|| null(of, row)));
    Ok(hold.collect::<Result<Vec<_>, _>>()?.into_iter().filter(|holds| *holds).count())
}

pub(super) fn numbers(rows: &[&Cells], column: &Column) -> Result<Vec<f64>, String> {
    rows.iter().map(|row| number(column, row)).collect()
}

pub(super) fn number(column: &Column, row: &Cells) -> Result<f64, String> {
    column.value(|name| row.get(name)).ok_or_else(|| null(column, row))
}

pub(super) fn null(what: impl std::fmt::Display, row: &Cells) -> String {
    let case = row.get("case").and_then(Value::as_str).unwrap_or("?");
    format!("{what} is null in case {case}")
}

pub(super) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The value that this share of the values does not exceed, interpolated linearly between neighbours.
pub(super) fn quantile(values: &[f64], q: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = q * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    low + (high - low) * at.fract()
}

pub(super) fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
}

pub(super) fn range(values: &[f64]) -> String {
    match extremes(values) {
        (low, high) if low == high => short(low),
        (low, high) => format!("{} … {}", short(low), short(high)),
    }
}

/// A number to four significant digits.
pub fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 || !x.is_finite() {
        return format!("{x}");
    }
    if !(1e-3..1e5).contains(&size) {
        return format!("{x:.3e}");
    }
    let digits = (3 - libm::log10(size).floor() as i32).max(0) as usize;
    let text = format!("{x:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

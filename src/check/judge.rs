//! The verdict on an expectation.
//!
//! No row selected, a null or a number that is not finite: not met, never a pass.

use super::failing::{Failing, failing};
use super::schema::{Cells, Schema, selected, strata};
use crate::experiment::expect::{Comparison, Expectation, What};
use crate::experiment::filter::Filter;
use crate::experiment::predicate::{Bounds, Column, Predicate, Quantity};
use crate::math::order;
use crate::math::trend::{cochran_armitage, mann_kendall};
use serde::Serialize;
use serde_json::Value;

/// An expectation and what became of it, in words.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Judged {
    pub expectation: String,
    pub bound: String,
    pub measured: String,
    pub met: bool,
    pub why: Option<String>,
    /// Number of rows that the expectation is about.
    pub rows: usize,
    /// Cases that it names where it is not met, the worst first.
    pub failing: Vec<Failing>,
}

impl Judged {
    /// An expectation that nobody has judged, and the reason.
    pub fn not_judged(expectation: &Expectation, reason: &str) -> Self {
        let (text, bound) = in_words(expectation);
        let (measured, why) = (reason.to_string(), expectation.why.clone());
        Judged { expectation: text, bound, measured, met: false, why, rows: 0, failing: Vec::new() }
    }
}

/// A measurement in words, and whether it is what was expected.
struct Verdict {
    measured: String,
    met: bool,
}

impl Verdict {
    fn not(measured: impl Into<String>) -> Self {
        Verdict { measured: measured.into(), met: false }
    }
}

/// Verdict on an expectation by the rows that it is about; rows have the columns of `schema`.
pub fn judge(expectation: &Expectation, schema: &Schema, rows: &[Cells]) -> Judged {
    let rows = selected(&rows.iter().collect::<Vec<_>>(), &expectation.rows);
    let verdict = if rows.is_empty() {
        Verdict::not("no row is selected")
    } else {
        match &expectation.what {
            What::Column { column, quantile, bounds } => of_column(&rows, column, *quantile, bounds),
            What::Fraction { of, bounds } => of_fraction(&rows, of, bounds),
            What::Trend { of, along, rising, p_max } => of_trend(schema, &rows, of, along, *rising, *p_max),
            What::Order { column, against, bounds } => of_order(schema, &rows, column, against, bounds),
            What::Equal { column, across, within_rel } => of_equal(schema, &rows, column, across, *within_rel),
            What::Compare { how, quantity, quantile, of, to, bounds } => {
                let value = |filter: &Filter| value(&selected(&rows, filter), quantity, *quantile);
                of_compare(*how, value(of), value(to), bounds)
            }
        }
    };
    let (text, bound) = in_words(expectation);
    let Verdict { measured, met } = verdict;
    let failing = if met { Vec::new() } else { failing(expectation, schema, &rows) };
    Judged { expectation: text, bound, measured, met, why: expectation.why.clone(), rows: rows.len(), failing }
}

fn in_words(expectation: &Expectation) -> (String, String) {
    let of_quantile = |q: &Option<f64>| q.map(|q| format!("{q} quantile of ")).unwrap_or_default();
    let (text, bound) = match &expectation.what {
        What::Column { column, quantile: Some(q), bounds: bounds @ Bounds { within: Some(_), .. } } => {
            (format!("{q} quantile of |{column}|"), bounds.to_string())
        }
        What::Column { column, quantile, bounds } => (format!("{}{column}", of_quantile(quantile)), bounds.to_string()),
        What::Fraction { of, bounds } => (format!("fraction {of}"), bounds.to_string()),
        What::Trend { of, along, rising, p_max } => {
            let way = if *rising { "rises" } else { "falls" };
            (format!("{of} {way} along {along}"), format!("p ≤ {p_max}"))
        }
        What::Order { column, against, bounds } => (format!("order of {column} in {against}"), bounds.to_string()),
        What::Equal { column, across, within_rel } => {
            let bound = if *within_rel == 0.0 { "the same bits".into() } else { format!("within {within_rel:e} rel") };
            (format!("{column} equal across {across}"), bound)
        }
        What::Compare { how, quantity, quantile, of, to, bounds } => {
            let text = format!("{} of {}{quantity}, [{of}] to [{to}]", how.name(), of_quantile(quantile));
            (text, bounds.to_string())
        }
    };
    match expectation.rows.0.is_empty() {
        true => (text, bound),
        false => (format!("{text}, where {}", expectation.rows), bound),
    }
}

fn of_column(rows: &[&Cells], column: &Column, quantile: Option<f64>, bounds: &Bounds) -> Verdict {
    let values = match numbers(rows, column) {
        Ok(values) => values,
        Err(missing) => return Verdict::not(missing),
    };
    if let Some(q) = quantile {
        let sizes = || values.iter().map(|x| x.abs()).collect();
        let x = self::quantile(&if bounds.within.is_some() { sizes() } else { values }, q);
        return Verdict { measured: short(x), met: bounds.contain(x) };
    }
    let outside = values.iter().filter(|x| !bounds.contain(**x)).count();
    let measured = match outside {
        0 => range(&values),
        _ => format!("{}; {outside} of {} rows outside", range(&values), values.len()),
    };
    Verdict { measured, met: outside == 0 }
}

fn of_fraction(rows: &[&Cells], of: &Predicate, bounds: &Bounds) -> Verdict {
    match count(rows, of) {
        Err(missing) => Verdict::not(missing),
        Ok(k) => {
            let share = k as f64 / rows.len() as f64;
            Verdict { measured: format!("{} ({k} of {})", short(share), rows.len()), met: bounds.contain(share) }
        }
    }
}

fn of_compare(how: Comparison, of: Result<f64, String>, to: Result<f64, String>, bounds: &Bounds) -> Verdict {
    let (of, to) = match (of, to) {
        (Ok(of), Ok(to)) => (of, to),
        (Err(missing), _) => return Verdict::not(format!("of: {missing}")),
        (_, Err(missing)) => return Verdict::not(format!("to: {missing}")),
    };
    let (x, sign) = (compared(how, of, to), how.sign());
    let measured = format!("{} ({} {sign} {})", short(x), short(of), short(to));
    Verdict { measured, met: x.is_finite() && bounds.contain(x) }
}

fn compared(how: Comparison, of: f64, to: f64) -> f64 {
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
fn value(rows: &[&Cells], quantity: &Quantity, q: Option<f64>) -> Result<f64, String> {
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

fn of_trend(schema: &Schema, rows: &[&Cells], of: &Quantity, along: &str, rising: bool, p_max: f64) -> Verdict {
    let levels = match levels(schema, rows, along) {
        Ok(levels) if levels.len() > 1 => levels,
        Ok(_) => return Verdict::not("a single level is no trend"),
        Err(missing) => return Verdict::not(missing),
    };
    let judged = match of {
        Quantity::Fraction(of) => trend_of_shares(&levels, of, rising),
        Quantity::Column(column) => trend_of_numbers(schema, &levels, column, along, rising),
    };
    match judged {
        Err(missing) => Verdict::not(missing),
        Ok((p, shown)) => Verdict { measured: format!("p = {}: {shown}", short(p)), met: p <= p_max },
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

fn trend_of_shares(levels: &[Vec<&Cells>], of: &Predicate, rising: bool) -> Result<(f64, String), String> {
    let counted = levels.iter().map(|rows| Ok((rows.len(), count(rows, of)?))).collect::<Result<Vec<_>, String>>()?;
    let shares: Vec<String> = counted.iter().map(|(n, k)| short(*k as f64 / *n as f64)).collect();
    let p = match rising {
        true => cochran_armitage(&counted),
        false => cochran_armitage(&counted.iter().rev().copied().collect::<Vec<_>>()),
    };
    Ok((p, arrows(&shares)))
}

fn trend_of_numbers(
    schema: &Schema,
    levels: &[Vec<&Cells>],
    column: &Column,
    along: &str,
    rising: bool,
) -> Result<(f64, String), String> {
    let sign = if rising { 1.0 } else { -1.0 };
    // Along a column there are no cells: every row may have a level of its own.
    let others = if schema.axis(along).is_some() { schema.others(along) } else { Vec::new() };
    let levelled = levels.iter().enumerate().flat_map(|(level, rows)| rows.iter().map(move |row| (level, *row)));
    let signed = |row: &Cells| number(column, row).map(|x| sign * x);
    let of_cell = |cell: Vec<(usize, &Cells)>| cell.iter().map(|(level, row)| Ok((*level, signed(row)?))).collect();
    let cells = strata(levelled, |(_, row)| row, &others);
    let cells = cells.into_iter().map(of_cell).collect::<Result<Vec<_>, String>>()?;
    let means =
        levels.iter().map(|rows| Ok(short(mean(&numbers(rows, column)?)))).collect::<Result<Vec<_>, String>>()?;
    Ok((mann_kendall(&cells), arrows(&means)))
}

/// Levels in their order, with arrows between them; of many levels the first and the last.
fn arrows(levels: &[String]) -> String {
    const MOST: usize = 12;
    match levels.len() {
        0..=MOST => levels.join(" → "),
        n => format!("{} → … → {}", levels[..3].join(" → "), levels[n - 3..].join(" → ")),
    }
}

fn of_order(schema: &Schema, rows: &[&Cells], column: &Column, against: &str, bounds: &Bounds) -> Verdict {
    let (x, others) = order_of(schema, against);
    let mut orders = Vec::new();
    for cell in strata(rows.iter().copied(), |row| row, &others) {
        let points = numbers(&cell, &x).and_then(|x| Ok(x.into_iter().zip(numbers(&cell, column)?)));
        let points: Vec<_> = match points {
            Ok(points) => points.map(|(x, y)| (x, y.abs())).collect(),
            Err(missing) => return Verdict::not(missing),
        };
        match order::fit(&points) {
            Some(order) => orders.push(order),
            None => return Verdict::not("fewer than two points above rounding"),
        }
    }
    let slopes: Vec<f64> = orders.iter().map(|order| order.slope).collect();
    let pairwise: Vec<String> = orders[0].pairwise.iter().map(|slope| format!("{slope:.2}")).collect();
    let floor: usize = orders.iter().map(|order| order.left_out).sum();
    let mut measured = match slopes.len() {
        1 => format!("{} (pairwise {})", short(slopes[0]), pairwise.join(" ")),
        cells => format!("{} in {cells} cells", range(&slopes)),
    };
    if floor > 0 {
        measured += &format!("; {floor} points in rounding left out");
    }
    Verdict { measured, met: slopes.iter().all(|slope| bounds.contain(*slope)) }
}

/// What an order is measured against, and the axes that tell its cells apart.
pub(super) fn order_of<'a>(schema: &'a Schema, against: &str) -> (Column, Vec<&'a str>) {
    // The step that was made, where rounding to a whole number of steps has changed it.
    let x = Column::new(if against == "time.step_s" { "step_used_s" } else { against });
    (x, if schema.axis(against).is_some() { schema.others(against) } else { Vec::new() })
}

fn of_equal(schema: &Schema, rows: &[&Cells], column: &str, across: &str, within_rel: f64) -> Verdict {
    let mut largest = (0.0_f64, column.to_string());
    let mut compared = 0;
    for cell in strata(rows.iter().copied(), |row| row, &schema.others(across)) {
        if cell.len() < 2 {
            return Verdict::not(format!("a cell has a single row: nothing to compare across {across}"));
        }
        compared += 1;
        for vector in schema.vectors(column) {
            match spread(&cell, &vector) {
                None => return Verdict::not(format!("{} is null in a row", vector.join(", "))),
                Some(spread) if spread > largest.0 => largest = (spread, vector[0].to_string()),
                Some(_) => {}
            }
        }
    }
    let (spread, name) = largest;
    let measured = match spread {
        0.0 => format!("the same in {compared} cells"),
        _ => format!("differs by {} rel ({name}), {compared} cells", short(spread)),
    };
    Verdict { measured, met: spread <= within_rel }
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

fn null(what: impl std::fmt::Display, row: &Cells) -> String {
    let case = row.get("case").and_then(Value::as_str).unwrap_or("?");
    format!("{what} is null in case {case}")
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The value that this share of the values does not exceed, interpolated linearly between neighbours.
fn quantile(values: &[f64], q: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let at = q * (sorted.len() - 1) as f64;
    let (low, high) = (sorted[at.floor() as usize], sorted[at.ceil() as usize]);
    low + (high - low) * at.fract()
}

fn extremes(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(*x), high.max(*x)))
}

fn range(values: &[f64]) -> String {
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

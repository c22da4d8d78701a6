//! The verdict on an expectation.
//!
//! No row selected, a null or a number that is not finite: not met, never a pass.

use super::failing::{Failing, failing};
use super::numbers::{
    compared, count, floor_of, levels, mean, number, numbers, order_in, order_of, quantile, range, short, spread, value,
};
use super::schema::{Cells, Schema, selected, strata};
use crate::experiment::expect::{Comparison, Expectation, What};
use crate::experiment::filter::Filter;
use crate::experiment::predicate::{Bounds, Column, Predicate, Quantity};
use crate::math::trend::{cochran_armitage, mann_kendall};
use serde::Serialize;

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
        match order_in(schema, &cell, &x, column) {
            Ok(Some(order)) => orders.push(order),
            Ok(None) => return Verdict::not(without_order(schema, &cell, column)),
            Err(missing) => return Verdict::not(missing),
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

/// Why a cell has no order.
fn without_order(schema: &Schema, cell: &[&Cells], column: &Column) -> String {
    let largest = numbers(cell, column).unwrap_or_default().iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let floor = floor_of(schema, column);
    if cell.len() > 1 && largest <= floor {
        return format!("nothing but rounding: at most {} ({} is rounding)", short(largest), short(floor));
    }
    "fewer than two points above rounding".to_string()
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

/// At most this many cases that the expectations name, each in its turn.
pub fn in_turn(judged: &[Judged], most: usize) -> Vec<String> {
    let mut chosen: Vec<String> = Vec::new();
    let longest = judged.iter().map(|judged| judged.failing.len()).max().unwrap_or_default();
    for failing in (0..longest).flat_map(|i| judged.iter().filter_map(move |judged| judged.failing.get(i))) {
        if chosen.len() < most && !chosen.contains(&failing.case) {
            chosen.push(failing.case.clone());
        }
    }
    chosen
}

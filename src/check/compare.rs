//! Two folders of results against each other: what got better, what got worse, by how much.
//!
//! Rows are joined by the axes that both have; rows that agree in all of them are one cell, whose number is the mean of
//! the sizes. Columns are compared in the cells whose runs have finished on both sides: what a run that diverged has
//! measured ends at another time.

use super::join::{Cell, Side, cells, common};
use super::schema::Cells;
use crate::heading::{Aim, CellKind, unit_of};
use crate::math::interval::{Interval, of_mean, of_share};
use crate::outcome::Outcome;
use crate::rows::columns;
use serde::Serialize;
use serde_json::{Map, Value};

/// What is asked for of a comparison.
#[derive(Clone, Debug, Default)]
pub struct CompareBy {
    /// Columns to compare; all that say what is better, where none is named.
    pub columns: Vec<String>,
    /// Whether what costs more is worse.
    pub with_cost: bool,
}

/// Comparison of the folders A and B.
#[derive(Clone, Debug, Serialize)]
pub struct Compared {
    /// Axes that the rows are joined by.
    pub axes: Vec<String>,
    /// Axes that one side alone has, over whose values its rows are pooled.
    pub axes_of_a: Vec<String>,
    pub axes_of_b: Vec<String>,
    /// Axes that the rows are not joined by, because they advance with one that they are joined by; with that one.
    pub following: Vec<(String, String)>,
    /// Number of cells that both have, and that one alone has.
    pub cells: usize,
    pub cells_of_a: usize,
    pub cells_of_b: usize,
    /// Number of cells of A that B's plan has and its rows have not, or not all of whose rows are there: an interrupted
    /// sweep.
    pub missing: usize,
    pub places_missing: Vec<Map<String, Value>>,
    /// Values of the first cells that one side alone has, B's plan included.
    pub places_of_a: Vec<Map<String, Value>>,
    pub places_of_b: Vec<Map<String, Value>>,
    pub outcomes: Vec<OutcomeShare>,
    /// Cells whose one outcome is another one in B.
    pub moved: Vec<Moved>,
    /// Number of cells that finished on both sides, in which columns are compared.
    pub finished: usize,
    pub columns: Vec<Change>,
    /// Columns with a better that have numbers on one side alone, where both have finished, with the number of cells.
    pub missing_in_b: Vec<(String, usize)>,
    pub missing_in_a: Vec<(String, usize)>,
    /// Columns that differ and of which nothing says what is better, with the number of cells.
    pub differing: Vec<(String, usize)>,
    /// Columns that cannot be compared, with the format in which their meaning has changed.
    pub refused: Vec<(String, u32)>,
    /// What is worse in B: the worst first.
    pub regressions: Vec<Regression>,
    pub regression_count: usize,
}

/// OutcomeShare of an outcome in the cells that both have.
#[derive(Clone, Debug, Serialize)]
pub struct OutcomeShare {
    pub outcome: String,
    pub a: usize,
    pub of_a: usize,
    pub interval_a: Interval,
    pub b: usize,
    pub of_b: usize,
    pub interval_b: Interval,
}

/// Number of cells that had one outcome and have another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Moved {
    pub from: String,
    pub to: String,
    pub cells: usize,
}

/// A column in the cells that finished on both sides.
#[derive(Clone, Debug, Serialize)]
pub struct Change {
    pub column: String,
    pub unit: &'static str,
    pub is_cost: bool,
    /// Number of cells with a number on both sides.
    pub cells: usize,
    pub better: usize,
    pub worse: usize,
    pub median_a: f64,
    pub median_b: f64,
    /// Geometric mean of B / A over the cells, what is below the floor taken for the floor, and its interval.
    pub factor: Option<f64>,
    pub interval: Option<Interval>,
    /// Side of the factor on which B / A is, where a floor has decided it.
    pub bound: Option<FactorBound>,
    /// Size up to which a number is rounding.
    pub floor: f64,
}

/// What a geometric mean says in which a number was taken for the floor that it is below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum FactorBound {
    /// B is at the floor: the ratio is smaller.
    Below,
    /// A is at the floor: the ratio is larger.
    Above,
}

/// A cell in which B is worse, or a column that B has no more.
#[derive(Clone, Debug, Serialize)]
pub struct Regression {
    pub axes: Map<String, Value>,
    pub column: String,
    pub a: Value,
    pub b: Value,
    /// Case of each side, where a cell has one row.
    pub case_a: Option<String>,
    pub case_b: Option<String>,
    #[serde(skip)]
    by: f64,
}

/// Reason why two folders cannot be compared.
#[derive(Debug, thiserror::Error)]
pub enum Incomparable {
    #[error("{0}: no row in it: nothing to compare")]
    NoRow(String),
    #[error("{a} and {b} have no axis in common ({axes_a}; {axes_b}): no row of one stands for a row of the other")]
    NoAxis { a: String, b: String, axes_a: String, axes_b: String },
    #[error("{a} and {b} have no case in common, though they share {axes}: {example}")]
    NoCase { a: String, b: String, axes: String, example: String },
    #[error("--columns: expected a column of numbers that both have, found `{0}`")]
    Column(String),
    #[error(
        "--columns {column}: {a} is of format {format_a}, {b} of format {format_b}, and the meaning of the column \
             has changed in format {changed}"
    )]
    Format { column: String, a: String, format_a: u32, b: String, format_b: u32, changed: u32 },
    #[error("{name}: expected format {} to {newest}, found {found}; run its sweep again", columns::OLDEST)]
    Unknown { name: String, found: u32, newest: u32 },
}

/// OutcomeShare by which a number may be larger and is still no worse.
pub const TOLERATED: f64 = 0.1;

/// Most regressions, and places of one side, that are listed.
const LISTED: usize = 24;

/// Folder B against folder A.
///
/// # Errors
/// A folder without rows, no axis or no case in common, or a column that cannot be compared.
pub fn compare(a: &Side, b: &Side, asked: &CompareBy) -> Result<Compared, Incomparable> {
    for side in [a, b] {
        if side.rows.is_empty() {
            return Err(Incomparable::NoRow(side.name.clone()));
        }
    }
    let axes = common(a, b);
    if axes.is_empty() && !(a.axes.is_empty() && b.axes.is_empty()) {
        return Err(no_axis(a, b));
    }
    let all = cells(a, b, &axes);
    let (both, single): (Vec<&Cell>, Vec<&Cell>) =
        all.iter().partition(|cell| !cell.a.is_empty() && !cell.b.is_empty());
    if both.is_empty() {
        return Err(no_case(a, b, &axes));
    }
    let (of_b, alone): (Vec<&Cell>, Vec<&Cell>) = single.iter().copied().partition(|cell| cell.a.is_empty());
    let place = |cell: &Cell| place(cell, &axes);
    let (absent, of_a): (Vec<&Cell>, Vec<&Cell>) = alone.iter().copied().partition(|cell| b.plans(&place(cell)));
    let planned = b.planned_in_a_cell(&axes).unwrap_or(0);
    let short = both.iter().copied().filter(|cell| cell.b.len() < planned);
    let missing: Vec<&Cell> = absent.into_iter().chain(short).collect();
    let follows = |path: &str| a.led_by(path, &axes).or_else(|| b.led_by(path, &axes));
    let is_beside = |path: &String| !axes.contains(path);
    let other = |side: &Side, other: &Side| -> Vec<String> {
        let own = side.axes.iter().map(|axis| &axis.path).filter(|path| is_beside(path) && other.axis(path).is_none());
        own.filter(|path| follows(path).is_none()).cloned().collect()
    };
    let mut following: Vec<(String, String)> = Vec::new();
    for path in a.axes.iter().chain(&b.axes).map(|axis| &axis.path).filter(|path| is_beside(path)) {
        if let Some(leader) = follows(path).filter(|_| !following.iter().any(|(known, _)| known == path)) {
            following.push((path.clone(), leader));
        }
    }
    let finished: Vec<&Cell> = both.iter().copied().filter(|cell| is_all(cell, Outcome::Finished.name())).collect();
    let (names, refused) = compared_columns(a, b, &axes, asked)?;
    let scale = Scale::of(a, b, &finished);
    let (mut columns, mut regressions) = (Vec::new(), outcome_regressions(&both, &axes));
    regressions.extend(missing.iter().filter_map(|cell| Regression::of_missing(cell, &axes, planned)));
    let missing_in_b = vanished(a, &finished, &axes, &refused, |cell| (&cell.a, &cell.b));
    let is_asked = |name: &str| columns::aim(name) != Some(Aim::Cheap) || asked.with_cost;
    for (name, count) in missing_in_b.iter().filter(|(name, _)| asked.columns.is_empty() && is_asked(name)) {
        regressions.push(Regression::of_column(name, *count));
    }
    for name in names {
        if let Some((change, worse)) = change(&name, &finished, &axes, &scale) {
            // What is named is asked for.
            if !change.is_cost || asked.with_cost || asked.columns.contains(&name) {
                regressions.extend(worse);
            }
            columns.push(change);
        }
    }
    regressions.sort_by(|a, b| b.by.total_cmp(&a.by));
    Ok(Compared {
        axes_of_a: other(a, b),
        axes_of_b: other(b, a),
        following,
        cells: both.len(),
        cells_of_a: of_a.len(),
        cells_of_b: of_b.len(),
        missing: missing.len(),
        places_missing: missing.iter().take(LISTED).map(|cell| place(cell)).collect(),
        missing_in_a: vanished(b, &finished, &axes, &refused, |cell| (&cell.b, &cell.a)),
        missing_in_b,
        places_of_a: of_a.iter().take(LISTED).map(|cell| place(cell)).collect(),
        places_of_b: of_b.iter().take(LISTED).map(|cell| place(cell)).collect(),
        outcomes: shares(&both),
        moved: moved(&both),
        finished: finished.len(),
        differing: differing(a, &axes, &finished, &columns, &refused),
        columns,
        refused,
        regression_count: regressions.len(),
        regressions: regressions.into_iter().take(LISTED).collect(),
        axes,
    })
}

fn no_axis(a: &Side, b: &Side) -> Incomparable {
    let said = |side: &Side| match side.axes.is_empty() {
        true => "none there".to_string(),
        false => side.axes.iter().map(|axis| axis.path.as_str()).collect::<Vec<_>>().join(", "),
    };
    Incomparable::NoAxis { a: a.name.clone(), b: b.name.clone(), axes_a: said(a), axes_b: said(b) }
}

fn no_case(a: &Side, b: &Side, axes: &[String]) -> Incomparable {
    let values = |side: &Side, path: &str| {
        let values = side.axis(path).map_or(&[][..], |axis| &axis.values);
        let shown: Vec<String> = values.iter().take(4).map(shown).collect();
        format!("{}{}", shown.join(", "), if values.len() > 4 { ", …" } else { "" })
    };
    let apart = axes.iter().find(|path| {
        let side = |side: &Side| Side { axes: vec![], rows: side.rows.clone(), ..side.clone() };
        cells(&side(a), &side(b), std::slice::from_ref(path)).iter().all(|cell| cell.a.is_empty() || cell.b.is_empty())
    });
    let example = match apart {
        Some(path) => format!("{path} is {} in A and {} in B", values(a, path), values(b, path)),
        None => "no combination of their values is in both".to_string(),
    };
    Incomparable::NoCase { a: a.name.clone(), b: b.name.clone(), axes: axes.join(", "), example }
}

fn shown(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_string)
}

/// Names of columns to compare, and those whose meaning has changed.
#[allow(clippy::type_complexity)]
fn compared_columns(
    a: &Side,
    b: &Side,
    axes: &[String],
    asked: &CompareBy,
) -> Result<(Vec<String>, Vec<(String, u32)>), Incomparable> {
    let (older, newer) = (a.format.min(b.format), a.format.max(b.format));
    let has = |side: &Side, name: &str| side.rows.iter().any(|row| row.get(name).is_some_and(Value::is_number));
    let mut names: Vec<String> = asked.columns.clone();
    for name in &names {
        if !has(a, name) || !has(b, name) || axes.contains(name) {
            return Err(Incomparable::Column(name.clone()));
        }
        if let Some(changed) = columns::changed_between(name, older, newer) {
            let (format_a, format_b) = (a.format, b.format);
            let (a, b, column) = (a.name.clone(), b.name.clone(), name.clone());
            return Err(Incomparable::Format { column, a, format_a, b, format_b, changed });
        }
    }
    if names.is_empty() {
        let known = a.rows.first().into_iter().flat_map(Map::keys);
        names = known.filter(|name| columns::aim(name).is_some() && has(a, name) && has(b, name)).cloned().collect();
    }
    let changed = |name: &String| Some((name.clone(), columns::changed_between(name, older, newer)?));
    let refused: Vec<(String, u32)> = names.iter().filter_map(changed).collect();
    names.retain(|name| !refused.iter().any(|(refused, _)| refused == name));
    Ok((names, refused))
}

/// Sizes that a floor is relative to.
struct Scale {
    size_m: Option<f64>,
    time_s: Option<f64>,
}

impl Scale {
    fn of(a: &Side, b: &Side, cells: &[&Cell]) -> Self {
        let size_m = [a.size_m, b.size_m].into_iter().flatten().reduce(f64::max).filter(|size| *size > 0.0);
        let rows = cells.iter().flat_map(|cell| cell.a.iter().chain(&cell.b));
        let time_s = rows.filter_map(|row| row.get("end_time_s")?.as_f64()).reduce(f64::max);
        Scale { size_m, time_s: time_s.filter(|time| *time > 0.0) }
    }

    /// The floor of a column as a number of its unit: of lengths and velocities in sizes of bodies and times of runs;
    /// where nobody knows them, of its largest number.
    fn floor(&self, name: &str, largest: f64) -> f64 {
        let Some(Aim::Small { floor }) = columns::aim(name) else { return 0.0 };
        let scale = match unit_of(name) {
            "" | "rad" => Some(1.0),
            "m" => self.size_m,
            "m/s" => self.size_m.zip(self.time_s).map(|(size, time)| size / time),
            "rad/s" => self.time_s.map(|time| 1.0 / time),
            _ => None,
        };
        floor * scale.unwrap_or(largest)
    }
}

/// A column in these cells, and the cells in which B is worse. None where no cell has a number on both sides.
fn change(name: &str, cells: &[&Cell], axes: &[String], scale: &Scale) -> Option<(Change, Vec<Regression>)> {
    let pairs = cells.iter().filter_map(|cell| Some((*cell, size(&cell.a, name)?, size(&cell.b, name)?)));
    let pairs: Vec<(&Cell, f64, f64)> = pairs.collect();
    if pairs.is_empty() {
        return None;
    }
    let largest = pairs.iter().map(|(_, a, b)| a.max(*b)).fold(0.0, f64::max);
    let floor = scale.floor(name, largest);
    let is_worse = |a: f64, b: f64| b > floor && b > a * (1.0 + TOLERATED);
    // Of a count that was none, one.
    let least = if columns::kind(name) == Some(CellKind::Count) { floor.max(1.0) } else { floor };
    let ratio = |a: f64, b: f64| {
        let (a, b) = (a.max(least), b.max(least));
        if a > 0.0 { b / a } else { f64::NAN }
    };
    let logs: Vec<f64> = pairs
        .iter()
        .map(|(_, a, b)| ratio(*a, *b))
        .filter(|x| *x > 0.0)
        .map(libm::log)
        .filter(|x| x.is_finite())
        .collect();
    let has_ratios = logs.len() == pairs.len();
    let is_floored = |x: f64| x <= floor || x < least;
    let floored =
        |pick: fn(bool, bool) -> bool| pairs.iter().filter(|(_, a, b)| pick(is_floored(*a), is_floored(*b))).count();
    let (low_a, low_b, low) = (floored(|a, b| a && !b), floored(|a, b| b && !a), floored(|a, b| a && b));
    // Below on both sides there is no ratio, and the mean of bounds to both sides is none.
    let has_factor = has_ratios && low < pairs.len() && (low_a == 0 || low_b == 0);
    let bound = match (low_a, low_b) {
        _ if !has_factor => None,
        (0, 0) => None,
        (0, _) => Some(FactorBound::Below),
        _ => Some(FactorBound::Above),
    };
    let exp = |Interval { low, high }| Interval { low: libm::exp(low), high: libm::exp(high) };
    let worse = pairs.iter().filter(|(_, a, b)| is_worse(*a, *b));
    let regressions: Vec<Regression> = worse
        .map(|(cell, a, b)| Regression {
            a: Value::from(*a),
            b: Value::from(*b),
            column: name.to_string(),
            ..Regression::of(cell, axes, if *a > 0.0 { ratio(*a, *b) } else { f64::MAX })
        })
        .collect();
    let of = |pick: fn(&(&Cell, f64, f64)) -> f64| median(pairs.iter().map(pick).collect());
    let change = Change {
        column: name.to_string(),
        unit: unit_of(name),
        is_cost: columns::aim(name) == Some(Aim::Cheap),
        cells: pairs.len(),
        better: pairs.iter().filter(|(_, a, b)| is_worse(*b, *a)).count(),
        worse: regressions.len(),
        median_a: of(|(_, a, _)| *a),
        median_b: of(|(_, _, b)| *b),
        factor: has_factor.then(|| libm::exp(logs.iter().sum::<f64>() / logs.len() as f64)),
        interval: of_mean(&logs).filter(|_| has_factor && bound.is_none()).map(exp),
        bound,
        floor,
    };
    Some((change, regressions))
}

impl Regression {
    fn of(cell: &Cell, axes: &[String], by: f64) -> Self {
        let only = |rows: &[&Cells]| match rows {
            [row] => row.get("case").and_then(Value::as_str).map(str::to_string),
            _ => None,
        };
        let (case_a, case_b) = (only(&cell.a), only(&cell.b));
        Regression {
            axes: place(cell, axes),
            column: String::new(),
            a: Value::Null,
            b: Value::Null,
            case_a,
            case_b,
            by,
        }
    }

    /// A cell that has finished in A and of which rows of B's plan are missing.
    fn of_missing(cell: &Cell, axes: &[String], planned: usize) -> Option<Self> {
        let count = finished(&cell.a);
        let a = match cell.a.len() {
            _ if count == 0 => return None,
            1 => Value::from(Outcome::Finished.name()),
            n => Value::from(format!("{count} of {n} finished")),
        };
        let b = match cell.b.len() {
            0 => Value::from("missing"),
            n => Value::from(format!("{} of {planned} missing", planned.saturating_sub(n))),
        };
        Some(Regression { column: "outcome".into(), a, b, ..Regression::of(cell, axes, f64::INFINITY) })
    }

    /// A column with a better that has numbers in so many cells of A, and none in B.
    fn of_column(name: &str, cells: usize) -> Self {
        let said = format!("a number in {cells} case{}", if cells == 1 { "" } else { "s" });
        let (a, b) = (Value::from(said), Value::from("missing"));
        let (axes, column) = (Map::new(), name.to_string());
        Regression { axes, column, a, b, case_a: None, case_b: None, by: f64::INFINITY }
    }
}

fn finished(rows: &[&Cells]) -> usize {
    rows.iter().filter(|row| outcome(row) == Outcome::Finished.name()).count()
}

/// Cells that finished in A and not in B; of several rows, if the intervals of their shares lie apart.
fn outcome_regressions(cells: &[&Cell], axes: &[String]) -> Vec<Regression> {
    let worse = cells.iter().filter(|cell| {
        let (a, b) = (finished(&cell.a), finished(&cell.b));
        let (n, m) = (cell.a.len(), cell.b.len());
        (a == n && b == 0) || of_share(a, n).low > of_share(b, m).high
    });
    let said = |rows: &[&Cells]| match rows {
        [row] => Value::from(outcome(row)),
        rows => Value::from(format!("{} of {} finished", finished(rows), rows.len())),
    };
    worse
        .map(|cell| Regression {
            column: "outcome".into(),
            a: said(&cell.a),
            b: said(&cell.b),
            ..Regression::of(cell, axes, f64::INFINITY)
        })
        .collect()
}

fn outcome(row: &Cells) -> &str {
    row.get("outcome").and_then(Value::as_str).unwrap_or_default()
}

fn is_all(cell: &Cell, wanted: &str) -> bool {
    cell.a.iter().chain(&cell.b).all(|row| outcome(row) == wanted)
}

fn shares(cells: &[&Cell]) -> Vec<OutcomeShare> {
    let of_a: Vec<&str> = cells.iter().flat_map(|cell| &cell.a).map(|row| outcome(row)).collect();
    let of_b: Vec<&str> = cells.iter().flat_map(|cell| &cell.b).map(|row| outcome(row)).collect();
    let share = |of: Outcome| {
        let count = |all: &[&str]| all.iter().filter(|outcome| **outcome == of.name()).count();
        let (a, b, n, m) = (count(&of_a), count(&of_b), of_a.len(), of_b.len());
        let (interval_a, interval_b) = (of_share(a, n), of_share(b, m));
        OutcomeShare { outcome: of.name().into(), a, of_a: n, interval_a, b, of_b: m, interval_b }
    };
    Outcome::ALL.map(share).into_iter().filter(|share| share.a + share.b > 0).collect()
}

fn moved(cells: &[&Cell]) -> Vec<Moved> {
    let one = |rows: &[&Cells]| {
        let first = outcome(rows.first()?).to_string();
        rows.iter().all(|row| outcome(row) == first).then_some(first)
    };
    let mut all: Vec<Moved> = Vec::new();
    for (from, to) in cells.iter().filter_map(|cell| Some((one(&cell.a)?, one(&cell.b)?))) {
        match all.iter_mut().find(|moved| moved.from == from && moved.to == to) {
            Some(moved) => moved.cells += 1,
            None if from != to => all.push(Moved { from, to, cells: 1 }),
            None => {}
        }
    }
    all
}

/// Columns with a better that have a number in a cell of one side, and in none of both; with the number of those cells.
fn vanished(
    side: &Side,
    cells: &[&Cell],
    axes: &[String],
    refused: &[(String, u32)],
    sides: for<'a, 'b> fn(&'a Cell<'b>) -> (&'a [&'b Cells], &'a [&'b Cells]),
) -> Vec<(String, usize)> {
    let names = side.rows.first().into_iter().flat_map(Map::keys).filter(|name| {
        columns::aim(name).is_some() && !axes.contains(name) && !refused.iter().any(|(refused, _)| refused == *name)
    });
    let counted = names.map(|name| {
        let has = cells.iter().map(|cell| sides(cell)).map(|(here, there)| (size(here, name), size(there, name)));
        let has: Vec<_> = has.filter(|(here, _)| here.is_some()).collect();
        let is_there = has.iter().any(|(_, there)| there.is_some());
        (name.clone(), if is_there { 0 } else { has.len() })
    });
    counted.filter(|(_, count)| *count > 0).collect()
}

/// Columns without a better, of cells with one row each, that are not the same.
fn differing(
    a: &Side,
    axes: &[String],
    cells: &[&Cell],
    compared: &[Change],
    refused: &[(String, u32)],
) -> Vec<(String, usize)> {
    let names = a.rows.first().into_iter().flat_map(Map::keys).filter(|name| {
        !["case", "build", "outcome"].contains(&name.as_str())
            && !columns::is_beside_the_run(name)
            && columns::aim(name).is_none()
            && !axes.contains(name)
            && a.axis(name).is_none()
            && !compared.iter().any(|change| change.column == **name)
            && !refused.iter().any(|(refused, _)| refused == *name)
    });
    let differs = |cell: &Cell, name: &str| match (&cell.a[..], &cell.b[..]) {
        ([a], [b]) => b.contains_key(name) && a.get(name) != b.get(name),
        _ => false,
    };
    let counted = names.map(|name| (name.clone(), cells.iter().filter(|cell| differs(cell, name)).count()));
    counted.filter(|(_, count)| *count > 0).collect()
}

/// Mean size of a column in some rows; None if one has no number.
fn size(rows: &[&Cells], name: &str) -> Option<f64> {
    let sizes = rows.iter().map(|row| row.get(name).and_then(Value::as_f64).map(f64::abs));
    let sizes: Vec<f64> = sizes.collect::<Option<_>>()?;
    Some(sizes.iter().sum::<f64>() / sizes.len() as f64)
}

fn place(cell: &Cell, axes: &[String]) -> Map<String, Value> {
    let row = cell.a.first().or(cell.b.first());
    axes.iter().map(|path| (path.clone(), row.and_then(|row| row.get(path)).cloned().unwrap_or_default())).collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    if n % 2 == 1 { values[n / 2] } else { 0.5 * (values[n / 2 - 1] + values[n / 2]) }
}

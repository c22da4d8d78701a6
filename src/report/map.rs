//! The map: over the two axes that tell most, the share of runs that end in one way, or the median of a column, with
//! the curve on which half of the runs do.

use super::figure::{Dot, Drawn, Figure, FigureAxis, FigureScale, GridCell, Mark, Picked, Shading};
use super::number::{counted, percent, plain, short};
use super::pooling::groups;
use super::stats::{crossing, explained, median};
use super::subject::{Ground, Levels};
use crate::heading::unit_of;
use crate::math::interval::{Interval, of_share};

/// What a map shows of the rows of a cell.
#[derive(Clone, Debug, PartialEq)]
pub enum Painted {
    /// Share that ends so.
    Share(String),
    /// Median of the sizes in a column.
    Median(String),
}

/// The value of a share at which a critical value stands, and its interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Critical {
    pub place: f64,
    pub value: f64,
    pub low: Option<f64>,
    pub high: Option<f64>,
}

/// Columns that a map shows where every run ends alike.
const NUMBERS: [&str; 5] =
    ["error_position_m", "search_low", "energy_drift_rel", "energy_rise_max_rel", "penetration_max_m"];

impl Painted {
    /// The one that is asked for, else that in which the rows differ.
    pub fn of(ground: &Ground) -> Self {
        let frame = ground.frame();
        if let Some(name) = &ground.subject.painted {
            let is_outcome = ["finished", "diverged", "stalled"].contains(&name.as_str());
            return if is_outcome { Painted::Share(name.clone()) } else { Painted::Median(name.clone()) };
        }
        // A row of a search is its run at one end of the bracket: how that ended says nothing.
        if ground.subject.search.is_some() && frame.numbers("search_low").is_some() {
            return Painted::Median("search_low".to_string());
        }
        if let Some(outcome) = ["diverged", "stalled"].iter().find(|outcome| frame.count(outcome) > 0) {
            return Painted::Share(outcome.to_string());
        }
        let differs = |name: &&&str| {
            let finite = || frame.numbers(name).into_iter().flatten().filter(|x| x.is_finite() && **x != 0.0);
            let first = finite().next();
            first.is_some_and(|first| finite().any(|x| x != first))
        };
        let number = NUMBERS.iter().find(differs).map(|name| Painted::Median(name.to_string()));
        number.unwrap_or(Painted::Share("diverged".to_string()))
    }

    /// What each row counts for; None where it does not.
    fn values(&self, ground: &Ground) -> Vec<Option<f64>> {
        let failed = ground.ended("failed");
        match self {
            Painted::Share(outcome) => {
                let ended = ground.ended(outcome);
                ended.iter().zip(failed).map(|(is, failed)| (!failed).then_some(f64::from(u8::from(*is)))).collect()
            }
            Painted::Median(column) => {
                let numbers = ground.frame().numbers(column).unwrap_or_default();
                let value = |(x, failed): (&f64, bool)| (x.is_finite() && !failed).then_some(x.abs());
                let mut values: Vec<_> = numbers.iter().zip(failed).map(value).collect();
                values.resize(ground.frame().rows(), None);
                values
            }
        }
    }
}

/// Axes in the order in which they tell of what is painted.
pub fn telling<'a>(ground: &'a Ground, painted: &Painted) -> Vec<&'a Levels> {
    let values = painted.values(ground);
    let log = |x: f64| (x > 0.0).then(|| libm::log10(x));
    let score = |axis: &Levels| {
        let of = axis.of_row.iter().zip(&values).filter_map(|(level, y)| Some(((*level)? as usize, (*y)?)));
        match painted {
            Painted::Share(_) => explained(axis.len(), of),
            Painted::Median(_) => explained(axis.len(), of.filter_map(|(level, y)| Some((level, log(y)?)))),
        }
    };
    let mut axes: Vec<(f64, &Levels)> = ground.chosen().map(|axis| (score(axis), axis)).collect();
    if axes.is_empty() {
        axes = ground.axes.iter().map(|axis| (score(axis), axis)).collect();
    }
    // Of equals the first in the plan.
    axes.sort_by(|a, b| b.0.total_cmp(&a.0));
    axes.into_iter().map(|(_, axis)| axis).collect()
}

/// What is counted in a cell.
#[derive(Clone, Default)]
struct Count {
    values: Vec<f64>,
    rows: usize,
    failed: usize,
    telling: Option<(f64, usize)>,
}

/// The map of a ground with at most so many values on an axis, the others pooled. None without an axis.
pub fn map(ground: &Ground, most: usize) -> Option<Figure> {
    let painted = Painted::of(ground);
    let axes = telling(ground, &painted);
    let (x, y) = sides(&axes)?;
    let (x_names, x_group) = groups(x, most);
    let (mut y_names, mut y_group) = y.map_or((vec!["all".to_string()], Vec::new()), |y| groups(y, most));
    let is_upside_down = y.is_some_and(|y| y.numbers.is_none());
    if is_upside_down {
        // Words are read from above.
        y_names.reverse();
        y_group.iter_mut().for_each(|group| *group = y_names.len() - 1 - *group);
    }
    let counts =
        counts(ground, &painted, (x, &x_group), y.map(|y| (y, y_group.as_slice())), (x_names.len(), y_names.len()));
    let cells = cells(
        ground,
        &painted,
        (x, &x_names, &x_group),
        y.map(|y| (y, y_names.as_slice(), y_group.as_slice())),
        &counts,
    );
    let (label, unit, is_share) = match &painted {
        Painted::Share(outcome) => (format!("share {outcome}"), "", true),
        Painted::Median(column) => {
            let (name, unit) = named(ground, column);
            (format!("median {name}"), unit, false)
        }
    };
    let mut notes = ground.notes();
    notes.extend(ground.pooled_beside(&[Some(x), y].into_iter().flatten().collect::<Vec<_>>()));
    notes.extend([Some(x), y].into_iter().flatten().filter_map(Levels::note));
    for axis in [Some(x), y].into_iter().flatten().filter(|axis| axis.len() > most) {
        notes.push(format!("{} values of {} are pooled into {most}", axis.len(), axis.path));
    }
    if matches!(&painted, Painted::Median(column) if column == "search_low") {
        notes.push("the lower end of every bracket".to_string());
    }
    let mut marks = Vec::new();
    let mut finding = finding(ground, &painted, &cells);
    if let (Painted::Share(outcome), true) = (&painted, x.len() <= most) {
        let curve = curve(&counts, x);
        let dots: Vec<Dot> = curve.iter().map(|(y_place, critical)| dot(*y_place, critical, x, &y_names)).collect();
        finding += &half(&curve, outcome, x, &y_names);
        if !dots.is_empty() {
            let label = format!("half of the runs {} at {}", verb(outcome), x.path);
            marks.push(Mark { label, drawn: Drawn::Boundary, colour: 0, dots });
        }
    }
    let values = || cells.iter().filter_map(|cell| cell.value).filter(|value| *value > 0.0);
    let (low, high) = values().fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), v| (low.min(v), high.max(v)));
    let axis = |levels: Option<&Levels>, names: Vec<String>| FigureAxis {
        label: levels.map_or(String::new(), |levels| levels.path.clone()),
        unit: levels.map_or(String::new(), |levels| levels.unit.to_string()),
        scale: FigureScale::Named(names),
    };
    Some(Figure {
        name: "map".to_string(),
        title: match &painted {
            Painted::Share(outcome) => format!("Where runs {}", verb(outcome)),
            Painted::Median(column) => capital(&named(ground, column).0),
        },
        finding,
        field: Some(Shading {
            label,
            unit: unit.to_string(),
            is_share,
            is_logarithmic: !is_share && high / low > 30.0,
            cells,
        }),
        x: axis(Some(x), x_names),
        y: axis(y, y_names),
        marks,
        notes,
    })
}

/// The axis along x, and that along y: what is read as a number lies, the step before others.
pub fn sides<'a>(axes: &[&'a Levels]) -> Option<(&'a Levels, Option<&'a Levels>)> {
    match axes {
        [] => None,
        [only] => Some((only, None)),
        [a, b, ..] => {
            let rank = |axis: &Levels| (axis.is_step(), axis.numbers.is_some(), axis.len());
            Some(if rank(b) > rank(a) { (b, Some(a)) } else { (a, Some(b)) })
        }
    }
}

pub fn verb(outcome: &str) -> &str {
    match outcome {
        "diverged" => "diverge",
        "stalled" => "stall",
        "finished" => "finish",
        other => other,
    }
}

type Grouped<'a> = (&'a Levels, &'a [usize]);

fn counts(
    ground: &Ground,
    painted: &Painted,
    (x, x_group): Grouped,
    y: Option<Grouped>,
    (columns, rows): (usize, usize),
) -> Vec<Vec<Count>> {
    let mut counts = vec![vec![Count::default(); columns]; rows];
    let (values, failed) = (painted.values(ground), ground.ended("failed"));
    let rise = ground.frame().numbers("energy_rise_max_rel");
    for row in 0..ground.frame().rows() {
        let at_y = y.map_or(Some(0), |(y, group)| y.of_row[row].map(|level| group[level as usize]));
        let (Some(x), Some(y)) = (x.of_row[row].map(|level| x_group[level as usize]), at_y) else { continue };
        let count = &mut counts[y][x];
        count.rows += 1;
        count.failed += usize::from(failed[row]);
        if let Some(value) = values[row] {
            count.values.push(value);
            let rise = rise.map(|rise| rise[row]).filter(|x| x.is_finite()).unwrap_or(0.0).clamp(0.0, 1e300);
            // What ends so comes before what does not, then the largest rise of energy.
            let telling = if matches!(painted, Painted::Share(_)) { 1e301 * value + rise } else { value };
            if count.telling.is_none_or(|(best, _)| telling > best) {
                count.telling = Some((telling, row));
            }
        }
    }
    counts
}

type Named<'a> = (&'a Levels, &'a [String], &'a [usize]);

/// What every group of levels stands for, and how many levels it has.
fn picks(levels: &Levels, group: &[usize]) -> Vec<(Picked, usize)> {
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); group.iter().max().map_or(0, |last| last + 1)];
    group.iter().enumerate().for_each(|(level, group)| members[*group].push(level));
    // What is pooled of words is all that stands nowhere else.
    let single = || members.iter().filter(|members| members.len() == 1).map(|members| levels.names[members[0]].clone());
    let pick = |members: &Vec<usize>| match (&members[..], &levels.numbers) {
        ([first, .., last], Some(numbers)) => Picked::Between(numbers[*first], numbers[*last]),
        ([_, _, ..], None) => Picked::NoneOf(single().collect()),
        (few, _) => Picked::OneOf(few.iter().map(|level| levels.names[*level].clone()).collect()),
    };
    members.iter().map(|members| (pick(members), members.len())).collect()
}

fn cells(
    ground: &Ground,
    painted: &Painted,
    (x, x_names, x_group): Named,
    y: Option<Named>,
    counts: &[Vec<Count>],
) -> Vec<GridCell> {
    let product: usize = ground.subject.axes.iter().map(|axis| axis.values.len()).product();
    let is_whole_grid = ground.subject.planned == product && ground.subject.together.is_empty();
    let (x_picks, y_picks) = (picks(x, x_group), y.map(|(y, _, group)| (y, picks(y, group))));
    let mut cells = Vec::new();
    for (y_at, line) in counts.iter().enumerate() {
        for (x_at, count) in line.iter().enumerate() {
            let (x_pick, x_count) = &x_picks[x_at];
            let mut pick = vec![(x.path.clone(), x_pick.clone())];
            pick.extend(y_picks.as_ref().map(|(y, picks)| (y.path.clone(), picks[y_at].0.clone())));
            let of_grid = x_count * y_picks.as_ref().map_or(1, |(_, picks)| picks[y_at].1);
            let all: usize = x.len() * y.map_or(1, |(y, ..)| y.len());
            let expected = if is_whole_grid { ground.subject.planned * of_grid / all } else { count.rows };
            let missing = expected.saturating_sub(count.rows);
            let n = count.values.len();
            let mut said = format!("{} = {}", x.path, with_unit(&x_names[x_at], x.unit));
            if let Some((y, names, _)) = y {
                said += &format!(", {} = {}", y.path, with_unit(&names[y_at], y.unit));
            }
            let (value, text) = match painted {
                _ if n == 0 => (None, (if count.failed > 0 { "failed" } else { "–" }).to_string()),
                Painted::Share(outcome) => {
                    let k = count.values.iter().filter(|value| **value > 0.0).count();
                    let Interval { low, high } = of_share(k, n);
                    said += &format!(": {k} of {n} {outcome} (95 % interval {} to {})", percent(low), percent(high));
                    let share = k as f64 / n as f64;
                    (Some(share), percent(share))
                }
                Painted::Median(column) => {
                    let middle = median(&count.values).unwrap_or_default();
                    let (name, unit) = named(ground, column);
                    said += &format!(": median {name} {} of {n}", with_unit(&short(middle), unit));
                    // Two digits where there is room for them.
                    let text = if middle == 0.0 {
                        "0".to_string()
                    } else if x_names.len() <= 8 {
                        format!("{middle:.1e}")
                    } else {
                        format!("{middle:.0e}")
                    };
                    (Some(middle), text)
                }
            };
            for (n, what) in
                [(count.failed, "failed"), (missing, "missing"), (count.rows - count.failed - n, "without a number")]
            {
                if n > 0 {
                    said += &format!("; {n} {what}");
                }
            }
            if count.rows == 0 {
                said += ": no row";
            }
            let is_doubtful = count.failed > 0 || missing > 0;
            let row = count.telling.map(|(_, row)| row);
            cells.push(GridCell { x: x_at, y: y_at, value, text, said: plain(&said), is_doubtful, row, pick });
        }
    }
    cells
}

/// What a column is called, and its unit; of a search it is of the key that is searched.
fn named(ground: &Ground, column: &str) -> (String, &'static str) {
    match &ground.subject.search {
        Some(key) if column.starts_with("search_") => (format!("critical {key}"), unit_of(key)),
        _ => (format!("|{column}|"), unit_of(column)),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_string() } else { format!("{number} {unit}") }
}

/// Critical values along x, a line of the map each: its place, and the value.
fn curve(counts: &[Vec<Count>], x: &Levels) -> Vec<(usize, Critical)> {
    let shares = |line: &[Count]| -> Vec<(f64, usize, usize)> {
        let share = |(i, count): (usize, &Count)| {
            (i as f64, count.values.iter().filter(|value| **value > 0.0).count(), count.values.len())
        };
        line.iter().enumerate().map(share).collect()
    };
    let critical = |line: &[Count]| critical(&shares(line), x);
    counts.iter().enumerate().filter_map(|(y, line)| Some((y, critical(line)?))).collect()
}

/// Where a share that rises along an axis crosses a half. Levels are (place, k, n).
pub fn critical(levels: &[(f64, usize, usize)], x: &Levels) -> Option<Critical> {
    let (place, low, high) = crossing(levels)?;
    let value = |place: f64| x.value_at(place);
    Some(Critical { place, value: value(place)?, low: low.and_then(value), high: high.and_then(value) })
}

fn dot(y: usize, critical: &Critical, x: &Levels, y_names: &[String]) -> Dot {
    let name = if y_names.len() > 1 { format!("{}: ", y_names[y]) } else { String::new() };
    let said = format!("{name}{}", interval(critical, x.unit));
    Dot::at(critical.place, y as f64).saying(plain(&said))
}

/// A critical value with its interval.
pub fn interval(critical: &Critical, unit: &str) -> String {
    let end = |end: Option<f64>, open: &str| end.map_or(open.to_string(), short);
    let value = with_unit(&short(critical.value), unit);
    match (critical.low, critical.high) {
        (None, None) => value,
        (low, high) => format!("{value} (95 %: {} to {})", end(low, "below"), end(high, "beyond")),
    }
}

fn half(curve: &[(usize, Critical)], outcome: &str, x: &Levels, y_names: &[String]) -> String {
    let smallest = curve.iter().min_by(|a, b| a.1.value.total_cmp(&b.1.value));
    match (smallest, y_names.len()) {
        (None, _) => String::new(),
        (Some((_, critical)), 1) => {
            format!(" Half of the runs {} at {} = {}.", verb(outcome), x.path, interval(critical, x.unit))
        }
        (Some((y, critical)), _) => format!(
            " Half of the runs {} first for {}: at {} = {}.",
            verb(outcome),
            y_names[*y],
            x.path,
            interval(critical, x.unit)
        ),
    }
}

fn finding(ground: &Ground, painted: &Painted, cells: &[GridCell]) -> String {
    let frame = ground.frame();
    let largest = cells.iter().filter(|cell| cell.value.is_some()).max_by(|a, b| {
        let value = |cell: &GridCell| cell.value.unwrap_or(f64::NEG_INFINITY);
        // Of equals the first.
        value(a).total_cmp(&value(b)).then(std::cmp::Ordering::Greater)
    });
    match painted {
        Painted::Share(outcome) => {
            let (k, n) = (frame.count(outcome), frame.rows() - frame.count("failed"));
            if n == 0 {
                return "No run has ended, so that nothing can be said.".to_string();
            }
            if k == 0 {
                let high = of_share(0, n).high;
                let of =
                    if n == 1 { "The one run does not".to_string() } else { format!("None of {}", counted(n, "run")) };
                return format!("{of} {} (95 % interval up to {:.2} %).", verb(outcome), 100.0 * high);
            }
            let Interval { low, high } = of_share(k, n);
            let most = largest.map(|cell| cell.said.split(" (95").next().unwrap_or_default().to_string());
            let alike = cells.iter().filter(|cell| cell.value == largest.and_then(|largest| largest.value)).count();
            let most = match alike {
                _ if cells.iter().filter(|cell| cell.value.is_some()).count() == alike => String::new(),
                0 | 1 => most.map(|said| format!("; most where {said}")).unwrap_or_default(),
                n => most.map(|said| format!("; most in {n} cells, such as {said}")).unwrap_or_default(),
            };
            let ending = if n == 1 { "s" } else { "" };
            // As many digits as tell the ends of the interval apart.
            let digits = (1.0 - libm::log10(100.0 * (high - low)).floor()).clamp(1.0, 6.0) as usize;
            format!(
                "{k} of {} {}{ending} ({:.digits$} %, 95 % interval {:.digits$} to {:.digits$} %){most}.",
                counted(n, "run"),
                verb(outcome),
                100.0 * k as f64 / n as f64,
                100.0 * low,
                100.0 * high
            )
        }
        Painted::Median(column) => {
            let smallest = cells.iter().filter_map(|cell| cell.value).reduce(f64::min);
            match (largest, smallest) {
                (Some(cell), Some(smallest)) => {
                    let (name, unit) = named(ground, column);
                    let [smallest, largest] =
                        [smallest, cell.value.unwrap_or_default()].map(|x| with_unit(&short(x), unit));
                    let place = cell.said.split(": median").next().unwrap_or_default();
                    match smallest == largest {
                        true => format!("The median {name} of every cell is {largest}."),
                        false => {
                            format!("The median {name} of a cell goes from {smallest} to {largest}, where {place}.")
                        }
                    }
                }
                _ => format!("No row has a number in {column}."),
            }
        }
    }
}

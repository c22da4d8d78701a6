//! Critical values against an axis that can be read as a number, with the law of a power: of a search as its rows have
//! them, else where half of the runs of the map end so.

use super::figure::{Dot, Drawn, Figure, FigureAxis, FigureScale, Mark};
use super::map::{Painted, critical, interval, sides, telling, verb};
use super::number::{counted, in_percent, plain, short};
use super::power_law::PowerFit;
use super::subject::{Ground, Levels};
use crate::heading::unit_of;

/// Series of critical values: its name, and the dots.
type Found = (String, Vec<Dot>);

/// What critical values there are: the key that is critical, the axis that they lie along, and the series.
struct Critically<'a> {
    key: String,
    along: &'a Levels,
    is_family: bool,
    series: Vec<Found>,
    notes: Vec<String>,
    how: String,
}

/// The figure of a ground. None where nothing critical is known at two places of an axis.
pub fn figure(ground: &Ground) -> Option<Figure> {
    let searched = of_search(ground);
    let is_search = searched.is_some();
    let Critically { key, along, is_family, series, notes: more, how } = searched.or_else(|| of_map(ground))?;
    let unit = unit_of(&key);
    let (mut marks, mut laws, mut has_law) = (Vec::new(), Vec::new(), false);
    for (colour, (name, dots)) in series.into_iter().enumerate() {
        let positive: Vec<&Dot> = dots.iter().filter(|dot| dot.x > 0.0 && dot.y > 0.0).collect();
        let points: Vec<(f64, f64)> = positive.iter().map(|dot| (dot.x, dot.y)).collect();
        // The brackets of a search are no intervals of chance.
        let intervals = if is_search { Vec::new() } else { positive.iter().filter_map(|dot| ends(dot)).collect() };
        let mut label = if name.is_empty() { how.clone() } else { name.clone() };
        let of = if name.is_empty() { String::new() } else { format!("{name}: ") };
        let fit = PowerFit::of(&points, &intervals);
        if let PowerFit::Holds(law) = fit {
            has_law = true;
            label += &format!(" ∝ x^{}", law.written());
            let mut ends: Vec<f64> = points.iter().map(|point| point.0).collect();
            ends.sort_by(f64::total_cmp);
            let line = ends.iter().map(|x| Dot::at(*x, law.at(*x))).collect();
            marks.push(Mark {
                label: format!("law of {}", if name.is_empty() { "all" } else { &name }),
                drawn: Drawn::Dashed,
                colour,
                dots: line,
            });
        }
        laws.push(format!("{of}{}{}", said_of(fit, &points), at_zero(dots.len() - points.len())));
        let drawn = if matches!(fit, PowerFit::Holds(_)) { Drawn::Points } else { Drawn::Line };
        marks.push(Mark { label, drawn, colour, dots });
    }
    let dots = || marks.iter().filter(|mark| mark.drawn != Drawn::Dashed).flat_map(|mark| &mark.dots);
    let (low, high) = dots().fold((f64::INFINITY, 0.0f64), |(low, high), dot| (low.min(dot.y), high.max(dot.y)));
    let range = format!("{how} goes from {} to {}", short(low), with_unit(&short(high), unit));
    let range = range.replacen("the critical", "The critical", 1);
    let finding = format!("{range}; as a power of {}, {}.", along.path, laws.join("; "));
    let is_log = dots().all(|dot| dot.x > 0.0 && dot.y > 0.0);
    let scale = || if is_log { FigureScale::Logarithmic } else { FigureScale::Linear };
    let label = if is_family { format!("number in {}", along.path) } else { along.path.clone() };
    let mut notes = ground.notes();
    notes.extend(more);
    if has_law {
        notes
            .push("dashed: least squares in logarithms, ± 95 %, where no bend and no scatter speaks against it".into());
    }
    Some(Figure {
        name: "critical".to_string(),
        title: format!("Critical {key}"),
        finding: plain(&finding),
        x: FigureAxis { label, unit: along.unit.to_string(), scale: scale() },
        y: FigureAxis { label: format!("critical {key}"), unit: unit.to_string(), scale: scale() },
        field: None,
        marks,
        notes,
    })
}

/// What a law has no place for.
fn at_zero(points: usize) -> String {
    if points == 0 { String::new() } else { format!(", {} at 0 left out", counted(points, "point")) }
}

/// What a fit says, in words.
fn said_of(fit: PowerFit, points: &[(f64, f64)]) -> String {
    match fit {
        PowerFit::Holds(law) => {
            // By how much the farthest point is off the law.
            let off = points.iter().map(|(x, y)| (y / law.at(*x) - 1.0).abs()).fold(0.0, f64::max);
            let off = if off < 0.01 { String::new() } else { format!(", up to {} off", in_percent(off)) };
            format!("exponent {} ({} places{off})", law.written(), points.len())
        }
        PowerFit::TooFew(1) => "too few places for a law (1)".to_string(),
        PowerFit::TooFew(places) => format!("too few places for a law ({places}; it takes 4)"),
        PowerFit::Scattered(law) => format!("too scattered for a law (exponent {})", law.written()),
        PowerFit::Flat(law) => format!("no law: the exponent {} may be 0", law.written()),
        PowerFit::Bends(first, last) => {
            format!("no law: the exponent goes from {first:.2} to {last:.2}").replace("-0.00", "0.00")
        }
        PowerFit::OutsideOfIntervals(n, of) => format!("no law: it leaves the 95 % intervals of {n} of {of} points"),
    }
}

/// Interval of a point; an end that is not known is open.
fn ends(dot: &Dot) -> Option<(f64, f64)> {
    Some((dot.low?, dot.high?))
}

fn with_unit(number: &str, unit: &str) -> String {
    if unit.is_empty() { number.to_string() } else { format!("{number} {unit}") }
}

fn of_search<'a>(ground: &'a Ground) -> Option<Critically<'a>> {
    let key = ground.subject.search.clone()?;
    let (low, high) = (ground.frame().numbers("search_low")?, ground.frame().numbers("search_high")?);
    let along = ground.chosen().filter(|axis| axis.numbers.is_some()).max_by_key(|axis| axis.len());
    let along = along.or_else(|| ground.chosen().find(|axis| !axis.families().is_empty()))?;
    let by = ground.chosen().find(|axis| axis.path != along.path && axis.len() <= 8);
    let numbers = places(along);
    let mut series: Vec<Found> = Vec::new();
    let mut open = 0;
    for row in 0..ground.frame().rows() {
        let Some((family, x)) = along.of_row[row].and_then(|level| numbers[level as usize].clone()) else { continue };
        let (low, high) = (low[row], high[row]);
        if !(low.is_finite() && high.is_finite()) {
            open += 1;
            continue;
        }
        let other = by.and_then(|by| Some(by.labels[by.of_row[row]? as usize].clone())).unwrap_or_default();
        let name = [family, other].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
        let middle = if low > 0.0 { (low * high).sqrt() } else { 0.5 * (low + high) };
        let said = format!("{} = {}: {key} between {} and {}", along.path, short(x), short(low), short(high));
        let dot = Dot { row: Some(row), ..Dot::at(x, middle).with_bar(low, high).saying(plain(&said)) };
        push(&mut series, name, dot);
    }
    let notes = (open > 0).then(|| format!("{} without a bracket not shown", counted(open, "cell")));
    finished(series, along, key.clone(), notes.into_iter().collect(), format!("the critical {key}"))
}

fn of_map<'a>(ground: &'a Ground) -> Option<Critically<'a>> {
    let painted = Painted::of(ground);
    let Painted::Share(outcome) = &painted else { return None };
    let axes = telling(ground, &painted);
    let (x, along) = sides(&axes)?;
    let along = along?;
    x.numbers.as_ref()?;
    let numbers = places(along);
    let (ended, failed) = (ground.ended(outcome), ground.ended("failed"));
    let mut counts = vec![vec![(0usize, 0usize); x.len()]; along.len()];
    for row in (0..ground.frame().rows()).filter(|row| !failed[*row]) {
        if let (Some(x), Some(y)) = (x.of_row[row], along.of_row[row]) {
            let count = &mut counts[y as usize][x as usize];
            count.0 += usize::from(ended[row]);
            count.1 += 1;
        }
    }
    let mut series: Vec<Found> = Vec::new();
    let mut open = 0;
    for (level, counts) in counts.iter().enumerate() {
        let Some((family, place)) = numbers[level].clone() else { continue };
        let shares: Vec<_> = counts.iter().enumerate().map(|(i, (k, n))| (i as f64, *k, *n)).collect();
        match critical(&shares, x) {
            None => open += 1,
            Some(found) => {
                let said = format!(
                    "{}: half {} at {} = {}",
                    along.says(level),
                    verb(outcome),
                    x.path,
                    interval(&found, x.unit)
                );
                let ends = x.numbers.as_ref().and_then(|numbers| Some((*numbers.first()?, *numbers.last()?)));
                let (first, last) = ends.unwrap_or((found.value, found.value));
                let (low, high) = (found.low.unwrap_or(first), found.high.unwrap_or(last));
                push(&mut series, family, Dot::at(place, found.value).with_bar(low, high).saying(plain(&said)));
            }
        }
    }
    let mut notes =
        vec![format!("critical: half of the runs {}; bars: 95 %, to the end of the axis where open", verb(outcome))];
    if open > 0 {
        notes.push(format!(
            "{} of {} on which the share does not cross a half not shown",
            counted(open, "value"),
            along.path
        ));
    }
    let key = x.path.clone();
    finished(series, along, key.clone(), notes, format!("the critical {key}"))
}

/// The number that every level stands for, and the family that it is of.
fn places(along: &Levels) -> Vec<Option<(String, f64)>> {
    let mut places = vec![None; along.len()];
    for (family, members) in along.families() {
        for (level, number) in members {
            places[level] = Some((family.clone(), number));
        }
    }
    places
}

fn push(series: &mut Vec<Found>, name: String, dot: Dot) {
    match series.iter_mut().find(|(known, _)| *known == name) {
        Some((_, dots)) => dots.push(dot),
        None => series.push((name, vec![dot])),
    }
}

fn finished<'a>(
    mut series: Vec<Found>,
    along: &'a Levels,
    key: String,
    notes: Vec<String>,
    how: String,
) -> Option<Critically<'a>> {
    series.iter_mut().for_each(|(_, dots)| dots.sort_by(|a, b| a.x.total_cmp(&b.x)));
    series.truncate(8);
    series.iter().any(|(_, dots)| dots.len() > 1).then_some(())?;
    Some(Critically { key, along, is_family: along.numbers.is_none(), series, notes, how })
}

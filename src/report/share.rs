//! The share of runs that end in one way along an axis, a line for each value of another, with intervals.

use super::ensemble::along;
use super::figure::{Dot, Drawn, Figure, FigureAxis, FigureScale, Mark};
use super::map::{Painted, sides, telling, verb};
use super::number::{in_percent, percent};
use super::subject::{Ground, Levels};
use crate::math::interval::{Interval, of_share};

/// Most lines that can be told apart.
const MOST: usize = 7;

/// The figure of a ground. None where the map shows no share, or nothing differs.
pub fn figure(ground: &Ground) -> Option<Figure> {
    let painted = Painted::of(ground);
    let Painted::Share(outcome) = &painted else { return None };
    if ground.frame().count(outcome) == 0 {
        return None;
    }
    let axes = telling(ground, &painted);
    let (x, y) = sides(&axes)?;
    let y = y.filter(|y| y.len() <= MOST);
    if x.is_of_seeds() {
        return None;
    }
    let (ended, failed) = (ground.ended(outcome), ground.ended("failed"));
    let mut counts = vec![vec![(0usize, 0usize); x.len()]; y.map_or(1, Levels::len)];
    for row in (0..ground.frame().rows()).filter(|row| !failed[*row]) {
        let at = y.map_or(Some(0), |y| y.of_row[row]);
        if let (Some(x), Some(y)) = (x.of_row[row], at) {
            let count = &mut counts[y as usize][x as usize];
            count.0 += usize::from(ended[row]);
            count.1 += 1;
        }
    }
    let mark = |(series, counts): (usize, &Vec<(usize, usize)>)| {
        let name = y.map_or("all".to_string(), |y| y.labels[series].clone());
        let dot = |(level, (k, n)): (usize, &(usize, usize))| {
            let Interval { low, high } = of_share(*k, *n);
            let place = x.numbers.as_ref().map_or(level as f64, |numbers| numbers[level]);
            let said = format!(
                "{name}, {}: {k} of {n} {outcome} (95 % interval {} to {})",
                x.says(level),
                percent(low),
                percent(high)
            );
            (*n > 0).then(|| Dot::at(place, *k as f64 / *n as f64).with_bar(low, high).saying(said))
        };
        let dots = counts.iter().enumerate().filter_map(dot).collect();
        Mark { label: name.clone(), drawn: Drawn::Line, colour: series, dots }
    };
    let marks: Vec<Mark> = counts.iter().enumerate().map(mark).collect();
    let mut notes = ground.notes();
    notes.extend(ground.pooled_beside(&[Some(x), y].into_iter().flatten().collect::<Vec<_>>()));
    notes.extend([Some(x), y].into_iter().flatten().filter(|axis| axis.numbers.is_none()).filter_map(Levels::note));
    let side_by_side = if y.is_some() { "; series stand side by side" } else { "" };
    notes.push(format!("bars: Wilson's interval, 95 %{side_by_side}"));
    Some(Figure {
        name: "share".to_string(),
        title: format!("Share of runs that {}", verb(outcome)),
        finding: finding(&marks, x, y, outcome)?,
        x: along(x, x.is_logarithmic()),
        y: FigureAxis { label: format!("share {outcome}"), unit: "1".to_string(), scale: FigureScale::Linear },
        field: None,
        marks,
        notes,
    })
}

/// What there is where the lines are farthest apart, or where a single one is highest.
fn finding(marks: &[Mark], x: &Levels, y: Option<&Levels>, outcome: &str) -> Option<String> {
    let place = |level: usize| x.numbers.as_ref().map_or(level as f64, |numbers| numbers[level]);
    let at = |level: usize| {
        let here =
            marks.iter().filter_map(move |mark| Some((mark, mark.dots.iter().find(|dot| dot.x == place(level))?.y)));
        let low = here.clone().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let high = here.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some((low, high))
    };
    let spread =
        |level: usize| at(level).map_or(-1.0, |(low, high)| if marks.len() > 1 { high.1 - low.1 } else { high.1 });
    let highest = |level: usize| at(level).map_or(-1.0, |(_, high)| high.1);
    // Where no two lines differ, the highest place.
    let rank = |a: usize, b: usize| spread(a).total_cmp(&spread(b)).then(highest(a).total_cmp(&highest(b)));
    let level = (0..x.len()).max_by(|a, b| rank(*a, *b))?;
    let of = |mark: &Mark| y.map_or(mark.label.clone(), |y| y.says(mark.colour));
    let (low, high) = at(level)?;
    let verb = verb(outcome);
    let sizes = || marks.iter().flat_map(|mark| mark.dots.iter().map(|dot| dot.y));
    if let Some(first) = sizes().next()
        && sizes().all(|y| y == first)
    {
        return Some(format!("Everywhere {} of the runs {verb}.", in_percent(first)));
    }
    Some(match marks.len() {
        1 => format!("At {} {} of the runs {verb}, the most anywhere.", x.says(level), in_percent(high.1)),
        // Of all series one alone has runs there, or all are alike.
        _ if low.1 == high.1 => {
            format!("At {} {} of the runs {verb} ({}).", x.says(level), in_percent(high.1), of(high.0))
        }
        _ => format!(
            "At {} between {} ({}) and {} ({}) of the runs {verb}.",
            x.says(level),
            in_percent(low.1),
            of(low.0),
            in_percent(high.1),
            of(high.0)
        ),
    })
}

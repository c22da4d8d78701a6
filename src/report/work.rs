//! Counters of work along the axis that tells most: medians.

use super::ensemble::along;
use super::figure::{Dot, Drawn, Figure, FigureAxis, FigureScale, Mark};
use super::number::{counted, short};
use super::stats::{explained, median};
use super::subject::{Ground, Levels};

/// Most counters of a figure.
const MOST: usize = 6;

/// The figure of a ground. None where nothing was counted, or there is no axis.
pub fn figure(ground: &Ground) -> Option<Figure> {
    let frame = ground.frame();
    let total = |name: &str| frame.numbers(name).map(|numbers| numbers.iter().filter(|x| x.is_finite()).sum::<f64>());
    let mut counters: Vec<(&str, f64)> = frame
        .names()
        .filter(|name| name.starts_with("work_"))
        .filter_map(|name| Some((name, total(name).filter(|sum| *sum > 0.0)?)))
        .collect();
    counters.sort_by(|a, b| b.1.total_cmp(&a.1));
    counters.truncate(MOST);
    let first = frame.numbers(counters.first()?.0)?;
    let score = |axis: &Levels| {
        let of = axis.of_row.iter().zip(first);
        explained(axis.len(), of.filter_map(|(level, y)| Some(((*level)? as usize, libm::log1p(y.max(0.0))))))
    };
    let x = ground.chosen().max_by(|a, b| score(a).total_cmp(&score(b)))?;
    let place = |level: usize| x.numbers.as_ref().map_or(level as f64, |numbers| numbers[level]);
    let (mut said, mut ranges) = (Vec::new(), Vec::new());
    let mut marks = Vec::new();
    for (colour, (name, _)) in counters.iter().enumerate() {
        let dot = |(level, values): (usize, &Vec<f64>)| {
            let middle = median(values).filter(|middle| *middle > 0.0)?;
            let said =
                format!("{name}, {}: median {} of {}", x.says(level), short(middle), counted(values.len(), "run"));
            Some(Dot::at(place(level), middle).saying(said))
        };
        let dots: Vec<Dot> = ground.grouped(x, None, name)[0].iter().enumerate().filter_map(dot).collect();
        let is_whole = |a: &Dot, b: &Dot| x.len() > 1 && [a.x, b.x] == [place(0), place(x.len() - 1)];
        let (low, high) =
            dots.iter().fold((f64::INFINITY, 0.0f64), |(low, high), dot| (low.min(dot.y), high.max(dot.y)));
        ranges.push(format!("{name} {} to {}", short(low), short(high)));
        if let (Some(a), Some(b)) = (dots.first(), dots.last())
            && is_whole(a, b)
        {
            said.push(format!("{name} {} to {}", short(a.y), short(b.y)));
        }
        if dots.is_empty() {
            continue;
        }
        let drawn = if x.numbers.is_some() { Drawn::Line } else { Drawn::Points };
        marks.push(Mark { label: name.to_string(), drawn, colour, dots });
    }
    said.truncate(3);
    ranges.truncate(3);
    let mut notes = ground.notes();
    notes.extend(ground.pooled_beside(&[x]));
    notes.extend(x.note().filter(|_| x.numbers.is_none()));
    notes.push("medians; a median of 0 is not shown".to_string());
    Some(Figure {
        name: "work".to_string(),
        title: "Work".to_string(),
        finding: match said.len() {
            0 => format!("Medians along {}, smallest to largest: {}.", x.path, ranges.join(", ")),
            _ => format!("Medians from {} to {}: {}.", x.says(0), x.says(x.len() - 1), said.join(", ")),
        },
        x: along(x, x.is_logarithmic()),
        y: FigureAxis {
            // One alone has no legend that names it.
            label: match &marks[..] {
                [only] => format!("{} in a run, median", only.label),
                _ => "count in a run, median".to_string(),
            },
            unit: "1".to_string(),
            scale: FigureScale::Logarithmic,
        },
        field: None,
        marks,
        notes,
    })
}

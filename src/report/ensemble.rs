//! Energy over an ensemble of seeds: the median and the middle nine tenths, along the axis that tells most.

use super::figure::{Dot, Drawn, Figure, FigureAxis, FigureScale, Mark};
use super::map::{Painted, sides, telling};
use super::number::{counted, short};
use super::stats::quantile;
use super::subject::{Ground, Levels};

/// Fewest seeds that make an ensemble.
const LEAST: usize = 5;
/// Most lines that can be told apart, and most bands.
const MOST: usize = 7;
const BANDS: usize = 3;

/// Medians that differ by less are alike.
const ALIKE: f64 = 1e-9;

/// The figure of a ground with seeds. None without them, or without an axis beside them.
pub fn figure(ground: &Ground) -> Option<Figure> {
    ground.axes.iter().find(|axis| axis.is_of_seeds() && axis.len() >= LEAST)?;
    let columns = ["energy_drift_rel", "energy_rise_max_rel", "energy_balance_rel"];
    let has_sizes = |name: &&&str| {
        ground.frame().numbers(name).is_some_and(|numbers| numbers.iter().any(|x| x.is_finite() && *x != 0.0))
    };
    let column = *columns.iter().find(has_sizes)?;
    let axes = telling(ground, &Painted::Median(column.to_string()));
    let (x, y) = sides(&axes)?;
    if x.is_of_seeds() {
        return None;
    }
    let y = y.filter(|y| y.len() <= MOST);
    let groups = ground.grouped(x, y, column);
    let is_log = x.is_logarithmic();
    let place = |level: usize| x.numbers.as_ref().map_or(level as f64, |numbers| numbers[level]);
    let (mut marks, mut largest, mut zeros, mut floored, mut n) = (Vec::new(), None, 0, 0, 0);
    for (series, levels) in groups.iter().enumerate() {
        let name = y.map_or("all".to_string(), |y| y.labels[series].clone());
        let mut dots = Vec::new();
        for (level, values) in levels.iter().enumerate() {
            let mut sizes: Vec<f64> = values.iter().map(|x| x.abs()).filter(|x| x.is_finite()).collect();
            sizes.sort_by(f64::total_cmp);
            if sizes.is_empty() {
                // A line does not go on over what is not known.
                dots.push(Dot::at(place(level), f64::NAN));
                continue;
            }
            n += sizes.len();
            let [low, middle, high] = [0.05, 0.5, 0.95].map(|q| quantile(&sizes, q));
            if middle == 0.0 {
                zeros += 1;
                dots.push(Dot::at(place(level), 0.0).with_bar(low, high));
                continue;
            }
            let of = y.map_or(String::new(), |_| format!("{name}, "));
            let said = format!(
                "{of}{}: median {}, 5 to 95 % {} to {}, {} runs",
                x.says(level),
                short(middle),
                short(low),
                short(high),
                sizes.len()
            );
            if largest.as_ref().is_none_or(|(largest, _)| middle > *largest * (1.0 + ALIKE)) {
                largest = Some((middle, said.clone()));
            }
            floored += usize::from(low == 0.0);
            dots.push(Dot::at(place(level), middle).with_bar(low, high).saying(said));
        }
        marks.push(Mark { label: name, drawn: Drawn::Line, colour: series, dots });
    }
    let banded = banded(&marks);
    let of = banded.iter().map(|series| marks[*series].label.clone()).collect::<Vec<_>>().join(", ");
    let band = |series: &usize| {
        let Mark { label, dots, .. } = &marks[*series];
        Mark { label: format!("{label}, 5 to 95 %"), drawn: Drawn::Band, colour: *series, dots: dots.clone() }
    };
    let mut bands: Vec<Mark> = banded.iter().map(band).collect();
    marks.iter_mut().flat_map(|mark| &mut mark.dots).for_each(|dot| (dot.low, dot.high) = (None, None));
    bands.append(&mut marks);
    let (_, said) = largest?;
    let is_drawn = |axis: &Levels| axis.path == x.path || y.is_some_and(|y| axis.path == y.path);
    let is_of_seeds = ground.axes.iter().all(|axis| axis.is_of_seeds() || is_drawn(axis));
    let mut notes = ground.notes();
    notes.extend([Some(x), y].into_iter().flatten().filter(|axis| axis.numbers.is_none()).filter_map(Levels::note));
    notes.extend(ground.pooled_beside(&[Some(x), y].into_iter().flatten().collect::<Vec<_>>()));
    notes.push(format!(
        "lines: medians; areas: 5 to 95 % of the {}{}",
        if is_of_seeds { "seeds" } else { "runs" },
        if of == "all" { String::new() } else { format!(", of {of}") }
    ));
    notes.push(format!("{} of {}; of what diverged too", counted(n, "number"), counted(ground.frame().rows(), "row")));
    if floored > 0 {
        notes.push(format!("{} of areas at 0, drawn to the axis", counted(floored, "lower end")));
    }
    if zeros > 0 {
        notes.push(format!("{} with a median of 0 not shown", counted(zeros, "point")));
    }
    Some(Figure {
        name: "ensemble".to_string(),
        title: format!("Size of {column} over {}", if is_of_seeds { "seeds" } else { "runs" }),
        finding: format!("The median of |{column}| is largest for {said}."),
        x: along(x, is_log),
        y: FigureAxis { label: format!("|{column}|"), unit: "1".to_string(), scale: FigureScale::Logarithmic },
        field: None,
        marks: bands,
        notes,
    })
}

/// The series that have a band: all of a few, else those with the smallest and the largest numbers.
fn banded(marks: &[Mark]) -> Vec<usize> {
    if marks.len() <= BANDS {
        return (0..marks.len()).collect();
    }
    let last = |series: &usize| marks[*series].dots.iter().rev().map(|dot| dot.y).find(|y| *y > 0.0);
    let mut series: Vec<usize> = (0..marks.len()).filter(|series| last(series).is_some()).collect();
    series.sort_by(|a, b| last(a).unwrap_or_default().total_cmp(&last(b).unwrap_or_default()));
    match series[..] {
        [first, .., last] => vec![first, last],
        _ => series,
    }
}

/// The axis of a figure along the levels of one of the sweep's.
pub fn along(x: &Levels, is_log: bool) -> FigureAxis {
    let scale = match (&x.numbers, is_log) {
        (None, _) => FigureScale::Named(x.labels.clone()),
        (Some(_), true) => FigureScale::Logarithmic,
        (Some(_), false) => FigureScale::Linear,
    };
    FigureAxis { label: x.path.clone(), unit: x.unit.to_string(), scale }
}

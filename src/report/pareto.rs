//! Run time against error: a line a method, the Pareto front behind them.

use super::figure::{Dot, Drawn, Figure, FigureAxis, FigureScale, Mark};
use super::number::{counted, plain, short};
use super::tried::Tried;
use crate::check::Magnitudes;
use crate::heading::unit_of;
use crate::rows::trials::{Trial, methods, order, pareto};

/// A slope of the error in the step that is none: rounding, or an error of another origin.
pub const IS_AN_ORDER: f64 = 0.2;

/// The figure of trials.
pub fn figure(title: &str, tried: &[Tried], magnitudes: &Magnitudes) -> Figure {
    let trials: Vec<Trial> = tried.iter().map(|tried| tried.trial.clone()).collect();
    let column = trials.first().map_or("error", |row| row.error_kind.as_str());
    let floor = magnitudes.floor(column);
    let is_one_problem = tried.iter().all(|other| other.problem == tried[0].problem);
    let on_front = if is_one_problem { pareto(&trials, floor) } else { vec![false; trials.len()] };
    let mut front: Vec<Dot> =
        trials.iter().zip(&on_front).filter(|(_, on_it)| **on_it).filter_map(|(row, _)| dot(row, None)).collect();
    front.sort_by(|a, b| a.x.total_cmp(&b.x));
    let front = Mark { label: "Pareto front".to_string(), drawn: Drawn::Front, colour: 4, dots: front };
    let mut marks = if is_one_problem { vec![front] } else { Vec::new() };
    let mut without = 0;
    for (colour, method) in methods(&trials).into_iter().enumerate() {
        let of_method: Vec<&Tried> = tried.iter().filter(|tried| tried.trial.method == method).collect();
        let dots: Vec<Dot> = of_method.iter().filter_map(|tried| dot(&tried.trial, tried.row)).collect();
        let mut label = plain(method);
        // None of another engine's best rows, which are of several methods, nor of what chooses its own steps.
        let has_steps = of_method.iter().all(|Tried { trial, .. }| trial.engine == "gotai" && trial.step_s.is_some());
        if let Some(order) = order(&trials, method, floor).filter(|order| has_steps && order.slope > IS_AN_ORDER) {
            label += &format!(", order {:.2}", order.slope);
        }
        // What a logarithm cannot show is said in words.
        let exact = dots.iter().filter(|dot| dot.x == 0.0).count();
        without += of_method.len() - dots.len();
        for (n, what) in [(exact, "error 0"), (of_method.len() - dots.len(), "without an end")] {
            if n > 0 {
                label += &format!(", {what}: {n}");
            }
        }
        marks.push(Mark { label, drawn: Drawn::Line, colour, dots });
    }
    let rows: usize = tried.iter().map(|tried| tried.rows).sum();
    let mut notes = vec![format!("n = {}", counted(rows, "row"))];
    if rows > tried.len() {
        notes.push(format!("a point is the median of up to {} runs", tried.iter().map(|t| t.rows).max().unwrap_or(1)));
    }
    let is_repeated = trials.iter().any(|trial| trial.wall_median_s.is_some());
    notes.push(
        (if is_repeated { "bars: from the best of the repeats to their median" } else { "times of steps in a sweep" })
            .to_string(),
    );
    if trials.iter().any(|trial| trial.step_s.or(trial.tolerance).is_none()) {
        notes.push("closed forms, which errors are measured against, do not compete".to_string());
    }
    if without > 0 {
        notes.push(format!("{} without an end or a number", counted(without, "point")));
    }
    Figure {
        name: "pareto".to_string(),
        title: plain(title),
        finding: if is_one_problem { finding(&trials, &on_front, (column, floor)) } else { of_problems(tried) },
        x: FigureAxis { label: in_words(column), unit: unit(column), scale: FigureScale::Logarithmic },
        y: FigureAxis {
            label: (if is_repeated { "run time, best" } else { "run time" }).to_string(),
            unit: "s".to_string(),
            scale: FigureScale::Logarithmic,
        },
        field: None,
        marks,
        notes,
    }
}

fn dot(trial: &Trial, row: Option<usize>) -> Option<Dot> {
    let (error, wall_s) = trial.point()?;
    let at = match (trial.step_s, trial.tolerance) {
        (_, Some(tolerance)) => format!(" at tolerance {}", short(tolerance)),
        (Some(step_s), None) => format!(" at {} s", short(step_s)),
        (None, None) => String::new(),
    };
    let said = format!("{}{at}: error {}, {} s", trial.method, short(error), short(wall_s));
    let (low, high) = trial.wall_median_s.map_or((None, None), |median_s| (Some(wall_s), Some(median_s)));
    Some(Dot { x: error, y: wall_s, low, high, said: plain(&said), row })
}

fn finding(trials: &[Trial], on_front: &[bool], (column, floor): (&str, f64)) -> String {
    let mut best: Vec<&str> = Vec::new();
    for (trial, _) in trials.iter().zip(on_front).filter(|(_, on_it)| **on_it) {
        if !best.contains(&trial.method.as_str()) {
            best.push(&trial.method);
        }
    }
    let accurate = trials.iter().zip(on_front).filter(|(_, on_it)| **on_it).filter_map(|(trial, _)| {
        let (error, wall_s) = trial.point()?;
        Some((error, wall_s, trial))
    });
    let accurate = accurate.min_by(|a, b| a.0.total_cmp(&b.0));
    let most = accurate.map(|(error, wall_s, trial)| {
        let method = &trial.method;
        if error <= floor {
            return format!(
                "; the first with no error but rounding{} is {method} in {} s",
                up_to(floor, column),
                short(wall_s)
            );
        }
        format!("; its smallest error, {} {}, is {method}'s in {} s", short(error), unit(column), short(wall_s))
    });
    plain(&format!(
        "{} of {} on the Pareto front: {}{}.",
        counted(on_front.iter().filter(|on_it| **on_it).count(), "point"),
        trials.len(),
        best.join(", "),
        most.unwrap_or_default()
    ))
}

/// What there is to say where the trials are of several problems.
fn of_problems(tried: &[Tried]) -> String {
    let mut problems: Vec<&str> = Vec::new();
    for Tried { problem, .. } in tried {
        if !problems.contains(&problem.as_str()) {
            problems.push(problem);
        }
    }
    let shown: Vec<&str> = problems.iter().take(4).copied().collect();
    let more = if problems.len() > shown.len() { ", …" } else { "" };
    plain(&format!(
        "{} of {}, which do not compete with each other: {}{more}.",
        counted(tried.len(), "point"),
        counted(problems.len(), "problem"),
        shown.join("; ")
    ))
}

/// What is rounding, for a note.
pub fn up_to(floor: f64, column: &str) -> String {
    if floor > 0.0 { format!(" (up to {} {})", short(floor), unit(column)) } else { String::new() }
}

/// Unit of an error; 1 of a ratio.
pub fn unit(column: &str) -> String {
    let unit = unit_of(column);
    if unit.is_empty() { "1".to_string() } else { unit.to_string() }
}

/// `error_orientation_rad`: orientation error.
pub fn in_words(column: &str) -> String {
    const ENDS: [&str; 7] = ["_rad_s", "_m_s", "_rad", "_rel", "_m", "_j", "_s"];
    let name = ENDS.iter().find_map(|end| column.strip_suffix(end)).unwrap_or(column);
    let words = name.strip_prefix("error_").map_or(name.to_string(), |what| format!("{what} error"));
    words.replace('_', " ")
}

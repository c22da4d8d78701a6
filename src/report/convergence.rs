//! Error against step, a line a method, with triangles of the orders that they have.

use super::figure::{Dot, Drawn, Figure, FigureAxis, FigureScale, Mark};
use super::number::{counted, plain, short};
use super::pareto::{IS_AN_ORDER, in_words, unit, up_to};
use super::tried::Tried;
use crate::check::Magnitudes;
use crate::rows::trials::{Trial, methods, order};

/// The figure of trials. None where no method takes steps of several lengths.
pub fn figure(tried: &[Tried], magnitudes: &Magnitudes) -> Option<Figure> {
    let trials: Vec<Trial> = tried.iter().map(|tried| tried.trial.clone()).collect();
    let column = trials.first().map_or("error", |row| row.error_kind.as_str());
    let floor = magnitudes.floor(column);
    let (mut marks, mut orders, mut rows) = (Vec::new(), Vec::new(), 0);
    for (colour, method) in methods(&trials).into_iter().enumerate() {
        let of_method = || tried.iter().filter(|tried| tried.trial.method == method);
        let mut dots: Vec<Dot> = of_method().filter_map(dot).collect();
        dots.sort_by(|a, b| a.x.total_cmp(&b.x));
        if dots.iter().filter(|dot| dot.y > 0.0).count() < 2 {
            continue;
        }
        rows += of_method().map(|tried| tried.rows).sum::<usize>();
        let mut label = plain(method);
        // An error that does not fall with the step is rounding, or of another origin.
        if let Some(order) = order(&trials, method, floor).filter(|order| order.slope > IS_AN_ORDER) {
            label += &format!(", order {:.2}", order.slope);
            let floor = if order.left_out > 0 { format!(" ({} in rounding)", order.left_out) } else { String::new() };
            orders.push((order.slope, format!("{} {:.2}{floor}", plain(method), order.slope)));
        }
        marks.push(Mark { label, drawn: Drawn::Line, colour, dots });
    }
    if marks.is_empty() {
        return None;
    }
    let finding = match orders.len() {
        0 => format!("No method has an order of the {} above its rounding.", in_words(column)),
        n => {
            let most = orders.iter().take(6).map(|(_, said)| said.clone()).collect::<Vec<_>>().join(", ");
            let more = if n > 6 { format!(" and {} more", n - 6) } else { String::new() };
            format!("Orders, as slopes of the {} in the step: {most}{more}.", in_words(column))
        }
    };
    let triangles = triangles(&marks, &orders);
    marks.extend(triangles);
    let mut notes = vec![
        format!("n = {}", counted(rows, "row")),
        format!("order: slope of log error in log step, least squares, rounding left out{}", up_to(floor, column)),
    ];
    if rows > tried.len() {
        notes.push("a point is the median of its runs".to_string());
    }
    Some(Figure {
        name: "convergence".to_string(),
        title: "Error against step".to_string(),
        finding,
        x: FigureAxis { label: "step".to_string(), unit: "s".to_string(), scale: FigureScale::Logarithmic },
        y: FigureAxis { label: in_words(column), unit: unit(column), scale: FigureScale::Logarithmic },
        field: None,
        marks,
        notes,
    })
}

fn dot(tried: &Tried) -> Option<Dot> {
    let (step_s, error) = (tried.trial.step_s?, tried.trial.error?);
    let said = plain(&format!("{} at {} s: error {}", tried.trial.method, short(step_s), short(error)));
    Some(Dot { row: tried.row, ..Dot::at(step_s, error).saying(said) })
}

/// A triangle for every whole order that a method has, below the points.
fn triangles(marks: &[Mark], orders: &[(f64, String)]) -> Vec<Mark> {
    let mut whole: Vec<i32> = Vec::new();
    for (slope, _) in orders {
        let order = slope.round() as i32;
        if (slope - f64::from(order)).abs() < 0.3 && (1..=8).contains(&order) && !whole.contains(&order) {
            whole.push(order);
        }
    }
    whole.sort_unstable();
    whole.truncate(3);
    let triangle = |order: &i32| {
        // Of the lowest line of that order, under its coarse end.
        let near = |mark: &&Mark| {
            let slope = mark.label.rsplit_once("order ").and_then(|(_, slope)| slope.parse::<f64>().ok());
            slope.is_some_and(|slope| (slope - f64::from(*order)).abs() < 0.3)
        };
        let level = |mark: &Mark| mark.dots.last().map_or(f64::INFINITY, |dot| dot.y);
        let by_level = |a: &&Mark, b: &&Mark| level(a).total_cmp(&level(b));
        let place = |mark: &Mark, times: f64| {
            let [.., a, b] = &mark.dots[..] else { return None };
            let (from, to) = (a.x, b.x.min(a.x * 3.0));
            let low = times * if times < 1.0 { a.y.min(b.y) } else { a.y.max(b.y) };
            Some((from, to, low, low * libm::pow(to / from, f64::from(*order))))
        };
        // Below the lowest line of that order, or above the highest one where fewer lines are in the way.
        let below = place(marks.iter().filter(near).min_by(by_level)?, 0.35)?;
        let above = place(marks.iter().filter(near).max_by(by_level)?, 2.2)?;
        let (from, to, low, high) = if in_the_way(marks, above) < in_the_way(marks, below) { above } else { below };
        let dots = vec![Dot::at(from, low), Dot::at(to, low), Dot::at(to, high), Dot::at(from, low)];
        Some(Mark { label: format!("order {order}"), drawn: Drawn::Triangle, colour: 4, dots })
    };
    whole.iter().filter_map(triangle).collect()
}

/// Number of lines that pass a rectangle, with some room around it.
fn in_the_way(marks: &[Mark], (from, to, low, high): (f64, f64, f64, f64)) -> usize {
    const ROOM: f64 = 1.3;
    let passes = |mark: &&Mark| {
        mark.dots.windows(2).any(|pair| {
            let [a, b] = pair else { return false };
            let (first, last) = (a.x.max(from), b.x.min(to));
            if first > last || a.y <= 0.0 || b.y <= 0.0 || a.x >= b.x {
                return false;
            }
            let at = |x: f64| a.y * libm::pow(b.y / a.y, libm::log(x / a.x) / libm::log(b.x / a.x));
            let (y, z) = (at(first), at(last));
            y.min(z) < high * ROOM && y.max(z) > low / ROOM
        })
    };
    marks.iter().filter(passes).count()
}

//! The table of a bench: a method a heading, below it what it did at every step or tolerance, in the width that there
//! is.

use super::output::wrapped;
use crate::check::Magnitudes;
use crate::report::cut;
use crate::rows::trials::{self, Trial, order};

/// Columns of a line: the mark of the front, the step or tolerance, its number of steps, error, times, how it ended.
type Line = [String; 7];

/// What lines of a method begin with.
const MARGIN: &str = "  ";
/// Letters between columns.
const GAP: usize = 2;

/// The rows of a bench, and the best of other engines beside them, in lines of at most so many letters; the front is
/// that of all of them.
pub fn bench_table(rows: &[Trial], beside: &[Trial], most: usize) -> String {
    let column = rows.first().map_or("error", |row| row.error_kind.as_str());
    // Most have finished: a column that is not needed is not there.
    let has_ended_early = rows.iter().any(|row| row.outcome != "finished");
    let of_engine = |row: &Trial| Trial { method: format!("{}: {}", row.engine, row.method), ..row.clone() };
    let all: Vec<Trial> = rows.iter().cloned().chain(beside.iter().map(of_engine)).collect();
    let head = ["", "step_s | tol.", "steps", column, "wall_s", "median_s", "outcome"].map(String::from);
    let on_front = trials::pareto(&all, Magnitudes::default().floor(column));
    let lines: Vec<Line> = all.iter().zip(on_front).map(|(row, on_front)| line(row, on_front)).collect();
    let shown = if has_ended_early { 7 } else { 6 };
    let mut widths: Vec<usize> = (0..shown)
        .map(|i| lines.iter().chain([&head]).map(|line| line[i].chars().count()).max().unwrap_or(0).max(1))
        .collect();
    // What is too long is cut: the name of the error, then how it ended, which may be a whole sentence.
    for (i, least) in [(3, 16), (6, 9), (3, 9)].into_iter().filter(|(i, _)| *i < shown) {
        let taken = MARGIN.len() + widths.iter().sum::<usize>() + GAP * (shown - 1);
        widths[i] = widths[i].saturating_sub(taken.saturating_sub(most)).max(least).min(widths[i]);
    }
    let written = |line: &Line| {
        let cells = widths.iter().enumerate().map(|(i, wide)| match i {
            0 | 1 | 6 => format!("{:<wide$}", cut(&line[i], *wide)),
            _ => format!("{:>wide$}", cut(&line[i], *wide)),
        });
        format!("{MARGIN}{}", cells.collect::<Vec<_>>().join(&" ".repeat(GAP))).trim_end().to_string()
    };
    let mut text = vec![written(&head)];
    let mut methods: Vec<&str> = Vec::new();
    for row in &all {
        if !methods.contains(&row.method.as_str()) {
            methods.push(&row.method);
        }
    }
    for method in methods {
        let order = order_said(rows, method).map_or(String::new(), |order| format!(": {order}"));
        // A name without a space is cut.
        let said = wrapped(&format!("{method}{order}"), most, "", "    ");
        text.extend(said.lines().map(|line| cut(line, most)));
        text.extend(all.iter().zip(&lines).filter(|(row, _)| row.method == method).map(|(_, line)| written(line)));
    }
    text.join("\n")
}

fn line(row: &Trial, on_front: bool) -> Line {
    let number = |x: Option<f64>| x.map_or("-".to_string(), |x| format!("{x:.2e}"));
    let outcome = match &row.criterion {
        Some(criterion) => format!("{} ({criterion})", row.outcome),
        None => row.outcome.clone(),
    };
    let accuracy = match (row.step_s, row.tolerance) {
        (_, Some(tolerance)) => format!("tol. {tolerance:e}"),
        (Some(step_s), None) => format!("{step_s:e}"),
        (None, None) => "closed form".to_string(),
    };
    let mark = if on_front { "◆" } else { "" }.to_string();
    [mark, accuracy, row.steps.to_string(), number(row.error), number(row.wall_s), number(row.wall_median_s), outcome]
}

/// Order of a method, and the slopes that it is of.
fn order_said(rows: &[Trial], method: &str) -> Option<String> {
    let order = order(rows, method, Magnitudes::default().floor(&rows.first()?.error_kind))?;
    let pairwise: Vec<String> = order.pairwise.iter().map(|slope| format!("{slope:.2}")).collect();
    let own_steps = rows.iter().any(|row| row.method == method && row.step_s.is_none());
    let against = if own_steps { " in its own mean step" } else { "" };
    let floor = match order.left_out {
        0 => String::new(),
        n => format!("; {n} in the rounding floor left out"),
    };
    Some(format!("order {:.2}{against} ({}{floor})", order.slope, pairwise.join(", ")))
}

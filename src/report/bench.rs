//! The diagram of `bench.json`: run time over error, a line a method, the Pareto front behind them.

use super::diagram::{Diagram, Series};
use crate::rows::trials::{Trial, methods, order, pareto};

/// Diagram of all rows of a scene.
pub fn diagram(title: &str, rows: &[Trial]) -> Diagram {
    let column = rows.first().map_or("error", |row| row.error_kind.as_str());
    let mut front: Vec<(f64, f64)> =
        rows.iter().zip(pareto(rows)).filter(|(_, on_it)| *on_it).filter_map(|(row, _)| row.point()).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0));
    Diagram {
        title: title.to_string(),
        x_label: in_words(column),
        y_label: "run time, best [s]".to_string(),
        series: methods(rows).into_iter().map(|method| series(rows, method)).collect(),
        band: Some(Series { label: "Pareto front".to_string(), points: front }),
    }
}

fn series(rows: &[Trial], method: &str) -> Series {
    let of_method: Vec<&Trial> = rows.iter().filter(|row| row.method == method).collect();
    let points: Vec<(f64, f64)> = of_method.iter().filter_map(|row| row.point()).collect();
    let mut label = method.to_string();
    // Of another engine's best rows, which are of several methods, there is none.
    let is_one = of_method.iter().all(|row| row.engine != row.method);
    if let Some(order) = order(rows, method).filter(|_| is_one) {
        label += &format!(", order {:.2}", order.slope);
    }
    // What a logarithm cannot show is said in words.
    let exact = points.iter().filter(|(error, _)| *error == 0.0).count();
    for (n, what) in [(exact, "error 0"), (of_method.len() - points.len(), "without an end")] {
        if n > 0 {
            label += &format!(", {what}: {n}");
        }
    }
    Series { label, points }
}

/// `error_orientation_rad`: orientation error [rad].
fn in_words(column: &str) -> String {
    const UNITS: [(&str, &str); 7] =
        [("_rad_s", "rad/s"), ("_m_s", "m/s"), ("_rad", "rad"), ("_rel", "1"), ("_m", "m"), ("_j", "J"), ("_s", "s")];
    let with_unit = UNITS.iter().find_map(|(end, unit)| Some((column.strip_suffix(end)?, *unit)));
    let (name, unit) = with_unit.unwrap_or((column, "1"));
    let words = match name.strip_prefix("error_") {
        Some(what) => format!("{what} error"),
        None => name.to_string(),
    };
    format!("{} [{unit}]", words.replace('_', " "))
}

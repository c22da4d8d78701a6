//! Reports: figures that four drawings agree on, the statistics in them, pages that hold what they should and no more.

mod browser;
mod command;
mod drawings;
mod figures;
mod webdriver;

use gotai::report::frame::RowFrame;
use gotai::report::subject::Subject;
use gotai::rows::plan_file::PlanAxis;
use serde_json::{Map, Value, json};

/// Rows over two axes and seeds: the longer the step and the larger `n`, the more of them diverge.
pub fn subject() -> Subject {
    let (steps, ns) = ([1e-3, 1e-2, 1e-1], ["cube 8", "cube 27", "cube 64", "cube 125"]);
    let mut rows = Vec::new();
    for (i, n) in ns.iter().enumerate() {
        for (j, step_s) in steps.iter().enumerate() {
            for seed in 0..10usize {
                let diverges = seed < (i * j * 2).min(10);
                let outcome = if diverges { "diverged" } else { "finished" };
                let size = (i + 1) as f64 * step_s * (1.0 + seed as f64);
                rows.push(row(json!({
                    "case": format!("{:016x}", rows.len()), "scene.n": n, "time.step_s": step_s, "seed": seed, "outcome": outcome,
                    "criterion": if diverges { json!("energy") } else { Value::Null }, "steps": 1.0 / step_s,
                    "step_used_s": step_s, "energy_drift_rel": size, "energy_rise_max_rel": size, "residual_max": 1e-12,
                    "error_position_m": size * size, "work_sweeps": 50.0 / step_s, "wall_s": 1e-3 / step_s,
                    "recording": Value::Null, "build": "b",
                })));
            }
        }
    }
    of_rows(
        rows,
        vec![
            axis("scene.n", json!(ns)),
            axis("time.step_s", json!(steps)),
            axis("seed", json!((0..10).collect::<Vec<_>>())),
        ],
    )
}

pub fn row(cells: Value) -> Map<String, Value> {
    cells.as_object().unwrap().clone()
}

pub fn axis(path: &str, values: Value) -> PlanAxis {
    PlanAxis { path: path.to_string(), values: values.as_array().unwrap().clone() }
}

pub fn of_rows(rows: Vec<Map<String, Value>>, axes: Vec<PlanAxis>) -> Subject {
    let planned = rows.len();
    let frame = RowFrame::of_rows(Vec::new(), rows.into_iter());
    Subject {
        name: "test".to_string(),
        frame,
        axes,
        planned,
        methods: vec!["lecture".to_string()],
        ..Subject::default()
    }
}

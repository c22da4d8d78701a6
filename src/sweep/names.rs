//! Names of recordings from the values on the axes.

use crate::experiment::axes::AxisValue;
use crate::experiment::{ExperimentFile, Value, error};

/// Values that tell a case from others: those of axes with more than one, in plan order. Where there are none:
/// `config`.
pub(super) fn values(file: &ExperimentFile, point: &[usize], config: &str) -> Vec<String> {
    // The values of this axis are tried together.
    let over = file.search().and_then(|search| search.over);
    let axes = &file.axes().axes;
    let telling = (0..point.len()).filter(|i| Some(*i) != over && axes[*i].values.len() > 1);
    let values: Vec<_> = telling.map(|i| word(&axes[i].values[point[i]], point[i])).collect();
    if values.is_empty() { vec![config.to_string()] } else { values }
}

fn word(value: &AxisValue, index: usize) -> String {
    match (&value.label, &value.value) {
        (Some(label), _) => label.clone(),
        (None, Value::String(word)) => word.clone(),
        (None, Value::Bool(flag)) => flag.to_string(),
        (None, Value::Number(number)) if number.is_f64() => error::number(number.as_f64().unwrap_or(f64::NAN)),
        (None, Value::Number(number)) => number.to_string(),
        (None, _) => format!("v{index}"),
    }
}

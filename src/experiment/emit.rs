//! YAML text of a tree, whose numbers and texts every reader takes for what they are.
//!
//! serde_yaml writes 10⁻⁵ as `1e-5`, which is a text to readers of YAML 1.1 (PyYAML), and texts like `1:30` bare, which
//! are numbers to them. It cannot be told otherwise: such a scalar is written behind a mark that the text does not
//! have, and the mark is taken out again.

use super::tree::{Number, Value};
use super::types::Experiment;

/// YAML of an experiment as the user would write it; read again, it is the same experiment, bit for bit.
pub fn to_yaml(experiment: &Experiment) -> String {
    let tree = serde_yaml::with::singleton_map_recursive::serialize(experiment, serde_yaml::value::Serializer);
    // Plain data always is a tree.
    emit(&tree.unwrap_or_default())
}

/// YAML text of a tree.
pub fn emit(tree: &Value) -> String {
    let text = written(tree);
    // It has its first letter once, and a scalar begins a line or follows a space: nothing else ends up as a mark.
    let mut marks = (0_u32..).map(|n| format!("scalar{n}q"));
    let mark = marks.find(|mark| !text.contains(mark.as_str())).unwrap_or_default();
    let mut marked = tree.clone();
    mark_scalars(&mut marked, &mark);
    written(&marked).replace(&mark, "")
}

/// Writing plain data into memory cannot fail.
fn written(tree: &Value) -> String {
    serde_yaml::to_string(tree).unwrap_or_default()
}

fn mark_scalars(tree: &mut Value, mark: &str) {
    match tree {
        Value::Mapping(mapping) => mapping.values_mut().for_each(|value| mark_scalars(value, mark)),
        Value::Sequence(items) => items.iter_mut().for_each(|item| mark_scalars(item, mark)),
        Value::Number(number) => {
            if let Some(text) = with_exponent(number) {
                *tree = Value::String(format!("{mark}{text}"));
            }
        }
        Value::String(text) if is_more_than_text(text) => *text = format!("{mark}'{text}'"),
        Value::String(_) | Value::Bool(_) | Value::Null | Value::Tagged(_) => {}
    }
}

/// Text of a number with a dot and a signed exponent: 1.0e-5, 1.0e+16.
fn with_exponent(number: &Number) -> Option<String> {
    let text = number.to_string();
    let (digits, exponent) = text.split_once('e')?;
    let fraction = if digits.contains('.') { "" } else { ".0" };
    let sign = if exponent.starts_with('-') { "" } else { "+" };
    Some(format!("{digits}{fraction}e{sign}{exponent}"))
}

/// Whether some reader takes the bare text for a number, a date or a truth value; rather too many than too few.
fn is_more_than_text(text: &str) -> bool {
    let is_of_numbers = |c: char| c.is_ascii_hexdigit() || "_:.+-xoTZ ".contains(c);
    let digits = text.trim_start_matches(['+', '-', '.']);
    let begins = digits.len() + 2 >= text.len() && digits.starts_with(|c: char| c.is_ascii_digit());
    let is_number = begins && !text.contains("..") && text.chars().all(is_of_numbers);
    is_number || ["y", "n", "yes", "no", "on", "off"].iter().any(|word| text.eq_ignore_ascii_case(word))
}

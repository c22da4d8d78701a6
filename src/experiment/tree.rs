//! The tree of values that a file is, and what a value of it is in a row.
//!
//! It is a tree of YAML, while rows are JSON: a tag, an infinity and a key that is no text are refused by the type that
//! meets them, which says what it expects there, and JSON could not hold them until then. Everybody else takes the tree
//! from here and need not know which library it is of.

use serde_json::Value as Cell;
pub use serde_yaml::{Mapping, Number, Value};

/// The value as columns show it: numbers, booleans and null stay what they are, all else is text.
pub(super) fn cell(value: &Value) -> Cell {
    match value {
        Value::Number(_) | Value::Bool(_) | Value::Null => serde_json::to_value(value).unwrap_or_default(),
        other => Cell::String(shown(other)),
    }
}

/// Text of the value: the text itself, a number as it is written, compact JSON of all else.
pub(super) fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => number.to_string(),
        other => compact_json(other),
    }
}

/// JSON of the value on one line; that of a tree with a key that JSON does not know, whose case is refused, is null.
pub(super) fn compact_json(value: &Value) -> String {
    serde_json::to_string(value).unwrap_or_else(|_| "null".to_string())
}

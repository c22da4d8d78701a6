//! Reader of a file, whose text becomes a tree of YAML values.

use super::error::{ExperimentError, Kind, describe};
use super::key_path::KeyPath;
use super::positions::{self, Duplicate, Position};
use super::tree::Value;
use std::io::ErrorKind;
use std::path::Path;

type Result<T> = std::result::Result<T, ExperimentError>;

/// Text of the whole file.
///
/// # Errors
/// The file is none or is not UTF-8, or the machine failed; the kind of the error tells which.
pub fn read(path: &Path) -> Result<String> {
    let bytes = std::fs::read(path).map_err(|error| {
        let kind = match error.kind() {
            ErrorKind::NotFound | ErrorKind::NotADirectory | ErrorKind::IsADirectory => Kind::File,
            ErrorKind::InvalidInput | ErrorKind::InvalidFilename => Kind::File,
            _ => Kind::Unreadable,
        };
        let message = match error.kind() {
            ErrorKind::IsADirectory => "expected an experiment file, found a folder".to_string(),
            _ => format!("cannot read the file: {error}"),
        };
        ExperimentError::new(kind, KeyPath::default(), message)
    })?;
    String::from_utf8(bytes).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let mut fault = ExperimentError::new(Kind::File, KeyPath::default(), "this line is not UTF-8 text");
        fault.details_mut().line = Some(valid.iter().filter(|byte| **byte == b'\n').count() + 1);
        fault
    })
}

/// The one mapping of a text, with merged keys (`<<`) in place.
///
/// # Errors
/// The text is not valid YAML, or no mapping.
pub fn parse(text: &str) -> Result<Value> {
    let mut tree: Value = serde_yaml::from_str(text).map_err(|error| syntax_error(&error, text))?;
    // Once for every merge within a merged mapping.
    while has_merge(&tree) {
        tree.apply_merge().map_err(|error| syntax_error(&error, text))?;
    }
    match tree {
        Value::Mapping(_) => Ok(tree),
        Value::Null => {
            let message = "the file is empty: expected an experiment (scene, method, time, …)";
            Err(ExperimentError::new(Kind::File, KeyPath::default(), message))
        }
        other => Err(ExperimentError::unexpected(
            KeyPath::default(),
            "an experiment (a mapping with the keys scene, method, time, …)",
            &describe(&other),
        )),
    }
}

/// The value that a flag gives.
///
/// # Errors
/// The text is not valid YAML. The error has no place yet.
pub fn parse_value(text: &str) -> Result<Value> {
    serde_yaml::from_str(text).map_err(|error| {
        let message = format!("the value is not valid YAML: {error}");
        ExperimentError::new(Kind::Syntax, KeyPath::default(), message)
    })
}

fn has_merge(tree: &Value) -> bool {
    match tree {
        Value::Mapping(mapping) => mapping.contains_key("<<") || mapping.values().any(has_merge),
        Value::Sequence(items) => items.iter().any(has_merge),
        _ => false,
    }
}

/// serde_yaml refuses a key that is there twice, but does not say where.
fn syntax_error(error: &serde_yaml::Error, text: &str) -> ExperimentError {
    let message = error.to_string();
    let duplicate = positions::duplicate(text).filter(|_| message.contains("duplicate entry"));
    if let Some(Duplicate { path, first, second }) = duplicate {
        let message = format!("this key is already there, on line {}", first.line);
        let mut error = ExperimentError::new(Kind::DuplicateKey, path, message);
        error.details_mut().line = Some(second.line);
        error.details_mut().column = Some(second.column);
        return error;
    }
    let mut fault = ExperimentError::new(Kind::Syntax, KeyPath::default(), format!("not valid YAML: {message}"));
    let location = error.location().map(|at| Position { line: at.line(), column: at.column() });
    if let Some(position) = location.or_else(|| positions::second_document(text)) {
        fault.details_mut().line = Some(position.line);
        fault.details_mut().column = Some(position.column);
    }
    fault
}

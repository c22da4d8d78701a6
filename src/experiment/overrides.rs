//! Assignment of a value to a key path, for `--set` and for axes alike.

use super::error::{ExperimentError, Kind, describe, shortened};
use super::key_path::{KeyPath, Path, Segment, is_addressable};
use super::nearest::nearest;
use super::source::parse_value;
use super::tree::{Mapping, Value};
use super::value_de::item_name;

type Result<T> = std::result::Result<T, ExperimentError>;

/// The `PATH=VALUE` of a flag.
#[derive(Clone, Debug)]
pub struct Override {
    pub path: Vec<String>,
    pub value: Value,
}

impl Override {
    /// Path and value of a flag's text.
    ///
    /// # Errors
    /// The text has no `=`, its value is no YAML, or its path is none.
    pub fn parse(text: &str) -> Result<Override> {
        let Some((path, value)) = text.split_once('=') else {
            return Err(ExperimentError::unexpected(KeyPath::default(), "PATH=VALUE", &format!("`{text}`")));
        };
        let value = parse_value(value).map_err(|error| error.at(KeyPath::of_keys(&[path.trim()])))?;
        Ok(Override { path: split(path.trim())?, value })
    }
}

/// Most segments of a path: deeper than any key of the vocabulary. A tree of unlimited depth would overflow the stack.
const DEEPEST: usize = 64;

/// Segments of a dotted path.
///
/// # Errors
/// The path has an empty segment, or too many of them.
pub fn split(path: &str) -> Result<Vec<String>> {
    let segments: Vec<String> = path.split('.').map(str::to_string).collect();
    if segments.len() > DEEPEST || segments.iter().any(String::is_empty) {
        let found = if path.is_empty() { "an empty path".to_string() } else { format!("`{}`", shortened(path)) };
        let expected = "a path such as scene.bodies.cube.mass_kg";
        return Err(ExperimentError::unexpected(KeyPath::default(), expected, &found));
    }
    Ok(segments)
}

/// Puts `value` at `path`, creating mappings on the way. Returns the topmost thing that is new or replaced: whatever is
/// wrong below it came with the value.
///
/// # Errors
/// An item that a list does not have; a path through a number or through a word other than the one written.
pub fn assign(tree: &mut Value, path: &[String], value: Value) -> Result<KeyPath> {
    let mut node = tree;
    let mut at = KeyPath::default();
    let mut new_from = None;
    for segment in path {
        node = step(node, segment, &mut at, &mut new_from)?;
    }
    *node = value;
    at.truncate(new_from.unwrap_or(at.len()));
    Ok(at)
}

fn step<'v>(node: &'v mut Value, key: &str, at: &mut KeyPath, new_from: &mut Option<usize>) -> Result<&'v mut Value> {
    let needs_mapping = match node {
        Value::Null => true,
        Value::String(word) => word == key,
        _ => false,
    };
    if needs_mapping {
        let was_word = node.is_string();
        *node = Value::Mapping(Mapping::new());
        new_from.get_or_insert(at.len() + usize::from(was_word));
    }
    match node {
        Value::Mapping(mapping) => {
            at.push(Segment::Key(key.to_string()));
            if !mapping.contains_key(key) {
                new_from.get_or_insert(at.len());
            }
            Ok(mapping.entry(Value::from(key)).or_insert(Value::Null))
        }
        Value::Sequence(items) => {
            let Some(index) = find_item(items, key) else {
                return Err(no_such_item(items, key, at));
            };
            at.push(item_segment(&items[index], index));
            Ok(&mut items[index])
        }
        other => Err(dead_end(other, key, at)),
    }
}

/// Index of an item, by name, else by index from 0.
fn find_item(items: &[Value], key: &str) -> Option<usize> {
    let by_name = items.iter().position(|item| item_name(item) == Some(key));
    by_name.or_else(|| key.parse().ok().filter(|index| *index < items.len()))
}

pub(super) fn item_segment(item: &Value, index: usize) -> Segment {
    let name = item_name(item).filter(|name| is_addressable(name)).map(str::to_string);
    Segment::Item { index, name }
}

fn no_such_item(items: &[Value], key: &str, at: &KeyPath) -> ExperimentError {
    let names: Vec<&str> = items.iter().filter_map(item_name).collect();
    let path = Path::Base(at).key(key).to_key_path();
    let near = nearest(key, &names);
    let known = match (names.as_slice(), items.len()) {
        ([], 0) => "the list is empty".to_string(),
        ([], len) => format!("items 0 to {}", len - 1),
        (names, _) => format!("known here: {}", names.join(", ")),
    };
    let hint = near.map(|near| format!("; did you mean `{near}`?")).unwrap_or_default();
    let mut error = ExperimentError::new(Kind::Path, path, format!("no such item{hint} ({known})"));
    let details = error.details_mut();
    details.expected = Some("an item's name or index".to_string());
    details.found = Some(format!("`{key}`"));
    details.known = names.iter().map(|name| name.to_string()).collect();
    details.nearest = near.map(str::to_string);
    error
}

fn dead_end(node: &Value, key: &str, at: &KeyPath) -> ExperimentError {
    let found = match node {
        Value::String(word) => format!("`{word}`"),
        other => describe(other),
    };
    let message = format!("`{at}` is {found}: there is no `{key}` in it");
    let mut error = ExperimentError::new(Kind::Path, Path::Base(at).key(key).to_key_path(), message);
    error.details_mut().found = Some(found);
    error
}

/// Place where a path leads, with list items by index, so that two ways to write one place compare equal. The rest of a
/// path that the tree does not have (yet) is taken for keys.
pub fn resolve(tree: &Value, path: &[String]) -> KeyPath {
    let mut resolved = KeyPath::default();
    let mut node = Some(tree);
    for key in path {
        let item = node.and_then(Value::as_sequence).and_then(|items| Some((items, find_item(items, key)?)));
        if let Some((items, index)) = item {
            resolved.push(item_segment(&items[index], index));
            node = items.get(index);
        } else {
            resolved.push(Segment::Key(key.clone()));
            node = node.and_then(|value| value.get(key.as_str()));
        }
    }
    resolved
}

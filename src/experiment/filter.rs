//! The vocabulary of `where`: rows that are chosen by their axes and columns.

use super::checks::Result;
use super::error::{ExperimentError, describe};
use super::key_path::{KeyPath, Path};
use super::predicate::Bounds;
use super::tree::{Mapping, Value, cell};
use super::value_de::from_value;
use serde_json::Value as Cell;
use std::fmt;

/// Conditions that must all hold; without any, every row is taken.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filter(pub Vec<(String, Condition)>);

/// Condition on the value of one axis or column.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// Values of which it is one; numbers match within 1e-9 relative.
    Is(Vec<Cell>),
    IsNot(Cell),
    Bounds(Bounds),
}

/// Longer ones first.
const SIGNS: [&str; 10] = ["<=", ">=", "!=", "==", "≤", "≥", "≠", "<", ">", "="];

/// Relative difference up to which numbers of a file and of a row are the same: 5e-3 and 0.005 written as a quotient.
const SAME: f64 = 1e-9;

impl Filter {
    /// The filter that a mapping says, or a list of mappings and of texts like `"time.step_s <= 0.01"`.
    ///
    /// # Errors
    /// A condition that is none, with its place.
    pub fn read(written: Option<&Value>, at: Path) -> Result<Filter> {
        let mut filter = Filter::default();
        match written {
            None => {}
            Some(Value::Sequence(items)) => {
                for (i, item) in items.iter().enumerate() {
                    filter.add(item, at.item(i, None))?;
                }
            }
            Some(item) => filter.add(item, at)?,
        }
        Ok(filter)
    }

    /// The filter of texts like `time.step_s <= 0.01`.
    ///
    /// # Errors
    /// A text that is no condition.
    pub fn of_texts(texts: &[String]) -> Result<Filter> {
        let base = KeyPath::of_keys(&["where"]);
        let mut filter = Filter::default();
        texts.iter().try_for_each(|text| filter.add(&Value::String(text.clone()), Path::Base(&base)))?;
        Ok(filter)
    }

    fn add(&mut self, item: &Value, at: Path) -> Result<()> {
        match item {
            Value::Mapping(entries) => {
                for (key, value) in entries {
                    let key = key.as_str().ok_or_else(|| {
                        ExperimentError::unexpected(at.to_key_path(), "an axis or a column", &describe(key))
                    })?;
                    self.0.push((key.to_string(), Condition::read(value, at.key(key))?));
                }
                Ok(())
            }
            Value::String(text) if SIGNS.iter().any(|sign| text.contains(sign)) => {
                let from = SIGNS.iter().filter_map(|sign| text.find(sign)).min().unwrap_or_default();
                let (key, condition) = text.split_at(from);
                self.0.push((key.trim().to_string(), Condition::read_text(condition, at)?));
                Ok(())
            }
            other => {
                let expected = "axes or columns with their values, or \"axis <= value\"";
                Err(ExperimentError::unexpected(at.to_key_path(), expected, &describe(other)))
            }
        }
    }

    /// Whether a row is taken; `cell` gives its value by the name of a column.
    pub fn takes<'a>(&self, cell: impl Fn(&str) -> Option<&'a Cell>) -> bool {
        self.0.iter().all(|(key, condition)| cell(key).is_some_and(|cell| condition.holds(cell)))
    }
}

impl Condition {
    fn read(value: &Value, at: Path) -> Result<Condition> {
        match value {
            Value::String(text) => Self::read_text(text, at),
            Value::Sequence(items) if items.is_empty() => {
                Err(ExperimentError::unexpected(at.to_key_path(), "a value, or a list of them", "an empty list"))
            }
            Value::Sequence(items) => Ok(Condition::Is(items.iter().map(cell).collect())),
            Value::Mapping(mapping) if is_bounds(mapping) => {
                let bounds: Bounds = from_value(value, &at.to_key_path())?;
                bounds.check(at)?;
                Ok(Condition::Bounds(bounds))
            }
            other => Ok(Condition::Is(vec![cell(other)])),
        }
    }

    /// `"<= 0.01"`, `"> 3"`, `"!= cube"`, or the text itself.
    fn read_text(text: &str, at: Path) -> Result<Condition> {
        let Some((sign, rest)) = SIGNS.iter().find_map(|sign| Some((*sign, text.trim().strip_prefix(sign)?.trim())))
        else {
            return Ok(Condition::Is(vec![Cell::from(text)]));
        };
        let x = rest.parse::<f64>().ok().filter(|x| x.is_finite());
        let value = || x.map_or_else(|| Cell::from(rest), Cell::from);
        match sign {
            "!=" | "≠" => return Ok(Condition::IsNot(value())),
            "==" | "=" => return Ok(Condition::Is(vec![value()])),
            _ => {}
        }
        let Some(x) = x else {
            let found = format!("`{text}`");
            return Err(ExperimentError::unexpected(at.to_key_path(), "a number after the sign", &found));
        };
        let none = Bounds::default();
        Ok(Condition::Bounds(match sign {
            "<=" | "≤" => Bounds { max: Some(x), ..none },
            ">=" | "≥" => Bounds { min: Some(x), ..none },
            "<" => Bounds { below: Some(x), ..none },
            _ => Bounds { above: Some(x), ..none },
        }))
    }

    pub fn holds(&self, cell: &Cell) -> bool {
        match self {
            Condition::Is(values) => values.iter().any(|value| is_same(value, cell)),
            Condition::IsNot(value) => !is_same(value, cell),
            Condition::Bounds(bounds) => cell.as_f64().is_some_and(|x| bounds.contain(x)),
        }
    }
}

impl fmt::Display for Filter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown = |(key, condition): &(String, Condition)| match condition {
            Condition::Is(values) => {
                let values: Vec<_> = values.iter().map(shown_cell).collect();
                format!("{key} = {}", values.join(" or "))
            }
            Condition::IsNot(value) => format!("{key} ≠ {}", shown_cell(value)),
            Condition::Bounds(bounds) => format!("{key} {bounds}"),
        };
        f.write_str(&self.0.iter().map(shown).collect::<Vec<_>>().join(", "))
    }
}

pub fn is_same(a: &Cell, b: &Cell) -> bool {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => a == b || (a - b).abs() <= SAME * a.abs().max(b.abs()),
        // A label may look like a number.
        _ => shown_cell(a) == shown_cell(b),
    }
}

pub fn shown_cell(cell: &Cell) -> String {
    cell.as_str().map_or_else(|| cell.to_string(), str::to_string)
}

fn is_bounds(mapping: &Mapping) -> bool {
    mapping.keys().any(|key| key.as_str().is_some_and(|key| ["min", "max", "above", "below", "within"].contains(&key)))
}

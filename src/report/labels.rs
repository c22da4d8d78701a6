//! Short names of the values on an axis: what tells them apart, where all of it is too long for a figure.

use super::number::{cut, plain, shown};
use serde_json::Value;
use std::collections::HashSet;

/// Most letters of a name in a figure.
pub const MOST: usize = 24;
/// Most letters of a number in a figure, where fewer digits tell it apart.
const DIGITS: usize = 6;
/// Numbers that are pooled wherever they are names.
const MANY: usize = 200;
/// Most letters of what all names have in common, in a note.
const COMMON: usize = 120;

/// Names as a figure has them, each once, and what was left out of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    pub labels: Vec<String>,
    /// What a note says of them; None where they are the names.
    pub note: Option<String>,
}

impl Labels {
    /// Numbers in as few digits as tell them apart.
    pub fn of_numbers(numbers: &[f64], names: &[String]) -> Self {
        if names.iter().all(|name| name.chars().count() <= DIGITS) {
            return Labels { labels: names.to_vec(), note: None };
        }
        let rounded = |digits: usize| -> Vec<String> {
            numbers.iter().map(|x| shown(format!("{x:.digits$e}").parse().unwrap_or(*x))).collect()
        };
        if numbers.len() > MANY {
            return Labels { labels: rounded(2), note: Some("rounded to 3 digits".to_string()) };
        }
        let is_distinct = |labels: &Vec<String>| labels.iter().collect::<HashSet<_>>().len() == labels.len();
        match (2..16).map(|digits| (digits + 1, rounded(digits))).find(|(_, labels)| is_distinct(labels)) {
            Some((digits, labels)) => Labels { labels, note: Some(format!("rounded to {digits} digits")) },
            None => Labels { labels: names.to_vec(), note: None },
        }
    }

    /// Words; of values that are maps, or texts of many words, what they do not have in common.
    pub fn of_words(names: &[String]) -> Self {
        let is_short = |name: &String| name.chars().count() <= MOST;
        if names.iter().all(is_short) {
            return Labels { labels: names.to_vec(), note: None };
        }
        let parts: Vec<Vec<String>> = names.iter().map(|name| parts(name)).collect();
        let (common, own): (Vec<String>, Vec<Vec<String>>) = match &parts[..] {
            [first, _, ..] => {
                let is_common = |part: &String| parts.iter().all(|parts| parts.contains(part));
                let own = parts.iter().map(|parts| parts.iter().filter(|part| !is_common(part)).cloned().collect());
                (first.iter().filter(|part| is_common(part)).cloned().collect(), own.collect())
            }
            _ => (Vec::new(), parts),
        };
        // What has nothing of its own is the common part alone.
        let label = |own: Vec<String>| if own.is_empty() { "the common part".to_string() } else { own.join(" ") };
        let mut labels: Vec<String> = own.into_iter().map(label).map(|label| cut(&label, MOST)).collect();
        let mut seen = HashSet::new();
        let is_distinct = labels.iter().all(|label| seen.insert(label.clone()));
        if !is_distinct {
            for (i, label) in labels.iter_mut().enumerate() {
                *label = cut(&format!("{}: {label}", i + 1), MOST);
            }
        }
        let note = match common.is_empty() {
            true => "cut; the table of rows has them in full".to_string(),
            false => format!("without what all have in common: {}", cut(&common.join(" "), COMMON)),
        };
        Labels { labels, note: Some(note) }
    }
}

/// Parts of a name: the words of a text, the leaves of a map.
fn parts(name: &str) -> Vec<String> {
    let mut all = Vec::new();
    match serde_json::from_str(name) {
        Ok(value @ (Value::Object(_) | Value::Array(_))) => leaves(&mut all, "", &value),
        _ => all.extend(name.split_whitespace().map(str::to_string)),
    }
    all.iter().map(|part| plain(part)).collect()
}

/// `key=value` of every leaf of a map, and the keys of the maps in it.
fn leaves(all: &mut Vec<String>, key: &str, value: &Value) {
    match value {
        Value::Object(map) => {
            if !key.is_empty() {
                all.push(key.to_string());
            }
            map.iter().for_each(|(key, value)| leaves(all, key, value));
        }
        Value::String(text) if key.is_empty() => all.push(text.clone()),
        Value::String(text) => all.push(format!("{key}={text}")),
        other if key.is_empty() => all.push(other.to_string()),
        other => all.push(format!("{key}={other}")),
    }
}

//! Place of a value in the experiment: `scene.bodies.cube.mass_kg`.

use serde::{Serialize, Serializer};
use std::fmt;

/// One step down into the tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Segment {
    /// A key of a mapping.
    Key(String),
    /// An item of a list; shown by its `name` when it has one that can be written in a path.
    Item { index: usize, name: Option<String> },
}

impl Segment {
    /// Same place, whatever the items are called.
    fn same(&self, other: &Segment) -> bool {
        match (self, other) {
            (Segment::Key(a), Segment::Key(b)) => a == b,
            (Segment::Item { index: a, .. }, Segment::Item { index: b, .. }) => a == b,
            _ => false,
        }
    }

    /// The text the source positions know this segment by: lists count, because names may repeat.
    fn lookup(&self) -> String {
        match self {
            Segment::Key(key) => key.clone(),
            Segment::Item { index, .. } => index.to_string(),
        }
    }
}

impl fmt::Display for Segment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Segment::Key(key) => f.write_str(key),
            Segment::Item { name: Some(name), .. } => f.write_str(name),
            Segment::Item { index, .. } => write!(f, "{index}"),
        }
    }
}

/// Path from the root of the experiment down to a value that need not exist. It is shown with dots; empty for the whole
/// file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct KeyPath(Vec<Segment>);

impl KeyPath {
    /// A path of mapping keys alone.
    pub fn of_keys(keys: &[&str]) -> Self {
        KeyPath(keys.iter().map(|key| Segment::Key(key.to_string())).collect())
    }

    pub fn push(&mut self, segment: Segment) {
        self.0.push(segment);
    }

    pub fn truncate(&mut self, len: usize) {
        self.0.truncate(len);
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Rest of this path below one that is `above` segments long.
    pub fn below(&self, above: usize) -> KeyPath {
        KeyPath(self.0.iter().skip(above).cloned().collect())
    }

    /// Path of this one, then the other.
    pub fn join(mut self, below: KeyPath) -> Self {
        self.0.extend(below.0);
        self
    }

    /// Whether this path leads through the other, or is it. Items are compared by their index.
    pub fn starts_with(&self, above: &KeyPath) -> bool {
        above.len() <= self.len() && above.0.iter().zip(&self.0).all(|(a, b)| a.same(b))
    }

    /// Whether both are the same place; items are compared by their index.
    pub fn is_same(&self, other: &KeyPath) -> bool {
        self.len() == other.len() && self.starts_with(other)
    }

    /// Segments as the source positions know them.
    pub fn lookup(&self) -> Vec<String> {
        self.0.iter().map(Segment::lookup).collect()
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, segment) in self.0.iter().enumerate() {
            if i > 0 {
                f.write_str(".")?;
            }
            write!(f, "{segment}")?;
        }
        Ok(())
    }
}

impl Serialize for KeyPath {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// A `KeyPath` on the stack: costs nothing until an error asks for it, so that twenty thousand cases resolve quickly.
#[derive(Clone, Copy)]
pub enum Path<'a> {
    Base(&'a KeyPath),
    Key { parent: &'a Path<'a>, key: &'a str },
    Item { parent: &'a Path<'a>, index: usize, name: Option<&'a str> },
}

impl<'a> Path<'a> {
    pub fn key(&'a self, key: &'a str) -> Path<'a> {
        Path::Key { parent: self, key }
    }

    pub fn item(&'a self, index: usize, name: Option<&'a str>) -> Path<'a> {
        Path::Item { parent: self, index, name: name.filter(|name| is_addressable(name)) }
    }

    pub fn to_key_path(self) -> KeyPath {
        match self {
            Path::Base(base) => base.clone(),
            Path::Key { parent, key } => with(parent.to_key_path(), Segment::Key(key.to_string())),
            Path::Item { parent, index, name } => {
                with(parent.to_key_path(), Segment::Item { index, name: name.map(str::to_string) })
            }
        }
    }
}

fn with(mut path: KeyPath, segment: Segment) -> KeyPath {
    path.push(segment);
    path
}

/// Whether an item of this name can be named in a path.
pub fn is_addressable(name: &str) -> bool {
    !name.is_empty() && !name.contains(|c: char| c == '.' || c.is_control())
}

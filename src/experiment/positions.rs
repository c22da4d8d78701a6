//! Lines on which key paths stand.
//!
//! serde_yaml's values do not know, but its errors do: so the text is read once more, by a reader that fails when it is
//! there. Slow beside a map of positions, but wanted for one error only; and it cannot disagree with the parser of the
//! values, as a second parser does (about a closing brace at the start of a line, for one).

use super::key_path::KeyPath;
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, Error, IgnoredAny, MapAccess, SeqAccess, VariantAccess, Visitor,
};
use std::collections::HashSet;
use std::fmt;

/// Line and column in a text, both from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    pub line: usize,
    pub column: usize,
}

/// A key that a mapping has twice.
#[derive(Clone, Debug, PartialEq)]
pub struct Duplicate {
    pub path: KeyPath,
    pub first: Position,
    pub second: Position,
}

/// Position of the path's key or list item, or of its nearest ancestor in the text: a default, or what a merged key
/// brought, has no place of its own.
pub fn nearest(text: &str, path: &KeyPath) -> Option<Position> {
    let segments = path.lookup();
    (1..=segments.len()).rev().find_map(|len| position(text, &segments[..len]))
}

fn position(text: &str, path: &[String]) -> Option<Position> {
    walk(text, |at| at == path).map(|(_, position)| position)
}

/// The first key that stands in its mapping twice.
pub fn duplicate(text: &str) -> Option<Duplicate> {
    let mut seen = HashSet::new();
    let (path, second) = walk(text, |at| !seen.insert(at.to_vec()))?;
    let keys: Vec<&str> = path.iter().map(String::as_str).collect();
    Some(Duplicate { path: KeyPath::of_keys(&keys), first: position(text, &path)?, second })
}

/// Position where a second document starts, of which serde_yaml only says that there is one.
pub fn second_document(text: &str) -> Option<Position> {
    let second = serde_yaml::Deserializer::from_str(text).nth(1)?;
    stopped_at(second.deserialize_any(Stop))
}

/// The first key or list item, in the order of the text, at whose path `is_end` holds.
fn walk(text: &str, mut is_end: impl FnMut(&[String]) -> bool) -> Option<(Vec<String>, Position)> {
    let mut walk = Walk { path: Vec::new(), is_end: &mut is_end, has_ended: false };
    let result = walk.value().deserialize(serde_yaml::Deserializer::from_str(text));
    let position = stopped_at(result).filter(|_| walk.has_ended)?;
    Some((walk.path, position))
}

fn stopped_at(result: Result<(), serde_yaml::Error>) -> Option<Position> {
    let location = result.err()?.location()?;
    Some(Position { line: location.line(), column: location.column() })
}

struct Walk<'a> {
    /// Path of the node that is being read.
    path: Vec<String>,
    is_end: &'a mut dyn FnMut(&[String]) -> bool,
    has_ended: bool,
}

impl<'a> Walk<'a> {
    fn value(&mut self) -> Node<'_, 'a> {
        Node { walk: self, is_key: false }
    }

    fn key(&mut self) -> Node<'_, 'a> {
        Node { walk: self, is_key: true }
    }

    fn enter(&mut self, segment: String) {
        self.path.push(segment);
        self.has_ended = (self.is_end)(&self.path);
    }
}

/// A value, or a mapping's key, which is entered as text whatever its type is.
struct Node<'w, 'a> {
    walk: &'w mut Walk<'a>,
    is_key: bool,
}

impl Node<'_, '_> {
    fn scalar<E: Error>(self, text: &dyn fmt::Display) -> Result<(), E> {
        if self.is_key {
            self.walk.enter(text.to_string());
        }
        if self.walk.has_ended { Err(E::custom("here")) } else { Ok(()) }
    }
}

impl<'de> DeserializeSeed<'de> for Node<'_, '_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        if self.walk.has_ended { deserializer.deserialize_any(Stop) } else { deserializer.deserialize_any(self) }
    }
}

impl<'de> Visitor<'de> for Node<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a key or value")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        if self.is_key {
            while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
            return self.scalar(&"a mapping");
        }
        while map.next_key_seed(self.walk.key())?.is_some() {
            map.next_value_seed(self.walk.value())?;
            self.walk.path.pop();
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        if self.is_key {
            while seq.next_element::<IgnoredAny>()?.is_some() {}
            return self.scalar(&"a list");
        }
        for index in 0_usize.. {
            self.walk.enter(index.to_string());
            let item = seq.next_element_seed(self.walk.value())?;
            self.walk.path.pop();
            if item.is_none() {
                break;
            }
        }
        Ok(())
    }

    fn visit_enum<A: EnumAccess<'de>>(self, tagged: A) -> Result<(), A::Error> {
        let (IgnoredAny, content) = tagged.variant()?;
        content.newtype_variant::<IgnoredAny>()?;
        self.scalar(&"a tag")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<(), E> {
        self.scalar(&text)
    }

    fn visit_bool<E: Error>(self, flag: bool) -> Result<(), E> {
        self.scalar(&flag)
    }

    fn visit_u64<E: Error>(self, n: u64) -> Result<(), E> {
        self.scalar(&n)
    }

    fn visit_i64<E: Error>(self, n: i64) -> Result<(), E> {
        self.scalar(&n)
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<(), E> {
        self.scalar(&x)
    }

    fn visit_unit<E: Error>(self) -> Result<(), E> {
        self.scalar(&"nothing")
    }
}

/// Fails at whatever it meets: a list item has no key to fail at.
struct Stop;

impl Visitor<'_> for Stop {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("nothing")
    }
}

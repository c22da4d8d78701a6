//! The JSON Schema of the experiment file, asked of the parser itself: for editors, which complete keys and check
//! values.
//!
//! serde's derived readers say what they want. A reader that goes down one path of keys, words and items, and gives
//! nothing else, notes what is wanted at its end; what the reader says of all that is missing does not matter.

use super::bench::BenchText;
use super::described::Described;
use super::expect::Expect;
use super::sweep::Sweep;
use super::types::Experiment;
use serde::de::value::{Error, MapDeserializer, SeqDeserializer, StrDeserializer};
use serde::de::{DeserializeOwned, DeserializeSeed, EnumAccess, Expected, IntoDeserializer, VariantAccess, Visitor};
use serde::{Deserializer, forward_to_deserialize_any};
use serde_json::{Map, Value, json};
use std::cell::RefCell;

/// Schema of a whole file: an experiment, and what stands beside it.
pub fn schema() -> Value {
    let mut whole = of::<Experiment>();
    let mut expectation = of::<Expect>();
    // One of these words, or bounds and words of its own.
    expectation["minProperties"] = json!(1);
    let beside = [
        ("extends", json!({ "type": "string" })),
        ("sweep", of::<Sweep>()),
        ("expect", json!({ "type": "array", "items": expectation })),
        ("bench", of::<BenchText>()),
    ];
    for (key, schema) in beside {
        whole["properties"][key] = schema;
    }
    Described::of_pages().describe(&mut whole);
    let mut said = Map::new();
    said.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    said.insert("title".into(), json!("gotai experiment"));
    if let Value::Object(whole) = whole {
        said.extend(whole);
    }
    Value::Object(said)
}

/// What is wanted at the end of a path.
#[derive(Clone, Debug)]
enum Wanted {
    Keys(&'static [&'static str]),
    Words(&'static [&'static str]),
    Nothing,
    Number,
    Whole,
    Flag,
    Text,
    Items,
    /// A list of that many.
    Several(usize),
    Entries,
    /// Something that the reader decides about when it sees it, in its words.
    Anything(String),
}

/// Part of a path.
#[derive(Clone, Copy, Debug)]
enum Part {
    Key(&'static str),
    Word(&'static str),
    Item,
}

/// Parts of the longest path: a predicate stands in predicates.
const DEEPEST: usize = 14;

fn of<T: DeserializeOwned>() -> Value {
    below::<T>(&mut Vec::new())
}

fn below<T: DeserializeOwned>(path: &mut Vec<Part>) -> Value {
    let found = RefCell::new(None);
    let is_optional = RefCell::new(false);
    drop(T::deserialize(Probe { path: &path[..], found: &found, is_optional: &is_optional }));
    let Some(wanted) = found.into_inner().filter(|_| path.len() < DEEPEST) else { return json!({}) };
    let mut next = |part: Part| {
        path.push(part);
        let schema = below::<T>(path);
        path.pop();
        schema
    };
    let schema = match wanted {
        Wanted::Keys(keys) => {
            let keys: Map<_, _> = keys.iter().map(|key| (key.to_string(), next(Part::Key(key)))).collect();
            json!({ "type": "object", "properties": keys, "additionalProperties": false })
        }
        Wanted::Words(words) => {
            // A word alone stands for its settings' defaults.
            let settings = words.iter().map(|word| (word.to_string(), next(Part::Word(word))));
            let settings: Map<_, _> = settings.filter(|(_, schema)| !schema.is_null()).collect();
            let word = json!({ "enum": words });
            match settings.is_empty() {
                true => word,
                false => json!({ "anyOf": [word, {
                    "type": "object", "properties": settings, "additionalProperties": false,
                    "minProperties": 1, "maxProperties": 1,
                }] }),
            }
        }
        Wanted::Nothing => return Value::Null,
        Wanted::Number => json!({ "type": "number" }),
        Wanted::Whole => json!({ "type": "integer" }),
        Wanted::Flag => json!({ "type": "boolean" }),
        Wanted::Text => json!({ "type": "string" }),
        Wanted::Items => json!({ "type": "array", "items": next(Part::Item) }),
        Wanted::Several(n) => json!({ "type": "array", "items": next(Part::Item), "minItems": n, "maxItems": n }),
        Wanted::Entries => json!({ "type": "object" }),
        Wanted::Anything(said) => json!({ "description": said }),
    };
    match is_optional.into_inner() {
        true => json!({ "anyOf": [schema, { "type": "null" }] }),
        false => schema,
    }
}

/// Reader that goes down one path.
#[derive(Clone, Copy)]
struct Probe<'a> {
    path: &'a [Part],
    found: &'a RefCell<Option<Wanted>>,
    is_optional: &'a RefCell<bool>,
}

type Result<T> = std::result::Result<T, Error>;

impl<'a> Probe<'a> {
    /// The next part of the path; at its end what is wanted is noted, and nothing more is given.
    fn next(self, wanted: Wanted) -> Result<(Part, Probe<'a>)> {
        match self.path {
            [] => {
                *self.found.borrow_mut() = Some(wanted);
                Err(serde::de::Error::custom("the end of the path"))
            }
            [part, rest @ ..] => Ok((*part, Probe { path: rest, ..self })),
        }
    }

    fn keys<'de, V: Visitor<'de>>(self, keys: &'static [&'static str], visitor: V) -> Result<V::Value> {
        match self.next(Wanted::Keys(keys))? {
            (Part::Key(key), rest) => visitor.visit_map(MapDeserializer::new(std::iter::once((key, rest)))),
            _ => Err(serde::de::Error::custom("no key")),
        }
    }

    fn items<'de, V: Visitor<'de>>(self, wanted: Wanted, visitor: V) -> Result<V::Value> {
        let (_, rest) = self.next(wanted)?;
        visitor.visit_seq(SeqDeserializer::new(std::iter::once(rest)))
    }
}

impl<'de> IntoDeserializer<'de, Error> for Probe<'_> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

/// Gives what a leaf wants to nobody.
macro_rules! leaves {
    ($($name:ident: $wanted:expr),+ $(,)?) => {
        $(fn $name<V: Visitor<'de>>(self, _: V) -> Result<V::Value> {
            self.next($wanted)?;
            Err(serde::de::Error::custom("nothing below it"))
        })+
    };
}

impl<'de> Deserializer<'de> for Probe<'_> {
    type Error = Error;

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &str,
        keys: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value> {
        self.keys(keys, visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &str,
        words: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value> {
        match self.next(Wanted::Words(words))? {
            (Part::Word(word), rest) => visitor.visit_enum(At { word, rest }),
            _ => Err(serde::de::Error::custom("no word")),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        if self.path.is_empty() {
            *self.is_optional.borrow_mut() = true;
        }
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &str, visitor: V) -> Result<V::Value> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        self.items(Wanted::Items, visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, n: usize, visitor: V) -> Result<V::Value> {
        self.items(Wanted::Several(n), visitor)
    }

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        let said = (&visitor as &dyn Expected).to_string();
        self.next(Wanted::Anything(said))?;
        Err(serde::de::Error::custom("nothing below it"))
    }

    leaves!(
        deserialize_bool: Wanted::Flag,
        deserialize_f64: Wanted::Number,
        deserialize_f32: Wanted::Number,
        deserialize_u8: Wanted::Whole,
        deserialize_u16: Wanted::Whole,
        deserialize_u32: Wanted::Whole,
        deserialize_u64: Wanted::Whole,
        deserialize_i32: Wanted::Whole,
        deserialize_i64: Wanted::Whole,
        deserialize_str: Wanted::Text,
        deserialize_string: Wanted::Text,
        deserialize_map: Wanted::Entries,
    );

    forward_to_deserialize_any! {
        i8 i16 i128 u128 char bytes byte_buf unit unit_struct tuple_struct identifier ignored_any
    }
}

/// A word, and the path below it.
struct At<'a> {
    word: &'static str,
    rest: Probe<'a>,
}

impl<'de, 'a> EnumAccess<'de> for At<'a> {
    type Error = Error;
    type Variant = Probe<'a>;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Probe<'a>)> {
        let word: StrDeserializer<Error> = self.word.into_deserializer();
        Ok((seed.deserialize(word)?, self.rest))
    }
}

impl<'de> VariantAccess<'de> for Probe<'_> {
    type Error = Error;

    fn unit_variant(self) -> Result<()> {
        self.next(Wanted::Nothing).map(drop)
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, n: usize, visitor: V) -> Result<V::Value> {
        self.items(Wanted::Several(n), visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, keys: &'static [&'static str], visitor: V) -> Result<V::Value> {
        self.keys(keys, visitor)
    }
}

//! The vocabulary, asked of the parser itself: the words of an enum, the settings that each takes, their defaults.
//!
//! serde's derived readers say what they want: the reader here gives them just that, and notes what it was. So a list
//! of what can be written holds what can be read, and nothing has to be listed by hand.

use super::error::number;
use serde::de::value::{Error, MapDeserializer, SeqDeserializer, StrDeserializer};
use serde::de::{DeserializeOwned, DeserializeSeed, EnumAccess, IntoDeserializer, VariantAccess, Visitor};
use serde::{Deserializer, Serialize, forward_to_deserialize_any};
use serde_json::{Map, Value, json};
use std::cell::{Cell, RefCell};

/// A word of the file.
#[derive(Clone, Debug)]
pub struct Word<T> {
    pub name: &'static str,
    /// Value that the word is read as, with settings that mean nothing.
    pub value: T,
    pub settings: Vec<SettingKey>,
}

/// A key below a word.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SettingKey {
    pub name: &'static str,
    pub takes: Takes,
    #[serde(rename = "default")]
    pub initial: Initial,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Takes {
    Words(&'static [&'static str]),
    Number,
    WholeNumber,
    /// A vector of that many numbers.
    Vector(usize),
    /// A list of vectors of that many numbers.
    Vectors(usize),
}

/// Value of a setting that the file leaves out.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Initial {
    /// No value: the file has to say one.
    Needed,
    Is(Value),
    /// No value of the parser's: it is the method's own affair.
    Absent,
}

impl std::fmt::Display for Takes {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Takes::Words(words) => f.write_str(&words.join(", ")),
            Takes::Number => f.write_str("number"),
            Takes::WholeNumber => f.write_str("whole number"),
            Takes::Vector(n) => write!(f, "{n} numbers"),
            Takes::Vectors(n) => write!(f, "list of {n} numbers each"),
        }
    }
}

/// Text of a value as a file would have it.
pub fn shown(value: &Value) -> String {
    match value {
        Value::String(word) => word.clone(),
        Value::Number(x) if x.is_f64() => number(x.as_f64().unwrap_or(f64::NAN)),
        other => other.to_string(),
    }
}

/// All words that are read as a `T`, in its own order.
pub fn words<T: DeserializeOwned + Serialize + PartialEq>() -> Vec<Word<T>> {
    let mut words = Vec::new();
    loop {
        let asked = Asked { place: words.len(), ..Asked::default() };
        let Ok(value) = T::deserialize(Reader(&asked)) else { return words };
        let Some(name) = asked.names.get().get(words.len()).copied() else { return words };
        let settings = settings::<T>(name, asked.settings.into_inner());
        words.push(Word { name, value, settings });
    }
}

/// Numbers that defaults are among, where serde leaves them out: found by reading them.
const PLAIN: [f64; 2] = [0.0, 1.0];

fn settings<T>(word: &'static str, taken: Vec<(&'static str, Takes)>) -> Vec<SettingKey>
where
    T: DeserializeOwned + Serialize + PartialEq,
{
    let read = |settings: Map<String, Value>| serde_json::from_value::<T>(json!({ word: settings })).ok();
    let all: Map<_, _> = taken.iter().map(|(name, takes)| (name.to_string(), some(takes))).collect();
    let mut needed = all.clone();
    needed.retain(|name, _| {
        let mut others = all.clone();
        others.remove(name);
        read(others).is_none()
    });
    let Some(least) = read(needed.clone()) else { return Vec::new() };
    let written = serde_json::to_value(&least).unwrap_or_default();
    let initial = |name: &str, takes: &Takes| {
        if needed.contains_key(name) {
            return Initial::Needed;
        }
        if let Some(value) = written.get(word).and_then(|settings| settings.get(name)).filter(|value| !value.is_null())
        {
            return Initial::Is(value.clone());
        }
        let candidates: Vec<Value> = match takes {
            Takes::Words(words) => words.iter().map(|word| json!(word)).collect(),
            Takes::Number => PLAIN.map(|x| json!(x)).to_vec(),
            Takes::WholeNumber | Takes::Vector(_) | Takes::Vectors(_) => Vec::new(),
        };
        let changes_nothing = |value: &Value| {
            let mut settings = needed.clone();
            settings.insert(name.to_string(), value.clone());
            read(settings).as_ref() == Some(&least)
        };
        candidates.into_iter().find(changes_nothing).map_or(Initial::Absent, Initial::Is)
    };
    taken.iter().map(|(name, takes)| SettingKey { name, takes: takes.clone(), initial: initial(name, takes) }).collect()
}

/// Something that it takes.
fn some(takes: &Takes) -> Value {
    match takes {
        Takes::Words(words) => json!(words.first()),
        Takes::Number => json!(1.0),
        Takes::WholeNumber => json!(1),
        Takes::Vector(n) => json!(vec![1.0; *n]),
        Takes::Vectors(n) => json!([vec![1.0; *n]]),
    }
}

/// Questions that a reader has been asked.
#[derive(Default)]
struct Asked {
    /// Number of the word that it gives.
    place: usize,
    names: Cell<&'static [&'static str]>,
    settings: RefCell<Vec<(&'static str, Takes)>>,
}

/// Gives one word with all its settings.
#[derive(Clone, Copy)]
struct Reader<'a>(&'a Asked);

/// Where it stands: at the word, whose value is an enum, or at its settings, a struct.
impl<'de> Deserializer<'de> for Reader<'_> {
    type Error = Error;

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &str,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.0.names.set(names);
        visitor.visit_enum(self)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let values = fields.iter().map(|name| (*name, At { asked: self.0, name }));
        visitor.visit_map(MapDeserializer::new(values))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        Err(serde::de::Error::custom("neither a word nor settings"))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map identifier ignored_any
    }
}

impl<'de> EnumAccess<'de> for Reader<'_> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self), Error> {
        let name = self.0.names.get().get(self.0.place).copied();
        let name = name.ok_or_else(|| <Error as serde::de::Error>::custom("no more words"))?;
        let name: StrDeserializer<Error> = name.into_deserializer();
        Ok((seed.deserialize(name)?, self))
    }
}

impl<'de> VariantAccess<'de> for Reader<'_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        Ok(())
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<S::Value, Error> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_any(visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.deserialize_struct("", fields, visitor)
    }
}

/// Gives the value of one setting.
#[derive(Clone, Copy)]
struct At<'a> {
    asked: &'a Asked,
    name: &'static str,
}

impl At<'_> {
    fn takes(&self, takes: Takes) {
        self.asked.settings.borrow_mut().push((self.name, takes));
    }
}

impl<'de> IntoDeserializer<'de, Error> for At<'_> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for At<'_> {
    type Error = Error;

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.takes(Takes::Number);
        visitor.visit_f64(1.0)
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.takes(Takes::WholeNumber);
        visitor.visit_u32(1)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &str,
        names: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.takes(Takes::Words(names));
        visitor.visit_enum(StrDeserializer::new(names[0]))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, n: usize, visitor: V) -> Result<V::Value, Error> {
        self.takes(Takes::Vector(n));
        visitor.visit_seq(SeqDeserializer::new(std::iter::repeat_n(1.0, n)))
    }

    /// The lists of the vocabulary are of triples.
    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.takes(Takes::Vectors(3));
        visitor.visit_seq(SeqDeserializer::new(std::iter::once([1.0; 3].to_vec())))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        let message = format!("{}: what it takes has no name in `Takes`", self.name);
        Err(serde::de::Error::custom(message))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u64 u128 f32 char str string bytes byte_buf unit unit_struct newtype_struct
        tuple_struct map struct identifier ignored_any
    }
}

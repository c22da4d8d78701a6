//! Reader of our types from YAML values, with errors that know the key path.
//!
//! serde_yaml's own reader takes enums as `!tag`s and its errors know neither path nor nearest key. This one reads an
//! enum as one word or as one key with settings, whole numbers where a number is expected, and nothing that is not
//! finite. All checks of type happen here, before serde's visitors see the value, so that the messages are ours.

use super::error::{ExperimentError, describe, key_text};
use super::key_path::{KeyPath, Path};
use super::later::{all_keys, is_later};
use super::tree::{Mapping, Number, Value};
use serde::de::value::BorrowedStrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, MapAccess, SeqAccess, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;

type Result<T> = std::result::Result<T, ExperimentError>;

/// A `T` from the value that stands at `base`.
///
/// # Errors
/// The value is not one; the error has the path of the part that is wrong.
pub fn from_value<T: DeserializeOwned>(value: &Value, base: &KeyPath) -> Result<T> {
    T::deserialize(Node { value: Some(value), path: Path::Base(base) })
}

/// The name of a list item, when it has one.
pub fn item_name(item: &Value) -> Option<&str> {
    item.as_mapping()?.get("name")?.as_str()
}

/// A value and where it stands.
#[derive(Clone, Copy)]
struct Node<'de, 'p> {
    /// Value there; None for the settings of a word that was written alone.
    value: Option<&'de Value>,
    path: Path<'p>,
}

impl<'de, 'p> Node<'de, 'p> {
    fn unexpected(&self, expected: &str) -> ExperimentError {
        let found = match self.value {
            Some(Value::Tagged(tagged)) => format!("the tag `{}` (tags are not used here)", tagged.tag),
            Some(value) => describe(value),
            None => "nothing".to_string(),
        };
        ExperimentError::unexpected(self.path.to_key_path(), expected, &found)
    }

    /// Completes the path of whatever serde's visitor complains about.
    fn located<T>(&self, result: Result<T>) -> Result<T> {
        result.map_err(|error| error.below(&self.path))
    }

    fn whole(&self, largest: u64) -> Result<u64> {
        let expected = || match largest {
            u64::MAX => "a whole number of at least 0".to_string(),
            _ => format!("a whole number from 0 to {largest}"),
        };
        match self.value {
            Some(Value::Number(number)) => whole(number).filter(|n| *n <= largest),
            _ => None,
        }
        .ok_or_else(|| self.unexpected(&expected()))
    }

    fn finite(&self, number: &Number) -> Result<f64> {
        number.as_f64().filter(|x| x.is_finite()).ok_or_else(|| self.unexpected("a finite number"))
    }

    /// An empty section (`diverge:` with nothing below) is an empty mapping.
    fn entries(&self, expected: impl Fn() -> String) -> Result<Option<&'de Mapping>> {
        match self.value {
            None | Some(Value::Null) => Ok(None),
            Some(Value::Mapping(mapping)) => Ok(Some(mapping)),
            Some(_) => Err(self.unexpected(&expected())),
        }
    }

    fn items(&self, expected: &str) -> Result<&'de [Value]> {
        match self.value {
            Some(Value::Sequence(items)) => Ok(items),
            _ => Err(self.unexpected(expected)),
        }
    }

    /// The word of an enum and its settings.
    fn variant(&self, name: &str, variants: &[&str]) -> Result<(&'de str, Option<&'de Value>)> {
        let expected = || format!("one of {}", variants.join(", "));
        match self.value {
            Some(Value::String(word)) => {
                self.check_word(name, variants, word, self.path)?;
                Ok((word, None))
            }
            Some(Value::Mapping(mapping)) => {
                let mut keys = mapping.iter();
                let Some((Value::String(word), content)) = keys.next() else {
                    return Err(self.unexpected(&expected()));
                };
                self.check_word(name, variants, word, self.path.key(word))?;
                if let Some((second, _)) = mapping.iter().skip(1).last() {
                    let path = self.path.key(second.as_str().unwrap_or_default()).to_key_path();
                    let found = format!("`{}` beside `{word}`", key_text(second));
                    return Err(ExperimentError::unexpected(path, &format!("only {}", expected()), &found));
                }
                Ok((word, Some(content)))
            }
            _ => Err(self.unexpected(&expected())),
        }
    }

    fn check_word(&self, name: &str, variants: &[&str], word: &str, path: Path) -> Result<()> {
        if variants.contains(&word) {
            return Ok(());
        }
        if is_later(name, word) {
            return Err(ExperimentError::not_available(path.to_key_path(), Some(word)));
        }
        Err(ExperimentError::unknown_word(path.to_key_path(), word, variants))
    }

    fn check_keys(&self, name: &str, fields: &[&str], mapping: &Mapping) -> Result<()> {
        for key in mapping.keys() {
            let known = key.as_str().is_some_and(|key| fields.contains(&key));
            if !known {
                return Err(self.unknown_key(name, fields, key));
            }
        }
        Ok(())
    }

    fn unknown_key(&self, name: &str, fields: &[&str], key: &Value) -> ExperimentError {
        let text = key_text(key);
        let path = self.path.key(key.as_str().unwrap_or(&text)).to_key_path();
        if is_later(name, &text) {
            return ExperimentError::not_available(path, None);
        }
        ExperimentError::unknown_key(path, &text, &all_keys(name, fields))
    }
}

/// `50.0` is a whole number too; beyond 2⁵³ a float no longer says which one.
fn whole(number: &Number) -> Option<u64> {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    match number.as_u64() {
        Some(n) => Some(n),
        None => number.as_f64().filter(|x| x.fract() == 0.0 && (0.0..=EXACT).contains(x)).map(|x| x as u64),
    }
}

impl<'de> Deserializer<'de> for Node<'de, '_> {
    type Error = ExperimentError;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        let result = match self.value {
            Some(Value::Bool(flag)) => visitor.visit_bool(*flag),
            Some(Value::Number(number)) => match (number.as_u64(), number.as_i64()) {
                (Some(n), _) => visitor.visit_u64(n),
                (None, Some(n)) => visitor.visit_i64(n),
                (None, None) => visitor.visit_f64(self.finite(number)?),
            },
            Some(Value::String(text)) => visitor.visit_borrowed_str(text),
            Some(Value::Sequence(items)) => visitor.visit_seq(Items::new(items, &self.path)),
            Some(Value::Mapping(mapping)) => visitor.visit_map(Entries::new(Some(mapping), &self.path)),
            Some(Value::Tagged(_)) => Err(self.unexpected("a plain value")),
            Some(Value::Null) | None => visitor.visit_unit(),
        };
        self.located(result)
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.value {
            Some(Value::Bool(flag)) => self.located(visitor.visit_bool(*flag)),
            _ => Err(self.unexpected("true or false")),
        }
    }

    fn deserialize_u32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        let n = self.whole(u64::from(u32::MAX))?;
        self.located(visitor.visit_u64(n))
    }

    fn deserialize_u64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        let n = self.whole(u64::MAX)?;
        self.located(visitor.visit_u64(n))
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.value {
            Some(Value::Number(number)) => self.located(visitor.visit_f64(self.finite(number)?)),
            _ => Err(self.unexpected("a number")),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.value {
            Some(Value::String(text)) => self.located(visitor.visit_borrowed_str(text)),
            Some(Value::Number(_) | Value::Bool(_)) => Err(self.unexpected("text (in quotes)")),
            _ => Err(self.unexpected("text")),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        match self.value {
            None | Some(Value::Null) => self.located(visitor.visit_none()),
            Some(_) => self.located(visitor.visit_some(self)),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &'static str, visitor: V) -> Result<V::Value> {
        self.located(visitor.visit_newtype_struct(self))
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        let items = self.items("a list")?;
        self.located(visitor.visit_seq(Items::new(items, &self.path)))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value> {
        let expected = format!("a list of {len}");
        let items = self.items(&expected)?;
        if items.len() != len {
            return Err(self.unexpected(&expected));
        }
        self.located(visitor.visit_seq(Items::new(items, &self.path)))
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value> {
        let mapping = self.entries(|| "a mapping".to_string())?;
        self.located(visitor.visit_map(Entries::new(mapping, &self.path)))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value> {
        let mapping = self.entries(|| format!("a mapping (known keys: {})", all_keys(name, fields).join(", ")))?;
        if let Some(mapping) = mapping {
            self.check_keys(name, fields, mapping)?;
        }
        self.located(visitor.visit_map(Entries::new(mapping, &self.path)))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value> {
        let (word, content) = self.variant(name, variants)?;
        self.located(visitor.visit_enum(Word { word, content, path: &self.path }))
    }

    forward_to_deserialize_any! {
        i8 i16 i32 i64 i128 u8 u16 u128 f32 char bytes byte_buf unit unit_struct tuple_struct identifier ignored_any
    }
}

/// The items of a list, in order.
struct Items<'de, 'p> {
    items: std::iter::Enumerate<std::slice::Iter<'de, Value>>,
    path: &'p Path<'p>,
}

impl<'de, 'p> Items<'de, 'p> {
    fn new(items: &'de [Value], path: &'p Path<'p>) -> Self {
        Items { items: items.iter().enumerate(), path }
    }
}

impl<'de> SeqAccess<'de> for Items<'de, '_> {
    type Error = ExperimentError;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>> {
        let Some((index, value)) = self.items.next() else {
            return Ok(None);
        };
        let path = self.path.item(index, item_name(value));
        seed.deserialize(Node { value: Some(value), path }).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len())
    }
}

/// The entries of a mapping, in order.
struct Entries<'de, 'p> {
    entries: Option<<&'de Mapping as IntoIterator>::IntoIter>,
    /// The entry whose key was read and whose value comes next.
    current: Option<(&'de str, &'de Value)>,
    path: &'p Path<'p>,
}

impl<'de, 'p> Entries<'de, 'p> {
    fn new(mapping: Option<&'de Mapping>, path: &'p Path<'p>) -> Self {
        Entries { entries: mapping.map(Mapping::iter), current: None, path }
    }
}

impl<'de> MapAccess<'de> for Entries<'de, '_> {
    type Error = ExperimentError;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>> {
        let Some((key, value)) = self.entries.as_mut().and_then(Iterator::next) else {
            return Ok(None);
        };
        let Value::String(key) = key else {
            return Err(ExperimentError::unexpected(self.path.to_key_path(), "keys that are text", &describe(key)));
        };
        self.current = Some((key, value));
        seed.deserialize(BorrowedStrDeserializer::new(key)).map(Some)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value> {
        let Some((key, value)) = self.current.take() else {
            return Err(serde::de::Error::custom("a value was asked for before its key"));
        };
        seed.deserialize(Node { value: Some(value), path: self.path.key(key) })
    }
}

/// An enum's word, with the settings below it.
struct Word<'de, 'p> {
    word: &'de str,
    content: Option<&'de Value>,
    path: &'p Path<'p>,
}

impl<'de, 'p> Word<'de, 'p> {
    fn settings(&'p self) -> Node<'de, 'p> {
        Node { value: self.content, path: self.path.key(self.word) }
    }
}

impl<'de> EnumAccess<'de> for Word<'de, '_> {
    type Error = ExperimentError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self)> {
        let value = seed.deserialize(BorrowedStrDeserializer::<ExperimentError>::new(self.word))?;
        Ok((value, self))
    }
}

impl<'de> VariantAccess<'de> for Word<'de, '_> {
    type Error = ExperimentError;

    fn unit_variant(self) -> Result<()> {
        match self.content {
            None | Some(Value::Null) => Ok(()),
            Some(Value::Mapping(mapping)) if mapping.is_empty() => Ok(()),
            Some(_) => Err(self.settings().unexpected(&format!("the word `{}` alone", self.word))),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value> {
        seed.deserialize(self.settings())
    }

    fn tuple_variant<V: Visitor<'de>>(self, len: usize, visitor: V) -> Result<V::Value> {
        self.settings().deserialize_tuple(len, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value> {
        self.settings().deserialize_map(visitor)
    }
}

//! Readings of a place in the vocabulary: as an enum's word, as keys, as a plain value.
//!
//! The types are asked themselves: a reader leads them down the path and notes what they want at its end, so that no
//! list of places is kept by hand.

use super::axes::Form;
use super::bench::BenchText;
use super::key_path::KeyPath;
use super::sweep::Sweep;
use super::types::Experiment;
use serde::de::value::{BorrowedStrDeserializer, Error};
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error as _, MapAccess, SeqAccess, VariantAccess,
    Visitor,
};
use serde::forward_to_deserialize_any;
use std::cell::Cell;

/// Reading of what stands at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reading {
    /// One word, or one key with settings.
    Word,
    /// Keys that stand for different ways to say one thing.
    Alternatives,
    /// A mapping whose keys do not exclude each other, a list, a scalar, or nothing that is known.
    Plain,
}

/// Types whose keys are alternatives; that they exclude each other is in no type, but in `validate.rs`.
const ALTERNATIVES: [&str; 4] = ["MeshSpec", "Orientation", "Copies", "PredicateText"];

/// Reading of the value at this place of a file.
pub(super) fn reading(place: &KeyPath) -> Reading {
    let path = place.lookup();
    let path: Vec<&str> = path.iter().map(String::as_str).collect();
    match path.as_slice() {
        ["sweep", "axes", _, below @ ..] => at::<Form>(below),
        ["sweep", below @ ..] => at::<Sweep>(below),
        ["bench", below @ ..] => at::<BenchText>(below),
        path => at::<Experiment>(path),
    }
}

fn at<T: DeserializeOwned>(path: &[&str]) -> Reading {
    let end = Cell::new(Reading::Plain);
    // It always ends in an error: there are no values.
    let _ = T::deserialize(Guide { path, end: &end });
    end.get()
}

/// Leads a type down a path.
#[derive(Clone, Copy)]
struct Guide<'a> {
    path: &'a [&'a str],
    end: &'a Cell<Reading>,
}

impl<'a> Guide<'a> {
    fn first(&self) -> Result<&'a str, Error> {
        self.path.first().copied().ok_or_else(|| Error::custom("the end of the path"))
    }

    fn below(&self) -> Guide<'a> {
        Guide { path: self.path.get(1..).unwrap_or_default(), end: self.end }
    }
}

impl<'de> Deserializer<'de> for Guide<'de> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        Err(Error::custom("a plain value"))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        if self.path.is_empty() {
            self.end.set(Reading::Word);
        }
        visitor.visit_enum(self)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        if self.path.is_empty() && ALTERNATIVES.contains(&name) {
            self.end.set(Reading::Alternatives);
        }
        visitor.visit_map(self)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _: &str, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_seq(self)
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct tuple
        tuple_struct map identifier ignored_any
    }
}

/// The one key of the path; its value never is one, so that there is no second.
impl<'de> MapAccess<'de> for Guide<'de> {
    type Error = Error;

    fn next_key_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Error> {
        seed.deserialize(BorrowedStrDeserializer::new(self.first()?)).map(Some)
    }

    fn next_value_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<S::Value, Error> {
        seed.deserialize(self.below())?;
        Err(Error::custom("the end of the path"))
    }
}

impl<'de> SeqAccess<'de> for Guide<'de> {
    type Error = Error;

    fn next_element_seed<S: DeserializeSeed<'de>>(&mut self, seed: S) -> Result<Option<S::Value>, Error> {
        self.first()?;
        seed.deserialize(self.below())?;
        Err(Error::custom("the end of the path"))
    }
}

impl<'de> EnumAccess<'de> for Guide<'de> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'de>>(self, seed: S) -> Result<(S::Value, Self), Error> {
        let word = seed.deserialize(BorrowedStrDeserializer::<Error>::new(self.first()?))?;
        Ok((word, self.below()))
    }
}

impl<'de> VariantAccess<'de> for Guide<'de> {
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

    fn struct_variant<V: Visitor<'de>>(self, _: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.deserialize_any(visitor)
    }
}

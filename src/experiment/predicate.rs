//! Bounds, and what can be true of a row: the words that `expect:` and `search:` share.

use super::checks::Result;
use super::error::{ExperimentError, number};
use super::key_path::Path;
use crate::outcome::Outcome;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde_json::Value as Cell;
use std::fmt;

/// An interval; `min` and `max` belong to it, `above` and `below` do not, `within: x` is all that is no larger than x.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bounds {
    pub min: Option<f64>,
    pub max: Option<f64>,
    pub above: Option<f64>,
    pub below: Option<f64>,
    pub within: Option<f64>,
}

impl Bounds {
    /// Whether a number is in the interval; what is not a number never is.
    pub fn contain(&self, x: f64) -> bool {
        self.min.is_none_or(|min| x >= min)
            && self.max.is_none_or(|max| x <= max)
            && self.above.is_none_or(|above| x > above)
            && self.below.is_none_or(|below| x < below)
            && self.within.is_none_or(|within| x.abs() <= within)
            && !x.is_nan()
    }

    pub fn is_none(&self) -> bool {
        *self == Bounds::default()
    }

    /// Whether all numbers on one side of the interval are in it, so that it says nothing of them.
    pub fn is_one_sided(&self) -> bool {
        let has_lower = self.min.or(self.above).is_some();
        let has_upper = self.max.or(self.below).is_some();
        self.within.is_none() && has_lower != has_upper
    }

    /// Bounds that are there, by their keys.
    pub fn given(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let all = [("min", self.min), ("max", self.max), ("above", self.above), ("below", self.below)];
        all.into_iter().chain([("within", self.within)]).filter_map(|(key, bound)| Some((key, bound?)))
    }

    /// Checks that there is at least one bound, and a number that meets all of them.
    ///
    /// # Errors
    /// No bound, bounds that no number meets, or `within` that is no size or has another bound beside it.
    pub fn check(&self, at: Path) -> Result<()> {
        if self.is_none() {
            return Err(ExperimentError::missing(at.to_key_path(), "a bound (min, max, above, below or within)"));
        }
        if let Some(within) = self.within {
            return self.check_within(within, at.key("within"));
        }
        let lower = [self.min, self.above].into_iter().flatten().fold(f64::NEG_INFINITY, f64::max);
        let upper = [self.max, self.below].into_iter().flatten().fold(f64::INFINITY, f64::min);
        let is_open = self.above == Some(lower) || self.below == Some(upper);
        if lower > upper || (lower == upper && is_open) {
            let key = if self.max.is_some() { "max" } else { "below" };
            let expected = format!("an upper bound that some number above {} meets", number(lower));
            return Err(ExperimentError::unexpected(at.key(key).to_key_path(), &expected, &number(upper)));
        }
        Ok(())
    }

    fn check_within(&self, within: f64, at: Path) -> Result<()> {
        if let Some((other, _)) = self.given().find(|(key, _)| *key != "within") {
            let found = format!("`within` and `{other}`");
            return Err(ExperimentError::unexpected(
                at.to_key_path(),
                "`within` without other bounds beside it",
                &found,
            ));
        }
        if within.is_finite() && within >= 0.0 {
            return Ok(());
        }
        Err(ExperimentError::unexpected(at.to_key_path(), "a finite number of at least 0", &number(within)))
    }

    /// Checks the bounds of a share: some number from 0 to 1.
    ///
    /// # Errors
    /// As `check`, or a bound outside of 0 to 1.
    pub fn check_share(&self, at: Path) -> Result<()> {
        self.check(at)?;
        match self.given().find(|(_, x)| !(0.0..=1.0).contains(x)) {
            None => Ok(()),
            Some((key, x)) => {
                Err(ExperimentError::unexpected(at.key(key).to_key_path(), "a share from 0 to 1", &number(x)))
            }
        }
    }
}

impl fmt::Display for Bounds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bounds = [("≥", self.min), (">", self.above), ("≤", self.max), ("<", self.below), ("|…| ≤", self.within)];
        let parts = bounds.into_iter().filter_map(|(sign, bound)| Some(format!("{sign} {}", number(bound?))));
        f.write_str(&parts.collect::<Vec<_>>().join(", "))
    }
}

/// A column, or the quotient of two (`search_high / critical_step_s`).
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub name: String,
    pub divided_by: Option<String>,
}

impl Column {
    pub fn new(text: &str) -> Self {
        match text.split_once(" / ") {
            Some((name, by)) => Column { name: name.trim().to_string(), divided_by: Some(by.trim().to_string()) },
            None => Column { name: text.to_string(), divided_by: None },
        }
    }

    /// The number of a row, whose values `cell` gives by the name of their column; None for null and what is not a
    /// number.
    pub fn value<'a>(&self, cell: impl Fn(&str) -> Option<&'a Cell>) -> Option<f64> {
        let number = |name: &str| cell(name).and_then(Cell::as_f64);
        match &self.divided_by {
            None => number(&self.name),
            Some(by) => Some(number(&self.name)? / number(by)?).filter(|x| x.is_finite()),
        }
    }

    pub fn names(&self) -> impl Iterator<Item = &str> {
        std::iter::once(self.name.as_str()).chain(self.divided_by.as_deref())
    }
}

impl fmt::Display for Column {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.names().collect::<Vec<_>>().join(" / "))
    }
}

/// Statement that is true of some rows and not of others.
#[derive(Clone, Debug, PartialEq)]
pub enum Predicate {
    Outcome(Outcome),
    Criterion(String),
    Column { column: Column, bounds: Bounds },
}

impl Predicate {
    /// Whether it is true of a row; None where the number that would decide it is not there.
    pub fn holds<'a>(&self, cell: impl Fn(&str) -> Option<&'a Cell>) -> Option<bool> {
        let is = |name: &str, word: &str| cell(name).and_then(Cell::as_str) == Some(word);
        match self {
            Predicate::Outcome(outcome) => Some(is("outcome", outcome.name())),
            Predicate::Criterion(name) => Some(is("criterion", name)),
            Predicate::Column { column, bounds } => column.value(&cell).map(|x| bounds.contain(x)),
        }
    }
}

impl fmt::Display for Predicate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Predicate::Outcome(outcome) => f.write_str(outcome.name()),
            Predicate::Criterion(name) => f.write_str(name),
            Predicate::Column { column, bounds } => write!(f, "{column} {bounds}"),
        }
    }
}

/// A number of a row, or whether something is true of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    Column(Column),
    Fraction(Predicate),
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Quantity::Column(column) => column.fmt(f),
            Quantity::Fraction(predicate) => predicate.fmt(f),
        }
    }
}

/// A predicate as it is written.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PredicateText {
    outcome: Option<Outcome>,
    criterion: Option<String>,
    column: Option<String>,
    min: Option<f64>,
    max: Option<f64>,
    above: Option<f64>,
    below: Option<f64>,
    within: Option<f64>,
    fraction: Option<Box<PredicateText>>,
}

impl PredicateText {
    fn bounds(&self) -> Bounds {
        Bounds { min: self.min, max: self.max, above: self.above, below: self.below, within: self.within }
    }

    /// The predicate that the keys say.
    ///
    /// # Errors
    /// Neither an outcome, nor a criterion, nor a column with bounds that some number meets.
    pub fn read(&self, at: Path) -> Result<Predicate> {
        let bounds = self.bounds();
        match (self.outcome, &self.criterion, &self.column, &self.fraction) {
            (Some(outcome), None, None, None) if bounds.is_none() => Ok(Predicate::Outcome(outcome)),
            (None, Some(name), None, None) if bounds.is_none() => Ok(Predicate::Criterion(name.clone())),
            (None, None, Some(column), None) => {
                bounds.check(at)?;
                Ok(Predicate::Column { column: Column::new(column), bounds })
            }
            (None, None, None, Some(inner)) if bounds.is_none() => inner.read(at.key("fraction")),
            _ => {
                let what = "one of outcome, criterion, or column with min, max, above, below or within";
                Err(ExperimentError::missing(at.to_key_path(), what))
            }
        }
    }

    /// A column without bounds is the number itself.
    fn quantity(&self, at: Path) -> Result<Quantity> {
        match (&self.column, self.bounds().is_none()) {
            (Some(column), true) if self.outcome.is_none() && self.criterion.is_none() && self.fraction.is_none() => {
                Ok(Quantity::Column(Column::new(column)))
            }
            _ => self.read(at).map(Quantity::Fraction),
        }
    }
}

/// A column's name, or a predicate.
#[derive(Clone, Debug, PartialEq)]
pub enum QuantityText {
    Column(String),
    Predicate(PredicateText),
}

impl QuantityText {
    /// The quantity that the keys say.
    ///
    /// # Errors
    /// A predicate that is none.
    pub fn read(&self, at: Path) -> Result<Quantity> {
        match self {
            QuantityText::Column(name) => Ok(Quantity::Column(Column::new(name))),
            QuantityText::Predicate(predicate) => predicate.quantity(at),
        }
    }
}

impl<'de> Deserialize<'de> for QuantityText {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        deserializer.deserialize_any(QuantityVisitor)
    }
}

struct QuantityVisitor;

impl<'de> Visitor<'de> for QuantityVisitor {
    type Value = QuantityText;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a column's name, or a share such as { outcome: diverged }")
    }

    fn visit_str<E: Error>(self, name: &str) -> std::result::Result<QuantityText, E> {
        Ok(QuantityText::Column(name.to_string()))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<QuantityText, A::Error> {
        PredicateText::deserialize(MapAccessDeserializer::new(map)).map(QuantityText::Predicate)
    }
}

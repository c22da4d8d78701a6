//! The vocabulary of `expect:`: what the rows of a sweep are expected to say. How it is judged is in `check/`.

use super::checks::Result;
use super::error::{ExperimentError, number};
use super::filter::Filter;
use super::key_path::{KeyPath, Path};
use super::predicate::{Bounds, Column, Predicate, PredicateText, Quantity, QuantityText};
use super::tree::{Mapping, Value};
use super::value_de::from_value;

/// One item of the list `expect:`.
#[derive(Clone, Debug, PartialEq)]
pub struct Expectation {
    pub what: What,
    /// The rows that it is about: `where`.
    pub rows: Filter,
    pub why: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub enum What {
    /// Every row's value, or a quantile of them; with `within`, of their absolute values.
    Column { column: Column, quantile: Option<f64>, bounds: Bounds },
    /// Share of the rows.
    Fraction { of: Predicate, bounds: Bounds },
    /// Trend along an axis, pooled over the other axes: Cochran–Armitage for shares, Mann–Kendall for numbers;
    /// one-sided.
    Trend { of: Quantity, along: String, rising: bool, p_max: f64 },
    /// Slope of log column against log axis, in every cell of the other axes.
    Order { column: Column, against: String, bounds: Bounds },
    /// One value in every cell of the other axes, to a difference relative to the largest.
    Equal { column: String, across: String, within_rel: f64 },
    /// Mean (or quantile) of a column, or a share, in some rows against others.
    Compare { how: Comparison, quantity: Quantity, quantile: Option<f64>, of: Filter, to: Filter, bounds: Bounds },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    Ratio,
    Difference,
}

impl Comparison {
    pub fn name(self) -> &'static str {
        match self {
            Comparison::Ratio => "ratio",
            Comparison::Difference => "difference",
        }
    }

    pub fn sign(self) -> &'static str {
        match self {
            Comparison::Ratio => "/",
            Comparison::Difference => "−",
        }
    }
}

/// The keys of an item as they are written.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Expect {
    column: Option<String>,
    fraction: Option<PredicateText>,
    trend: Option<QuantityText>,
    order: Option<String>,
    equal: Option<String>,
    ratio: Option<QuantityText>,
    difference: Option<QuantityText>,
    r#where: Option<Value>,
    min: Option<f64>,
    max: Option<f64>,
    above: Option<f64>,
    below: Option<f64>,
    within: Option<f64>,
    quantile: Option<f64>,
    along: Option<String>,
    rising: Option<bool>,
    falling: Option<bool>,
    p_max: Option<f64>,
    against: Option<String>,
    between: Option<[f64; 2]>,
    across: Option<String>,
    within_rel: Option<f64>,
    of: Option<Value>,
    to: Option<Value>,
    why: Option<String>,
}

/// Kinds of expectation, each with the keys that it may carry besides `where` and `why`.
const KINDS: [(&str, &[&str]); 7] = [
    ("column", &["min", "max", "above", "below", "between", "within", "quantile"]),
    ("fraction", &["min", "max", "above", "below", "between"]),
    ("trend", &["along", "rising", "falling", "p_max"]),
    ("order", &["against", "between", "min", "max", "above", "below"]),
    ("equal", &["across", "within_rel"]),
    ("ratio", &["of", "to", "min", "max", "above", "below", "between", "quantile"]),
    ("difference", &["of", "to", "min", "max", "above", "below", "between", "within", "quantile"]),
];

/// Keys of bounds, of which a kind takes those that it lists.
const BOUNDS: [&str; 6] = ["min", "max", "above", "below", "between", "within"];

/// The expectations of the list that stands below `expect:`.
///
/// # Errors
/// The first item that is none, with its place.
pub fn read(value: &Value) -> Result<Vec<Expectation>> {
    let base = KeyPath::of_keys(&["expect"]);
    let items: Vec<Value> = from_value(value, &base)?;
    let at = Path::Base(&base);
    items.iter().enumerate().map(|(i, item)| read_one(item, at.item(i, None))).collect()
}

fn read_one(item: &Value, at: Path) -> Result<Expectation> {
    let text: Expect = from_value(item, &at.to_key_path())?;
    let (kind, own) = kind(item, at)?;
    let rows = Filter::read(text.r#where.as_ref(), at.key("where"))?;
    if own.contains(&"min") && !keys_of(item).any(|key| BOUNDS.contains(&key)) {
        let known: Vec<&str> = BOUNDS.into_iter().filter(|key| own.contains(key)).collect();
        return Err(ExperimentError::missing(at.to_key_path(), &format!("a bound ({})", known.join(", "))));
    }
    Ok(Expectation { what: text.what(kind, at)?, rows, why: text.why })
}

/// The one key that says what is expected; every other key must belong to it.
fn kind(item: &Value, at: Path) -> Result<&'static (&'static str, &'static [&'static str])> {
    let keys: Vec<&str> = keys_of(item).collect();
    let mut kinds = KINDS.iter().filter(|(kind, _)| keys.contains(kind));
    let Some(found @ (kind, own)) = kinds.next() else {
        let what = "one of column, fraction, trend, order, equal, ratio, difference";
        return Err(ExperimentError::missing(at.to_key_path(), what));
    };
    let foreign = |key: &&str| key != kind && !["where", "why"].contains(key) && !own.contains(key);
    match keys.iter().copied().find(|key| foreign(key)) {
        None => Ok(found),
        Some(key) => {
            let expected = format!("only keys of `{kind}` ({}, where, why)", own.join(", "));
            Err(ExperimentError::unexpected(at.key(key).to_key_path(), &expected, &format!("`{key}`")))
        }
    }
}

fn keys_of(item: &Value) -> impl Iterator<Item = &str> {
    item.as_mapping().into_iter().flat_map(Mapping::keys).filter_map(Value::as_str)
}

impl Expect {
    fn what(&self, kind: &str, at: Path) -> Result<What> {
        let quantile = self.quantile(at)?;
        Ok(match kind {
            "column" => What::Column {
                column: Column::new(needed(&self.column, at, "column")?),
                quantile,
                bounds: self.bounds(at)?,
            },
            "fraction" => What::Fraction {
                of: needed(&self.fraction, at, "fraction")?.read(at.key("fraction"))?,
                bounds: self.share(at)?,
            },
            "trend" => What::Trend {
                of: needed(&self.trend, at, "trend")?.read(at.key("trend"))?,
                along: needed(&self.along, at, "along")?.clone(),
                rising: self.is_rising(at)?,
                p_max: self.p_max(at)?,
            },
            "order" => What::Order {
                column: Column::new(needed(&self.order, at, "order")?),
                against: needed(&self.against, at, "against")?.clone(),
                bounds: self.bounds(at)?,
            },
            "equal" => What::Equal {
                column: needed(&self.equal, at, "equal")?.clone(),
                across: needed(&self.across, at, "across")?.clone(),
                within_rel: self.within_rel(at)?,
            },
            "ratio" => self.compare(Comparison::Ratio, needed(&self.ratio, at, "ratio")?.read(at.key("ratio"))?, at)?,
            _ => {
                let quantity = needed(&self.difference, at, "difference")?.read(at.key("difference"))?;
                self.compare(Comparison::Difference, quantity, at)?
            }
        })
    }

    fn compare(&self, how: Comparison, quantity: Quantity, at: Path) -> Result<What> {
        let of = Filter::read(Some(needed(&self.of, at, "of")?), at.key("of"))?;
        let to = Filter::read(Some(needed(&self.to, at, "to")?), at.key("to"))?;
        Ok(What::Compare { how, quantity, quantile: self.quantile(at)?, of, to, bounds: self.bounds(at)? })
    }

    /// `between: [min, max]` is short for both.
    fn bounds(&self, at: Path) -> Result<Bounds> {
        let Expect { min, max, above, below, within, .. } = *self;
        let mut bounds = Bounds { min, max, above, below, within };
        if let Some([low, high]) = self.between {
            if low > high || !bounds.is_none() {
                let others: String = bounds.given().map(|(key, _)| format!(" and `{key}`")).collect();
                let found = format!("[{}, {}]{others}", number(low), number(high));
                let expected = "[min, max], without other bounds beside it";
                return Err(ExperimentError::unexpected(at.key("between").to_key_path(), expected, &found));
            }
            bounds = Bounds { min: Some(low), max: Some(high), ..bounds };
        }
        bounds.check(at)?;
        Ok(bounds)
    }

    fn share(&self, at: Path) -> Result<Bounds> {
        let bounds = self.bounds(at)?;
        bounds.check_share(at)?;
        Ok(bounds)
    }

    fn is_rising(&self, at: Path) -> Result<bool> {
        match (self.rising, self.falling) {
            (Some(true), None | Some(false)) => Ok(true),
            (None | Some(false), Some(true)) => Ok(false),
            (None, None) => Err(ExperimentError::missing(at.to_key_path(), "`rising: true` or `falling: true`")),
            _ => {
                let found = format!("rising: {:?}, falling: {:?}", self.rising, self.falling);
                let found = found.replace("Some(", "").replace(')', "").replace("None", "nothing");
                let key = if self.rising.is_some() { "rising" } else { "falling" };
                let expected = "one of `rising: true` and `falling: true`";
                Err(ExperimentError::unexpected(at.key(key).to_key_path(), expected, &found))
            }
        }
    }

    /// 0.01: in a hundred experiments without any trend one would show it by chance.
    fn p_max(&self, at: Path) -> Result<f64> {
        let p = self.p_max.unwrap_or(0.01);
        if p > 0.0 && p < 1.0 {
            return Ok(p);
        }
        Err(ExperimentError::unexpected(at.key("p_max").to_key_path(), "a probability between 0 and 1", &number(p)))
    }

    /// 0, bit for bit, unless a tolerance is given.
    fn within_rel(&self, at: Path) -> Result<f64> {
        let within = self.within_rel.unwrap_or(0.0);
        if within >= 0.0 {
            return Ok(within);
        }
        let path = at.key("within_rel").to_key_path();
        Err(ExperimentError::unexpected(path, "a number of at least 0", &number(within)))
    }

    fn quantile(&self, at: Path) -> Result<Option<f64>> {
        match self.quantile.filter(|q| !(0.0..=1.0).contains(q)) {
            None => Ok(self.quantile),
            Some(q) => {
                Err(ExperimentError::unexpected(at.key("quantile").to_key_path(), "a share from 0 to 1", &number(q)))
            }
        }
    }
}

fn needed<'a, T>(value: &'a Option<T>, at: Path, key: &str) -> Result<&'a T> {
    value.as_ref().ok_or_else(|| ExperimentError::missing(at.key(key).to_key_path(), ""))
}

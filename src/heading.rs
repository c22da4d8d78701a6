//! Headings of a table's columns. `columns!` makes them from the lines that declare a row's fields, so that a column
//! stands in one place.

use crate::shared::Shared;
use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

/// Kind of the cells of a column; any of them may be null.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CellKind {
    Text,
    /// A whole number.
    Count,
    Number,
}

impl CellKind {
    pub fn word(self) -> &'static str {
        match self {
            CellKind::Text => "text",
            CellKind::Count => "count",
            CellKind::Number => "number",
        }
    }
}

/// One column, or the columns of a vector's components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heading {
    /// Name of the column; `<body>.` at the start stands for each body's name.
    pub name: &'static str,
    /// Names of the components, each a column `name.part`; where there are none, the name is the column.
    pub parts: &'static [&'static str],
    pub kind: CellKind,
    /// Whether the number is relative and has a sign, so that a bound on one side lets any size pass on the other.
    pub signed: bool,
    /// What is better, of numbers of which the smaller is the better one.
    pub aim: Option<Aim>,
    /// Meaning of the number, in whole sentences.
    pub meaning: &'static str,
}

/// Why the smaller of two numbers, whatever their signs, is the better one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Aim {
    /// It is an error, or a fault; up to this size it is rounding, or none. Of a column with a unit the size is
    /// relative to the bodies' size and the time of the run.
    Small { floor: f64 },
    /// It is what a run costs.
    Cheap,
}

/// Beginning of a name that belongs to each body.
pub const EACH_BODY: &str = "<body>";

impl Heading {
    /// A heading of one column; `meaning` as a doc comment has it, with a space before every line.
    pub const fn new(name: &'static str, kind: CellKind, meaning: &'static str) -> Self {
        Heading { name, parts: &[], kind, signed: false, aim: None, meaning: meaning.trim_ascii() }
    }

    pub const fn signed(self) -> Self {
        Heading { signed: true, ..self }
    }

    /// The heading of an error: the smaller the better, down to this size.
    pub const fn small(self, floor: f64) -> Self {
        Heading { aim: Some(Aim::Small { floor }), ..self }
    }

    /// The heading of a cost: the smaller the better.
    pub const fn cheap(self) -> Self {
        Heading { aim: Some(Aim::Cheap), ..self }
    }

    pub const fn with_parts(self, parts: &'static [&'static str]) -> Self {
        Heading { parts, ..self }
    }

    /// Names of its columns as they stand here; the name itself, if it has no parts.
    pub fn names(&self) -> Vec<String> {
        match self.parts {
            [] => vec![self.name.to_string()],
            parts => parts.iter().map(|part| format!("{}.{part}", self.name)).collect(),
        }
    }

    /// Names of its columns for one body.
    pub fn names_of(&self, body: &str) -> Vec<String> {
        self.names().iter().map(|name| name.replacen(EACH_BODY, body, 1)).collect()
    }

    /// Whether a body's column, or vector, stands under this heading.
    pub fn is_of_a_body(&self, name: &str) -> bool {
        self.name.strip_prefix(EACH_BODY).is_some_and(|own| name.ends_with(own))
    }

    /// The unit that its name ends with; empty for texts, counts and ratios.
    pub fn unit(&self) -> &'static str {
        unit_of(self.name)
    }
}

/// The unit that the name of a column, or the path of an axis, ends with, whatever component stands behind it; empty
/// for texts, counts and ratios.
pub fn unit_of(name: &str) -> &'static str {
    let ends = |name: &str| UNITS.iter().find(|(ending, _)| name.ends_with(ending)).map(|(_, unit)| *unit);
    ends(name).or_else(|| ends(name.rsplit_once('.')?.0)).unwrap_or_default()
}

/// Endings of names with their units, the longer before its own ending.
const UNITS: [(&str, &str); 17] = [
    ("_m_s2", "m/s²"),
    ("_kg_m3", "kg/m³"),
    ("stiffness_n_m", "N/m"),
    ("torque_n_m", "N m"),
    ("_n_s_m", "N s/m"),
    ("_n", "N"),
    ("_deg", "°"),
    ("_mb", "MB"),
    ("_rad_s", "rad/s"),
    ("_m_s", "m/s"),
    ("_kg_m2", "kg m²"),
    ("_1_kg", "1/kg"),
    ("_kg", "kg"),
    ("_rad", "rad"),
    ("_m", "m"),
    ("_s", "s"),
    ("_j", "J"),
];

/// As lists show it, the unit written out.
impl Serialize for Heading {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Shown<'a> {
            name: &'a str,
            parts: &'a [&'a str],
            kind: CellKind,
            unit: &'a str,
            signed: bool,
            aim: Option<Aim>,
            meaning: &'a str,
        }
        let Heading { name, parts, kind, signed, aim, meaning } = *self;
        Shown { name, parts, kind, unit: self.unit(), signed, aim, meaning }.serialize(serializer)
    }
}

/// Content of a cell, borrowed from its row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Datum<'a> {
    Null,
    Text(&'a str),
    Count(u64),
    Number(f64),
    /// Of a column that only some experiments have.
    Other(&'a Value),
}

impl Datum<'_> {
    /// The number in it, if there is one.
    pub fn as_f64(self) -> Option<f64> {
        match self {
            Datum::Count(count) => Some(count as f64),
            Datum::Number(x) => Some(x),
            Datum::Other(value) => value.as_f64(),
            Datum::Null | Datum::Text(_) => None,
        }
    }

    /// The whole number in it, if there is one.
    pub fn as_i64(self) -> Option<i64> {
        match self {
            Datum::Count(count) => i64::try_from(count).ok(),
            Datum::Other(value) => value.as_i64(),
            Datum::Null | Datum::Text(_) | Datum::Number(_) => None,
        }
    }

    /// Appends its JSON.
    pub fn write_json(self, to: &mut Vec<u8>) {
        // Writing into memory cannot fail, and JSON has all of these.
        let _ = match self {
            Datum::Null => serde_json::to_writer(to, &()),
            Datum::Text(text) => serde_json::to_writer(to, text),
            Datum::Count(count) => serde_json::to_writer(to, &count),
            Datum::Number(x) => serde_json::to_writer(to, &x),
            Datum::Other(value) => serde_json::to_writer(to, value),
        };
    }

    /// Appends its text as tables have it: null is nothing, and texts are without quotes.
    pub fn write_text(self, to: &mut Vec<u8>) {
        match self {
            Datum::Null | Datum::Other(Value::Null) => {}
            Datum::Text(text) => to.extend_from_slice(text.as_bytes()),
            Datum::Other(Value::String(text)) => to.extend_from_slice(text.as_bytes()),
            Datum::Count(_) | Datum::Number(_) | Datum::Other(_) => self.write_json(to),
        }
    }
}

/// A type of a field that is one cell.
pub trait InCell {
    const KIND: CellKind;

    fn cell(&self) -> Datum<'_>;
}

impl InCell for String {
    const KIND: CellKind = CellKind::Text;

    fn cell(&self) -> Datum<'_> {
        Datum::Text(self)
    }
}

impl InCell for u64 {
    const KIND: CellKind = CellKind::Count;

    fn cell(&self) -> Datum<'_> {
        Datum::Count(*self)
    }
}

impl InCell for f64 {
    const KIND: CellKind = CellKind::Number;

    /// A number that JSON cannot hold is null there, too.
    fn cell(&self) -> Datum<'_> {
        if self.is_finite() { Datum::Number(*self) } else { Datum::Null }
    }
}

impl<T: InCell> InCell for Option<T> {
    const KIND: CellKind = T::KIND;

    fn cell(&self) -> Datum<'_> {
        self.as_ref().map_or(Datum::Null, T::cell)
    }
}

/// A row, or a part of one.
pub trait Headings {
    /// Headings in the order in which serde writes the fields.
    fn headings() -> Vec<Heading>;

    /// Shows the cells in the same order, each with the name of its column.
    fn each_cell<'a>(&'a self, visit: &mut dyn FnMut(&'a str, Datum<'a>));
}

/// Columns whose names are known only when an experiment is there.
impl Headings for Map<String, Value> {
    fn headings() -> Vec<Heading> {
        Vec::new()
    }

    fn each_cell<'a>(&'a self, visit: &mut dyn FnMut(&'a str, Datum<'a>)) {
        self.iter().for_each(|(name, value)| visit(name, Datum::Other(value)));
    }
}

impl<T: Headings> Headings for Shared<T> {
    fn headings() -> Vec<Heading> {
        T::headings()
    }

    fn each_cell<'a>(&'a self, visit: &mut dyn FnMut(&'a str, Datum<'a>)) {
        T::each_cell(self, visit);
    }
}

/// Declares a struct whose fields are the columns of a table, and lists them: a field's doc comment is the column's
/// meaning, its type the kind, `#[serde(rename)]` another name for it, `#[column(…)]` what `Heading` has a word for:
/// `signed`, a relative number with a sign, `small = 1e-12`, an error with its floor, `cheap`, a cost; a field with
/// `#[serde(flatten)]` has columns of its own.
macro_rules! columns {
    (
        $(#[$on_struct:meta])*
        pub struct $row:ident {
            $(
                $(#[doc = $meaning:literal])+ $(#[serde($($how:tt)+)])?
                $(#[column($($word:ident $(= $floor:literal)?),+)])?
                pub $field:ident: $type:ty,
            )+
        }
    ) => {
        $(#[$on_struct])*
        pub struct $row {
            $($(#[doc = $meaning])+ $(#[serde($($how)+)])? pub $field: $type,)+
        }

        impl $crate::heading::Headings for $row {
            fn headings() -> Vec<$crate::heading::Heading> {
                [$(
                    $crate::heading::columns!(
                        @of $field, $type, concat!($($meaning),+), [$($($how)+)?], [$($($word $(= $floor)?),+)?]
                    )
                ),+].concat()
            }

            fn each_cell<'a>(&'a self, visit: &mut dyn FnMut(&'a str, $crate::heading::Datum<'a>)) {
                $($crate::heading::columns!(@cell self, visit, $field, $type, [$($($how)+)?]);)+
            }
        }
    };
    (@cell $self:ident, $visit:ident, $field:ident, $type:ty, [flatten]) => {
        <$type as $crate::heading::Headings>::each_cell(&$self.$field, $visit)
    };
    (@cell $self:ident, $visit:ident, $field:ident, $type:ty, [rename = $name:literal]) => {
        $visit($name, $crate::heading::InCell::cell(&$self.$field))
    };
    (@cell $self:ident, $visit:ident, $field:ident, $type:ty, []) => {
        $visit(stringify!($field), $crate::heading::InCell::cell(&$self.$field))
    };
    (@of $field:ident, $type:ty, $meaning:expr, [flatten], []) => {
        <$type as $crate::heading::Headings>::headings()
    };
    (@of $field:ident, $type:ty, $meaning:expr, [rename = $name:literal], [$($words:tt)*]) => {
        $crate::heading::columns!(@one $name, $type, $meaning, [$($words)*])
    };
    (@of $field:ident, $type:ty, $meaning:expr, [], [$($words:tt)*]) => {
        $crate::heading::columns!(@one stringify!($field), $type, $meaning, [$($words)*])
    };
    (@one $name:expr, $type:ty, $meaning:expr, [$($word:ident $(= $floor:literal)?),*]) => {
        vec![
            $crate::heading::Heading::new($name, <$type as $crate::heading::InCell>::KIND, $meaning)
                $(.$word($($floor)?))*
        ]
    };
}

pub(crate) use columns;

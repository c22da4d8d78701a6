//! The two values that are written either short or in full; read by hand, because serde's `untagged` would answer a
//! slip with «did not match any variant».

use super::types::{Inertia, NodesPerEdge};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Unexpected, Visitor};
use std::fmt;

impl<'de> Deserialize<'de> for NodesPerEdge {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NodesVisitor)
    }
}

struct NodesVisitor;

impl<'de> Visitor<'de> for NodesVisitor {
    type Value = NodesPerEdge;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a whole number or a list of three")
    }

    fn visit_u64<E: Error>(self, n: u64) -> Result<NodesPerEdge, E> {
        u32::try_from(n).map(NodesPerEdge::Shortest).map_err(|_| E::invalid_value(Unexpected::Unsigned(n), &self))
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<NodesPerEdge, E> {
        let is_whole = x.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&x);
        if is_whole { Ok(NodesPerEdge::Shortest(x as u32)) } else { Err(E::invalid_value(Unexpected::Float(x), &self)) }
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<NodesPerEdge, A::Error> {
        let mut counts = Vec::new();
        while let Some(count) = seq.next_element::<u32>()? {
            counts.push(count);
        }
        let len = counts.len();
        counts.try_into().map(NodesPerEdge::Each).map_err(|_| A::Error::invalid_length(len, &self))
    }
}

impl<'de> Deserialize<'de> for Inertia {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(InertiaVisitor)
    }
}

struct InertiaVisitor;

impl<'de> Visitor<'de> for InertiaVisitor {
    type Value = Inertia;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("three principal moments or three rows of three")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Inertia, A::Error> {
        let (mut moments, mut rows) = (Vec::new(), Vec::new());
        while let Some(entry) = seq.next_element()? {
            match entry {
                Entry::Moment(moment) => moments.push(moment),
                Entry::Row(row) => rows.push(row),
            }
        }
        let len = moments.len() + rows.len();
        match (<[f64; 3]>::try_from(moments), <[[f64; 3]; 3]>::try_from(rows)) {
            (Ok(moments), Err(rows)) if rows.is_empty() => Ok(Inertia::Principal(moments)),
            (Err(moments), Ok(rows)) if moments.is_empty() => Ok(Inertia::Full(rows)),
            _ => Err(A::Error::invalid_length(len, &self)),
        }
    }
}

/// One item of an inertia: a moment, or a row of the matrix.
enum Entry {
    Moment(f64),
    Row([f64; 3]),
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EntryVisitor)
    }
}

struct EntryVisitor;

impl<'de> Visitor<'de> for EntryVisitor {
    type Value = Entry;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a number or a row of three numbers")
    }

    fn visit_f64<E: Error>(self, x: f64) -> Result<Entry, E> {
        Ok(Entry::Moment(x))
    }

    fn visit_u64<E: Error>(self, n: u64) -> Result<Entry, E> {
        Ok(Entry::Moment(n as f64))
    }

    fn visit_i64<E: Error>(self, n: i64) -> Result<Entry, E> {
        Ok(Entry::Moment(n as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Entry, A::Error> {
        let mut row = Vec::new();
        while let Some(x) = seq.next_element::<f64>()? {
            row.push(x);
        }
        let len = row.len();
        row.try_into().map(Entry::Row).map_err(|_| A::Error::invalid_length(len, &self))
    }
}

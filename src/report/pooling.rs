//! Many values of an axis as few: neighbours together, of words the last ones.

use super::subject::{Ground, Levels};
use std::borrow::Cow;

/// Groups of levels, at most so many: their names, and the group of each level.
pub fn groups(axis: &Levels, most: usize) -> (Vec<String>, Vec<usize>) {
    let n = axis.len();
    if n <= most {
        return (axis.labels.clone(), (0..n).collect());
    }
    if axis.numbers.is_none() {
        // Words have no neighbours.
        let mut names: Vec<String> = axis.labels[..most - 1].to_vec();
        names.push(format!("{} others", n - most + 1));
        return (names, (0..n).map(|i| i.min(most - 1)).collect());
    }
    let group: Vec<usize> = (0..n).map(|i| i * most / n).collect();
    // Groups are of neighbours: each begins where the one before ends.
    let first = |g: usize| group.partition_point(|other| *other < g);
    let name = |g: usize| {
        let (first, last) = (first(g), first(g + 1) - 1);
        if first == last {
            axis.labels[first].clone()
        } else {
            format!("{}…{}", axis.labels[first], axis.labels[last])
        }
    };
    ((0..most).map(name).collect(), group)
}

impl<'a> Ground<'a> {
    /// The same ground with at most so many values on an axis that is drawn: a line needs no more places, and a page
    /// has no room for a hundred thousand points.
    pub fn pooled(&self, most: usize) -> Cow<'_, Ground<'a>> {
        let is_long = |axis: &Levels| axis.len() > most && !axis.is_of_seeds();
        if !self.axes.iter().any(is_long) {
            return Cow::Borrowed(self);
        }
        let axis = |axis: &Levels| if is_long(axis) { pooled(axis, most) } else { axis.clone() };
        Cow::Owned(Ground { subject: self.subject, axes: self.axes.iter().map(axis).collect() })
    }
}

/// An axis of groups: of numbers each is at its middle, in the logarithm where the axis is.
fn pooled(axis: &Levels, most: usize) -> Levels {
    let (names, group) = groups(axis, most);
    let is_log = axis.is_logarithmic();
    let middle = |members: &[f64]| {
        let mean = members.iter().map(|x| if is_log { libm::log(*x) } else { *x }).sum::<f64>() / members.len() as f64;
        if is_log { libm::exp(mean) } else { mean }
    };
    let middles = |numbers: &Vec<f64>| -> Vec<f64> {
        let first = |g: usize| group.partition_point(|other| *other < g);
        (0..names.len()).map(|g| middle(&numbers[first(g)..first(g + 1)])).collect()
    };
    Levels {
        numbers: axis.numbers.as_ref().map(middles),
        labels: names.clone(),
        names,
        of_row: axis.of_row.iter().map(|level| level.map(|level| group[level as usize] as u32)).collect(),
        pooled_from: Some(axis.len()),
        ..axis.clone()
    }
}

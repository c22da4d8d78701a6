//! A direction that parts two solids, and by how much.

use super::posed::{Posed, gap_along_m};
use nalgebra::Vector3;

/// What parts two solids best.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parting {
    /// Negative: the shortest translation that parts them. Positive: they are apart by at least as much.
    pub gap_m: f64,
    /// Unit, from b to a: a plane across it has the two on its sides, with that gap.
    pub normal: Vector3<f64>,
}

impl Parting {
    /// Seen from a.
    pub fn flipped(self) -> Self {
        Parting { normal: -self.normal, ..self }
    }
}

/// The parting across a unit vector from b to a.
pub fn along_m(a: &Posed, b: &Posed, normal: &Vector3<f64>) -> Parting {
    Parting { gap_m: gap_along_m(a, b, normal), normal: *normal }
}

/// The one with the larger gap.
pub fn better(one: Parting, other: Parting) -> Parting {
    if other.gap_m > one.gap_m { other } else { one }
}

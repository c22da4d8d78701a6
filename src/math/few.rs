//! Lists that are mostly short: kept in place up to a few elements, so that small problems need no allocator.

use nalgebra::Vector6;
use smallvec::SmallVec;
use std::ops::{Index, IndexMut};

/// Elements of which there are mostly no more than eight, a contact each.
pub type Few<T> = SmallVec<[T; 8]>;

/// Elements of which there are often but one or two, a body each.
pub type OneOrTwo<T> = SmallVec<[T; 2]>;

/// A vector of six numbers a body.
#[derive(Clone, Debug, Default)]
pub struct BlockVector(OneOrTwo<Vector6<f64>>);

impl BlockVector {
    /// Zeros for so many bodies.
    pub fn zeros(bodies: usize) -> Self {
        BlockVector(SmallVec::from_elem(Vector6::zeros(), bodies))
    }

    /// Number of bodies.
    pub fn bodies(&self) -> usize {
        self.0.len()
    }

    /// `self += other · part`.
    pub fn add_scaled(&mut self, other: &BlockVector, part: f64) {
        self.0.iter_mut().zip(&other.0).for_each(|(own, other)| *own += other * part);
    }

    /// The same without changing this one.
    pub fn plus_scaled(&self, other: &BlockVector, part: f64) -> Self {
        BlockVector(self.0.iter().zip(&other.0).map(|(own, other)| own + other * part).collect())
    }

    pub fn minus(&self, other: &BlockVector) -> Self {
        BlockVector(self.0.iter().zip(&other.0).map(|(own, other)| own - other).collect())
    }

    pub fn plus(&self, other: &BlockVector) -> Self {
        BlockVector(self.0.iter().zip(&other.0).map(|(own, other)| own + other).collect())
    }

    pub fn negative(&self) -> Self {
        BlockVector(self.0.iter().map(|own| -own).collect())
    }

    /// Euclidean norm.
    pub fn norm(&self) -> f64 {
        self.0.iter().map(|own| own.norm_squared()).sum::<f64>().sqrt()
    }

    /// The largest absolute value.
    pub fn amax(&self) -> f64 {
        self.0.iter().map(|own| own.amax()).fold(0.0, f64::max)
    }

    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|own| own.iter().all(|x| x.is_finite()))
    }
}

impl Index<usize> for BlockVector {
    type Output = Vector6<f64>;

    fn index(&self, body: usize) -> &Vector6<f64> {
        &self.0[body]
    }
}

impl IndexMut<usize> for BlockVector {
    fn index_mut(&mut self, body: usize) -> &mut Vector6<f64> {
        &mut self.0[body]
    }
}

//! Sparse linear systems of 6×6 blocks, a block a pair of bodies in contact: LU factors in the order of least degree
//! (W. F. Tinney, J. W. Walker, Proc. IEEE 55 (1967) 1801), found once a pattern.
//!
//! The pattern is symmetric, the numbers need not be. Rows are exchanged within a body's own six only: the systems here
//! are E + Gᵀ D G, whose blocks on the diagonal hold what their body's contacts add. Own code, as libraries for it
//! choose their vector instructions, and with them their rounding, by the machine.

use super::few::{BlockVector, OneOrTwo};
use super::lu6::Lu6;
use crate::deadline::Deadline;
use nalgebra::{Matrix6, Vector6};
use smallvec::{SmallVec, smallvec};

/// Places of the blocks that the factors have.
#[derive(Clone, Debug, Default)]
pub struct Pattern {
    /// Place of every body in the order of elimination.
    place: OneOrTwo<usize>,
    /// Later places that every place is coupled with, ascending, and where its blocks begin among all.
    later: OneOrTwo<Vec<usize>>,
    first: OneOrTwo<usize>,
    /// Number of blocks above the diagonal.
    blocks: usize,
}

impl Pattern {
    /// Pattern of a number of bodies; `pairs` are those that are coupled.
    pub fn new(bodies: usize, pairs: impl Iterator<Item = (usize, usize)>) -> Self {
        Pattern::within(bodies, pairs, usize::MAX).unwrap_or_default()
    }

    /// The same; None where factors take more products of blocks.
    pub fn within(bodies: usize, pairs: impl Iterator<Item = (usize, usize)>, most_products: usize) -> Option<Self> {
        if bodies == 1 {
            return Some(Pattern { place: smallvec![0], later: smallvec![Vec::new()], first: smallvec![0], blocks: 0 });
        }
        let mut products = 0;
        let mut near = vec![std::collections::BTreeSet::new(); bodies];
        for (a, b) in pairs.filter(|(a, b)| a != b) {
            near[a].insert(b);
            near[b].insert(a);
        }
        let (mut place, mut fronts) = (OneOrTwo::from_elem(usize::MAX, bodies), Vec::with_capacity(bodies));
        for now in 0..bodies {
            let left = (0..bodies).filter(|body| place[*body] == usize::MAX);
            let Some(body) = left.min_by_key(|body| near[*body].len()) else { break };
            place[body] = now;
            let front = std::mem::take(&mut near[body]);
            products += front.len() * (front.len() + 1);
            if products > most_products {
                return None;
            }
            for a in &front {
                near[*a].remove(&body);
                near[*a].extend(front.iter().filter(|b| *b != a));
            }
            fronts.push(front);
        }
        let ascending = |front: &std::collections::BTreeSet<usize>| {
            let mut later: Vec<usize> = front.iter().map(|body| place[*body]).collect();
            later.sort_unstable();
            later
        };
        let later: OneOrTwo<Vec<usize>> = fronts.iter().map(ascending).collect();
        let before = |blocks: &mut usize, later: &Vec<usize>| {
            *blocks += later.len();
            Some(*blocks - later.len())
        };
        let first: OneOrTwo<usize> = later.iter().scan(0, before).collect();
        let blocks = later.iter().map(Vec::len).sum();
        Some(Pattern { place, later, first, blocks })
    }

    /// Place of the block of places i < j.
    fn slot(&self, i: usize, j: usize) -> usize {
        self.first[i] + self.later[i].partition_point(|later| *later < j)
    }
}

/// A matrix of a pattern.
pub struct BlockMatrix<'a> {
    pattern: &'a Pattern,
    diagonal: SmallVec<[Matrix6<f64>; 1]>,
    upper: Vec<Matrix6<f64>>,
    lower: Vec<Matrix6<f64>>,
}

impl<'a> BlockMatrix<'a> {
    /// Identity times `on_diagonal`.
    pub fn diagonal(pattern: &'a Pattern, on_diagonal: f64) -> Self {
        let zeros = vec![Matrix6::zeros(); pattern.blocks];
        let diagonal = SmallVec::from_elem(Matrix6::identity() * on_diagonal, pattern.place.len());
        BlockMatrix { pattern, diagonal, upper: zeros.clone(), lower: zeros }
    }

    /// The block of two bodies that are coupled.
    pub fn block(&mut self, row: usize, column: usize) -> &mut Matrix6<f64> {
        let (i, j) = (self.pattern.place[row], self.pattern.place[column]);
        match i.cmp(&j) {
            std::cmp::Ordering::Equal => &mut self.diagonal[i],
            std::cmp::Ordering::Less => &mut self.upper[self.pattern.slot(i, j)],
            std::cmp::Ordering::Greater => &mut self.lower[self.pattern.slot(j, i)],
        }
    }

    /// The largest element of the diagonal.
    pub fn largest(&self) -> f64 {
        self.diagonal.iter().map(|block| block.diagonal().amax()).fold(0.0, f64::max)
    }

    pub fn add_on_diagonal(&mut self, value: f64) {
        self.diagonal.iter_mut().for_each(|block| *block += Matrix6::identity() * value);
    }

    /// Solution for a right-hand side; None where the matrix is singular, or time is up.
    pub fn solve(self, right: &BlockVector, deadline: Deadline) -> Option<BlockVector> {
        if let [alone] = &self.diagonal[..] {
            let mut x = BlockVector::zeros(1);
            x[0] = Lu6::new(alone)?.solve(&right[0]);
            return x.is_finite().then_some(x);
        }
        self.factors(deadline)?.solve(right)
    }

    /// Factors of the matrix; None where it is singular, or time is up.
    pub fn factors(mut self, deadline: Deadline) -> Option<Factors<'a>> {
        let pattern = self.pattern;
        let mut pivots = SmallVec::with_capacity(self.diagonal.len());
        for (k, later) in pattern.later.iter().enumerate() {
            if deadline.is_over() {
                return None;
            }
            let pivot = Lu6::new(&self.diagonal[k])?;
            for own in pattern.first[k]..pattern.first[k] + later.len() {
                pivot.solve_all(&mut self.upper[own]);
            }
            for (a, i) in later.iter().enumerate() {
                let (left, above) = (self.lower[pattern.first[k] + a], self.upper[pattern.first[k] + a]);
                self.diagonal[*i] -= left * above;
                // Those later than k and later than i are among those later than i.
                let mut slot = pattern.first[*i];
                for (b, j) in later.iter().enumerate().skip(a + 1) {
                    slot += pattern.later[*i][slot - pattern.first[*i]..].partition_point(|later| later < j);
                    let (L, U) = (self.lower[pattern.first[k] + b], self.upper[pattern.first[k] + b]);
                    self.upper[slot] -= left * U;
                    self.lower[slot] -= L * above;
                }
            }
            pivots.push(pivot);
        }
        Some(Factors { pattern, pivots, upper: self.upper, lower: self.lower })
    }
}

/// Factors L and U, U's diagonal being 1.
pub struct Factors<'a> {
    pattern: &'a Pattern,
    pivots: SmallVec<[Lu6; 1]>,
    upper: Vec<Matrix6<f64>>,
    lower: Vec<Matrix6<f64>>,
}

impl Factors<'_> {
    /// Solution for a right-hand side; None where it is not finite.
    pub fn solve(&self, right: &BlockVector) -> Option<BlockVector> {
        let pattern = self.pattern;
        let mut x: OneOrTwo<Vector6<f64>> = OneOrTwo::from_elem(Vector6::zeros(), pattern.place.len());
        for (body, place) in pattern.place.iter().enumerate() {
            x[*place] = right[body];
        }
        for (k, later) in pattern.later.iter().enumerate() {
            let own = self.pivots[k].solve(&x[k]);
            x[k] = own;
            later.iter().zip(&self.lower[pattern.first[k]..]).for_each(|(i, L)| x[*i] -= L * own);
        }
        for (k, later) in pattern.later.iter().enumerate().rev() {
            let above = later.iter().zip(&self.upper[pattern.first[k]..]).map(|(j, U)| U * x[*j]);
            let above: Vector6<f64> = above.sum();
            x[k] -= above;
        }
        let mut solution = BlockVector::zeros(right.bodies());
        for (body, place) in pattern.place.iter().enumerate() {
            solution[body] = x[*place];
        }
        solution.is_finite().then_some(solution)
    }
}

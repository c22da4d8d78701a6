//! How the contacts of a problem feel each other, through A or through the bodies.

use super::Impulse;
use super::block::Block;
use super::twist::Twist;
use nalgebra::{Matrix3, Vector3};
use std::cell::Ref;

/// How contacts feel each other: c = b + A p.
pub trait Coupling {
    /// c of contact `i` at the present impulses.
    fn velocity(&self, i: usize, block: &Block, p: &[Impulse]) -> Vector3<f64>;
    /// The contact's impulse has changed.
    fn moved(&mut self, block: &Block, change: &Impulse);
}

/// Through A itself.
pub struct Dense<'a> {
    /// Block (i, j) at i L + j.
    pub(super) A_blocks: Ref<'a, Vec<Matrix3<f64>>>,
}

impl Coupling for Dense<'_> {
    #[inline(always)]
    fn velocity(&self, i: usize, block: &Block, p: &[Impulse]) -> Vector3<f64> {
        let row = &self.A_blocks[i * p.len()..][..p.len()];
        row.iter().zip(p).fold(block.b, |c, (A, p)| c + A * p)
    }

    #[inline(always)]
    fn moved(&mut self, _: &Block, _: &Impulse) {}
}

/// Through the bodies' velocities.
pub struct ThroughBodies<'a> {
    /// M⁻¹ Jᵀ p.
    pub(super) u: &'a mut [Twist],
}

impl Coupling for ThroughBodies<'_> {
    fn velocity(&self, _: usize, block: &Block, _: &[Impulse]) -> Vector3<f64> {
        block.velocity(self.u)
    }

    fn moved(&mut self, block: &Block, change: &Impulse) {
        if *change != Impulse::zeros() {
            block.apply(change, self.u);
        }
    }
}

/// Memory of `ThroughBodies` between steps.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    pub(super) u: Vec<Twist>,
}

impl Memory {
    pub fn with_capacity(bodies: usize) -> Self {
        Memory { u: Vec::with_capacity(bodies) }
    }
}

//! The way of an impact in its normal impulse, as data.

use super::super::Impulse;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phase {
    Compression,
    Restitution,
    Over,
}

/// Where the impact has come to.
pub(super) struct Path<'a> {
    pub A: &'a Matrix3<f64>,
    pub friction: f64,
    pub e2: f64,
    pub u: Vector3<f64>,
    pub p: Impulse,
    /// Work that the normal impulse has yet to give back.
    pub store: f64,
    pub phase: Phase,
}

impl Path<'_> {
    pub fn tangents(&self) -> Matrix2<f64> {
        self.A.fixed_view::<2, 2>(1, 1).into_owned()
    }

    /// A_tn.
    pub fn coupling(&self) -> Vector2<f64> {
        Vector2::new(self.A[(1, 0)], self.A[(2, 0)])
    }

    pub fn slip(&self) -> Vector2<f64> {
        Vector2::new(self.u.y, self.u.z)
    }

    pub fn store_rate(&self) -> f64 {
        if self.phase == Phase::Compression { self.e2 } else { 1.0 }
    }
}

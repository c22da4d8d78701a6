//! What contacts did to a body, and parts of a scale.

use nalgebra::Vector3;

/// What the contacts of one step did to a body: Σp and Σ r×p about its centre of mass, world axes.
#[derive(Clone, Copy, Debug)]
pub struct Push {
    pub linear: Vector3<f64>,
    pub angular: Vector3<f64>,
}

impl Push {
    pub(super) const NONE: Push = Push { linear: Vector3::new(0.0, 0.0, 0.0), angular: Vector3::new(0.0, 0.0, 0.0) };
}

/// Part of a scale; 0 if it is no more than the rounding of what it is the difference of: a body at rest has no scale
/// of its own.
pub(super) fn beyond_rounding(amount: f64, of: f64, scale: f64) -> f64 {
    if amount.abs() <= 64.0 * f64::EPSILON * of { 0.0 } else { relative(amount, scale) }
}

/// Part of a scale; 0 of a scale that is 0 as well.
pub(super) fn relative(amount: f64, scale: f64) -> f64 {
    if amount == 0.0 { 0.0 } else { amount / scale }
}

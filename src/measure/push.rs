//! What contacts did to a body, and parts of a scale.

use nalgebra::Vector3;

/// What the contacts of one step did to a body: Σp and Σ r×p about its centre of mass, world axes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Push {
    pub linear: Vector3<f64>,
    pub angular: Vector3<f64>,
    /// Σ|p| and Σ|r×p|.
    pub linear_size: f64,
    pub angular_size: f64,
}

impl Push {
    pub(super) fn add(&mut self, impulse_W: Vector3<f64>, r_W: &Vector3<f64>) {
        let moment = r_W.cross(&impulse_W);
        self.linear += impulse_W;
        self.angular += moment;
        self.linear_size += impulse_W.norm();
        self.angular_size += moment.norm();
    }
}

/// Rounding, of the sizes that an amount is the difference of.
pub(super) const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// Part of a scale; 0 of a scale that is 0 as well.
pub(super) fn relative(amount: f64, scale: f64) -> f64 {
    if amount == 0.0 { 0.0 } else { amount / scale }
}

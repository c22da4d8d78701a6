//! Newton's method for three unknowns: the implicit integrators' equation of one step.

use nalgebra::{Matrix3, Vector3};

/// Root near `start` of a function that comes with its derivative; None if none is found: a step that has no solution
/// must not look like one.
pub fn root(
    start: Vector3<f64>,
    mut at: impl FnMut(&Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>),
) -> Option<Vector3<f64>> {
    /// Most steps. From a start that is right to first order in the step, three or four do.
    const MOST: u32 = 30;
    /// Convergence is quadratic: what is left after a change this small is far below rounding.
    const SMALL: f64 = 1e-10;
    let mut x = start;
    for _ in 0..MOST {
        let (residual, derivative) = at(&x);
        let change = derivative.try_inverse()? * residual;
        x -= change;
        if change.amax() <= SMALL * x.amax() {
            return Some(x);
        }
    }
    None
}

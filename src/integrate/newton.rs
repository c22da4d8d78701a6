//! Newton's method for three unknowns: the implicit integrators' equation of one step.

use nalgebra::{Matrix3, Vector3};

/// The root near `start` of a function that comes with its derivative; not a number if there is none: a step that has
/// no solution must not look like one.
pub fn root(start: Vector3<f64>, mut at: impl FnMut(&Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>)) -> Vector3<f64> {
    /// From a start that is right to first order in the step, three or four do.
    const MOST: u32 = 30;
    /// Convergence is quadratic: what is left after a change this small is far below rounding.
    const SMALL: f64 = 1e-10;
    let mut x = start;
    for _ in 0..MOST {
        let (residual, derivative) = at(&x);
        let Some(inverse) = derivative.try_inverse() else { break };
        let change = inverse * residual;
        x -= change;
        if change.amax() <= SMALL * x.amax() {
            return x;
        }
    }
    Vector3::repeat(f64::NAN)
}

//! Friction of one contact whose normal impulse is given: the tangent impulse within its disc.

use nalgebra::{Matrix2, Vector2};

/// Newton's iteration ends after 5.
const MOST: usize = 100;

/// The x of least ½ xᵀ S x − dᵀ x within |x| ≤ `radius`; S positive.
///
/// On the rim (S + α) x = d with α > 0. 1/|x(α)| is concave and nearly linear, so that Newton's method for it comes
/// from α = 0 without a step too far (J. Moré, D. Sorensen, SIAM J. Sci. Stat. Comput. 4 (1983) 553).
pub fn least(S: &Matrix2<f64>, d: &Vector2<f64>, radius: f64) -> Vector2<f64> {
    if radius <= 0.0 {
        return Vector2::zeros();
    }
    // A block of too small a rank gets what rounding leaves of a row.
    let mut alpha = 4.0 * f64::EPSILON * S.trace();
    let mut x = solve(S, alpha, d);
    let mut length = x.norm();
    if length <= radius {
        return x;
    }
    for _ in 0..MOST {
        if length <= radius * (1.0 + f64::EPSILON) {
            break;
        }
        let on = length * length * (length / radius - 1.0) / x.dot(&solve(S, alpha, &x));
        if alpha + on == alpha {
            break;
        }
        alpha += on;
        x = solve(S, alpha, d);
        length = x.norm();
    }
    x * (radius / length)
}

/// (S + α)⁻¹ d.
fn solve(S: &Matrix2<f64>, alpha: f64, d: &Vector2<f64>) -> Vector2<f64> {
    let (a, b, c) = (S[(0, 0)] + alpha, S[(1, 1)] + alpha, S[(0, 1)]);
    Vector2::new(b * d.x - c * d.y, a * d.y - c * d.x) / (a * b - c * c)
}

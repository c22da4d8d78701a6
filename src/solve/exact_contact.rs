//! One contact solved exactly, the others given: the step of nonlinear Gauss–Seidel (F. Jourdan, P. Alart, M. Jean,
//! Comput. Methods Appl. Mech. Engrg. 155 (1998) 31).
//!
//! With the velocity q that the contact would have without its own impulse, u = q + A p has three cases: it separates
//! (p = 0), sticks (u = 0), or slips: u_n = 0, |p_t| = μ p_n, u_t = −α p_t, α > 0. Without p_n the last reads
//! (S + α) p_t = d with S = A_tt − w wᵀ/A_nn, w = A_tn; α is the root of μ p_n / |p_t| = 1 (at 0 this is the sticking
//! impulse, too flat; for α → ∞ it is the frictionless one, too steep: there is a root for every μ).

use super::{Impulse, corrected};
use crate::experiment::types::Cone;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// Newton's iteration ends after 5; bisection, its guard, halves all 53 bits.
const MOST: usize = 100;

/// The impulse of a contact with the 3×3 block `A` of A, now at velocity `c` with impulse `p`.
pub fn solve(A: &Matrix3<f64>, c: &Vector3<f64>, p: &Impulse, friction: f64) -> Impulse {
    let q = c - A * p;
    if q.x >= 0.0 {
        return Impulse::zeros();
    }
    if friction == 0.0 {
        return Impulse::new(-q.x / A[(0, 0)], 0.0, 0.0);
    }
    let slipping = Slipping::new(A, &q);
    let sticking = slipping.at(0.0);
    if sticking.slip <= friction * sticking.normal {
        return sticking.impulse();
    }
    slipping.root(friction)
}

/// The tangent rows after the normal row has been eliminated.
struct Slipping {
    S: Matrix2<f64>,
    d: Vector2<f64>,
    w: Vector2<f64>,
    A_nn: f64,
    q_n: f64,
}

/// Impulse at one α and its derivatives.
struct At {
    normal: f64,
    tangent: Vector2<f64>,
    /// |p_t|.
    slip: f64,
    d_normal: f64,
    d_slip: f64,
}

impl At {
    fn impulse(&self) -> Impulse {
        Impulse::new(self.normal, self.tangent.x, self.tangent.y)
    }
}

impl Slipping {
    fn new(A: &Matrix3<f64>, q: &Vector3<f64>) -> Self {
        let w = Vector2::new(A[(1, 0)], A[(2, 0)]);
        let A_nn = A[(0, 0)];
        let mut S = A.fixed_view::<2, 2>(1, 1) - w * w.transpose() / A_nn;
        // A block of too small a rank gets what rounding leaves of a row.
        let rounding = 4.0 * f64::EPSILON * A.trace();
        S[(0, 0)] += rounding;
        S[(1, 1)] += rounding;
        Slipping { S, d: w * (q.x / A_nn) - Vector2::new(q.y, q.z), w, A_nn, q_n: q.x }
    }

    fn at(&self, alpha: f64) -> At {
        let (a, b, c) = (self.S[(0, 0)] + alpha, self.S[(1, 1)] + alpha, self.S[(0, 1)]);
        let solve = |x: &Vector2<f64>| Vector2::new(b * x.x - c * x.y, a * x.y - c * x.x) / (a * b - c * c);
        let tangent = solve(&self.d);
        let change = -solve(&tangent);
        let slip = tangent.norm();
        At {
            normal: -(self.q_n + self.w.dot(&tangent)) / self.A_nn,
            tangent,
            slip,
            d_normal: -self.w.dot(&change) / self.A_nn,
            d_slip: tangent.dot(&change) / slip,
        }
    }

    /// Newton on μ p_n/|p_t| − 1, which is nearly linear in α, within a bracket that bisection shrinks.
    fn root(&self, friction: f64) -> Impulse {
        // |p_t| ≤ |d|/α: beyond this p_t is within the disc.
        let steep = self.d.norm() * (self.A_nn + friction * self.w.norm()) / (friction * -self.q_n);
        let (mut low, mut high) = (0.0, 2.0 * steep);
        if !high.is_finite() {
            return Impulse::zeros();
        }
        let (mut alpha, mut at) = (0.0, self.at(0.0));
        for _ in 0..MOST {
            let excess = friction * at.normal / at.slip - 1.0;
            if excess >= 0.0 {
                high = alpha;
            } else {
                low = alpha;
            }
            let slope = friction * (at.d_normal * at.slip - at.normal * at.d_slip) / (at.slip * at.slip);
            let newton = alpha - excess / slope;
            let next = if newton > low && newton < high { newton } else { (low + high) / 2.0 };
            if excess.abs() <= f64::EPSILON || next == alpha {
                break;
            }
            alpha = next;
            at = self.at(alpha);
        }
        let onto_disc = friction * at.normal / at.slip;
        corrected(&Impulse::new(at.normal, at.tangent.x * onto_disc, at.tangent.y * onto_disc), friction, Cone::Disc)
    }
}

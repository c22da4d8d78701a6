//! The attitude of a body whose angular velocity is known, q̇ = ½ ω q (world axes), where no elementary function gives
//! it: Taylor's series of the quaternion, (n + 1) c_{n+1} = ½ Σ ω_j c_{n−j}, in steps of at most a radian (Hairer,
//! Nørsett & Wanner, Solving Ordinary Differential Equations I, I.8). Every step is exact but for rounding.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Number of terms of a step's series: what is left is below 10⁻²⁰.
pub const TERMS: usize = 25;

/// An attitude, and the number of steps that it took.
#[derive(Clone, Copy, Debug)]
pub struct Turned {
    pub q_WB: UnitQuaternion<f64>,
    /// Number of steps of Taylor's series.
    pub steps: u64,
}

/// The attitude after a time (s), from Taylor's coefficients of ω at any time on the way, those that are not zero;
/// `rate` (rad/s) is no less than |ω| and than the rate at which ω itself turns.
pub fn turned<const N: usize>(
    q_WB: &UnitQuaternion<f64>,
    t_s: f64,
    rate: f64,
    series: impl Fn(f64) -> [Vector3<f64>; N],
) -> Turned {
    let steps = libm::ceil(t_s.abs() * rate).max(1.0);
    let step_s = t_s / steps;
    let (mut q, mut done) = (*q_WB, 0.0);
    while done < steps {
        q = stepped(&q, step_s, &series(done * step_s));
        done += 1.0;
    }
    Turned { q_WB: q, steps: steps as u64 }
}

fn stepped(q: &UnitQuaternion<f64>, step_s: f64, w_W: &[Vector3<f64>]) -> UnitQuaternion<f64> {
    let zero = Quaternion::new(0.0, 0.0, 0.0, 0.0);
    let mut terms = [zero; TERMS + 1];
    terms[0] = *q.quaternion();
    for n in 0..TERMS {
        let product = |sum, (j, w): (usize, &Vector3<f64>)| sum + Quaternion::from_imag(*w) * terms[n - j];
        let sum = w_W.iter().enumerate().take(n + 1).fold(zero, product);
        terms[n + 1] = sum * (0.5 / (n + 1) as f64);
    }
    let whole = terms.iter().rev().fold(zero, |sum, term| sum * step_s + term);
    UnitQuaternion::new_normalize(whole)
}

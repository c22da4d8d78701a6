//! The attitude of a body whose angular velocity is known, q̇ = ½ ω q (world axes), where no elementary function gives
//! it: Taylor's series of the quaternion, (n + 1) c_{n+1} = ½ Σ ω_j c_{n−j}, in steps of at most a radian (Hairer,
//! Nørsett & Wanner, Solving Ordinary Differential Equations I, I.8). Every step is exact but for rounding.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Of a step's series: what is left is below 10⁻²⁰.
pub const TERMS: usize = 25;

/// After a time, from Taylor's coefficients of ω at any time on the way; `rate` is no less than |ω| and than the rate
/// at which ω itself turns.
pub fn turned(
    q_WB: &UnitQuaternion<f64>,
    t_s: f64,
    rate: f64,
    series: impl Fn(f64) -> [Vector3<f64>; TERMS],
) -> UnitQuaternion<f64> {
    let steps = libm::ceil(t_s.abs() * rate).max(1.0);
    let step_s = t_s / steps;
    let (mut q, mut done) = (*q_WB, 0.0);
    while done < steps {
        q = stepped(&q, step_s, &series(done * step_s));
        done += 1.0;
    }
    q
}

fn stepped(q: &UnitQuaternion<f64>, step_s: f64, w_W: &[Vector3<f64>; TERMS]) -> UnitQuaternion<f64> {
    let mut terms = [Quaternion::new(0.0, 0.0, 0.0, 0.0); TERMS + 1];
    terms[0] = *q.quaternion();
    for n in 0..TERMS {
        let zero = Quaternion::new(0.0, 0.0, 0.0, 0.0);
        let sum = (0..=n).fold(zero, |sum, j| sum + Quaternion::from_imag(w_W[j]) * terms[n - j]);
        terms[n + 1] = sum * (0.5 / (n + 1) as f64);
    }
    let whole = terms.iter().rev().fold(Quaternion::new(0.0, 0.0, 0.0, 0.0), |sum, term| sum * step_s + term);
    UnitQuaternion::new_normalize(whole)
}

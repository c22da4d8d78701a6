//! Energy and angular momentum of a body without torque, restored after every expansion (E. Hairer, C. Lubich, G.
//! Wanner, Geometric Numerical Integration, IV.4). What is left of the error is along the motion.
//!
//! Near an axis m the two integrals say almost the same. Told apart they are L² − 2 E Iₘ = Σ Iᵢ (Iᵢ − Iₘ) ωᵢ², without
//! ωₘ, and then E for ωₘ. The sum is the distance from the separatrix, on which the time of a flip depends by its
//! logarithm: it is kept in double-double, where the ω of a turning body has not the digits for it.

use crate::math::dd::Dd;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

#[derive(Clone, Debug)]
pub struct Invariants {
    /// Principal moments of inertia.
    I: Vector3<f64>,
    twice_energy: f64,
    /// Σ Iᵢ (Iᵢ − Iₘ) ωᵢ² for every axis m.
    apart: [Dd; 3],
    L_W: Vector3<f64>,
}

impl Invariants {
    /// Invariants of a start, in principal axes.
    pub fn new(I: &Vector3<f64>, w_P: &Vector3<f64>, q_WP: &UnitQuaternion<f64>) -> Self {
        let mut invariants = Invariants {
            I: *I,
            twice_energy: I.component_mul(w_P).dot(w_P),
            apart: [Dd::ZERO; 3],
            L_W: q_WP * I.component_mul(w_P),
        };
        invariants.apart = [0, 1, 2].map(|m| invariants.apart(m, w_P));
        invariants
    }

    /// Restores the invariants: the nearest ω that has them, and the attitude nearest to the one given at which L is
    /// where it was.
    pub fn restore(&self, w_P: &mut Vector3<f64>, q_WP: &mut UnitQuaternion<f64>) {
        let m = w_P.iamax();
        // Newton's method, from what one expansion has left: it squares, and a change this small leaves nothing.
        const SMALL: f64 = 1e-9;
        for _ in 0..3 {
            let missed = (self.apart(m, w_P) - self.apart[m]).f64();
            let gradient = Vector3::from_fn(|i, _| 2.0 * self.I[i] * (self.I[i] - self.I[m]) * w_P[i]);
            if gradient == Vector3::zeros() {
                break;
            }
            let change = gradient * (missed / gradient.norm_squared());
            *w_P -= change;
            if change.amax() <= SMALL * gradient.amax() / self.I.amax() / self.I.amax() {
                break;
            }
        }
        let mut others = *w_P;
        others[m] = 0.0;
        let squared = (self.twice_energy - self.I.component_mul(&others).dot(&others)) / self.I[m];
        if squared > 0.0 {
            w_P[m] = libm::copysign(squared.sqrt(), w_P[m]);
        }
        let L_W = *q_WP * self.I.component_mul(w_P);
        if L_W != Vector3::zeros() {
            // The half-angle's tangent is the half-angle, as small as it is.
            let half = L_W.cross(&self.L_W) / (2.0 * L_W.norm_squared());
            *q_WP = UnitQuaternion::new_normalize(Quaternion::from_parts(1.0, half)) * *q_WP;
        }
    }

    fn apart(&self, m: usize, w_P: &Vector3<f64>) -> Dd {
        let I = |i: usize| Dd::from(self.I[i]);
        let term = |i: usize| I(i) * (I(i) - I(m)) * Dd::from(w_P[i]).squared();
        term(0) + term(1) + term(2)
    }
}

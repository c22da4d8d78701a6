//! A point mass under constant and harmonic acceleration: a = g + Σ Aᵢ cos(ωᵢ t + φᵢ), integrated twice (for instance
//! Landau & Lifshitz, Mechanics, § 22, without the spring). SI units.
//!
//! With θ = ω t each harmonic adds A t cos(φ + θ/2) S₁(θ/2) to the velocity and
//! A t² (½ cos φ S₁(θ/2)² − sin φ S₂(θ)) to the position, where S₁(x) = sin x/x and S₂(x) = (x − sin x)/x². Nothing
//! cancels as ω → 0, where the harmonic is the constant A cos φ. θ is reduced in double-double, for long times.

use crate::math::dd::Dd;
use nalgebra::Vector3;

/// An acceleration A cos(ω t + φ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic {
    pub amplitude_m_s2: Vector3<f64>,
    pub rate_rad_s: f64,
    pub phase_rad: f64,
}

#[derive(Clone, Debug)]
pub struct PointMotion {
    pub position_m: Vector3<f64>,
    pub velocity_m_s: Vector3<f64>,
    pub constant_m_s2: Vector3<f64>,
    pub harmonics: Vec<Harmonic>,
}

impl PointMotion {
    /// Position and velocity at a time of either sign.
    pub fn at(&self, t_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let mut p = self.position_m + (self.velocity_m_s + self.constant_m_s2 * (t_s / 2.0)) * t_s;
        let mut v = self.velocity_m_s + self.constant_m_s2 * t_s;
        for harmonic in &self.harmonics {
            let (once, twice) = harmonic.integrals(t_s);
            v += harmonic.amplitude_m_s2 * once;
            p += harmonic.amplitude_m_s2 * twice;
        }
        (p, v)
    }
}

impl Harmonic {
    /// ∫ cos(ω t + φ) dt and its integral, from 0.
    fn integrals(&self, t_s: f64) -> (f64, f64) {
        let half = Dd::from(self.rate_rad_s) * Dd::from(t_s) * Dd::from(0.5);
        let mid = reduced(Dd::from(self.phase_rad) + half);
        let sinc = if half.f64() == 0.0 { 1.0 } else { libm::sin(reduced(half)) / half.f64() };
        let (sin, cos) = (libm::sin(self.phase_rad), libm::cos(self.phase_rad));
        let once = libm::cos(mid) * sinc * t_s;
        (once, t_s * t_s * (cos * sinc * sinc / 2.0 - sin * late(half + half)))
    }
}

fn reduced(angle: Dd) -> f64 {
    angle.reduce(Dd::PI + Dd::PI).1
}

/// (x − sin x)/x²
fn late(x: Dd) -> f64 {
    /// Above it the difference keeps all but three bits.
    const DIRECT: f64 = 1.0;
    let angle = x.f64();
    if angle.abs() > DIRECT {
        return (1.0 - libm::sin(reduced(x)) / angle) / angle;
    }
    // x/3! − x³/5! + …, from the last term that counts.
    (1..9).rev().fold(0.0, |sum, n| {
        let n = 2.0 * f64::from(n);
        (1.0 - sum) * angle * angle / (n * (n + 1.0))
    }) / if angle == 0.0 { 1.0 } else { angle }
}

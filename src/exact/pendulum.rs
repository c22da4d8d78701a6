//! The compound plane pendulum, θ̈ = −(m g l/I) sin θ, at any amplitude (Whittaker, Analytical Dynamics, § 44). SI
//! units; θ from the lowest position, continuous: it counts turns.
//!
//! With ω₀² = m g l/I, p = θ̇₀/(2ω₀) and k² = p² + sin²(θ₀/2):
//!
//! - librating, k < 1: sin(θ/2) = k sn x, cos(θ/2) = dn x, θ̇ = 2 ω₀ k cn x, x = x₀ + ω₀ t, k′² = cos²(θ₀/2) − p²
//! - rotating, k > 1: θ/2 = am x of the modulus 1/k, θ̇ = 2 ω₀ k dn x, x = x₀ + k ω₀ t, k′² = (p² − cos²(θ₀/2))/k²
//! - the separatrix, k = 1: either, with k′ = 0
//!
//! Rates and k′ are double-double, whole periods are counted. At rest within rounding of the highest position it stays.

use crate::math::dd::{Dd, sin_cos};
use crate::math::elliptic::{Jacobi, carlson_rf, cel};

/// cos(θ₀/2) of a rounded π.
const TOP: f64 = 2e-16;

#[derive(Clone, Debug)]
pub struct Pendulum {
    /// Of the lowest position nearest to the start.
    turns_rad: f64,
    /// Of the start velocity: motion the other way is its mirror image.
    sign: f64,
    motion: Motion,
}

#[derive(Clone, Debug)]
enum Motion {
    Rest { angle: f64 },
    Librating { k: f64, course: Course },
    Rotating { course: Course },
}

/// x = x₀ + rate t.
#[derive(Clone, Debug)]
struct Course {
    jacobi: Jacobi,
    x_start: Dd,
    rate: Dd,
    /// 2K; none on the separatrix.
    half_period: Option<Dd>,
}

impl Pendulum {
    /// m g l and I about the pivot, positive.
    pub fn new(weight_moment_N_m: f64, inertia_kg_m2: f64, angle_rad: f64, rate_rad_s: f64) -> Self {
        let two_pi = Dd::PI + Dd::PI;
        let (turns, _) = Dd::from(angle_rad).reduce(two_pi);
        let sign = libm::copysign(1.0, rate_rad_s);
        let angle = (Dd::from(angle_rad) - two_pi * Dd::from(turns)) * Dd::from(sign);
        let (sin, cos) = sin_cos(angle * Dd::from(0.5));
        let natural_squared = Dd::from(weight_moment_N_m) / Dd::from(inertia_kg_m2);
        let half_rate = Dd::from(rate_rad_s) * Dd::from(0.5);
        let p_squared = half_rate.squared() / natural_squared;
        let (k_squared, short) = (p_squared + sin.squared(), cos.squared() - p_squared);
        let (k, natural) = (k_squared.sqrt(), natural_squared.sqrt());
        let rest = p_squared == Dd::ZERO && cos.f64().abs() < TOP;
        let motion = if k == Dd::ZERO || rest {
            Motion::Rest { angle: angle.f64() }
        } else if short >= Dd::ZERO {
            let [sn, cn] = [sin / k, (p_squared / k_squared).sqrt()];
            let course = Course::new(short.sqrt(), [sn, cn, cos], natural);
            Motion::Librating { k: k.f64(), course }
        } else {
            let dn = (p_squared / k_squared).sqrt();
            let course = Course::new((-short).sqrt() / k, [sin, cos, dn], k * natural);
            Motion::Rotating { course }
        };
        Pendulum { turns_rad: (two_pi * Dd::from(turns)).f64(), sign, motion }
    }

    /// (θ, θ̇) at a time of either sign.
    pub fn at(&self, t_s: f64) -> (f64, f64) {
        let (angle, rate) = match &self.motion {
            Motion::Rest { angle } => (*angle, 0.0),
            Motion::Librating { k, course } => {
                let (count, [sn, cn, dn]) = course.at(t_s);
                let sign = if count % 2.0 == 0.0 { 2.0 } else { -2.0 };
                (sign * libm::atan2(k * sn, dn), sign * k * course.rate.f64() * cn)
            }
            Motion::Rotating { course } => {
                let (count, [sn, cn, dn]) = course.at(t_s);
                let whole = (Dd::PI + Dd::PI) * Dd::from(count) + Dd::from(2.0 * libm::atan2(sn, cn));
                (whole.f64(), 2.0 * course.rate.f64() * dn)
            }
        };
        (self.turns_rad + self.sign * angle, self.sign * rate)
    }

    /// To and fro, or once around; none at rest and on the separatrix.
    pub fn period_s(&self) -> Option<f64> {
        let (course, times) = match &self.motion {
            Motion::Rest { .. } => return None,
            Motion::Librating { course, .. } => (course, 2.0),
            Motion::Rotating { course } => (course, 1.0),
        };
        course.half_period.map(|half| times * (half / course.rate).f64())
    }
}

impl Course {
    /// From k′ and sn, cn ≥ 0, dn of the start.
    fn new(kc: Dd, [sn, cn, dn]: [Dd; 3], rate: Dd) -> Self {
        let x_start = sn.f64() * carlson_rf(cn.squared().f64(), dn.squared().f64(), 1.0);
        let half_period = (kc.f64() > 0.0).then(|| cel(kc, Dd::ONE, Dd::ONE, Dd::ONE) * Dd::from(2.0));
        Course { jacobi: Jacobi::new(kc.f64()), x_start: Dd::from(x_start), rate, half_period }
    }

    /// Half periods, and the functions of what is left.
    fn at(&self, t_s: f64) -> (f64, [f64; 3]) {
        let x = self.x_start + self.rate * Dd::from(t_s);
        let (count, x) = self.half_period.map_or((0.0, x.f64()), |half| x.reduce(half));
        (count, self.jacobi.at(x))
    }
}

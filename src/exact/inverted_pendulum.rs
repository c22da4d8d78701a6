//! The inverted pendulum, θ̈ = p² sin θ, θ from the highest position: what turns over an edge or slides down a curve.
//!
//! With s = sin(θ/2), θ̇² = 4p² (h + s²); τ is the time since the position that is nearest to the top (DLMF 19.25,
//! 19.29):
//!
//! - h < 0, it turns back at s² = x₁² = −h: s = x₁/dn(pτ), k′ = x₁; pτ = R_F(U² + x₁², U² + 1, U²) with
//!   U² = x₁² cos²(θ/2)/(s² − x₁²)
//! - h > 0, it passes the top: tan(θ/2) = k′ sc(pτ/k), k² = 1/(1 + h); pτ = s R_F(h, h cos²(θ/2), h + s²)
//!
//! SI units. Known limit: at h = 0, on its way to the top for ever, it has no time.

use crate::math::elliptic::{Jacobi, carlson_rf};

#[derive(Clone, Debug)]
pub struct InvertedPendulum {
    /// p.
    natural_rad_s: f64,
    angle_rad: f64,
    /// θ̇²/4p² at the start.
    kinetic: f64,
    path: Path,
    /// τ at the start.
    start_s: f64,
}

#[derive(Clone, Debug)]
enum Path {
    /// Path that turns back, on one side of the top.
    Turning { side: f64, turning: Turning },
    /// Path that passes the top, in one direction.
    Passing { direction: f64, h: f64, jacobi: Jacobi },
}

/// A path that turns back, on the positive side.
#[derive(Clone, Debug)]
pub struct Turning {
    natural_rad_s: f64,
    /// x₁.
    highest: f64,
    jacobi: Jacobi,
}

impl Turning {
    pub fn new(natural_rad_s: f64, highest: f64) -> Self {
        Turning { natural_rad_s, highest, jacobi: Jacobi::new(highest) }
    }

    /// Angle θ and rate θ̇ at a time (s) since the highest position.
    pub fn at(&self, since_s: f64) -> (f64, f64) {
        let p = self.natural_rad_s;
        let [sn, _, dn] = self.jacobi.at(p * since_s);
        let k = (1.0 - self.highest * self.highest).sqrt();
        (2.0 * libm::asin((self.highest / dn).min(1.0)), 2.0 * p * self.highest * k * sn / dn)
    }
}

/// Time (s) from a highest position to sin²(θ/2), which is more than there by `excess`.
pub fn from_highest_s(natural_rad_s: f64, excess: f64, squared: f64) -> f64 {
    if excess == 0.0 {
        return 0.0;
    }
    let highest = squared - excess;
    let u = highest * (1.0 - squared) / excess;
    carlson_rf(u + highest, u + 1.0, u) / natural_rad_s
}

impl InvertedPendulum {
    pub fn new(natural_rad_s: f64, angle_rad: f64, rate_rad_s: f64) -> Self {
        let sin = libm::sin(angle_rad / 2.0);
        let kinetic = (rate_rad_s / (2.0 * natural_rad_s)).powi(2);
        let h = kinetic - sin * sin;
        let path = if h < 0.0 {
            let turning = Turning::new(natural_rad_s, (-h).sqrt());
            Path::Turning { side: libm::copysign(1.0, angle_rad), turning }
        } else {
            let jacobi = Jacobi::new((h / (1.0 + h)).sqrt());
            Path::Passing { direction: libm::copysign(1.0, rate_rad_s), h, jacobi }
        };
        let mut pendulum = InvertedPendulum { natural_rad_s, angle_rad, kinetic, path, start_s: 0.0 };
        let start_s = pendulum.since_s(angle_rad, kinetic);
        pendulum.start_s = if h < 0.0 && angle_rad * rate_rad_s < 0.0 { -start_s } else { start_s };
        pendulum
    }

    /// Time |τ| on a path that turns back, τ on one that passes, at θ where θ̇²/4p² is `kinetic`.
    fn since_s(&self, angle_rad: f64, kinetic: f64) -> f64 {
        let sin = libm::sin(angle_rad / 2.0);
        match &self.path {
            Path::Turning { .. } => from_highest_s(self.natural_rad_s, kinetic, sin * sin),
            Path::Passing { direction, h, .. } => {
                let cos = libm::cos(angle_rad / 2.0);
                direction * sin * carlson_rf(*h, h * cos * cos, h + sin * sin) / self.natural_rad_s
            }
        }
    }

    /// Angle θ and rate θ̇ at a time (s).
    pub fn at(&self, t_s: f64) -> (f64, f64) {
        let since_s = self.start_s + t_s;
        match &self.path {
            Path::Turning { side, turning } => {
                let (angle, rate) = turning.at(since_s);
                (side * angle, side * rate)
            }
            Path::Passing { direction, h, jacobi } => {
                let (p, kc) = (self.natural_rad_s, (h / (1.0 + h)).sqrt());
                let [sn, cn, dn] = jacobi.at(p * (1.0 + h).sqrt() * since_s);
                let s = kc * sn / dn;
                (direction * 2.0 * libm::atan2(kc * sn, cn), direction * 2.0 * p * (h + s * s).sqrt())
            }
        }
    }

    /// Time (s) at which it comes to an angle for the first time after the start, and its rate there.
    pub fn comes_to(&self, angle_rad: f64) -> Option<(f64, f64)> {
        let (mean, half) = ((angle_rad + self.angle_rad) / 2.0, (angle_rad - self.angle_rad) / 2.0);
        // sin²(θ/2) − sin²(θ₀/2), without the difference.
        let kinetic = self.kinetic + libm::sin(mean) * libm::sin(half);
        if kinetic < 0.0 {
            return None;
        }
        let (since_s, speed) = (self.since_s(angle_rad, kinetic), 2.0 * self.natural_rad_s * kinetic.sqrt());
        let comings = match &self.path {
            Path::Turning { side, .. } if side * angle_rad < 0.0 => return None,
            Path::Turning { side, .. } => [(-since_s, -side * speed), (since_s, side * speed)],
            Path::Passing { direction, .. } => [(since_s, direction * speed); 2],
        };
        let later = comings.into_iter().find(|(since_s, _)| *since_s > self.start_s);
        later.map(|(since_s, rate)| (since_s - self.start_s, rate))
    }
}

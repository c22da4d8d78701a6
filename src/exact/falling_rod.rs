//! A thin rod that falls over on a smooth floor (Routh, Elementary Rigid Dynamics, § 136): its centre falls straight
//! down, θ̇² = 2 (g/l)(cos θ₀ − cos θ)/(κ + sin² θ), θ from the vertical, l half its length, κ = I/(m l²), 1/3 if
//! homogeneous. The floor presses all the way, as κ + sin² θ₀ + (cos θ − cos θ₀)² > 0, and flat it stays at rest if
//! κ ≤ 1. SI units.
//!
//! With sin(θ/2) = sin(θ₀/2) cosh u the time is √(l/g) ∫ √(κ + sin² θ)/cos(θ/2) du, whose integrand is smooth: Gauss
//! and Legendre's rule on short panels, inverted by Newton's method.

use crate::math::quadrature;

const NODES: usize = 20;

/// Of u. The error of a panel is below rounding.
const PANEL: f64 = 0.25;

#[derive(Clone, Debug)]
pub struct FallingRod {
    /// sin(θ₀/2).
    start: f64,
    inertia: f64,
    /// √(l/g).
    unit_s: f64,
    rule: [(f64, f64); NODES],
    /// Times at u = 0, 1, 2 … panels, the last one flat.
    times_s: Vec<f64>,
    panel: f64,
}

impl FallingRod {
    /// At rest at 0 < θ₀ < π/2.
    pub fn new(angle_rad: f64, inertia: f64, half_length_m: f64, gravity_m_s2: f64) -> Self {
        let start = libm::sin(angle_rad / 2.0);
        let flat = libm::acosh(std::f64::consts::FRAC_1_SQRT_2 / start);
        let panels = libm::ceil(flat / PANEL).max(1.0);
        let unit_s = (half_length_m / gravity_m_s2).sqrt();
        let panel = flat / panels;
        let mut rod = FallingRod { start, inertia, unit_s, rule: quadrature::legendre(), times_s: vec![0.0], panel };
        let mut time_s = 0.0;
        for i in 0..panels as usize {
            time_s += rod.between_s(i as f64 * panel, (i + 1) as f64 * panel);
            rod.times_s.push(time_s);
        }
        rod
    }

    pub fn flat_s(&self) -> f64 {
        self.times_s[self.times_s.len() - 1]
    }

    /// θ and θ̇, before it is flat.
    pub fn at(&self, t_s: f64) -> (f64, f64) {
        let begun = self.times_s.partition_point(|time_s| *time_s <= t_s).clamp(1, self.times_s.len() - 1) - 1;
        let (left, time_s) = (begun as f64 * self.panel, self.times_s[begun]);
        let mut u = left + (t_s - time_s) / (self.times_s[begun + 1] - time_s) * self.panel;
        for _ in 0..8 {
            u -= (time_s + self.between_s(left, u) - t_s) / self.slope_s(u);
        }
        let half = self.start * libm::cosh(u);
        let rate = 2.0 * self.start * libm::sinh(u) / ((1.0 - half * half).sqrt() * self.slope_s(u));
        (2.0 * libm::asin(half), rate)
    }

    /// dt/du.
    fn slope_s(&self, u: f64) -> f64 {
        let sin = self.start * libm::cosh(u);
        let cos_squared = 1.0 - sin * sin;
        self.unit_s * ((self.inertia + 4.0 * sin * sin * cos_squared) / cos_squared).sqrt()
    }

    /// When it comes to an angle on its way.
    pub fn comes_to_s(&self, angle_rad: f64) -> f64 {
        let u = libm::acosh((libm::sin(angle_rad / 2.0) / self.start).max(1.0));
        let begun = ((u / self.panel) as usize).min(self.times_s.len() - 2);
        self.times_s[begun] + self.between_s(begun as f64 * self.panel, u)
    }

    fn between_s(&self, a: f64, b: f64) -> f64 {
        let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
        self.rule.iter().map(|(x, weight)| weight * half * self.slope_s(middle + half * x)).sum()
    }
}

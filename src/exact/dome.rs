//! A ball on top of a fixed one, let go at θ₀ from the top: it slides without friction, k = 0, or rolls, k = I/(m r²)
//! (Routh, Elementary Rigid Dynamics, § 137). Its centre is an inverted pendulum of θ̈ = g sin θ/(d (1 + k)), d the sum
//! of the radii, and would leave where cos θ = 2 cos θ₀/(3 + k): ⅔, and 10/17 for a homogeneous ball from the top. Then
//! it flies.
//!
//! Rolling takes k sin θ/((3 + k) cos θ − 2 cos θ₀) of friction, more than any before it leaves: it rolls until then.
//! SI units.

use super::inverted_pendulum::InvertedPendulum;

#[derive(Clone, Debug)]
pub struct Dome {
    pub swing: InvertedPendulum,
    /// When it leaves the dome; never, if it rolls.
    pub leaves_s: f64,
    /// Up to when it rolls; for ever, if it slides.
    pub rolls_s: f64,
}

impl Dome {
    /// At rest at 0 < θ₀ < π/2. None if it slips, and has friction.
    pub fn new(angle_rad: f64, distance_m: f64, inertia: f64, friction: f64, gravity_m_s2: f64) -> Option<Self> {
        let start = libm::cos(angle_rad);
        let k = if friction == 0.0 { 0.0 } else { inertia };
        let swing = InvertedPendulum::new((gravity_m_s2 / (distance_m * (1.0 + k))).sqrt(), angle_rad, 0.0);
        if friction == 0.0 {
            let (leaves_s, _) = swing.comes_to(libm::acos(2.0 / 3.0 * start))?;
            return Some(Dome { swing, leaves_s, rolls_s: f64::INFINITY });
        }
        let grip = friction * (3.0 + k);
        let slipping = libm::atan2(grip, k) - libm::asin(2.0 * friction * start / libm::hypot(k, grip));
        let (rolls_s, _) = if slipping > angle_rad { swing.comes_to(slipping)? } else { return None };
        Some(Dome { swing, leaves_s: f64::INFINITY, rolls_s })
    }
}

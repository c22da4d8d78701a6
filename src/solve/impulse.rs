//! The impulse of one contact, and the cone that it lies in.

use crate::experiment::types::Cone;
use nalgebra::Vector3;

/// Impulse of one contact in its own frame: normal, tangent 1, tangent 2 (the lecture's ᶜF_c Δt).
pub type Impulse = Vector3<f64>;

/// Puts an impulse back into its cone (L19): f₁ ≤ 0 → 0, else (f₂, f₃) is scaled into the disc of radius μ f₁, or each
/// of them cut to ±μ f₁.
#[inline(always)]
pub fn corrected(p: &Impulse, friction: f64, cone: Cone) -> Impulse {
    if p.x <= 0.0 {
        return Impulse::zeros();
    }
    let radius = friction * p.x;
    if cone == Cone::Box {
        // Not `clamp`, which panics at a radius that is not a number.
        let within = |f: f64| f.max(-radius).min(radius);
        return Impulse::new(p.x, within(p.y), within(p.z));
    }
    let slip = (p.y * p.y + p.z * p.z).sqrt();
    if slip <= radius {
        *p
    } else {
        let scale = radius / slip;
        Impulse::new(p.x, p.y * scale, p.z * scale)
    }
}

/// Whether it is at the side of the cone.
pub fn slips(p: &Impulse, friction: f64) -> bool {
    friction > 0.0 && p.x > 0.0 && p.yz().norm() >= friction * p.x * (1.0 - 1e-9)
}

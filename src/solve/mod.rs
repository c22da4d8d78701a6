//! Contact solvers: a `ContactProblem` (plain data) becomes impulses, one method a file, each owning its scratch.

pub mod exact_contact;
pub mod gauss_seidel;
pub mod position;
pub mod problem;
pub mod start;

use nalgebra::Vector3;

/// Impulse of one contact in its own frame: normal, tangent 1, tangent 2 (the lecture's ᶜF_c Δt).
pub type Impulse = Vector3<f64>;

/// Puts an impulse back into its cone (L19): f₁ ≤ 0 → 0, else (f₂, f₃) is scaled into the disc of radius μ f₁.
pub fn corrected(p: &Impulse, friction: f64) -> Impulse {
    if p.x <= 0.0 {
        return Impulse::zeros();
    }
    let (radius, slip) = (friction * p.x, (p.y * p.y + p.z * p.z).sqrt());
    if slip <= radius {
        *p
    } else {
        let scale = radius / slip;
        Impulse::new(p.x, p.y * scale, p.z * scale)
    }
}

//! What contacts do in a step of Newton's method on their law, as the natural map has it (P. Alart, A. Curnier 1991).

use super::Impulse;
use super::island::Share;
use super::law::{self, Place};
use nalgebra::Vector3;

/// What a contact does in a step of Newton's method.
#[derive(Clone, Copy, Debug)]
pub(super) enum Mode {
    /// It has no impulse.
    Open,
    /// It does not move, or along the surface only if it has no friction.
    Held,
    /// Its impulse is at the side of the cone that is this way.
    Slips(Vector3<f64>),
}

impl Mode {
    /// What the natural map has it do.
    pub(super) fn of(touch: &Share, p: &Impulse, u: &Vector3<f64>) -> Self {
        match law::place(&(p - law::dual(u, touch.law)), touch.law) {
            Place::Tip => Mode::Open,
            Place::Side { t, .. } if touch.law.friction() > 0.0 => Mode::Slips(t),
            _ => Mode::Held,
        }
    }
}

/// |u_t|.
pub(super) fn slip(u: &Vector3<f64>) -> f64 {
    (u.y * u.y + u.z * u.z).sqrt()
}

/// How fast p turns with what slips across: E = |u_t|/μ p_n, with η.
pub(super) fn turning(p: &Impulse, u: &Vector3<f64>, friction: f64, eta: f64) -> f64 {
    let E = if p.x > 0.0 { slip(u) / (friction * p.x) } else { f64::INFINITY };
    1.0 / (E + eta)
}

/// The way against a slip.
pub(super) fn against(u: &Vector3<f64>) -> Option<Vector3<f64>> {
    let slip = slip(u);
    (slip > 0.0).then(|| Vector3::new(0.0, -u.y / slip, -u.z / slip))
}

/// Along the tangent the cone is left to second order.
pub(super) fn onto_cone(p: &Impulse, friction: f64) -> Impulse {
    let length = (p.y * p.y + p.z * p.z).sqrt();
    if p.x <= 0.0 || length == 0.0 {
        return Impulse::zeros();
    }
    let scale = friction * p.x / length;
    Impulse::new(p.x, p.y * scale, p.z * scale)
}

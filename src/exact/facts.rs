//! What a scene has, as far as closed forms ask.

/// Moments, directions and lengths that differ by less, relative, are the same: what is written with ten digits is.
pub(super) const SAME: f64 = 1e-10;

/// What the scene lacks to be the closed form's.
pub type Lacks = String;

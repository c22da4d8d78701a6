//! The law of contact of one contact, without units: p ∈ K, ũ ∈ K*, p ⟂ ũ with ũ = u + μ|u_t| n (G. De Saxcé, Z.-Q.
//! Feng 1998), K Coulomb's cone |p_t| ≤ μ p_n; rows are normal, tangent 1, tangent 2. A pin is the same law with
//! another K.

use super::Impulse;
use nalgebra::{Matrix3, Vector3};

/// What a block of the problem asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    Contact {
        friction: f64,
    },
    /// u = 0 by any impulse: K is all of R³, its dual 0.
    Pin,
}

impl Law {
    pub fn friction(&self) -> f64 {
        match self {
            Law::Contact { friction } => *friction,
            Law::Pin => 0.0,
        }
    }
}

/// What of a tangent is left where it has no direction.
fn tangent(z: &Vector3<f64>) -> (f64, Vector3<f64>) {
    let length = (z.y * z.y + z.z * z.z).sqrt();
    (length, if length > 0.0 { Vector3::new(0.0, z.y / length, z.z / length) } else { Vector3::zeros() })
}

/// ũ.
pub fn dual(u: &Vector3<f64>, law: Law) -> Vector3<f64> {
    u + Vector3::new(law.friction() * tangent(u).0, 0.0, 0.0)
}

/// E + μ n τᵀ, what ũ changes with u.
pub fn dual_slope(u: &Vector3<f64>, law: Law) -> Matrix3<f64> {
    let (_, t) = tangent(u);
    let mut slope = Matrix3::identity();
    slope[(0, 1)] = law.friction() * t.y;
    slope[(0, 2)] = law.friction() * t.z;
    slope
}

/// Where a point lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// In K.
    Inside,
    /// Nearest to the tip.
    Tip,
    /// Nearest to the side: the point there is `along` (n + μ t).
    Side { along: f64, t: Vector3<f64>, length: f64 },
}

pub fn place(z: &Vector3<f64>, law: Law) -> Place {
    let friction = law.friction();
    let (length, t) = tangent(z);
    if law == Law::Pin || (z.x >= 0.0 && length <= friction * z.x) {
        return Place::Inside;
    }
    let along = (z.x + friction * length) / (1.0 + friction * friction);
    if along > 0.0 { Place::Side { along, t, length } } else { Place::Tip }
}

/// n + μ t.
pub fn edge(t: &Vector3<f64>, friction: f64) -> Vector3<f64> {
    Vector3::new(1.0, friction * t.y, friction * t.z)
}

/// The other tangent.
pub fn across(t: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(0.0, -t.z, t.y)
}

/// P_K(z).
pub fn in_cone(z: &Vector3<f64>, law: Law) -> Impulse {
    match place(z, law) {
        Place::Inside => *z,
        Place::Tip => Impulse::zeros(),
        Place::Side { along, t, .. } => edge(&t, law.friction()) * along,
    }
}

/// What P_K(z) changes with z.
pub fn in_cone_slope(z: &Vector3<f64>, law: Law) -> Matrix3<f64> {
    match place(z, law) {
        Place::Inside => Matrix3::identity(),
        Place::Tip => Matrix3::zeros(),
        Place::Side { along, t, length } => {
            let friction = law.friction();
            let (edge, across) = (edge(&t, friction), across(&t));
            edge * edge.transpose() / (1.0 + friction * friction)
                + across * across.transpose() * (along * friction / length)
        }
    }
}

/// |p − P_K(p − ũ)|.
pub fn missed(p: &Impulse, u: &Vector3<f64>, law: Law) -> f64 {
    (p - in_cone(&(p - dual(u, law)), law)).norm()
}

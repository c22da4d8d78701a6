//! What the impulse of a contact changes with its velocity, by what it is made of: a system of linear equations takes
//! two products a contact that slips, not three.

use super::law;
use nalgebra::{Matrix3, Vector3};

/// D of one contact: Δp = −D Δu.
#[derive(Clone, Copy, Debug)]
pub enum Slope {
    Nothing,
    Any(Matrix3<f64>),
    Diagonal(Vector3<f64>),
    /// `normal` e nᵀ + `across` s sᵀ, e a vector along the side of the cone, s the other tangent.
    Side {
        edge: Vector3<f64>,
        s: Vector3<f64>,
        normal: f64,
        across: f64,
    },
}

impl Slope {
    /// The same in all directions.
    pub fn alike(stiffness: f64) -> Self {
        Slope::Diagonal(Vector3::repeat(stiffness))
    }

    /// Along the side of the cone where its tangent is t.
    pub fn along_side(t: &Vector3<f64>, friction: f64, normal: f64, across: f64) -> Self {
        Slope::Side { edge: law::edge(t, friction), s: law::across(t), normal, across }
    }

    /// D u.
    #[inline(always)]
    pub fn times(&self, u: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Slope::Nothing => Vector3::zeros(),
            Slope::Any(D) => D * u,
            Slope::Diagonal(d) => d.component_mul(u),
            Slope::Side { edge, s, normal, across } => edge * (normal * u.x) + s * (across * (s.y * u.y + s.z * u.z)),
        }
    }
}

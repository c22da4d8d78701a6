//! Volume, mass, centre of mass and inertia (L8, L9), of meshes; of a shape: its file.

use super::mesh::{TetMesh, signed_volume};
use nalgebra::{Matrix3, Vector3};

/// Mass properties of the whole body: about its centre of mass, in the axes of the body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    pub mass_kg: f64,
    /// Centre of mass in the body frame.
    pub p_BoBcm: Vector3<f64>,
    /// Inertia, ᴼI of the lecture.
    pub I_B: Matrix3<f64>,
}

/// Volume, first moment ∫u dV and second moment ∫u uᵀ dV about the origin: everything mass properties are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    pub volume_m3: f64,
    pub first: Vector3<f64>,
    pub second: Matrix3<f64>,
}

impl Moments {
    /// Mass properties at uniform density. The slide prints ᴼI = ∫ uᵀu dm; meant is ∫ (|u|² E − u uᵀ) dm.
    pub fn with_mass(&self, mass_kg: f64) -> MassProperties {
        let density = mass_kg / self.volume_m3;
        let centre = self.first / self.volume_m3;
        let second = (self.second - self.volume_m3 * centre * centre.transpose()) * density;
        MassProperties { mass_kg, p_BoBcm: centre, I_B: Matrix3::identity() * second.trace() - second }
    }
}

/// Moments by the slide's sums (L8, L9): each tet's mass at its centroid.
pub fn lumped(mesh: &TetMesh) -> Moments {
    sum(mesh, |corners, volume| {
        let u = corners.iter().sum::<Vector3<f64>>() / 4.0;
        (u * volume, u * u.transpose() * volume)
    })
}

/// Moments by the integrals over each tet: ∫u uᵀ dV = V/20 (Σ uᵢuᵢᵀ + s sᵀ), s = Σ uᵢ over its corners (F. Tonon, J.
/// Math. Stat. 1 (2005) 8, in matrix form).
pub fn exact(mesh: &TetMesh) -> Moments {
    sum(mesh, |corners, volume| {
        let s = corners.iter().sum::<Vector3<f64>>();
        let squares = corners.iter().map(|u| u * u.transpose()).sum::<Matrix3<f64>>();
        (s * (volume / 4.0), (squares + s * s.transpose()) * (volume / 20.0))
    })
}

fn sum(mesh: &TetMesh, of: impl Fn(&[Vector3<f64>; 4], f64) -> (Vector3<f64>, Matrix3<f64>)) -> Moments {
    let mut total = Moments { volume_m3: 0.0, first: Vector3::zeros(), second: Matrix3::zeros() };
    for tet in &mesh.tets {
        let corners = mesh.corners(tet);
        let volume = signed_volume(&corners);
        let (first, second) = of(&corners, volume);
        total.volume_m3 += volume;
        total.first += first;
        total.second += second;
    }
    total
}

/// Moments of a body whose own axes are its principal ones.
pub(super) fn about_centre(volume_m3: f64, second: Vector3<f64>) -> Moments {
    Moments { volume_m3, first: Vector3::zeros(), second: Matrix3::from_diagonal(&second) }
}

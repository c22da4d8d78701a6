//! Volume, mass, centre of mass and inertia (L8, L9), of meshes and of shapes.

use super::mesh::{TetMesh, hull_mesh, signed_volume};
use super::solid::Solid;
use nalgebra::{Matrix3, Vector3};

/// Of the whole body: about its centre of mass, in the axes of the body frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    pub mass_kg: f64,
    /// Centre of mass in the body frame.
    pub p_BoBcm: Vector3<f64>,
    /// ᴼI of the lecture.
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
    /// Of a solid about its centre: closed forms, and the tets of a hull.
    pub fn of(solid: &Solid) -> Self {
        match solid {
            Solid::Sphere { radius_m } => sphere_moments(*radius_m),
            Solid::Box { half_m } => box_moments((half_m * 2.0).into()),
            Solid::Cylinder { radius_m, half_height_m } => cylinder_moments(*radius_m, 2.0 * half_height_m),
            Solid::Capsule { radius_m, half_height_m } => capsule_moments(*radius_m, 2.0 * half_height_m),
            Solid::Ellipsoid { semi_axes_m } => ellipsoid_moments((*semi_axes_m).into()),
            Solid::Convex(hull) => exact(&hull_mesh(hull)),
        }
    }

    /// Mass properties at uniform density. The slide prints ᴼI = ∫ uᵀu dm; meant is ∫ (|u|² E − u uᵀ) dm.
    pub fn with_mass(&self, mass_kg: f64) -> MassProperties {
        let density = mass_kg / self.volume_m3;
        let centre = self.first / self.volume_m3;
        let second = (self.second - self.volume_m3 * centre * centre.transpose()) * density;
        MassProperties { mass_kg, p_BoBcm: centre, I_B: Matrix3::identity() * second.trace() - second }
    }
}

/// The slide's sums (L8, L9): each tet's mass at its centroid.
pub fn lumped(mesh: &TetMesh) -> Moments {
    sum(mesh, |corners, volume| {
        let u = corners.iter().sum::<Vector3<f64>>() / 4.0;
        (u * volume, u * u.transpose() * volume)
    })
}

/// The integrals over each tet: ∫u uᵀ dV = V/20 (Σ uᵢuᵢᵀ + s sᵀ), s = Σ uᵢ over its corners
/// (F. Tonon, J. Math. Stat. 1 (2005) 8, in matrix form).
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

/// Closed form: a box of the given edge lengths about its centre.
pub fn box_moments(size_m: [f64; 3]) -> Moments {
    let size = Vector3::from(size_m);
    let volume_m3 = size.product();
    Moments {
        volume_m3,
        first: Vector3::zeros(),
        second: Matrix3::from_diagonal(&(size.component_mul(&size) * (volume_m3 / 12.0))),
    }
}

/// Closed form: a cylinder about its centre, its axis y.
pub fn cylinder_moments(radius_m: f64, height_m: f64) -> Moments {
    let square = radius_m * radius_m;
    let volume_m3 = std::f64::consts::PI * square * height_m;
    let across = square / 4.0;
    about_centre(volume_m3, Vector3::new(across, height_m * height_m / 12.0, across) * volume_m3)
}

/// Closed form: a cylinder, its axis y, between two half balls; `height_m` between their centres.
pub fn capsule_moments(radius_m: f64, height_m: f64) -> Moments {
    let (middle, ball) = (cylinder_moments(radius_m, height_m), sphere_moments(radius_m));
    let half_m = height_m / 2.0;
    let fourth = radius_m * radius_m * radius_m * radius_m;
    // Of each half ball ∫(y + half)² dV with ∫y dV = π r⁴/4.
    let moved = std::f64::consts::PI * fourth * half_m + ball.volume_m3 * half_m * half_m;
    let second = middle.second.diagonal() + ball.second.diagonal() + Vector3::y() * moved;
    about_centre(middle.volume_m3 + ball.volume_m3, second)
}

/// Closed form: an ellipsoid about its centre.
pub fn ellipsoid_moments(semi_axes_m: [f64; 3]) -> Moments {
    let axes = Vector3::from(semi_axes_m);
    let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * axes.product();
    about_centre(volume_m3, axes.component_mul(&axes) * (volume_m3 / 5.0))
}

fn about_centre(volume_m3: f64, second: Vector3<f64>) -> Moments {
    Moments { volume_m3, first: Vector3::zeros(), second: Matrix3::from_diagonal(&second) }
}

/// Closed form: a ball about its centre.
pub fn sphere_moments(radius_m: f64) -> Moments {
    let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * radius_m * radius_m * radius_m;
    about_centre(volume_m3, Vector3::repeat(volume_m3 * radius_m * radius_m / 5.0))
}

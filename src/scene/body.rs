//! One body of a scene: its shape, mesh, mass properties, surface.

use super::error::BuildError;
use crate::experiment::copies::described_as;
use crate::experiment::types as file;
use crate::model::loads::Drag;
use crate::model::surface::Surface;
use crate::model::{Body, Geometry};
use crate::shape::hull::Hull;
use crate::shape::mesh::{TetMesh, box_mesh, sphere_mesh};
use crate::shape::moments::{MassProperties, Moments, exact, lumped};
use crate::shape::solid::Solid;
use nalgebra::{Matrix3, Vector3};

pub(super) fn build_body(described: &file::Body, scene: &file::Scene, skips: file::Skips) -> Result<Body, BuildError> {
    let mesh = described.mesh.as_ref().and_then(|spec| volume_mesh(&described.shape, spec));
    let solid = build_solid(described)?;
    let drag = scene.air.map_or_else(Drag::default, |air| build_drag(&air, solid.as_ref()));
    let mass = mass_properties(described, mesh.as_ref(), solid.as_ref());
    let among_others = scene.bodies.iter().filter(|body| body.shape != file::Shape::None).count() > 1;
    let geometry = geometry(mesh, solid, &mass.p_BoBcm, among_others);
    let bounding_radius_m = match &geometry {
        Geometry::None => 0.0,
        Geometry::Mesh { nodes, .. } => nodes.iter().map(|u| u.norm()).fold(0.0, f64::max),
        Geometry::Solid { solid: Solid::Box { half_m }, centre } => (centre.abs() + half_m).norm(),
        Geometry::Solid { solid, centre } => centre.norm() + solid.bounding_radius_m(),
    };
    let I_B = snapped(mass.I_B);
    let isotropic = I_B == Matrix3::identity() * I_B[(0, 0)];
    Ok(Body {
        name: described.name.clone(),
        mass_kg: mass.mass_kg,
        I_B,
        // A flat or point-like body has no inverse about some axis: nothing turns it there.
        I_B_inverse: I_B.try_inverse().unwrap_or_else(Matrix3::zeros),
        isotropic,
        spins_steadily: isotropic && skips.has(file::Skip::GyroscopicTerm),
        p_BoBcm: mass.p_BoBcm,
        geometry,
        bounding_radius_m,
        surface: Surface {
            friction: described.friction.unwrap_or(scene.friction),
            restitution: described.restitution.unwrap_or(scene.restitution),
            tangential_restitution: 0.0,
        },
        drag,
        driven: described.is_driven(),
    })
}

/// Place of a body among the model's.
///
/// # Panics
/// No body is called so: a fault of the program, as validation refuses such a name, that must not look like a scene.
pub(super) fn index_of(name: &str, bodies: &[Body]) -> usize {
    let at = bodies.iter().position(|body| body.name == name);
    at.unwrap_or_else(|| panic!("validated: no body is called `{name}`"))
}

/// Solid of a body; None for a point.
fn build_solid(described: &file::Body) -> Result<Option<Solid>, BuildError> {
    Ok(Some(match &described.shape {
        file::Shape::Sphere(s) => Solid::Sphere { radius_m: s.radius_m },
        file::Shape::Box(b) => Solid::Box { half_m: Vector3::from(b.size_m) / 2.0 },
        file::Shape::Cylinder(c) => Solid::Cylinder { radius_m: c.radius_m, half_height_m: c.height_m / 2.0 },
        file::Shape::Capsule(c) => Solid::Capsule { radius_m: c.radius_m, half_height_m: c.height_m / 2.0 },
        file::Shape::Ellipsoid(e) => Solid::Ellipsoid { semi_axes_m: e.semi_axes_m.into() },
        file::Shape::Convex(convex) => Solid::Convex(Hull::new(convex.vertices()).map_err(|wrong| BuildError {
            path: format!("scene.bodies.{}.shape.convex.vertices_m", described_as(&described.name)),
            expected: "corners of a convex hull".into(),
            found: wrong.to_string(),
        })?),
        file::Shape::None => return Ok(None),
    }))
}

fn volume_mesh(shape: &file::Shape, spec: &file::MeshSpec) -> Option<TetMesh> {
    match shape {
        file::Shape::Box(b) => spec.nodes_per_edge.map(|nodes| box_mesh(b.size_m, nodes.counts(b.size_m))),
        file::Shape::Sphere(s) => spec.subdivisions.map(|k| sphere_mesh(s.radius_m, k)),
        _ => None,
    }
}

/// A mesh touches others with its hull, if there are others.
fn geometry(mesh: Option<TetMesh>, solid: Option<Solid>, p_BoBcm: &Vector3<f64>, among_others: bool) -> Geometry {
    let centre = -p_BoBcm;
    match (mesh, solid) {
        (Some(mesh), solid) => {
            let hull = among_others.then(|| match solid {
                Some(solid @ Solid::Box { .. }) => solid,
                _ => Solid::Convex(mesh.hull()),
            });
            let nodes = mesh.nodes.iter().map(|u| u - p_BoBcm).collect();
            Geometry::Mesh { nodes, mesh, hull, centre }
        }
        (None, Some(solid)) => Geometry::Solid { solid, centre },
        (None, None) => Geometry::None,
    }
}

fn mass_properties(described: &file::Body, mesh: Option<&TetMesh>, solid: Option<&Solid>) -> MassProperties {
    let moments = moments(described, mesh, solid);
    let volume_m3 = moments.as_ref().map_or(0.0, |m| m.volume_m3);
    let mass_kg = described.mass_kg.unwrap_or_else(|| described.density_kg_m3.unwrap_or(0.0) * volume_m3);
    let mut mass = match moments {
        Some(moments) => moments.with_mass(mass_kg),
        // A point: its rotation means nothing, any inertia does.
        None => MassProperties { mass_kg, p_BoBcm: Vector3::zeros(), I_B: Matrix3::identity() * mass_kg },
    };
    if let Some(centre) = described.center_of_mass_m {
        let centre = Vector3::from(centre);
        let moved = centre - mass.p_BoBcm;
        mass.I_B += mass_kg * (Matrix3::identity() * moved.norm_squared() - moved * moved.transpose());
        mass.p_BoBcm = centre;
    }
    match described.inertia_kg_m2 {
        Some(file::Inertia::Principal(moments)) => mass.I_B = Matrix3::from_diagonal(&Vector3::from(moments)),
        Some(file::Inertia::Full(rows)) => mass.I_B = Matrix3::from_fn(|i, j| rows[i][j]),
        None => {}
    }
    mass
}

fn moments(described: &file::Body, mesh: Option<&TetMesh>, solid: Option<&Solid>) -> Option<Moments> {
    match (mesh, described.inertia_from) {
        (Some(mesh), file::InertiaFrom::Exact) => Some(exact(mesh)),
        (Some(mesh), file::InertiaFrom::Lumped) => Some(lumped(mesh)),
        (None, _) => solid.map(Solid::moments),
    }
}

/// The area is a quarter of the surface.
fn build_drag(air: &file::Air, solid: Option<&Solid>) -> Drag {
    let area_m2 = solid.map_or(0.0, Solid::surface_m2) / 4.0;
    Drag {
        linear_n_s_m: air.linear_drag_n_s_m,
        quadratic_n_s2_m2: 0.5 * air.density_kg_m3 * air.drag_coefficient * area_m2,
    }
}

/// An inertia that is a multiple of the identity but for rounding becomes one exactly, so that the gyroscopic term can
/// be skipped without changing a bit.
fn snapped(I_B: Matrix3<f64>) -> Matrix3<f64> {
    /// Rounding of sums over some hundred tets, relative.
    const ROUNDING: f64 = 1e-13;
    let mean = Matrix3::identity() * (I_B.trace() / 3.0);
    if (I_B - mean).abs().max() <= ROUNDING * mean[(0, 0)] { mean } else { I_B }
}

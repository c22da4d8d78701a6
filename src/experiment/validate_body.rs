//! Checks of one body, whatever else is in the scene.

use super::checks::{Result, a_part, direction, not_negative, positive, sizes, unexpected};
use super::copies::{validate_copies, without_number};
use super::error::{ExperimentError, number};
use super::key_path::Path;
use super::types::{
    Body, BoxShape, CONTAINER, Convex, Inertia, InertiaFrom, MeshSpec, NodesPerEdge, Orientation, Shape,
};
use super::validate_loads::validate_driven;
use crate::shape::hull::{Hull, HullError, MOST_VERTICES};
use nalgebra::Matrix3;

/// Most subdivisions of a sphere: six levels make 40,962 surface nodes, seven 163,842; finer spheres only fill the
/// memory.
const FINEST_SPHERE: u32 = 7;
/// Most nodes of a mesh. A million are some six million tets: more is a slip, and would end in a lack of memory.
const MOST_NODES: f64 = 1e6;
/// Relative rounding of moments: computed in floating point they meet I₁ + I₂ = I₃ of a flat body only up to it.
const TRIANGLE_SLACK: f64 = 1e-9;

/// Checks one body.
///
/// # Errors
/// The first thing that is wrong with the body.
pub fn validate_body(body: &Body, at: Path) -> Result<()> {
    validate_name(body, at.key("name"))?;
    validate_shape(&body.shape, at.key("shape"))?;
    validate_mesh(body, at.key("mesh"))?;
    validate_mass(body, at)?;
    validate_inertia(body, at)?;
    if let Some(orientation) = &body.orientation {
        validate_orientation(orientation, at.key("orientation"))?;
    }
    validate_spin(body, at)?;
    validate_driven(body, at)?;
    body.copies.as_ref().map_or(Ok(()), |copies| validate_copies(copies, at.key("copies")))?;
    body.friction.map_or(Ok(()), |friction| not_negative(friction, at.key("friction")))?;
    body.restitution.map_or(Ok(()), |restitution| a_part(restitution, at.key("restitution")))
}

/// Names stand in key paths, `--set`s, columns and the paths of recordings; contacts call the container `container`.
/// A resolved experiment names copies by their number.
fn validate_name(body: &Body, at: Path) -> Result<()> {
    let name = match &body.copies {
        None => without_number(&body.name).unwrap_or(&body.name),
        Some(_) => &body.name,
    };
    let is_reserved = |c: char| c.is_control() || ".[]=/".contains(c);
    let expected = if name.is_empty() || name.trim() != name {
        "a name without space around it"
    } else if name.contains(is_reserved) {
        "a name without any of . [ ] = /"
    } else if name == CONTAINER {
        "another name (contacts name the container so)"
    } else {
        return Ok(());
    };
    Err(unexpected(at, expected, &format!("`{}`", body.name.escape_debug())))
}

fn validate_shape(shape: &Shape, at: Path) -> Result<()> {
    match shape {
        Shape::Sphere(sphere) => positive(sphere.radius_m, at.key("sphere").key("radius_m")),
        Shape::Box(box_) => sizes(&box_.size_m, at.key("box").key("size_m")),
        Shape::Cylinder(cylinder) => round(cylinder.radius_m, cylinder.height_m, at.key("cylinder")),
        Shape::Capsule(capsule) => round(capsule.radius_m, capsule.height_m, at.key("capsule")),
        Shape::Ellipsoid(ellipsoid) => sizes(&ellipsoid.semi_axes_m, at.key("ellipsoid").key("semi_axes_m")),
        Shape::Convex(convex) => validate_hull(convex, at.key("convex").key("vertices_m")),
        Shape::None => Ok(()),
    }
}

fn round(radius_m: f64, height_m: f64, at: Path) -> Result<()> {
    positive(radius_m, at.key("radius_m"))?;
    positive(height_m, at.key("height_m"))
}

fn validate_hull(convex: &Convex, at: Path) -> Result<()> {
    let Err(wrong) = Hull::new(convex.vertices()) else { return Ok(()) };
    match wrong {
        HullError::Few(_) => Err(unexpected(at, "at least 4 vertices", &wrong.to_string())),
        HullError::Many(_) => Err(unexpected(at, &format!("at most {MOST_VERTICES} vertices"), &wrong.to_string())),
        HullError::Flat => Err(unexpected(at, "vertices that span a volume", "all of them in one plane")),
        HullError::NotConvex(vertex) => {
            let found = "a vertex inside the others' hull, on one of its edges or faces, or given twice";
            Err(unexpected(at.item(vertex, None), "a corner of the convex hull", found))
        }
    }
}

fn validate_mesh(body: &Body, at: Path) -> Result<()> {
    let Some(MeshSpec { nodes_per_edge, subdivisions }) = &body.mesh else {
        return Ok(());
    };
    let (nodes, levels) = (at.key("nodes_per_edge"), at.key("subdivisions"));
    match (&body.shape, nodes_per_edge, subdivisions) {
        (Shape::None, ..) => Err(unexpected(at, "no mesh, as the shape is `none`", "one")),
        (Shape::Cylinder(_) | Shape::Capsule(_) | Shape::Ellipsoid(_) | Shape::Convex(_), ..) => {
            Err(unexpected(at, "no mesh, as only a `box` and a `sphere` can have one", "one"))
        }
        (Shape::Box(_), _, Some(_)) => Err(unexpected(levels, "`nodes_per_edge` for a box", "`subdivisions`")),
        (Shape::Sphere(_), Some(_), _) => Err(unexpected(nodes, "`subdivisions` for a sphere", "`nodes_per_edge`")),
        (Shape::Box(_), None, None) => Err(ExperimentError::missing(nodes.to_key_path(), "the nodes along an edge")),
        (Shape::Sphere(_), None, None) => {
            Err(ExperimentError::missing(levels.to_key_path(), "the subdivisions of the icosphere"))
        }
        (Shape::Sphere(_), None, Some(n)) if *n > FINEST_SPHERE => {
            Err(unexpected(levels, &format!("a whole number from 0 to {FINEST_SPHERE}"), &n.to_string()))
        }
        (Shape::Sphere(_), None, Some(_)) => Ok(()),
        (Shape::Box(box_), Some(count), None) => validate_nodes(box_, count, nodes),
    }
}

fn validate_nodes(shape: &BoxShape, count: &NodesPerEdge, at: Path) -> Result<()> {
    let counts = match count {
        NodesPerEdge::Shortest(n) => vec![*n],
        NodesPerEdge::Each(counts) => counts.to_vec(),
    };
    if let Some(few) = counts.iter().find(|n| **n < 2) {
        return Err(unexpected(at, "at least 2 nodes along an edge", &few.to_string()));
    }
    let nodes: f64 = count.counts(shape.size_m).map(f64::from).iter().product();
    if nodes > MOST_NODES {
        let found = format!("{} nodes", number(nodes.round()));
        return Err(unexpected(at, &format!("a mesh of at most {MOST_NODES:e} nodes"), &found));
    }
    Ok(())
}

fn validate_mass(body: &Body, at: Path) -> Result<()> {
    let (mass, density) = (at.key("mass_kg"), at.key("density_kg_m3"));
    match (body.mass_kg, body.density_kg_m3) {
        (Some(_), Some(_)) => Err(unexpected(density, "either `mass_kg` or `density_kg_m3`", "both")),
        (None, Some(_)) if body.shape == Shape::None => {
            Err(unexpected(density, "`mass_kg`, as the shape `none` has no volume", "`density_kg_m3`"))
        }
        // A body that moves as it is told has no use for it.
        (None, None) if body.is_driven() => Ok(()),
        (None, None) if body.shape == Shape::None => {
            Err(ExperimentError::missing(mass.to_key_path(), "the mass of the point"))
        }
        (None, None) => Err(ExperimentError::missing(mass.to_key_path(), "give `mass_kg` or `density_kg_m3`")),
        (Some(kg), None) => positive(kg, mass),
        (None, Some(kg_m3)) => positive(kg_m3, density),
    }
}

fn validate_inertia(body: &Body, at: Path) -> Result<()> {
    if body.inertia_from == InertiaFrom::Lumped && body.mesh.is_none() {
        let expected = "`exact`, as `lumped` is over the tets of a mesh and the body has no `mesh`";
        return Err(unexpected(at.key("inertia_from"), expected, "`lumped`"));
    }
    let at = at.key("inertia_kg_m2");
    match body.inertia_kg_m2 {
        None => Ok(()),
        Some(Inertia::Principal(moments)) => validate_moments(moments, at),
        Some(Inertia::Full(rows)) => {
            let matrix = Matrix3::from_fn(|i, j| rows[i][j]);
            let largest = matrix.amax();
            if (matrix - matrix.transpose()).amax() > TRIANGLE_SLACK * largest {
                return Err(unexpected(at, "a symmetric matrix", "one that is not"));
            }
            validate_moments(matrix.symmetric_eigenvalues().into(), at)
        }
    }
}

/// No mass distribution has a moment that exceeds the sum of the other two; a flat one reaches it.
fn validate_moments(mut moments: [f64; 3], at: Path) -> Result<()> {
    moments.sort_by(f64::total_cmp);
    let [small, middle, large] = moments;
    let found = || format!("principal moments {}, {}, {}", number(small), number(middle), number(large));
    if small <= 0.0 {
        return Err(unexpected(at, "moments of inertia greater than 0", &found()));
    }
    if large > (small + middle) * (1.0 + TRIANGLE_SLACK) {
        let expected = "moments of which none is larger than the sum of the other two";
        return Err(unexpected(at, expected, &found()));
    }
    Ok(())
}

fn validate_orientation(orientation: &Orientation, at: Path) -> Result<()> {
    let Orientation { axis, angle_deg, quaternion_xyzw, euler_xyz_deg } = orientation;
    let is_turn = axis.is_some() || angle_deg.is_some();
    let forms = [is_turn, quaternion_xyzw.is_some(), euler_xyz_deg.is_some()];
    let count = forms.iter().filter(|is_given| **is_given).count();
    if count != 1 {
        let found = if count == 0 { "none" } else { "more than one of them" };
        return Err(unexpected(at, "one of {axis, angle_deg}, {quaternion_xyzw}, {euler_xyz_deg}", found));
    }
    match (axis, angle_deg) {
        (Some(_), None) => {
            return Err(ExperimentError::missing(at.key("angle_deg").to_key_path(), "the angle about `axis`"));
        }
        (None, Some(_)) => {
            return Err(ExperimentError::missing(at.key("axis").to_key_path(), "the axis of `angle_deg`"));
        }
        _ => {}
    }
    axis.map_or(Ok(()), |axis| direction(&axis, at.key("axis")))?;
    match quaternion_xyzw {
        Some(q) if q.iter().all(|x| *x == 0.0) => {
            Err(unexpected(at.key("quaternion_xyzw"), "a rotation", "the zero quaternion"))
        }
        _ => Ok(()),
    }
}

fn validate_spin(body: &Body, at: Path) -> Result<()> {
    let (world, local) = (at.key("angular_velocity_rad_s"), at.key("angular_velocity_body_rad_s"));
    if body.angular_velocity_rad_s.is_some() && body.angular_velocity_body_rad_s.is_some() {
        return Err(unexpected(local, "either `angular_velocity_rad_s` or `angular_velocity_body_rad_s`", "both"));
    }
    let is_point = body.shape == Shape::None && body.inertia_kg_m2.is_none();
    for (velocity, at) in [(body.angular_velocity_rad_s, world), (body.angular_velocity_body_rad_s, local)] {
        if is_point && velocity.is_some_and(|w| w != [0.0; 3]) {
            return Err(unexpected(at, "no rotation, as a point without `inertia_kg_m2` cannot spin", "one"));
        }
    }
    Ok(())
}

//! From one resolved experiment to its constant `Model` and first `State`.

use super::area::surface_m2;
use super::container::{Container, Face};
use super::loads::{AppliedForce, Drag};
use super::mass::{
    MassProperties, Moments, box_moments, capsule_moments, cylinder_moments, ellipsoid_moments, exact, lumped,
    sphere_moments,
};
use super::mesh::{TetMesh, box_counts, box_mesh, hull_mesh, sphere_mesh};
use super::pins::build_pins;
use super::place::{Landing, MOST_DRAWS};
use super::random::Draws;
use super::surface::{Pair, Surface};
use super::{Body, Geometry, Model};
use crate::collide::hull::Hull;
use crate::collide::solid::Solid;
use crate::collide::{Contact, Detector, Reach};
use crate::experiment::copies::described_as;
use crate::experiment::types as file;
use crate::measure::work::Work;
use crate::state::{BodyState, State};
use nalgebra::{Matrix3, Quaternion, Unit, UnitQuaternion, Vector3};

/// The experiment cannot be built; to be reported with file and line of `path`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{path}: expected {expected}, found {found}")]
pub struct BuildError {
    pub path: String,
    pub expected: String,
    pub found: String,
}

/// Expects an experiment that has passed validation.
pub fn build(experiment: &file::Experiment) -> Result<(Model, State), BuildError> {
    let scene = &experiment.scene;
    let container = scene.container.as_ref().map(build_container);
    let landing = Landing::new(experiment, container.as_ref());
    let mut bodies = Vec::with_capacity(scene.bodies.len());
    let mut states = Vec::with_capacity(scene.bodies.len());
    let mut depths_m = Vec::with_capacity(scene.bodies.len());
    for described in &scene.bodies {
        let body = build_body(described, scene)?;
        let (state, depth_m) = first_state(described, &body, experiment, landing.as_ref())?;
        states.push(state);
        depths_m.push(depth_m);
        bodies.push(body);
    }
    let forces = scene.forces.iter().map(|force| build_force(force, &bodies)).collect();
    let pins = build_pins(scene, &bodies, &mut states)?;
    let gravity_m_s2 = Vector3::from(scene.gravity_m_s2);
    let potential_zero_m = potential_zero(&gravity_m_s2, container.as_ref(), &bodies, &states);
    let solids = || bodies.iter().filter(|body| body.solid().is_some());
    let model = Model {
        touching_pairs: solids().count() > 1 && solids().any(|body| !body.driven),
        gravity_m_s2,
        container,
        container_surface: Surface {
            friction: scene.friction,
            restitution: scene.restitution,
            tangential_restitution: 0.0,
        },
        pairs: scene.pairs.iter().map(|pair| build_pair(pair, &bodies)).collect(),
        bodies,
        forces,
        pins,
        potential_zero_m,
    };
    let state = State { step: 0, time_s: 0.0, bodies: states };
    if !matches!(experiment.method, file::Method::Free(_)) && !scene.allow_overlap {
        refuse_overlap(&model, &state, &depths_m)?;
    }
    Ok((model, state))
}

fn build_container(container: &file::Container) -> Container {
    let face = |plane: &file::Plane| {
        let normal = Vector3::from(plane.normal);
        Face { normal: normal / normal.norm(), offset_m: plane.offset_m }
    };
    match container {
        file::Container::Box(b) => Container::new_box(b.size_m, b.center_m.unwrap_or([0.0, b.size_m[1] / 2.0, 0.0])),
        file::Container::Plane(plane) => Container { faces: vec![face(plane)] },
        file::Container::Planes(planes) => Container { faces: planes.iter().map(face).collect() },
    }
}

fn build_pair(pair: &file::Pair, bodies: &[Body]) -> Pair {
    // Validation has seen to it that a name is a body's or the container.
    let index = |name: &String| bodies.iter().position(|body| body.name == *name);
    Pair {
        between: pair.between.each_ref().map(index),
        friction: pair.friction,
        restitution: pair.restitution,
        tangential_restitution: pair.tangential_restitution,
    }
}

fn build_force(force: &file::Force, bodies: &[Body]) -> AppliedForce {
    let body = bodies.iter().position(|body| body.name == force.body).unwrap_or_default();
    let vector = |given: Option<[f64; 3]>| given.map_or_else(Vector3::zeros, Vector3::from);
    AppliedForce {
        body,
        force_n: vector(force.force_n),
        torque_n_m: vector(force.torque_n_m),
        r_B: force.at_m.map_or_else(Vector3::zeros, |at| Vector3::from(at) - bodies[body].p_BoBcm),
        frame: force.frame,
        cosine: match force.course {
            file::Course::Constant => None,
            file::Course::Cosine(cosine) => Some((cosine.frequency_rad_s, cosine.phase_rad)),
        },
    }
}

fn build_drag(air: &file::Air, shape: &file::Shape, hull: Option<&Hull>) -> Drag {
    Drag {
        linear_n_s_m: air.linear_drag_n_s_m,
        quadratic_n_s2_m2: 0.5 * air.density_kg_m3 * air.drag_coefficient * surface_m2(shape, hull) / 4.0,
    }
}

fn build_body(described: &file::Body, scene: &file::Scene) -> Result<Body, BuildError> {
    let mesh = described.mesh.as_ref().and_then(|spec| volume_mesh(&described.shape, spec));
    let hull = build_hull(described)?;
    let drag = scene.air.map_or_else(Drag::default, |air| build_drag(&air, &described.shape, hull.as_ref()));
    let mass = mass_properties(described, mesh.as_ref(), hull.as_ref());
    let among_others = scene.bodies.iter().filter(|body| body.shape != file::Shape::None).count() > 1;
    let geometry = geometry(&described.shape, mesh, hull, &mass.p_BoBcm, among_others);
    let bounding_radius_m = match &geometry {
        Geometry::None => 0.0,
        Geometry::Mesh { nodes, .. } => nodes.iter().map(|u| u.norm()).fold(0.0, f64::max),
        Geometry::Solid { solid: Solid::Box { half_m }, centre } => (centre.abs() + half_m).norm(),
        Geometry::Solid { solid, centre } => centre.norm() + solid.bounding_radius_m(),
    };
    let I_B = snapped(mass.I_B);
    Ok(Body {
        name: described.name.clone(),
        mass_kg: mass.mass_kg,
        I_B,
        // A flat or point-like body has no inverse about some axis: nothing turns it there.
        I_B_inverse: I_B.try_inverse().unwrap_or_else(Matrix3::zeros),
        isotropic: I_B == Matrix3::identity() * I_B[(0, 0)],
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

fn build_hull(described: &file::Body) -> Result<Option<Hull>, BuildError> {
    let file::Shape::Convex(convex) = &described.shape else { return Ok(None) };
    Hull::new(convex.vertices()).map(Some).map_err(|wrong| BuildError {
        path: format!("scene.bodies.{}.shape.convex.vertices_m", described_as(&described.name)),
        expected: "corners of a convex hull".into(),
        found: wrong.to_string(),
    })
}

fn volume_mesh(shape: &file::Shape, spec: &file::MeshSpec) -> Option<TetMesh> {
    match shape {
        file::Shape::Box(b) => spec.nodes_per_edge.map(|nodes| match nodes {
            file::NodesPerEdge::Shortest(n) => box_mesh(b.size_m, box_counts(b.size_m, n)),
            file::NodesPerEdge::Each(counts) => box_mesh(b.size_m, counts),
        }),
        file::Shape::Sphere(s) => spec.subdivisions.map(|k| sphere_mesh(s.radius_m, k)),
        _ => None,
    }
}

fn geometry(
    shape: &file::Shape,
    mesh: Option<TetMesh>,
    hull: Option<Hull>,
    p_BoBcm: &Vector3<f64>,
    among_others: bool,
) -> Geometry {
    let about = |solid: Solid| Geometry::Solid { solid, centre: -p_BoBcm };
    let of_box = |b: &file::BoxShape| Solid::Box { half_m: Vector3::from(b.size_m) / 2.0 };
    match (shape, mesh) {
        (_, Some(mesh)) => {
            let hull = among_others.then(|| match shape {
                file::Shape::Box(b) => of_box(b),
                _ => Solid::Convex(mesh.hull()),
            });
            let nodes = mesh.nodes.iter().map(|u| u - p_BoBcm).collect();
            Geometry::Mesh { nodes, mesh, hull, centre: -p_BoBcm }
        }
        (file::Shape::Box(b), None) => about(of_box(b)),
        (file::Shape::Sphere(s), None) => about(Solid::Sphere { radius_m: s.radius_m }),
        (file::Shape::Cylinder(c), None) => {
            about(Solid::Cylinder { radius_m: c.radius_m, half_height_m: c.height_m / 2.0 })
        }
        (file::Shape::Capsule(c), None) => {
            about(Solid::Capsule { radius_m: c.radius_m, half_height_m: c.height_m / 2.0 })
        }
        (file::Shape::Ellipsoid(e), None) => about(Solid::Ellipsoid { semi_axes_m: e.semi_axes_m.into() }),
        (file::Shape::Convex(_), None) => hull.map_or(Geometry::None, |hull| about(Solid::Convex(hull))),
        (file::Shape::None, None) => Geometry::None,
    }
}

fn mass_properties(described: &file::Body, mesh: Option<&TetMesh>, hull: Option<&Hull>) -> MassProperties {
    let moments = shape_moments(described, mesh, hull);
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

fn shape_moments(described: &file::Body, mesh: Option<&TetMesh>, hull: Option<&Hull>) -> Option<Moments> {
    match (mesh, &described.shape) {
        (Some(mesh), _) => Some(match described.inertia_from {
            file::InertiaFrom::Exact => exact(mesh),
            file::InertiaFrom::Lumped => lumped(mesh),
        }),
        (None, file::Shape::Box(b)) => Some(box_moments(b.size_m)),
        (None, file::Shape::Sphere(s)) => Some(sphere_moments(s.radius_m)),
        (None, file::Shape::Cylinder(c)) => Some(cylinder_moments(c.radius_m, c.height_m)),
        (None, file::Shape::Capsule(c)) => Some(capsule_moments(c.radius_m, c.height_m)),
        (None, file::Shape::Ellipsoid(e)) => Some(ellipsoid_moments(e.semi_axes_m)),
        (None, file::Shape::Convex(_)) => hull.map(|hull| exact(&hull_mesh(hull))),
        (None, file::Shape::None) => None,
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

/// The state at t = 0, and how deep `place: at-contact` has put it into the floor.
fn first_state(
    described: &file::Body,
    body: &Body,
    experiment: &file::Experiment,
    landing: Option<&Landing>,
) -> Result<(BodyState, f64), BuildError> {
    let given = given_state(described);
    let placed = |mut state: BodyState| {
        state.p_WB = Vector3::from(described.position_m) + state.q_WB * body.p_BoBcm;
        state
    };
    let random = experiment.scene.random.as_ref().filter(|_| !body.driven);
    let Some(random) = random else { return Ok((placed(given), 0.0)) };
    let mut draws = Draws::new(experiment.seed, &described.name);
    let mut draw = || {
        let mut state = given;
        let part = draws.next(random, &mut state);
        (placed(state), part)
    };
    match landing {
        Some(landing) if body.feels_container() => landing.first(body, draw).ok_or_else(|| BuildError {
            path: "scene.random.place".into(),
            expected: "a body that approaches the floor in some draw".into(),
            found: format!("{} receding in all of {MOST_DRAWS}", body.name),
        }),
        _ => Ok((draw().0, 0.0)),
    }
}

/// What the file says, but for the position, which follows from the attitude.
fn given_state(described: &file::Body) -> BodyState {
    let mut state = BodyState {
        p_WB: Vector3::zeros(),
        q_WB: described.orientation.as_ref().map_or_else(UnitQuaternion::identity, attitude),
        v_WB: described.velocity_m_s.map_or_else(Vector3::zeros, Vector3::from),
        w_WB: described.angular_velocity_rad_s.map_or_else(Vector3::zeros, Vector3::from),
    };
    if let Some(kinematic) = described.kinematic {
        state.v_WB = Vector3::from(kinematic.velocity_m_s);
        state.w_WB = Vector3::from(kinematic.angular_velocity_rad_s);
    }
    if let Some(w_B) = described.angular_velocity_body_rad_s {
        state.w_WB = state.q_WB * Vector3::from(w_B);
    }
    state
}

fn attitude(orientation: &file::Orientation) -> UnitQuaternion<f64> {
    let about =
        |axis: Vector3<f64>, deg: f64| UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), deg.to_radians());
    if let Some([x, y, z, w]) = orientation.quaternion_xyzw {
        return UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    }
    if let Some([x, y, z]) = orientation.euler_xyz_deg {
        return about(Vector3::z(), z) * about(Vector3::y(), y) * about(Vector3::x(), x);
    }
    match (orientation.axis, orientation.angle_deg) {
        (Some(axis), Some(deg)) => about(Vector3::from(axis), deg),
        _ => UnitQuaternion::identity(),
    }
}

/// The container's lowest point; without a closed one below, the lowest start position.
fn potential_zero(
    gravity: &Vector3<f64>,
    container: Option<&Container>,
    bodies: &[Body],
    states: &[BodyState],
) -> Vector3<f64> {
    let Some(down) = gravity.try_normalize(0.0) else {
        return Vector3::zeros();
    };
    let up = -down;
    let moving = bodies.iter().zip(states).filter(|(body, _)| !body.driven);
    let lowest_start = moving.map(|(_, s)| up.dot(&s.p_WB)).reduce(f64::min).unwrap_or_default();
    let height = container.and_then(|c| c.lowest_m(&up)).unwrap_or(lowest_start);
    up * height
}

/// `allowed_m`: how deep each body has been put into the floor on purpose.
fn refuse_overlap(model: &Model, state: &State, allowed_m: &[f64]) -> Result<(), BuildError> {
    /// Of the body's size: a body placed on the floor is not inside it.
    const ROUNDING: f64 = 1e-9;
    let mut contacts = Vec::new();
    Detector::default().detect(model, state, &Reach::INSIDE, &mut contacts, &mut Work::default());
    let allowed = |contact: &Contact| {
        let size_m = contact.ends().map(|(i, ..)| model.bodies[i].bounding_radius_m).fold(0.0, f64::max);
        let placed_m = if contact.other.is_none() { allowed_m[contact.body] } else { 0.0 };
        placed_m + ROUNDING * size_m
    };
    let inside = contacts.iter().filter(|contact| -contact.gap_m > allowed(contact));
    let Some(contact) = inside.reduce(|a, b| if b.gap_m < a.gap_m { b } else { a }) else { return Ok(()) };
    let (name, depth) = (&model.bodies[contact.body].name, -contact.gap_m);
    let (whom, what) = match contact.other {
        None => ("the container".into(), format!("{name} inside a face by {depth:.3e} m")),
        Some(other) => {
            let other = &model.bodies[other].name;
            (format!("`{other}`"), format!("{name} and {other} inside each other by {depth:.3e} m"))
        }
    };
    Err(BuildError {
        path: format!("scene.bodies.{}.position_m", described_as(name)),
        expected: format!("no overlap with {whom} at the start"),
        found: what,
    })
}

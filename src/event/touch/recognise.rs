//! Which kind of contact one is that the contact test has found.

use super::parts::Parts;
use super::plane::Plane;
use crate::collide::Contact;
use crate::event::shown::{Ball, Border, Face, Facing, Line, Part, ROLLS, Spot, shown};
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// None: parts whose motion along each other is not known here.
pub(super) fn parts(model: &Model, state: &State, found: &Contact) -> Option<Parts> {
    match found.other {
        None => on_container(model, state, found),
        Some(other) => between(model, state, found, other),
    }
}

fn corner(centre_B: Vector3<f64>) -> Part {
    Part::Ball(Ball::new(centre_B, 0.0))
}

fn on_container(model: &Model, state: &State, found: &Contact) -> Option<Parts> {
    let (face, node) = found.feature;
    let face = model.container.as_ref()?.faces[face as usize];
    let plane = Plane { of: None, normal: face.normal, offset_m: face.offset_m, border: Border::Nowhere };
    let part = lowest(&model.bodies[found.body], &state.bodies[found.body], node, found)?;
    Some(Parts::OnPlane { of: found.body, part, plane })
}

/// The part that a container's contact test calls `node`.
fn lowest(body: &Body, at: &BodyState, node: u32, found: &Contact) -> Option<Part> {
    let (solid, centre) = match &body.geometry {
        Geometry::None => return None,
        Geometry::Mesh { nodes, .. } => return Some(corner(nodes[node as usize])),
        Geometry::Solid { solid, centre } => (solid, *centre),
    };
    let y = Vector3::y();
    Some(match solid {
        Solid::Sphere { radius_m } => Part::Ball(Ball::new(centre, *radius_m)),
        Solid::Capsule { radius_m, half_height_m } => {
            let end = if node == 0 { -half_height_m } else { *half_height_m };
            Part::Ball(Ball::new(centre + y * end, *radius_m))
        }
        Solid::Ellipsoid { semi_axes_m } => Part::Ellipsoid { centre_B: centre, semi_axes_m: *semi_axes_m },
        Solid::Cylinder { radius_m, half_height_m } => {
            let rolls = at.q_WB.inverse_transform_vector(&found.normal).cross(&y).norm() > ROLLS;
            let centre_B = centre + y * if node % 8 < 4 { -half_height_m } else { *half_height_m };
            if rolls && node.is_multiple_of(4) {
                Part::Rim { centre_B, axis_B: y, radius_m: *radius_m }
            } else {
                corner(at.q_WB.inverse_transform_vector(&found.r_BC_W))
            }
        }
        Solid::Box { .. } | Solid::Convex(_) => corner(at.q_WB.inverse_transform_vector(&found.r_BC_W)),
    })
}

/// Of unit vectors: less than this is parallel.
const PARALLEL: f64 = 1e-6;

fn between(model: &Model, state: &State, found: &Contact, other: usize) -> Option<Parts> {
    let bodies = [found.body, other];
    let at = bodies.map(|i| &state.bodies[i]);
    let p_B = at.map(|at| at.q_WB.inverse_transform_vector(&(found.p_WC - at.p_WB)));
    let show = |side: usize, out: Vector3<f64>| {
        shown(&model.bodies[bodies[side]], &p_B[side], &at[side].q_WB.inverse_transform_vector(&out))
    };
    let (a, b) = (show(0, -found.normal)?, show(1, found.normal)?);
    if let (Spot::Line(line_A), Spot::Line(line_B)) = (&a.spot, &b.spot) {
        let cross = (at[0].q_WB * line_A.direction_B).cross(&(at[1].q_WB * line_B.direction_B));
        if cross.norm() > PARALLEL {
            return Some(Parts::Lines([line_A.clone(), line_B.clone()]));
        }
    }
    let on = |of: usize, face: &Face, base: usize| {
        let plane = Plane {
            of: Some(bodies[base]),
            normal: face.normal_B,
            offset_m: face.offset_m,
            border: face.border.clone(),
        };
        let spot = if of == 0 { &a.spot } else { &b.spot };
        Parts::OnPlane { of: bodies[of], part: part(spot, p_B[of]), plane }
    };
    match (&a, &b) {
        // What is a corner or an edge of one is held by the face of the other.
        (Facing { face: Some(face), spot: Spot::Inside }, Facing { spot, .. }) if *spot != Spot::Inside => {
            Some(on(1, face, 0))
        }
        (_, Facing { face: Some(face), .. }) => Some(on(0, face, 1)),
        (Facing { face: Some(face), .. }, _) => Some(on(1, face, 0)),
        _ => round(&a.spot, &b.spot),
    }
}

/// Without any face.
fn round(a: &Spot, b: &Spot) -> Option<Parts> {
    let ball = |spot: &Spot| match spot {
        Spot::Part(Part::Ball(ball)) => Some(ball.clone()),
        _ => None,
    };
    let on_line = |first: bool, ball: Ball, line: &Line| {
        (ball.radius_m + line.radius_m > 0.0).then(|| Parts::BallOnLine { first, ball, line: line.clone() })
    };
    match (ball(a), ball(b), a, b) {
        (Some(a), Some(b), ..) if a.radius_m + b.radius_m > 0.0 => Some(Parts::Balls([a, b])),
        (Some(ball), _, _, Spot::Line(line)) => on_line(true, ball, line),
        (_, Some(ball), Spot::Line(line), _) => on_line(false, ball, line),
        _ => None,
    }
}

/// Of a radius: nearer to it is the end of a round side.
const AT_END: f64 = 1e-9;

/// On a face the point of a line that lies there stays one of the body's, and so does one of another face.
fn part(spot: &Spot, p_B: Vector3<f64>) -> Part {
    match spot {
        Spot::Part(part) => part.clone(),
        // A round side ends at a rim: what turns up from a face stands on that.
        Spot::Line(Line { point_B, direction_B, radius_m, ends_m, .. })
            if ends_m.iter().any(|end_m| end_m.abs() < AT_END * radius_m) =>
        {
            Part::Rim { centre_B: *point_B, axis_B: *direction_B, radius_m: *radius_m }
        }
        Spot::Line(line) => Part::Ball(Ball::new(line.point_B, line.radius_m)),
        Spot::Inside => corner(p_B),
    }
}

//! Which kind of contact one is that the contact test has found.

use super::ball_on_line::Beside;
use super::crossing::{Disc, LIES, OnRim, Outline};
use super::curved::{Curved, Side};
use super::lines::Crossing;
use super::parts::Parts;
use super::plane::{self, Plane};
use super::rim_on_edge::RimOnEdge;
use crate::collide::Contact;
use crate::event::shown::{Ball, Border, Face, Facing, Line, Part, ROLLS, Spot, face_toward, shown};
use crate::model::{Body, Geometry, Model, pose_of_solid};
use crate::shape::cylinder::{ARC, EDGE, FACE, RIM, VERTEX, are_side_by_side, kind, middle_of_arc};
use crate::shape::pair::edge_ends_W;
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

/// Of the bounding radii: points of the contact test that are one.
const BESIDE: f64 = 2e-9;

/// The same of points that are known along a round side or an edge to the root of rounding only.
const ASTRAY: f64 = 2e-7;

fn between(model: &Model, state: &State, found: &Contact, other: usize) -> Option<Parts> {
    let bodies = [found.body, other];
    let at = bodies.map(|i| &state.bodies[i]);
    let p_B = at.map(|at| at.q_WB.inverse_transform_vector(&(found.p_WC - at.p_WB)));
    let show = |side: usize, out: Vector3<f64>| {
        let out_B = at[side].q_WB.inverse_transform_vector(&out);
        let at = |off_m: f64| shown(&model.bodies[bodies[side]], &p_B[side], &out_B, off_m);
        // A point that the contact test has put to the end of something is beside it by as much.
        let size_m: f64 = bodies.iter().map(|i| model.bodies[*i].bounding_radius_m).sum();
        at(found.gap_m).or_else(|| at(BESIDE * size_m)).or_else(|| at(ASTRAY * size_m))
    };
    let on = |of: usize, face: &Face, base: usize, spot: Option<&Spot>| {
        let plane = Plane {
            of: Some(bodies[base]),
            normal: face.normal_B,
            offset_m: face.offset_m,
            border: face.border.clone(),
        };
        Parts::OnPlane { of: bodies[of], part: spot.map_or_else(|| corner(p_B[of]), |spot| part(spot, p_B[of])), plane }
    };
    let toward = |side: usize, out: Vector3<f64>| {
        face_toward(&model.bodies[bodies[side]], &at[side].q_WB.inverse_transform_vector(&out))
    };
    if let Some(crossing) = rims_crossing(model, state, found, bodies) {
        return Some(Parts::OnRim(crossing));
    }
    let (mut a, mut b) = (show(0, -found.normal), show(1, found.normal));
    if found.feature == (VERTEX, VERTEX) {
        [(&mut a, 0), (&mut b, 1)].into_iter().for_each(|(of, side)| beside_cap(&model.bodies[bodies[side]], of));
    }
    let spot = |of: &'_ Option<Facing>| of.as_ref().map(|facing| facing.spot.clone());
    let face = |of: &Option<Facing>| of.as_ref().and_then(|facing| facing.face.clone());
    // The contact test says which of two has the corner, where edges lie along each other or faces lie almost flat.
    // So do the middles of arcs.
    let is_corner = |feature: u32| [VERTEX, RIM].contains(&kind(feature));
    let middle = middle_of_arc(found.feature);
    match found.feature {
        (of, of_b) if (of == FACE && is_corner(of_b)) || middle == Some(1) => {
            if let Some(face) = face(&a).or_else(|| toward(0, -found.normal)) {
                return Some(on(1, &face, 0, spot(&b).as_ref()));
            }
        }
        (of, of_b) if (of_b == FACE && is_corner(of)) || middle == Some(0) => {
            if let Some(face) = face(&b).or_else(|| toward(1, found.normal)) {
                return Some(on(0, &face, 1, spot(&a).as_ref()));
            }
        }
        _ => {}
    }
    if let (Some(a), Some(b)) = (&a, &b)
        && let Some(parts) = facing(state, found, [a, b], &on)
    {
        return Some(parts);
    }
    let near = [(0, toward(1, found.normal), &a), (1, toward(0, -found.normal), &b)];
    near.into_iter().find_map(|(of, face, own)| Some(on(of, &face?, 1 - of, spot(own).as_ref())))
}

/// Two caps whose rims cross, by the names that the contact test gives them, however they are tilted.
fn rims_crossing(model: &Model, state: &State, found: &Contact, bodies: [usize; 2]) -> Option<OnRim> {
    if !crosses(found.feature.0) || !crosses(found.feature.1) {
        return None;
    }
    let cap = |side: usize, out_W| cap(&model.bodies[bodies[side]], &state.bodies[bodies[side]], out_W);
    let (own, other) = (cap(0, -found.normal)?, cap(1, found.normal)?);
    Some(OnRim::new(found, &|i: usize| &state.bodies[i], true, own, Outline::Rim(other)))
}

/// The cap of a cylinder that faces a direction.
fn cap(body: &Body, at: &BodyState, out_W: Vector3<f64>) -> Option<Disc> {
    let (Solid::Cylinder { radius_m, half_height_m }, centre) = body.solid()? else { return None };
    let out_B = Vector3::y() * at.q_WB.inverse_transform_vector(&out_W).y.signum();
    Some(Disc { centre_B: centre + out_B * *half_height_m, out_B, radius_m: *radius_m })
}

/// Whether it is a point of an arc's ends.
fn crosses(feature: u32) -> bool {
    feature == ARC || feature == ARC | 1
}

/// A cap next to flat whose rim crosses an edge, by the names that the contact test gives them: the point is known to
/// it less than the other kinds take to tell what is there.
pub(super) fn rim_on_edge<'a>(
    model: &Model,
    place: &impl Fn(usize) -> &'a BodyState,
    found: &Contact,
) -> Option<RimOnEdge> {
    let bodies = [found.body, found.other?];
    let features = [found.feature.0, found.feature.1];
    let of =
        (0..2).find(|k| (kind(features[*k]) == VERTEX || crosses(features[*k])) && kind(features[1 - k]) == EDGE)?;
    let base = &model.bodies[bodies[1 - of]];
    let (solid @ (Solid::Box { .. } | Solid::Convex(_)), base_centre) = base.solid()? else { return None };
    let at = bodies.map(place);
    let out_W = if of == 0 { -found.normal } else { found.normal };
    let cap = cap(&model.bodies[bodies[of]], at[of], out_W)?;
    // The point of the edge that is next to what was found.
    let ends = edge_ends_W(solid, &pose_of_solid(base_centre, at[1 - of]), features[1 - of])?;
    let d = (ends[1] - ends[0]).try_normalize(0.0)?;
    // What lies flat on a cap crosses its outline (`crossing`).
    let lies = (at[of].q_WB * cap.out_B).dot(&d).abs() <= LIES;
    if lies && kind(features[of]) == ARC && at[of].q_WB.inverse_transform_vector(&out_W).xz().norm() <= ROLLS {
        return None;
    }
    let on_W = ends[0] + d * d.dot(&(found.p_WC - ends[0]));
    let own = |v: Vector3<f64>| at[1 - of].q_WB.inverse_transform_vector(&v);
    let Spot::Line(edge) = shown(base, &own(on_W - at[1 - of].p_WB), &own(-out_W), 0.0)?.spot else { return None };
    RimOnEdge::new(found, place, of == 0, cap, edge)
}

/// The same of what has come over the border of a face or the end of an edge or a round side: with what is there. None:
/// there is nothing.
pub(super) fn over_border(model: &Model, state: &State, found: &Contact, parts: &Parts) -> Option<Parts> {
    let at = |i: usize| &state.bodies[i];
    match parts {
        Parts::OnPlane { of, part, plane } => over_face(model, state, found, (*of, part), plane),
        Parts::Lines(lines) => {
            let bodies = [found.body, found.other?];
            let Crossing { s, t, .. } = Crossing::new(&bodies.map(at), lines);
            let spots = [0, 1].map(|i| end_of(&model.bodies[bodies[i]], &lines[i], [s, t][i]));
            let is_line = |spot: &Spot| matches!(spot, Spot::Line(_));
            if spots.iter().all(is_line) {
                return None;
            }
            round(&spots[0], &spots[1]).or_else(|| curved(state, found, [&spots[0], &spots[1]]))
        }
        Parts::BallOnLine { first, ball, line } => {
            let bodies = [found.body, found.other?];
            let Beside { s, .. } = Beside::new(bodies.map(at), *first, ball, line);
            let end = end_of(&model.bodies[bodies[usize::from(*first)]], line, s);
            let ball = Spot::Part(Part::Ball(ball.clone()));
            let spots = if *first { [&ball, &end] } else { [&end, &ball] };
            let is_line = matches!(end, Spot::Line(_));
            if is_line { None } else { round(spots[0], spots[1]).or_else(|| curved(state, found, spots)) }
        }
        // What is curved beyond the end of an edge is on its corner.
        Parts::Curved(meeting) => {
            let bodies = [found.body, found.other?];
            let (side, line, along_m, part) = meeting.along_line(bodies.map(at))?;
            let end_m = along_m.clamp(line.ends_m[0], line.ends_m[1]);
            let out_W = if side == 0 { -found.normal } else { found.normal };
            let out_B = at(bodies[side]).q_WB.inverse_transform_vector(&out_W);
            let end_B = line.point_B + line.direction_B * end_m;
            let end = shown(&model.bodies[bodies[side]], &end_B, &out_B, 0.0)?.spot;
            let part = Spot::Part(part.clone());
            let is_end = end_m != along_m && matches!(end, Spot::Part(_));
            if is_end { curved(state, found, if side == 0 { [&end, &part] } else { [&part, &end] }) } else { None }
        }
        Parts::Balls(_) | Parts::OnRim(_) | Parts::RimOnEdge(_) => None,
    }
}

/// What is at so far along a line: it, or what it ends in.
fn end_of(body: &Body, line: &Line, along_m: f64) -> Spot {
    let end_m = along_m.clamp(line.ends_m[0], line.ends_m[1]);
    if end_m == along_m {
        return Spot::Line(line.clone());
    }
    let end_B = line.point_B + line.direction_B * end_m;
    Spot::Part(match body.solid() {
        Some((Solid::Cylinder { radius_m, .. }, _)) => {
            Part::Rim { centre_B: end_B, axis_B: line.direction_B, radius_m: *radius_m }
        }
        _ => Part::Ball(Ball { centre_B: end_B, radius_m: line.radius_m, cone: Vec::new() }),
    })
}

/// The tilt (rad) of a rim whose lowest point is told well by its normal.
const LEANS: f64 = 1e-3;

/// What is round, on the edge of the face over whose border it has come.
fn over_face(
    model: &Model,
    state: &State,
    found: &Contact,
    (of, part): (usize, &Part),
    plane: &Plane,
) -> Option<Parts> {
    let base = plane.of?;
    let at = |i: usize| &state.bodies[i];
    let out_W = at(base).q_WB * plane.normal;
    if let Part::Rim { centre_B, axis_B, radius_m } = part {
        let axis_W = at(of).q_WB * axis_B;
        if axis_W.cross(&out_W).norm() <= LEANS {
            let out_B = axis_B * -axis_W.dot(&out_W).signum();
            let cap = Disc { centre_B: *centre_B, out_B, radius_m: *radius_m };
            let edge = edge_beside(&model.bodies[base], at(base), found, plane)?;
            return RimOnEdge::new(found, &at, of == found.body, cap, edge).map(Parts::RimOnEdge);
        }
    }
    // Where a cap ends, the normal alone tells the point of a ball only.
    let is_told = match part {
        Part::Ball(ball) => ball.radius_m > 0.0,
        Part::Rim { .. } | Part::Ellipsoid { .. } => !matches!(plane.border, Border::Round { .. }),
    };
    if !is_told {
        return None;
    }
    let (contact, _) = plane::here(found, &at, of, part, plane);
    let p_B = at(base).q_WB.inverse_transform_vector(&(contact.p_WC - at(base).p_WB));
    let edge = match &plane.border {
        Border::Nowhere => return None,
        Border::Walls(_) => {
            let on = plane.border.onto(&p_B, &plane.normal);
            shown(&model.bodies[base], &on, &plane.normal, 0.0)?.spot
        }
        Border::Round { centre_B, radius_m } => {
            let n = plane.normal;
            let centre_B = centre_B + n * (plane.offset_m - n.dot(centre_B));
            Spot::Part(Part::Rim { centre_B, axis_B: Vector3::y(), radius_m: *radius_m })
        }
    };
    let own = Spot::Part(part.clone());
    let spots = if of == found.body { [&own, &edge] } else { [&edge, &own] };
    round(spots[0], spots[1]).or_else(|| curved(state, found, spots))
}

/// What lies beside a cap meets its rim, however little the normal is off the cap's.
fn beside_cap(body: &Body, of: &mut Option<Facing>) {
    if let (Some((Solid::Cylinder { radius_m, half_height_m }, centre)), Some(facing)) = (body.solid(), &mut *of)
        && let Some(face) = &facing.face
    {
        let (axis_B, radius_m) = (Vector3::y(), *radius_m);
        let centre_B = centre + face.normal_B * *half_height_m;
        *facing = Facing { spot: Spot::Part(Part::Rim { centre_B, axis_B, radius_m }), face: None };
    }
}

/// The edge of a face that is next to what was found.
fn edge_beside(body: &Body, at: &BodyState, found: &Contact, plane: &Plane) -> Option<Line> {
    let (Border::Walls(walls), n) = (&plane.border, plane.normal) else { return None };
    let p_B = at.q_WB.inverse_transform_vector(&(found.p_WC - at.p_WB));
    let on = p_B + n * (plane.offset_m - n.dot(&p_B));
    let inside_m = |(wall, offset_m): &(Vector3<f64>, f64)| offset_m - wall.dot(&on);
    let nearest = walls.iter().min_by(|a, b| inside_m(a).total_cmp(&inside_m(b)))?;
    let along = nearest.0 - n * n.dot(&nearest.0);
    match shown(body, &(on + along * (inside_m(nearest) / along.norm_squared())), &n, 0.0)?.spot {
        Spot::Line(edge) => Some(edge),
        Spot::Part(_) | Spot::Inside => None,
    }
}

/// Of parts that both bodies show.
fn facing(
    state: &State,
    found: &Contact,
    [a, b]: [&Facing; 2],
    on: &impl Fn(usize, &Face, usize, Option<&Spot>) -> Parts,
) -> Option<Parts> {
    let at = [found.body, found.other?].map(|i| &state.bodies[i]);
    if let (Spot::Line(line_A), Spot::Line(line_B)) = (&a.spot, &b.spot) {
        let cross = (at[0].q_WB * line_A.direction_B).cross(&(at[1].q_WB * line_B.direction_B));
        if cross.norm() > PARALLEL && !are_side_by_side(found.feature) {
            return Some(Parts::Lines([line_A.clone(), line_B.clone()]));
        }
    }
    if let Some((first, cap, outline)) = crossing(found.feature, a, b) {
        let bodies = |i: usize| &state.bodies[i];
        return Some(Parts::OnRim(OnRim::new(found, &bodies, first, cap, outline)));
    }
    match (a, b) {
        // What is a corner or an edge of one is held by the face of the other.
        (Facing { face: Some(face), spot: Spot::Inside }, Facing { spot, .. }) if *spot != Spot::Inside => {
            Some(on(1, face, 0, Some(spot)))
        }
        (_, Facing { face: Some(face), .. }) => Some(on(0, face, 1, Some(&a.spot))),
        (Facing { face: Some(face), .. }, _) => Some(on(1, face, 0, Some(&b.spot))),
        _ => round(&a.spot, &b.spot).or_else(|| curved(state, found, [&a.spot, &b.spot])),
    }
}

/// What crosses a rim there, if the contact test says so: whether the cap is of the first body, and what of the other
/// one it is.
fn crossing(feature: (u32, u32), a: &Facing, b: &Facing) -> Option<(bool, Disc, Outline)> {
    let cap = |facing: &Facing| facing.face.as_ref().and_then(Disc::of);
    let with = |first: bool, of: &Facing, other: &Facing| match &other.spot {
        Spot::Line(line) => Some((first, cap(of)?, Outline::Line(line.clone()))),
        _ => None,
    };
    match (crosses(feature.0), crosses(feature.1)) {
        (true, false) => with(true, a, b),
        (false, true) => with(false, b, a),
        _ => None,
    }
}

/// Of its length: nearer to it is the end of a line.
const ENDS: f64 = 1e-8;

/// Whether a line ends where it was found.
fn ends(line: &Line) -> bool {
    let [from_m, to_m] = line.ends_m;
    from_m.abs().min(to_m.abs()) <= ENDS * (to_m - from_m)
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
        // Side by side: a point of the one's middle line stays so, however it rolls; of the one that ends there, its
        // end.
        (.., Spot::Line(line), Spot::Line(own)) if ends(own) => {
            on_line(false, Ball::new(own.point_B, own.radius_m), line)
        }
        (.., Spot::Line(own), Spot::Line(line)) => on_line(true, Ball::new(own.point_B, own.radius_m), line),
        _ => None,
    }
}

/// Of which one is a rim or an ellipsoid.
fn curved(state: &State, found: &Contact, spots: [&Spot; 2]) -> Option<Parts> {
    let side = |spot: &Spot| match spot {
        Spot::Part(part) => Some(Side::Part(part.clone())),
        Spot::Line(line) => Some(Side::Line(line.clone())),
        Spot::Inside => None,
    };
    let sides = [side(spots[0])?, side(spots[1])?];
    Curved::new(found, &|i: usize| &state.bodies[i], sides).map(Parts::Curved)
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

//! What a solid shows at a point of its surface: the part that meets another body there, and the face, if its normal is
//! one's.

use crate::model::Body;
use crate::shape::cylinder::FLAT;
use crate::shape::hull::{Hull, Polygon};
use crate::shape::solid::Solid;
use nalgebra::Vector3;

/// Everything from the centre of mass, body axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Spot {
    Part(Part),
    Line(Line),
    /// Of a face, away from corners and edges.
    Inside,
}

/// A convex part that has one point farthest in every direction.
#[derive(Clone, Debug, PartialEq)]
pub enum Part {
    Ball(Ball),
    Rim { centre_B: Vector3<f64>, axis_B: Vector3<f64>, radius_m: f64 },
    Ellipsoid { centre_B: Vector3<f64>, semi_axes_m: Vector3<f64> },
}

/// Of radius 0: a corner.
#[derive(Clone, Debug, PartialEq)]
pub struct Ball {
    pub centre_B: Vector3<f64>,
    pub radius_m: f64,
    /// Normals from it have no part against any of these; beyond, what it ends is nearer.
    pub cone: Vec<Vector3<f64>>,
}

impl Ball {
    pub fn new(centre_B: Vector3<f64>, radius_m: f64) -> Self {
        Ball { centre_B, radius_m, cone: Vec::new() }
    }
}

/// How far a direction, with its length, is within a cone.
pub fn within_m(cone: &[Vector3<f64>], out_B: &Vector3<f64>) -> f64 {
    cone.iter().map(|along| along.dot(out_B)).fold(f64::INFINITY, f64::min)
}

/// An edge (radius 0), or the side of a capsule or a cylinder.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    pub point_B: Vector3<f64>,
    pub direction_B: Vector3<f64>,
    pub radius_m: f64,
    /// As of a ball.
    pub cone: Vec<Vector3<f64>>,
    /// From the point, along the direction.
    pub ends_m: [f64; 2],
}

#[derive(Clone, Debug, PartialEq)]
pub struct Face {
    pub normal_B: Vector3<f64>,
    pub offset_m: f64,
    pub border: Border,
}

/// Where a face ends.
#[derive(Clone, Debug, PartialEq)]
pub enum Border {
    Nowhere,
    /// n·x ≤ offset.
    Walls(Vec<(Vector3<f64>, f64)>),
    Round {
        centre_B: Vector3<f64>,
        radius_m: f64,
    },
}

impl Border {
    /// How far inside a point of the face is.
    pub fn inside_m(&self, p_B: &Vector3<f64>) -> f64 {
        match self {
            Border::Nowhere => f64::INFINITY,
            Border::Walls(walls) => {
                walls.iter().map(|(normal, offset_m)| offset_m - normal.dot(p_B)).fold(f64::INFINITY, f64::min)
            }
            Border::Round { centre_B, radius_m } => radius_m - (p_B - centre_B).xz().norm(),
        }
    }
}

impl Border {
    /// The point of the border that is next to one beyond it, in a face with this normal.
    pub fn onto(&self, p_B: &Vector3<f64>, normal_B: &Vector3<f64>) -> Vector3<f64> {
        let mut on = *p_B;
        if let Border::Walls(walls) = self {
            for (wall, offset_m) in walls {
                let along = wall - normal_B * normal_B.dot(wall);
                let beyond_m = wall.dot(&on) - offset_m;
                if beyond_m > 0.0 && along != Vector3::zeros() {
                    on -= along * (beyond_m / along.norm_squared());
                }
            }
        }
        on
    }
}

pub struct Facing {
    pub spot: Spot,
    pub face: Option<Face>,
}

/// Of a unit vector: the normal is the face's.
const ALONG: f64 = 1e-9;

/// The same of what is between the ends of a round side: a normal is known to the contact test to the root of rounding
/// only, and nothing else is there.
const ASIDE: f64 = 1e-6;

/// Of a cap's tilt (rad): a steeper one rolls along its rim, one less steep stands on points of the body (`caps`).
pub const ROLLS: f64 = 1.75 * FLAT;

/// Of the bounding radius: the point is on the corner, on the edge. Less than a point may be beyond a border (`touch`).
const AT: f64 = 2e-10;

/// Of a unit vector's cosine: a face along which it nearly is.
const NEARLY: f64 = 0.95;

/// The face that is nearest to having this outward normal, if it nearly does; of what has corners.
pub fn face_toward(body: &Body, out_B: &Vector3<f64>) -> Option<Face> {
    let (solid, centre) = body.solid()?;
    let face = match solid {
        Solid::Box { half_m } => face_of_box(half_m, centre, out_B),
        Solid::Convex(hull) => {
            let along = |i: &usize| hull.faces[*i].normal.dot(out_B);
            let i = (0..hull.faces.len()).max_by(|i, j| along(i).total_cmp(&along(j)))?;
            face_of_hull(hull, centre, i)
        }
        _ => return None,
    };
    (face.normal_B.dot(out_B) > NEARLY).then_some(face)
}

/// At a point with this outward normal, of a contact that is so far open.
pub fn shown(body: &Body, p_B: &Vector3<f64>, out_B: &Vector3<f64>, gap_m: f64) -> Option<Facing> {
    let (solid, centre) = body.solid()?;
    let (y, own, near) = (Vector3::y(), p_B - centre, AT * body.bounding_radius_m + gap_m.abs());
    let only = |spot: Spot| Facing { spot, face: None };
    // Of something about the axis y, at this height.
    let side = |y_m: f64, radius_m: f64, half_m: f64| {
        Spot::Line(Line {
            point_B: centre + y * y_m,
            direction_B: y,
            radius_m,
            cone: Vec::new(),
            ends_m: [-half_m - y_m, half_m - y_m],
        })
    };
    Some(match solid {
        Solid::Sphere { radius_m } => only(ball(*centre, *radius_m, Vec::new())),
        Solid::Ellipsoid { semi_axes_m } => {
            only(Spot::Part(Part::Ellipsoid { centre_B: *centre, semi_axes_m: *semi_axes_m }))
        }
        Solid::Capsule { radius_m, half_height_m } => {
            let y_m = (own - out_B * *radius_m).y;
            let at_end = y_m.abs() >= half_height_m - near;
            let end = centre + y * half_height_m.copysign(y_m);
            only(if at_end {
                ball(end, *radius_m, vec![y * y_m.signum()])
            } else {
                side(y_m, *radius_m, *half_height_m)
            })
        }
        Solid::Cylinder { radius_m, half_height_m } => {
            let (normal_B, end) = (y * out_B.y.signum(), centre + y * half_height_m.copysign(out_B.y));
            let is_at_end = own.y.abs() >= half_height_m - near;
            if (out_B - normal_B).norm() <= ROLLS {
                let border = Border::Round { centre_B: *centre, radius_m: *radius_m };
                let face = Face { normal_B, offset_m: normal_B.dot(&end), border };
                let radial = Vector3::new(own.x, 0.0, own.z);
                let is_on_rim = (radial.norm() - radius_m).abs() <= near;
                let spot = if is_on_rim { ball(end + radial, 0.0, Vec::new()) } else { Spot::Inside };
                Facing { spot, face: Some(face) }
            } else if out_B.y.abs() <= if is_at_end { ALONG } else { ASIDE } {
                only(side(own.y.clamp(-half_height_m, *half_height_m), *radius_m, *half_height_m))
            } else {
                // Of a round side that all but lies, the rim that is higher touches as well.
                let end = if is_at_end { centre + y * half_height_m.copysign(own.y) } else { end };
                only(Spot::Part(Part::Rim { centre_B: end, axis_B: y, radius_m: *radius_m }))
            }
        }
        Solid::Box { half_m } => of_box(half_m, centre, &own, out_B, near)?,
        Solid::Convex(hull) => of_hull(hull, centre, &own, out_B, near)?,
    })
}

fn ball(centre_B: Vector3<f64>, radius_m: f64, cone: Vec<Vector3<f64>>) -> Spot {
    Spot::Part(Part::Ball(Ball { centre_B, radius_m, cone }))
}

fn of_box(
    half_m: &Vector3<f64>,
    centre: &Vector3<f64>,
    own: &Vector3<f64>,
    out_B: &Vector3<f64>,
    near: f64,
) -> Option<Facing> {
    let axis = out_B.iamax();
    let normal_B = Vector3::ith(axis, out_B[axis].signum());
    let is_face = (out_B - normal_B).norm() <= ALONG;
    let face = is_face.then(|| face_of_box(half_m, centre, out_B));
    let at = |k: &usize| (half_m[*k] - own[*k].abs()).abs() <= near;
    let corner = half_m.zip_map(own, |half, x| half.copysign(x));
    let out = |k: usize| Vector3::ith(k, corner[k].signum());
    let free: Vec<usize> = (0..3).filter(|k| !at(k)).collect();
    let spot = match free[..] {
        [] => ball(centre + corner, 0.0, (0..3).map(out).collect()),
        [k] => {
            let mut point = corner;
            point[k] = own[k];
            Spot::Line(Line {
                point_B: centre + point,
                direction_B: Vector3::ith(k, 1.0),
                radius_m: 0.0,
                cone: (0..3).filter(|j| *j != k).map(out).collect(),
                ends_m: [-half_m[k] - own[k], half_m[k] - own[k]],
            })
        }
        _ if is_face => Spot::Inside,
        _ => return None,
    };
    Some(Facing { spot, face })
}

/// The one nearest to a direction.
fn face_of_box(half_m: &Vector3<f64>, centre: &Vector3<f64>, out_B: &Vector3<f64>) -> Face {
    let axis = out_B.iamax();
    let normal_B = Vector3::ith(axis, out_B[axis].signum());
    let wall = |k: usize, sign: f64| (Vector3::ith(k, sign), half_m[k] + sign * centre[k]);
    Face {
        normal_B,
        offset_m: half_m[axis] + normal_B.dot(centre),
        border: Border::Walls((0..3).filter(|k| *k != axis).flat_map(|k| [wall(k, 1.0), wall(k, -1.0)]).collect()),
    }
}

fn face_of_hull(hull: &Hull, centre: &Vector3<f64>, i: usize) -> Face {
    let offset_m = |f: &Polygon| f.normal.dot(&(hull.vertices[f.corners[0] as usize] + centre));
    let others = hull.faces.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, f)| (f.normal, offset_m(f)));
    let own = &hull.faces[i];
    Face { normal_B: own.normal, offset_m: offset_m(own), border: Border::Walls(others.collect()) }
}

fn of_hull(hull: &Hull, centre: &Vector3<f64>, own: &Vector3<f64>, out_B: &Vector3<f64>, near: f64) -> Option<Facing> {
    let vertex = |i: u32| hull.vertices[i as usize];
    let which = hull.faces.iter().position(|face| (face.normal - out_B).norm() <= ALONG);
    let face = which.map(|i| face_of_hull(hull, centre, i));
    // Every edge twice, once with either face.
    let mut edges: Vec<(&Polygon, u32, u32)> = Vec::new();
    for f in &hull.faces {
        edges.extend((0..f.corners.len()).map(|k| (f, f.corners[k], f.corners[(k + 1) % f.corners.len()])));
    }
    if let Some(i) = (0..hull.vertices.len() as u32).find(|i| (vertex(*i) - own).norm() <= near) {
        let away =
            |(_, from, to): &(&Polygon, u32, u32)| (*from == i).then(|| (vertex(*from) - vertex(*to)).normalize());
        return Some(Facing { spot: ball(centre + vertex(i), 0.0, edges.iter().filter_map(away).collect()), face });
    }
    let line = edges.iter().find_map(|(f, i, j)| {
        let (from, to) = (vertex(*i), vertex(*j));
        let (length, direction) = ((to - from).norm(), (to - from).normalize());
        let along = direction.dot(&(own - from));
        let on = from + direction * along;
        let is_on = (on - own).norm() <= near && along > 0.0 && along < length;
        let beyond = |f: &Polygon, d: &Vector3<f64>| d.cross(&f.normal);
        let other = edges.iter().find(|(_, a, b)| (a, b) == (j, i)).map(|(f, ..)| beyond(f, &-direction));
        is_on.then(|| Line {
            point_B: centre + on,
            direction_B: direction,
            radius_m: 0.0,
            cone: std::iter::once(beyond(f, &direction)).chain(other).collect(),
            ends_m: [-along, length - along],
        })
    });
    match line {
        Some(line) => Some(Facing { spot: Spot::Line(line), face }),
        None if face.is_some() => Some(Facing { spot: Spot::Inside, face }),
        None => None,
    }
}

//! A point of contact as a function of where its bodies are, and how it moves with them: the geometry that accelerations
//! need.
//!
//! `Contact` is what the contact test finds in one state; a `Touch` is the same point in every other state: which parts of
//! the two bodies meet. Its rates are analytic. With V̇ = 0 the relative velocity u of the geometric point of contact
//! changes by β = ω_A × ṙ_A − ω_B × ṙ_B, and its normal part by n·β + ṅ·u: for a rolling sphere ṙ = 0, for a corner
//! ṙ = ω × r (F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts, 1996, ch. 4).

use crate::collide::solid::Solid;
use crate::collide::{Contact, Key};
use crate::model::{Body, Geometry, Model};
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// What meets what.
#[derive(Clone, Debug, PartialEq)]
pub struct Touch {
    /// As of the contact test; friction and restitution are in it.
    found: Contact,
    parts: Parts,
}

#[derive(Clone, Debug, PartialEq)]
enum Parts {
    /// A part of one body on a plane of the other, or of the container.
    OnPlane { of: usize, part: Part, plane: Plane },
    /// Two balls: centres in body axes, and radii.
    Balls([(Vector3<f64>, f64); 2]),
}

/// A convex part that has one point farthest in every direction; from the centre of mass, body axes.
#[derive(Clone, Debug, PartialEq)]
enum Part {
    /// Of radius 0: a corner.
    Ball {
        centre_B: Vector3<f64>,
        radius_m: f64,
    },
    Rim {
        centre_B: Vector3<f64>,
        axis_B: Vector3<f64>,
        radius_m: f64,
    },
    Ellipsoid {
        centre_B: Vector3<f64>,
        semi_axes_m: Vector3<f64>,
    },
}

/// n·x ≥ offset is free: of the world, or in a body's axes about its centre of mass.
#[derive(Clone, Debug, PartialEq)]
struct Plane {
    of: Option<usize>,
    normal: Vector3<f64>,
    offset_m: f64,
}

/// A touch in one state.
#[derive(Clone, Copy, Debug)]
pub struct Here {
    pub contact: Contact,
    /// u of the bodies' velocities: of the body's point against the other's.
    pub velocity_W: Vector3<f64>,
    /// β, and the normal part's ṅ·u.
    pub bias_W: Vector3<f64>,
    pub turning: f64,
}

impl Here {
    /// What the bodies' velocities alone add to the relative acceleration, in the contact's frame.
    pub fn bias(&self, frame: &[Vector3<f64>; 3]) -> Vector3<f64> {
        let [n, t1, t2] = frame.map(|e| e.dot(&self.bias_W));
        Vector3::new(n + self.turning, t1, t2)
    }

    pub fn normal_speed(&self) -> f64 {
        self.contact.normal.dot(&self.velocity_W)
    }

    /// Velocity along the surface.
    pub fn slip_W(&self) -> Vector3<f64> {
        self.velocity_W - self.contact.normal * self.normal_speed()
    }
}

/// Rates of a geometric point of contact: from both centres of mass, and of the normal.
struct Rates {
    r_A: Vector3<f64>,
    r_B: Vector3<f64>,
    normal: Vector3<f64>,
}

impl Touch {
    /// None: parts whose motion along each other is not known here.
    pub fn new(model: &Model, state: &State, found: &Contact) -> Option<Self> {
        let parts = match found.other {
            None => on_container(model, state, found),
            Some(other) => between(model, state, found, other),
        };
        Some(Touch { found: *found, parts: parts? })
    }

    pub fn key(&self) -> Key {
        self.found.key()
    }

    /// The two bodies, or the one.
    pub fn bodies(&self) -> impl Iterator<Item = usize> {
        std::iter::once(self.found.body).chain(self.found.other)
    }

    /// On a plane, whose normal turns only with its body.
    pub fn is_on_plane(&self) -> bool {
        matches!(self.parts, Parts::OnPlane { .. })
    }

    pub fn friction(&self) -> f64 {
        self.found.friction
    }

    pub fn here(&self, state: &State) -> Here {
        self.here_of(|i| &state.bodies[i])
    }

    /// `at`: a body by its index.
    pub fn here_of<'a>(&self, at: impl Fn(usize) -> &'a BodyState) -> Here {
        let (mut contact, rates) = match &self.parts {
            Parts::OnPlane { of, part, plane } => self.on_plane(&at, *of, part, plane),
            Parts::Balls(balls) => self.balls(&at, balls),
        };
        let (a, b) = (at(contact.body), contact.other.map(&at));
        contact.r_BC_W = contact.p_WC - a.p_WB;
        contact.r_OC_W = b.map_or_else(Vector3::zeros, |b| contact.p_WC - b.p_WB);
        let velocity_W = contact.velocity(|i| [at(i).v_WB, at(i).w_WB]);
        let bias_W = a.w_WB.cross(&rates.r_A) - b.map_or_else(Vector3::zeros, |b| b.w_WB.cross(&rates.r_B));
        Here { contact, velocity_W, bias_W, turning: rates.normal.dot(&velocity_W) }
    }

    fn on_plane<'a>(
        &self,
        bodies: &impl Fn(usize) -> &'a BodyState,
        of: usize,
        part: &Part,
        plane: &Plane,
    ) -> (Contact, Rates) {
        let at = bodies(of);
        let base = plane.of.map(bodies);
        let zero = Vector3::zeros();
        let w_plane = base.map_or(zero, |base| base.w_WB);
        let normal = base.map_or(plane.normal, |base| base.q_WB * plane.normal);
        let normal_rate = w_plane.cross(&normal);
        let (r, r_rate) = part.farthest(at, &-normal, &-normal_rate);
        let point = at.p_WB + r;
        let gap_m = normal.dot(&(point - base.map_or(zero, |base| base.p_WB))) - plane.offset_m;
        let base_rate = at.v_WB + r_rate - base.map_or(zero, |base| base.v_WB);
        let own = of == self.found.body;
        let (sign, r_A, r_B) = if own { (1.0, r_rate, base_rate) } else { (-1.0, base_rate, r_rate) };
        let contact = Contact { p_WC: point, normal: normal * sign, gap_m, ..self.found };
        (contact, Rates { r_A, r_B, normal: normal_rate * sign })
    }

    fn balls<'a>(
        &self,
        bodies: &impl Fn(usize) -> &'a BodyState,
        balls: &[(Vector3<f64>, f64); 2],
    ) -> (Contact, Rates) {
        let at = [self.found.body, self.found.other.unwrap_or(self.found.body)].map(bodies);
        let arm = [0, 1].map(|i| at[i].q_WB * balls[i].0);
        let arm_rate = [0, 1].map(|i| at[i].w_WB.cross(&arm[i]));
        let apart = at[0].p_WB + arm[0] - at[1].p_WB - arm[1];
        let apart_rate = at[0].v_WB + arm_rate[0] - at[1].v_WB - arm_rate[1];
        let distance = apart.norm();
        let normal = apart / distance;
        let normal_rate = (apart_rate - normal * normal.dot(&apart_rate)) / distance;
        let [radius_A, radius_B] = [balls[0].1, balls[1].1];
        let contact = Contact {
            p_WC: at[0].p_WB + arm[0] - normal * radius_A,
            normal,
            gap_m: distance - radius_A - radius_B,
            ..self.found
        };
        let (r_A, r_B) = (arm_rate[0] - normal_rate * radius_A, arm_rate[1] + normal_rate * radius_B);
        (contact, Rates { r_A, r_B, normal: normal_rate })
    }
}

impl Part {
    /// The point farthest along d (unit), from the centre of mass, world axes; and its rate.
    fn farthest(&self, at: &BodyState, d: &Vector3<f64>, d_rate: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let with_body = |r: Vector3<f64>| at.w_WB.cross(&r);
        match self {
            Part::Ball { centre_B, radius_m } => {
                let arm = at.q_WB * centre_B;
                (arm + d * *radius_m, with_body(arm) + d_rate * *radius_m)
            }
            Part::Rim { centre_B, axis_B, radius_m } => {
                let (arm, axis) = (at.q_WB * centre_B, at.q_WB * axis_B);
                let axis_rate = with_body(axis);
                let along = axis.dot(d);
                let radial = d - axis * along;
                let length = radial.norm();
                let radial_rate = d_rate - axis_rate * along - axis * (axis_rate.dot(d) + axis.dot(d_rate));
                let u = radial / length;
                let u_rate = (radial_rate - u * u.dot(&radial_rate)) / length;
                (arm + u * *radius_m, with_body(arm) + u_rate * *radius_m)
            }
            Part::Ellipsoid { centre_B, semi_axes_m } => {
                let d_B = at.q_WB.inverse_transform_vector(d);
                let d_rate_B = at.q_WB.inverse_transform_vector(&(d_rate - with_body(*d)));
                let squares = semi_axes_m.component_mul(semi_axes_m);
                let (s, s_rate) = (squares.component_mul(&d_B), squares.component_mul(&d_rate_B));
                let h = semi_axes_m.component_mul(&d_B).norm();
                let u_B = s / h;
                let u_rate_B = s_rate / h - s * (s.dot(&d_rate_B) / (h * h * h));
                let r = at.q_WB * (centre_B + u_B);
                (r, with_body(r) + at.q_WB * u_rate_B)
            }
        }
    }
}

fn corner(centre_B: Vector3<f64>) -> Part {
    Part::Ball { centre_B, radius_m: 0.0 }
}

fn on_container(model: &Model, state: &State, found: &Contact) -> Option<Parts> {
    let (face, node) = found.feature;
    let face = model.container.as_ref()?.faces[face as usize];
    let plane = Plane { of: None, normal: face.normal, offset_m: face.offset_m };
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
        Solid::Sphere { radius_m } => Part::Ball { centre_B: centre, radius_m: *radius_m },
        Solid::Capsule { radius_m, half_height_m } => {
            let end = if node == 0 { -half_height_m } else { *half_height_m };
            Part::Ball { centre_B: centre + y * end, radius_m: *radius_m }
        }
        Solid::Ellipsoid { semi_axes_m } => Part::Ellipsoid { centre_B: centre, semi_axes_m: *semi_axes_m },
        Solid::Cylinder { radius_m, half_height_m } => {
            let tilted = at.q_WB.inverse_transform_vector(&found.normal).cross(&y).norm() > TILTED;
            let centre_B = centre + y * if node < 4 { -half_height_m } else { *half_height_m };
            if tilted && node.is_multiple_of(4) {
                Part::Rim { centre_B, axis_B: y, radius_m: *radius_m }
            } else {
                corner(at.q_WB.inverse_transform_vector(&found.r_BC_W))
            }
        }
        Solid::Box { .. } | Solid::Convex(_) => corner(at.q_WB.inverse_transform_vector(&found.r_BC_W)),
    })
}

/// Of a cap (rad): flatter, four points of its rim stand for it.
const TILTED: f64 = 1e-8;

/// What a solid shows to another one.
enum Shown {
    Ball(Vector3<f64>, f64),
    Face {
        normal_B: Vector3<f64>,
        offset_m: f64,
    },
    Ellipsoid(Vector3<f64>, Vector3<f64>),
    /// An edge or something else that is curved.
    Other,
}

fn between(model: &Model, state: &State, found: &Contact, other: usize) -> Option<Parts> {
    let bodies = [found.body, other];
    let shown = |side: usize, out: Vector3<f64>| {
        let (body, at) = (&model.bodies[bodies[side]], &state.bodies[bodies[side]]);
        let p_B = at.q_WB.inverse_transform_vector(&(found.p_WC - at.p_WB));
        Some((shows(body, &p_B, &at.q_WB.inverse_transform_vector(&out))?, p_B))
    };
    let (a, p_A) = shown(0, -found.normal)?;
    let (b, p_B) = shown(1, found.normal)?;
    let plane = |of: usize, normal: Vector3<f64>, offset_m: f64| Plane { of: Some(of), normal, offset_m };
    let on = |of: usize, part: Part, plane: Plane| Some(Parts::OnPlane { of, part, plane });
    match (a, b) {
        (Shown::Ball(a, r), Shown::Ball(b, s)) => Some(Parts::Balls([(a, r), (b, s)])),
        (a, Shown::Face { normal_B, offset_m }) => on(bodies[0], part(a, p_A)?, plane(other, normal_B, offset_m)),
        (Shown::Face { normal_B, offset_m }, b) => on(other, part(b, p_B)?, plane(bodies[0], normal_B, offset_m)),
        _ => None,
    }
}

/// Two faces, or a face and an edge: the point stays one of the body's.
fn part(shown: Shown, p_B: Vector3<f64>) -> Option<Part> {
    match shown {
        Shown::Ball(centre_B, radius_m) => Some(Part::Ball { centre_B, radius_m }),
        Shown::Ellipsoid(centre_B, semi_axes_m) => Some(Part::Ellipsoid { centre_B, semi_axes_m }),
        Shown::Face { .. } => Some(corner(p_B)),
        Shown::Other => None,
    }
}

/// At a point of its surface with this outward normal, both in body axes.
fn shows(body: &Body, p_B: &Vector3<f64>, out_B: &Vector3<f64>) -> Option<Shown> {
    /// Of a unit vector: the normal is the face's.
    const ALONG: f64 = 1e-9;
    /// Of the bounding radius: the point is the corner.
    const AT: f64 = 1e-7;
    let (solid, centre) = body.solid()?;
    let near = AT * body.bounding_radius_m;
    let face =
        |normal_B: Vector3<f64>, offset_m: f64| Shown::Face { normal_B, offset_m: offset_m + normal_B.dot(centre) };
    let y = Vector3::y();
    Some(match solid {
        Solid::Sphere { radius_m } => Shown::Ball(*centre, *radius_m),
        Solid::Ellipsoid { semi_axes_m } => Shown::Ellipsoid(*centre, *semi_axes_m),
        Solid::Capsule { radius_m, half_height_m } => {
            let ends = [-half_height_m, *half_height_m].map(|end| centre + y * end);
            let end = ends.into_iter().find(|end| (p_B - out_B * *radius_m - end).norm() <= near);
            end.map_or(Shown::Other, |end| Shown::Ball(end, *radius_m))
        }
        Solid::Box { half_m } => {
            let axis = out_B.iamax();
            let normal_B = Vector3::ith(axis, out_B[axis].signum());
            if (out_B - normal_B).norm() <= ALONG {
                face(normal_B, half_m[axis])
            } else {
                let own = p_B - centre;
                let at = half_m.zip_map(&own, |half, x| half.copysign(x));
                if (own - at).norm() <= near { Shown::Ball(centre + at, 0.0) } else { Shown::Other }
            }
        }
        Solid::Cylinder { half_height_m, .. } => {
            let normal_B = y * out_B.y.signum();
            if (out_B - normal_B).norm() <= ALONG { face(normal_B, *half_height_m) } else { Shown::Other }
        }
        Solid::Convex(hull) => {
            let own = p_B - centre;
            let along = hull.faces.iter().find(|face| (face.normal - out_B).norm() <= ALONG);
            let at = hull.vertices.iter().find(|v| (*v - own).norm() <= near);
            match (along, at) {
                (Some(f), _) => face(f.normal, f.normal.dot(&hull.vertices[f.corners[0] as usize])),
                (None, Some(v)) => Shown::Ball(centre + v, 0.0),
                _ => Shown::Other,
            }
        }
    })
}

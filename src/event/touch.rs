//! A point of contact as a function of where its bodies are, and how it moves with them: the geometry that
//! accelerations need.
//!
//! `Contact` is what the contact test finds in one state; a `Touch` is the same point in every other state: which parts
//! of the two bodies meet. Its rates are analytic. With V̇ = 0 the relative velocity u of the geometric point of
//! contact changes by β = ω_A × ṙ_A − ω_B × ṙ_B, and its normal part by n·β + ṅ·u: for a rolling sphere ṙ = 0, for a
//! corner ṙ = ω × r (F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts, 1996, ch. 4).

use super::shown::{Ball, Border, Face, Facing, Line, Part, Spot, shown, within_m};
use crate::collide::{Contact, Key};
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// What meets what.
#[derive(Clone, Debug, PartialEq)]
pub struct Touch {
    /// As of the contact test; friction and restitution are in it.
    found: Contact,
    parts: Parts,
    /// It began within the borders of faces and the ends of edges, by so much or a little less.
    slack_m: Option<f64>,
}

#[derive(Clone, Debug, PartialEq)]
enum Parts {
    /// A part of one body on a plane of the other, or of the container.
    OnPlane {
        of: usize,
        part: Part,
        plane: Plane,
    },
    Balls([Ball; 2]),
    /// Two edges, or round sides, that cross.
    Lines([Line; 2]),
    /// The ball is of the first body, or of the other.
    BallOnLine {
        first: bool,
        ball: Ball,
        line: Line,
    },
}

/// n·x ≥ offset is free: of the world, or in a body's axes about its centre of mass.
#[derive(Clone, Debug, PartialEq)]
struct Plane {
    of: Option<usize>,
    normal: Vector3<f64>,
    offset_m: f64,
    border: Border,
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
        let mut touch = Touch { found: *found, parts: parts?, slack_m: None };
        let slack_m = BORDER * found.ends().map(|(i, ..)| model.bodies[i].bounding_radius_m).sum::<f64>();
        touch.slack_m = (touch.inside_m(state) >= -slack_m).then_some(slack_m);
        Some(touch)
    }

    /// It may come to a border.
    pub fn is_bounded(&self) -> bool {
        let ends = match &self.parts {
            Parts::OnPlane { plane, .. } => plane.border != Border::Nowhere,
            Parts::Balls(balls) => balls.iter().any(|ball| !ball.cone.is_empty()),
            Parts::Lines(_) | Parts::BallOnLine { .. } => true,
        };
        ends && self.slack_m.is_some()
    }

    /// How far it is from having left a face or an edge. Negative: it has.
    pub fn left_m(&self, state: &State) -> f64 {
        match self.slack_m {
            Some(slack_m) if self.is_bounded() => self.inside_m(state) + 2.0 * slack_m,
            _ => f64::INFINITY,
        }
    }

    fn inside_m(&self, state: &State) -> f64 {
        let at = |i: usize| &state.bodies[i];
        let along = |line: &Line, s: f64| (s - line.ends_m[0]).min(line.ends_m[1] - s);
        match &self.parts {
            Parts::OnPlane { plane: Plane { of: Some(of), border, .. }, .. } => {
                let base = at(*of);
                let p_W = self.here(state).contact.p_WC - base.p_WB;
                border.inside_m(&base.q_WB.inverse_transform_vector(&p_W))
            }
            Parts::OnPlane { .. } => f64::INFINITY,
            Parts::Balls(balls) => {
                let at = self.pair(&at);
                let centre = [0, 1].map(|i| at[i].p_WB + at[i].q_WB * balls[i].centre_B);
                let within = |i: usize| {
                    within_m(&balls[i].cone, &at[i].q_WB.inverse_transform_vector(&(centre[1 - i] - centre[i])))
                };
                within(0).min(within(1))
            }
            Parts::Lines(lines) => {
                let Crossing { s, t, .. } = Crossing::new(&self.pair(&at), lines);
                along(&lines[0], s).min(along(&lines[1], t))
            }
            Parts::BallOnLine { first, ball, line } => {
                let Beside { of_ball, of_line, s, off, .. } = Beside::new(self.pair(&at), *first, ball, line);
                along(line, s)
                    .min(within_m(&line.cone, &of_line.q_WB.inverse_transform_vector(&off)))
                    .min(within_m(&ball.cone, &of_ball.q_WB.inverse_transform_vector(&-off)))
            }
        }
    }

    fn pair<'a>(&self, at: &impl Fn(usize) -> &'a BodyState) -> [&'a BodyState; 2] {
        [self.found.body, self.found.other.unwrap_or(self.found.body)].map(at)
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
            Parts::Lines(lines) => self.lines(&at, lines),
            Parts::BallOnLine { first, ball, line } => self.ball_on_line(&at, *first, ball, line),
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

    fn balls<'a>(&self, bodies: &impl Fn(usize) -> &'a BodyState, balls: &[Ball; 2]) -> (Contact, Rates) {
        let at = self.pair(bodies);
        let arm = [0, 1].map(|i| at[i].q_WB * balls[i].centre_B);
        let arm_rate = [0, 1].map(|i| at[i].w_WB.cross(&arm[i]));
        let apart = at[0].p_WB + arm[0] - at[1].p_WB - arm[1];
        let apart_rate = at[0].v_WB + arm_rate[0] - at[1].v_WB - arm_rate[1];
        let distance = apart.norm();
        let normal = apart / distance;
        let normal_rate = (apart_rate - normal * normal.dot(&apart_rate)) / distance;
        let [radius_A, radius_B] = [balls[0].radius_m, balls[1].radius_m];
        let contact = Contact {
            p_WC: at[0].p_WB + arm[0] - normal * radius_A,
            normal,
            gap_m: distance - radius_A - radius_B,
            ..self.found
        };
        let (r_A, r_B) = (arm_rate[0] - normal_rate * radius_A, arm_rate[1] + normal_rate * radius_B);
        (contact, Rates { r_A, r_B, normal: normal_rate })
    }

    /// The nearest points of two lines: w = c_1 + s d_1 − c_2 − t d_2 is across both, always.
    fn lines<'a>(&self, bodies: &impl Fn(usize) -> &'a BodyState, lines: &[Line; 2]) -> (Contact, Rates) {
        let at = self.pair(bodies);
        let Crossing { arm, d, s, t, w } = Crossing::new(&at, lines);
        let arm_rate = [0, 1].map(|i| at[i].w_WB.cross(&arm[i]));
        let d_rate = [0, 1].map(|i| at[i].w_WB.cross(&d[i]));
        let fixed = at[0].v_WB + arm_rate[0] + d_rate[0] * s - at[1].v_WB - arm_rate[1] - d_rate[1] * t;
        let across = [0, 1].map(|i| -d[i].dot(&fixed) - d_rate[i].dot(&w));
        let [s_rate, t_rate] = crossed(d[0].dot(&d[1]), across);
        let cross = d[0].cross(&d[1]);
        let (sign, length) = (cross.dot(&self.found.normal).signum(), cross.norm());
        let normal = cross * (sign / length);
        let cross_rate = (d_rate[0].cross(&d[1]) + d[0].cross(&d_rate[1])) * sign;
        let normal_rate = (cross_rate - normal * normal.dot(&cross_rate)) / length;
        let [radius_A, radius_B] = [lines[0].radius_m, lines[1].radius_m];
        let contact = Contact {
            p_WC: at[0].p_WB + arm[0] + d[0] * s - normal * radius_A,
            normal,
            gap_m: normal.dot(&w) - radius_A - radius_B,
            ..self.found
        };
        let r_A = arm_rate[0] + d_rate[0] * s + d[0] * s_rate - normal_rate * radius_A;
        let r_B = arm_rate[1] + d_rate[1] * t + d[1] * t_rate + normal_rate * radius_B;
        (contact, Rates { r_A, r_B, normal: normal_rate })
    }

    fn ball_on_line<'a>(
        &self,
        bodies: &impl Fn(usize) -> &'a BodyState,
        first: bool,
        ball: &Ball,
        line: &Line,
    ) -> (Contact, Rates) {
        let Beside { of_ball, of_line, arm, foot, d, apart, s, off } =
            Beside::new(self.pair(bodies), first, ball, line);
        let w = &of_line.w_WB;
        let (arm_rate, foot_rate, d_rate) = (of_ball.w_WB.cross(&arm), w.cross(&foot), w.cross(&d));
        let apart_rate = of_ball.v_WB + arm_rate - of_line.v_WB - foot_rate;
        let s_rate = d_rate.dot(&apart) + d.dot(&apart_rate);
        let off_rate = apart_rate - d * s_rate - d_rate * s;
        let distance = off.norm();
        // From the line to the ball.
        let out = off / distance;
        let out_rate = (off_rate - out * out.dot(&off_rate)) / distance;
        let r_ball = arm_rate - out_rate * ball.radius_m;
        let r_line = foot_rate + d_rate * s + d * s_rate + out_rate * line.radius_m;
        let (sign, r_A, r_B) = if first { (1.0, r_ball, r_line) } else { (-1.0, r_line, r_ball) };
        let contact = Contact {
            p_WC: of_ball.p_WB + arm - out * ball.radius_m,
            normal: out * sign,
            gap_m: distance - ball.radius_m - line.radius_m,
            ..self.found
        };
        (contact, Rates { r_A, r_B, normal: out_rate * sign })
    }
}

/// Two lines: where they are nearest to each other.
struct Crossing {
    arm: [Vector3<f64>; 2],
    d: [Vector3<f64>; 2],
    s: f64,
    t: f64,
    w: Vector3<f64>,
}

impl Crossing {
    fn new(at: &[&BodyState; 2], lines: &[Line; 2]) -> Self {
        let arm = [0, 1].map(|i| at[i].q_WB * lines[i].point_B);
        let d = [0, 1].map(|i| at[i].q_WB * lines[i].direction_B);
        let apart = at[0].p_WB + arm[0] - at[1].p_WB - arm[1];
        let [s, t] = crossed(d[0].dot(&d[1]), d.map(|d| -d.dot(&apart)));
        Crossing { arm, d, s, t, w: apart + d[0] * s - d[1] * t }
    }
}

/// A ball beside a line: c_ball = c_line + s d + off, off across the line.
struct Beside<'a> {
    of_ball: &'a BodyState,
    of_line: &'a BodyState,
    arm: Vector3<f64>,
    foot: Vector3<f64>,
    d: Vector3<f64>,
    apart: Vector3<f64>,
    s: f64,
    off: Vector3<f64>,
}

impl<'a> Beside<'a> {
    fn new([a, b]: [&'a BodyState; 2], first: bool, ball: &Ball, line: &Line) -> Self {
        let (of_ball, of_line) = if first { (a, b) } else { (b, a) };
        let (arm, foot) = (of_ball.q_WB * ball.centre_B, of_line.q_WB * line.point_B);
        let d = of_line.q_WB * line.direction_B;
        let apart = of_ball.p_WB + arm - of_line.p_WB - foot;
        let s = d.dot(&apart);
        Beside { of_ball, of_line, arm, foot, d, apart, s, off: apart - d * s }
    }
}

/// x − b y = r_1, b x − y = r_2.
fn crossed(b: f64, r: [f64; 2]) -> [f64; 2] {
    let determinant = b * b - 1.0;
    [(b * r[1] - r[0]) / determinant, (r[1] - b * r[0]) / determinant]
}

impl Part {
    /// The point farthest along d (unit), from the centre of mass, world axes; and its rate.
    fn farthest(&self, at: &BodyState, d: &Vector3<f64>, d_rate: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        let with_body = |r: Vector3<f64>| at.w_WB.cross(&r);
        match self {
            Part::Ball(Ball { centre_B, radius_m, .. }) => {
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

/// Of the bounding radii: so far beyond a border is not beyond it. The contact test takes points as one within half of
/// it.
const BORDER: f64 = 2e-9;

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

/// On a face the point of a line that lies there stays one of the body's, and so does one of another face.
fn part(spot: &Spot, p_B: Vector3<f64>) -> Part {
    match spot {
        Spot::Part(part) => part.clone(),
        Spot::Line(line) => Part::Ball(Ball::new(line.point_B, line.radius_m)),
        Spot::Inside => corner(p_B),
    }
}

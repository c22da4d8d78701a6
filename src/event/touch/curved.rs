//! Two parts, one of them at least curved: rims and ellipsoids against each other, edges, round sides and balls.
//!
//! The normal n is where the separation s(n) = −h_a(−n) − h_b(n) of the two supports is stationary, across a line's
//! direction where one of them is a line (`shape/axis.rs` has the same). With x_a(−n) and x_b(n) the points of support
//! and H = ∇²h: their difference w stays along n, so that t·(H_a + H_b + s)ṅ = t·(u + H_a(ω_a × n) + H_b(ω_b × n)) for
//! every t across n (and the line), u the bodies' velocity against each other at the point.

use super::rates::{Rates, pair};
use super::two_rims::{Circle, TwoRims};
use crate::collide::Contact;
use crate::event::shown::{Ball, Line, Part, within_m};
use crate::state::BodyState;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// One of the two.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Side {
    Part(Part),
    Line(Line),
}

/// Two parts, and the normal that they had when they were found, in the axes of either body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curved {
    sides: [Side; 2],
    normals_B: [Vector3<f64>; 2],
    /// Of rims: the sign of their axes outward.
    outward: [f64; 2],
    /// Where they were found, in the axes of the first body.
    found_B: Vector3<f64>,
}

/// Steps to the normal, which is known nearly.
const STEPS: u32 = 30;

/// Of a rim: a direction that has less (rad) across its axis is a cap's.
const FACES: f64 = 1e-6;

/// The least angle (rad) from a cap's normal that a rim has beside a ball.
const NEXT_TO: f64 = 1e-12;

/// Where a side is in the world.
struct Placed<'a> {
    side: &'a Side,
    at: &'a BodyState,
    outward: f64,
}

/// A point of support, from the world's origin, and H.
struct Support {
    x: Vector3<f64>,
    H: Matrix3<f64>,
}

impl Placed<'_> {
    /// Direction of a line.
    fn line(&self) -> Option<Vector3<f64>> {
        match self.side {
            Side::Line(line) => Some(self.at.q_WB * line.direction_B),
            Side::Part(_) => None,
        }
    }

    /// Along a unit d; of a line, its own point.
    fn support(&self, d: &Vector3<f64>) -> Support {
        let BodyState { p_WB, q_WB, .. } = self.at;
        let round = |radius_m: f64| (Matrix3::identity() - d * d.transpose()) * radius_m;
        match self.side {
            Side::Line(line) => Support { x: p_WB + q_WB * line.point_B + d * line.radius_m, H: round(line.radius_m) },
            Side::Part(Part::Ball(ball)) => {
                Support { x: p_WB + q_WB * ball.centre_B + d * ball.radius_m, H: round(ball.radius_m) }
            }
            Side::Part(Part::Rim { centre_B, axis_B, radius_m }) => {
                let axis = q_WB * axis_B;
                let radial = d - axis * axis.dot(d);
                let length = radial.norm();
                let Some(out) = radial.try_normalize(0.0) else {
                    return Support { x: p_WB + q_WB * centre_B, H: Matrix3::zeros() };
                };
                let aside = axis.cross(&out);
                let H = aside * aside.transpose() * (radius_m / length);
                Support { x: p_WB + q_WB * centre_B + out * *radius_m, H }
            }
            Side::Part(Part::Ellipsoid { centre_B, semi_axes_m }) => {
                let d_B = q_WB.inverse_transform_vector(d);
                let squares = semi_axes_m.component_mul(semi_axes_m);
                let (h, point_B) = (semi_axes_m.component_mul(&d_B).norm(), squares.component_mul(&d_B));
                let H_B = Matrix3::from_diagonal(&(squares / h)) - point_B * point_B.transpose() / (h * h * h);
                let R = q_WB.to_rotation_matrix().into_inner();
                Support { x: p_WB + q_WB * (centre_B + point_B / h), H: R * H_B * R.transpose() }
            }
        }
    }

    fn velocity(&self, x: &Vector3<f64>) -> Vector3<f64> {
        self.at.v_WB + self.at.w_WB.cross(&(x - self.at.p_WB))
    }

    /// How far a normal outward is from where another part is nearer; at a place along a line. `size_m`: of the other.
    fn inside_m(&self, out: &Vector3<f64>, x: &Vector3<f64>, size_m: f64) -> f64 {
        let out_B = self.at.q_WB.inverse_transform_vector(out);
        match self.side {
            Side::Line(Line { point_B, direction_B, ends_m, cone, .. }) => {
                let s = direction_B.dot(&(self.at.q_WB.inverse_transform_vector(&(x - self.at.p_WB)) - point_B));
                (s - ends_m[0]).min(ends_m[1] - s).min(within_m(cone, &(out_B * size_m)))
            }
            Side::Part(Part::Ball(ball)) => within_m(&ball.cone, &(out_B * size_m)),
            Side::Part(Part::Rim { axis_B, radius_m, .. }) => {
                let along = axis_B.dot(&out_B);
                (along * self.outward).min((out_B - axis_B * along).norm() - FACES) * radius_m
            }
            Side::Part(Part::Ellipsoid { .. }) => f64::INFINITY,
        }
    }

    /// Of what is curved.
    fn size_m(&self) -> f64 {
        match self.side {
            Side::Line(Line { radius_m, .. }) | Side::Part(Part::Ball(Ball { radius_m, .. })) => *radius_m,
            Side::Part(Part::Rim { radius_m, .. }) => *radius_m,
            Side::Part(Part::Ellipsoid { semi_axes_m, .. }) => semi_axes_m.min(),
        }
    }
}

/// Both, with their normal.
struct Meeting<'a> {
    placed: [Placed<'a>; 2],
    n: Vector3<f64>,
    supports: [Support; 2],
    gap_m: f64,
    /// Directions across the normal in which it may turn.
    across: Vec<Vector3<f64>>,
    /// How far beyond a cap a ball is, which on it has the cap's normal.
    beyond_m: Option<f64>,
}

impl Curved {
    /// None: two parts that have no one normal.
    pub(super) fn new<'a>(found: &Contact, bodies: &impl Fn(usize) -> &'a BodyState, sides: [Side; 2]) -> Option<Self> {
        let is_curved = |side: &Side| matches!(side, Side::Part(Part::Rim { .. } | Part::Ellipsoid { .. }));
        let is_corner = |side: &Side| matches!(side, Side::Part(Part::Ball(Ball { radius_m, .. })) if *radius_m == 0.0);
        let is_rim = |side: &Side| matches!(side, Side::Part(Part::Rim { .. }));
        let [a, b] = &sides;
        let has_none = (is_corner(a) && is_rim(b)) || (is_rim(a) && is_corner(b));
        if has_none || !(is_curved(a) || is_curved(b)) {
            return None;
        }
        let normals_B = pair(found, bodies).map(|at| at.q_WB.inverse_transform_vector(&found.normal));
        let outward = |i: usize| match &sides[i] {
            Side::Part(Part::Rim { axis_B, .. }) => {
                axis_B.dot(&normals_B[i]).signum() * if i == 0 { -1.0 } else { 1.0 }
            }
            _ => 1.0,
        };
        let outward = [outward(0), outward(1)];
        let [first, _] = pair(found, bodies);
        let found_B = first.q_WB.inverse_transform_vector(&(found.p_WC - first.p_WB));
        Some(Curved { sides, normals_B, outward, found_B })
    }

    /// Of two rims that cross next to where they were found: their points tell more than a normal.
    fn two_rims(&self, at: [&BodyState; 2]) -> Option<TwoRims> {
        let circle = |i: usize| match &self.sides[i] {
            Side::Part(Part::Rim { centre_B, axis_B, radius_m }) => Some(Circle {
                centre: at[i].p_WB + at[i].q_WB * centre_B,
                axis: at[i].q_WB * axis_B * self.outward[i],
                radius_m: *radius_m,
            }),
            _ => None,
        };
        TwoRims::near([&circle(0)?, &circle(1)?], &(at[0].p_WB + at[0].q_WB * self.found_B))
    }

    fn meeting<'a>(&'a self, at: [&'a BodyState; 2]) -> Meeting<'a> {
        let placed = [0, 1].map(|i| Placed { side: &self.sides[i], at: at[i], outward: self.outward[i] });
        let beside = ball_beside_rim(&placed[0], &placed[1]).map(|beside| (beside, 1.0));
        let beside = beside.or_else(|| Some((ball_beside_rim(&placed[1], &placed[0])?, -1.0)));
        if let Some((Beside { d, ball, rim, gap_m, beyond_m }, sign)) = beside {
            let supports = if sign > 0.0 { [ball, rim] } else { [rim, ball] };
            let n = d * sign;
            return Meeting { placed, n, supports, gap_m, across: directions(&n, &None), beyond_m: Some(beyond_m) };
        }
        let line = placed[0].line().or(placed[1].line());
        let supports = |n: &Vector3<f64>| {
            let [mut a, mut b] = [placed[0].support(&-n), placed[1].support(n)];
            // The line's point is the one that is nearest.
            if let Some(d) = &line {
                let off = d.dot(&(a.x - b.x));
                if placed[0].line().is_some() { a.x -= d * off } else { b.x += d * off }
            }
            [a, b]
        };
        let across_line = |n: Vector3<f64>| line.map_or(n, |d| (n - d * d.dot(&n)).normalize());
        let gap = |n: &Vector3<f64>, [a, b]: &[Support; 2]| n.dot(&(a.x - b.x));
        let starts = [0, 1].map(|i| across_line(at[i].q_WB * self.normals_B[i]));
        let [gap_a, gap_b] = starts.map(|n| gap(&n, &supports(&n)));
        let mut n = if gap_a >= gap_b { starts[0] } else { starts[1] };
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let [a, b] = supports(&n);
            let w = a.x - b.x;
            let M = a.H + b.H + Matrix3::identity() * n.dot(&w);
            let turn = solved(&M, &w, &directions(&n, &line));
            let angle = turn.norm();
            n = across_line((n + turn * (0.5 / angle.max(0.5))).normalize());
            if angle.is_nan() || angle <= 1e-15 || (angle < 1e-9 && angle >= last) {
                break;
            }
            last = angle;
        }
        let supports = supports(&n);
        let gap_m = gap(&n, &supports);
        Meeting { placed, n, supports, gap_m, across: directions(&n, &line), beyond_m: None }
    }

    pub(super) fn inside_m(&self, at: [&BodyState; 2]) -> f64 {
        if let Some(rims) = self.two_rims(at) {
            return rims.inside_m;
        }
        let Meeting { placed: [a, b], n, supports, beyond_m, .. } = self.meeting(at);
        if let Some(beyond_m) = beyond_m {
            let along = |of: &Placed, out: Vector3<f64>| match of.side {
                Side::Part(Part::Rim { axis_B, radius_m, .. }) => {
                    of.outward * (of.at.q_WB * axis_B).dot(&out) * radius_m
                }
                _ => of.inside_m(&out, &supports[0].x, of.size_m()),
            };
            return beyond_m.min(along(&a, -n)).min(along(&b, n));
        }
        a.inside_m(&-n, &supports[1].x, b.size_m()).min(b.inside_m(&n, &supports[0].x, a.size_m()))
    }

    /// The side that is a line, how far along it the other one meets it, and that one. None: no side is.
    pub(super) fn along_line(&self, at: [&BodyState; 2]) -> Option<(usize, &Line, f64, &Part)> {
        let (side, line, part) = match &self.sides {
            [Side::Line(line), Side::Part(part)] => (0, line, part),
            [Side::Part(part), Side::Line(line)] => (1, line, part),
            _ => return None,
        };
        let x_B = at[side].q_WB.inverse_transform_vector(&(self.meeting(at).supports[1 - side].x - at[side].p_WB));
        Some((side, line, line.direction_B.dot(&(x_B - line.point_B)), part))
    }

    pub(super) fn here<'a>(&self, found: &Contact, bodies: &impl Fn(usize) -> &'a BodyState) -> (Contact, Rates) {
        let at = pair(found, bodies);
        if let Some(rims) = self.two_rims(at) {
            return rims.here(found, at, true);
        }
        let Meeting { placed, n, supports: [a, b], gap_m, across, .. } = self.meeting(at);
        let [w_a, w_b] = at.map(|at| at.w_WB);
        let M = a.H + b.H + Matrix3::identity() * gap_m;
        let u = placed[0].velocity(&a.x) - placed[1].velocity(&b.x);
        let turned = a.H * w_a.cross(&n) + b.H * w_b.cross(&n);
        // It stays across a line, which turns with its body.
        let with_line = [0, 1].into_iter().find_map(|i| {
            let d = placed[i].line()?;
            Some(d * -n.dot(&at[i].w_WB.cross(&d)))
        });
        let with_line = with_line.unwrap_or_else(Vector3::zeros);
        let n_rate = with_line + solved(&M, &(u + turned - M * with_line), &across);
        let x_a_rate = placed[0].velocity(&a.x) + a.H * (w_a.cross(&n) - n_rate);
        let x_b_rate = placed[1].velocity(&b.x) + b.H * (n_rate - w_b.cross(&n));
        // Along a line it goes with the other one.
        let [x_a_rate, x_b_rate] = match (placed[0].line(), placed[1].line()) {
            (Some(_), _) => [x_b_rate, x_b_rate],
            (_, Some(_)) => [x_a_rate, x_a_rate],
            _ => [x_a_rate, x_b_rate],
        };
        let contact = Contact { p_WC: (a.x + b.x) * 0.5, normal: n, gap_m, ..*found };
        (contact, Rates { r_A: x_a_rate - at[0].v_WB, r_B: x_b_rate - at[1].v_WB, normal: n_rate })
    }
}

/// A ball and the point of a rim that is nearest to it.
struct Beside {
    /// From the rim.
    d: Vector3<f64>,
    ball: Support,
    rim: Support,
    gap_m: f64,
    beyond_m: f64,
}

/// Next to a cap, the normal alone would not tell which point of the rim it is.
fn ball_beside_rim(ball: &Placed, rim: &Placed) -> Option<Beside> {
    let (Side::Part(Part::Ball(of_ball)), Side::Part(Part::Rim { centre_B, axis_B, radius_m })) = (ball.side, rim.side)
    else {
        return None;
    };
    let (axis, middle) = (rim.at.q_WB * axis_B, rim.at.p_WB + rim.at.q_WB * centre_B);
    let from = ball.at.p_WB + ball.at.q_WB * of_ball.centre_B - middle;
    let flat = from - axis * axis.dot(&from);
    let out = flat.try_normalize(0.0)?;
    let apart = from - out * *radius_m;
    let d = apart.try_normalize(0.0)?;
    let (beyond_m, aside) = (flat.norm() - radius_m, axis.cross(&out));
    let turned = (beyond_m / apart.norm()).max(NEXT_TO);
    Some(Beside {
        d,
        ball: ball.support(&-d),
        rim: Support { x: middle + out * *radius_m, H: aside * aside.transpose() * (radius_m / turned) },
        gap_m: apart.norm() - of_ball.radius_m,
        beyond_m,
    })
}

/// Across a normal, and a line.
fn directions(n: &Vector3<f64>, line: &Option<Vector3<f64>>) -> Vec<Vector3<f64>> {
    match line {
        Some(d) => vec![d.cross(n)],
        None => {
            let first = Vector3::ith(n.iamin(), 1.0).cross(n).normalize();
            vec![first, n.cross(&first)]
        }
    }
}

/// x in the span of these directions with t·M x = t·r for each of them; 0: there is none.
fn solved(M: &Matrix3<f64>, r: &Vector3<f64>, across: &[Vector3<f64>]) -> Vector3<f64> {
    match across {
        [t] => t * (t.dot(r) / t.dot(&(M * t))),
        [s, t] => {
            let (Ms, Mt) = (M * s, M * t);
            let inner = Matrix2::new(s.dot(&Ms), s.dot(&Mt), t.dot(&Ms), t.dot(&Mt));
            let x = inner.try_inverse().map(|inverse| inverse * Vector2::new(s.dot(r), t.dot(r)));
            x.map_or_else(Vector3::zeros, |x| s * x.x + t * x.y)
        }
        _ => Vector3::zeros(),
    }
}

//! Points in which two cores meet along an axis: the corners of the part that their facing sides have in common, seen
//! along the axis.
//!
//! Corners of one side inside the other, and crossings of the two outlines. Which of them count is decided with a
//! tolerance, corners of b before those of a where both coincide and before crossings: bodies that lie flush or corner
//! on corner keep the same points whatever the last bit says. (Clipping edge after edge, I. E. Sutherland & G. W.
//! Hodgman, Comm. ACM 17 (1974) 32, would name such points at random.)

use super::axis::{Axis, Face};
use super::cylinder::side_by_side;
use super::placed::{FACING, PARALLEL, Placed};
use nalgebra::Vector3;

/// Distance of points, of the size and seen along the axis, that are one.
const ONE_POINT: f64 = 1e-9;

/// Caps tilted by less (rad) bear on each other over an area; seen from one, the other's rim is a circle to 10⁻⁸.
const COAXIAL: f64 = 1e-4;

/// Points of a's and of b's core on one line along the axis, and what of either they are.
pub struct Opposite {
    pub on_a: Vector3<f64>,
    pub on_b: Vector3<f64>,
    pub feature: (u32, u32),
}

/// Features of a body that can face another one: kind in the upper four bits, number in the others.
mod feature {
    use crate::shape::cylinder::{ARC, EDGE, RIM, VERTEX};

    pub use crate::shape::cylinder::FACE;

    pub fn vertex(number: u32) -> u32 {
        VERTEX | number
    }
    pub fn edge(from: u32, to: u32) -> u32 {
        EDGE | from.min(to) << 14 | from.max(to)
    }
    pub fn rim(point: usize) -> u32 {
        RIM | point as u32
    }
    pub fn arc(part: u32) -> u32 {
        ARC | part
    }
}

/// The side of a body that faces along `d`.
enum Side<'a> {
    /// Vertices in order around the face with this normal.
    Polygon {
        of: &'a Placed<'a>,
        corners: &'a [u32],
        normal: Vector3<f64>,
    },
    Line([Vector3<f64>; 2]),
    Point(Vector3<f64>),
    Disc(Disc),
}

struct Disc {
    centre: Vector3<f64>,
    normal: Vector3<f64>,
    radius_m: f64,
    /// Directions to four points of the rim, the lowest first.
    rim: [Vector3<f64>; 4],
}

impl<'a> Side<'a> {
    fn facing(of: &'a Placed<'a>, d: &Vector3<f64>, face: Option<u32>) -> Self {
        let aligned = || {
            let mut best = (f64::NEG_INFINITY, 0);
            for face in 0..of.faces() {
                let along = of.face_normal(face).dot(d);
                if along > best.0 {
                    best = (along, face);
                }
            }
            (best.0 > 0.0 && (of.is_polytope() || best.0 > FACING)).then_some(best.1)
        };
        match face.or_else(aligned) {
            Some(face) if of.is_polytope() => {
                Side::Polygon { of, corners: of.face_corners(face), normal: of.face_normal(face) }
            }
            Some(face) => {
                let (centre, radius_m) = of.cap(face);
                Side::Disc(Disc { centre, normal: of.face_normal(face), radius_m, rim: of.rim(d) })
            }
            None if of.vertices() == 2 => Side::Line([of.vertex(0), of.vertex(1)]),
            None if of.faces() > 0 => {
                let side = of.support(d);
                let along = of.axis() * (2.0 * of.axis().dot(&(of.p - side)));
                let ends =
                    if of.axis().dot(&(side - of.p)) > 0.0 { [side + along, side] } else { [side, side + along] };
                Side::Line(ends)
            }
            None => Side::Point(of.support(d)),
        }
    }

    fn corners(&self) -> usize {
        match self {
            Side::Polygon { corners, .. } => corners.len(),
            Side::Line(_) => 2,
            Side::Point(_) => 1,
            Side::Disc(_) => 4,
        }
    }

    fn corner(&self, i: usize) -> Vector3<f64> {
        match self {
            Side::Polygon { of, corners, .. } => of.vertex(corners[i]),
            Side::Line(ends) => ends[i],
            Side::Point(point) => *point,
            Side::Disc(disc) => disc.centre + disc.rim[i] * disc.radius_m,
        }
    }

    fn number(&self, i: usize) -> u32 {
        match self {
            Side::Polygon { corners, .. } => corners[i],
            _ => i as u32,
        }
    }

    fn corner_feature(&self, i: usize) -> u32 {
        if let Side::Disc(_) = self { feature::rim(i) } else { feature::vertex(self.number(i)) }
    }

    /// Straight pieces of the outline: start and end as corner numbers.
    fn edges(&self) -> impl Iterator<Item = (usize, usize)> {
        let n = match self {
            Side::Polygon { corners, .. } => corners.len(),
            _ => 0,
        };
        let line = matches!(self, Side::Line(_)).then_some((0, 1));
        (0..n).map(move |i| (i, (i + 1) % n)).chain(line)
    }

    /// Straight pieces of the outline, or the one point that it is.
    fn pieces(&self) -> impl Iterator<Item = (usize, usize)> {
        self.edges().chain(matches!(self, Side::Point(_)).then_some((0, 0)))
    }

    fn piece_feature(&self, (i, j): (usize, usize)) -> u32 {
        if i == j { self.corner_feature(i) } else { self.edge_feature((i, j)) }
    }

    fn edge_feature(&self, (i, j): (usize, usize)) -> u32 {
        feature::edge(self.number(i), self.number(j))
    }

    /// The point over, below or in `p` along the axis, if the side has an area there.
    fn over(&self, p: &Vector3<f64>, n: &Vector3<f64>, slack_m: f64) -> Option<Vector3<f64>> {
        let (normal, on) = match self {
            Side::Polygon { normal, .. } => (*normal, self.corner(0)),
            Side::Disc(disc) => (disc.normal, disc.centre),
            _ => return None,
        };
        let q = projected(p, n, &normal, &on)?;
        let is_inside = match self {
            Side::Disc(disc) => (q - disc.centre).norm() <= disc.radius_m + slack_m,
            _ => self.edges().all(|(i, j)| {
                let from = self.corner(i);
                let out = (self.corner(j) - from).cross(&normal).normalize();
                out.dot(&(q - from)) <= slack_m
            }),
        };
        is_inside.then_some(q)
    }
}

/// Along n into the plane; none if the plane is as good as parallel to n.
fn projected(p: &Vector3<f64>, n: &Vector3<f64>, normal: &Vector3<f64>, on: &Vector3<f64>) -> Option<Vector3<f64>> {
    let along = normal.dot(n);
    (along.abs() > 1e-6).then(|| p + n * (normal.dot(&(on - p)) / along))
}

/// Sides that face each other along the axis of a face.
fn facing_sides<'a>(a: &'a Placed, b: &'a Placed, axis: &Axis) -> Option<[Side<'a>; 2]> {
    let (face_a, face_b) = match axis.face? {
        Face::OfA(face) => (Some(face), None),
        Face::OfB(face) => (None, Some(face)),
    };
    Some([Side::facing(a, &-axis.normal, face_a), Side::facing(b, &axis.normal, face_b)])
}

/// Calls `visit` for the point where the outlines of two facing sides are nearest to each other, which do not lie
/// opposite.
pub fn of_nearest_edges(a: &Placed, b: &Placed, axis: &Axis, visit: &mut impl FnMut(Opposite)) {
    let Some([side_a, side_b]) = facing_sides(a, b, axis) else { return };
    let corner = feature::vertex(0);
    match (&side_a, &side_b) {
        (Side::Disc(disc), other) => {
            if let Some((on_a, on_b)) = beside_rim(disc, other) {
                visit(Opposite { on_a, on_b, feature: (corner, corner) });
            }
            return;
        }
        (other, Side::Disc(disc)) => {
            if let Some((on_b, on_a)) = beside_rim(disc, other) {
                visit(Opposite { on_a, on_b, feature: (corner, corner) });
            }
            return;
        }
        _ => {}
    }
    let mut nearest: Option<(f64, Opposite)> = None;
    for edge_a in side_a.pieces() {
        let (p, u) = (side_a.corner(edge_a.0), side_a.corner(edge_a.1) - side_a.corner(edge_a.0));
        for edge_b in side_b.pieces() {
            let (q, v) = (side_b.corner(edge_b.0), side_b.corner(edge_b.1) - side_b.corner(edge_b.0));
            let (s, t) = closest_parts(&p, &u, &q, &v);
            let (on_a, on_b) = (p + u * s, q + v * t);
            let distance_m = (on_a - on_b).norm();
            if nearest.as_ref().is_none_or(|(least_m, _)| distance_m < *least_m) {
                let feature = (side_a.piece_feature(edge_a), side_b.piece_feature(edge_b));
                nearest = Some((distance_m, Opposite { on_a, on_b, feature }));
            }
        }
    }
    nearest.into_iter().for_each(|(_, at)| visit(at));
}

/// The point of a rim that is nearest to what lies beside its cap, and that one's point.
fn beside_rim(disc: &Disc, other: &Side) -> Option<(Vector3<f64>, Vector3<f64>)> {
    let flat = |v: Vector3<f64>| v - disc.normal * disc.normal.dot(&v);
    let of_piece = |(i, j): (usize, usize)| {
        let (p, q) = (other.corner(i), other.corner(j));
        let (r, e) = (flat(p - disc.centre), flat(q - p));
        let part = if e.norm_squared() > 0.0 { (-r.dot(&e) / e.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
        p + (q - p) * part
    };
    let from_axis_m = |p: &Vector3<f64>| flat(p - disc.centre).norm();
    let nearest = match other {
        Side::Disc(other) => {
            let toward = flat(disc.centre - other.centre).try_normalize(0.0)?;
            Some(other.centre + toward * other.radius_m)
        }
        _ => other.pieces().map(of_piece).min_by(|p, q| from_axis_m(p).total_cmp(&from_axis_m(q))),
    }?;
    let toward = flat(nearest - disc.centre).try_normalize(0.0)?;
    Some((disc.centre + toward * disc.radius_m, nearest))
}

/// Calls `visit` for the points where a face of one of the two lies opposite a side of the other.
pub fn of_face(a: &Placed, b: &Placed, axis: &Axis, size_m: f64, visit: &mut impl FnMut(Opposite)) {
    let Some([side_a, side_b]) = facing_sides(a, b, axis) else { return };
    let n = axis.normal;
    let slack_m = ONE_POINT * size_m;
    corners(&side_a, &side_b, &n, slack_m, visit);
    for edge_a in side_a.edges() {
        for edge_b in side_b.edges() {
            crossing(&side_a, edge_a, &side_b, edge_b, &n, slack_m, visit);
        }
    }
    match (&side_a, &side_b) {
        (Side::Disc(disc), other) if !matches!(other, Side::Disc(_)) => {
            rim_crossings(disc, other, &n, slack_m, &mut |rim, edge, arc, of| {
                visit(Opposite { on_a: rim, on_b: edge, feature: (arc, of) });
            });
        }
        (other, Side::Disc(disc)) if !matches!(other, Side::Disc(_)) => {
            rim_crossings(disc, other, &n, slack_m, &mut |rim, edge, arc, of| {
                visit(Opposite { on_a: edge, on_b: rim, feature: (of, arc) });
            });
        }
        (Side::Disc(disc_a), Side::Disc(disc_b)) => lens(disc_a, disc_b, &n, slack_m, visit),
        _ => {}
    }
}

/// Corners (points of a rim) of either side that the other one covers.
fn corners(a: &Side, b: &Side, n: &Vector3<f64>, slack_m: f64, visit: &mut impl FnMut(Opposite)) {
    for i in 0..b.corners() {
        let on_b = b.corner(i);
        if let Some(on_a) = a.over(&on_b, n, slack_m) {
            visit(Opposite { on_a, on_b, feature: (feature::FACE, b.corner_feature(i)) });
        }
    }
    for i in 0..a.corners() {
        let on_a = a.corner(i);
        let coincide = |j: usize| n.cross(&(b.corner(j) - on_a)).norm() <= slack_m;
        if let Some(on_b) = b.over(&on_a, n, slack_m)
            && !(0..b.corners()).any(coincide)
        {
            visit(Opposite { on_a, on_b, feature: (a.corner_feature(i), feature::FACE) });
        }
    }
}

/// Calls `visit` for the crossing of two straight pieces of the outlines, seen along the axis and away from their ends,
/// which are corners.
fn crossing(
    a: &Side,
    edge_a: (usize, usize),
    b: &Side,
    edge_b: (usize, usize),
    n: &Vector3<f64>,
    slack_m: f64,
    visit: &mut impl FnMut(Opposite),
) {
    let (p, q) = (a.corner(edge_a.0), b.corner(edge_b.0));
    let (u, v) = (a.corner(edge_a.1) - p, b.corner(edge_b.1) - q);
    let (long_u, long_v) = (n.cross(&u).norm(), n.cross(&v).norm());
    let across = n.dot(&u.cross(&v));
    if across.abs() <= ONE_POINT * long_u * long_v {
        return;
    }
    let (s, t) = (n.dot(&(q - p).cross(&v)) / across, n.dot(&(q - p).cross(&u)) / across);
    let inner = |part: f64, long: f64| part * long > slack_m && (1.0 - part) * long > slack_m;
    if inner(s, long_u) && inner(t, long_v) {
        let feature = (a.edge_feature(edge_a), b.edge_feature(edge_b));
        visit(Opposite { on_a: p + u * s, on_b: q + v * t, feature });
    }
}

/// Calls `visit` for the points where straight pieces of an outline cross a rim, and for the middle of the arc that
/// each of them leaves to the other side.
fn rim_crossings(
    disc: &Disc,
    other: &Side,
    n: &Vector3<f64>,
    slack_m: f64,
    visit: &mut impl FnMut(Vector3<f64>, Vector3<f64>, u32, u32),
) {
    for (i, j) in other.edges() {
        let (p, q) = (other.corner(i), other.corner(j));
        let flat = |p: &Vector3<f64>| projected(p, n, &disc.normal, &disc.centre);
        let (Some(from), Some(to)) = (flat(&p), flat(&q)) else { continue };
        let (r, e) = (from - disc.centre, to - from);
        let length = e.norm();
        if length <= slack_m {
            continue;
        }
        let middle = -r.dot(&e) / (length * length);
        let foot = r + e * middle;
        let half = disc.radius_m * disc.radius_m - foot.norm_squared();
        if half <= 0.0 || half.sqrt() <= slack_m {
            continue;
        }
        let edge = other.edge_feature((i, j));
        let mut crosses = false;
        for (k, half) in [-half.sqrt(), half.sqrt()].into_iter().enumerate() {
            let part = middle + half / length;
            if part * length > slack_m && (1.0 - part) * length > slack_m {
                crosses = true;
                visit(disc.centre + r + e * part, p + (q - p) * part, feature::arc(k as u32), edge);
            }
        }
        if let Side::Polygon { normal, .. } = other
            && crosses
        {
            let inward = normal.cross(&(q - p)).normalize();
            let Some(inward) = projected(&inward, n, &disc.normal, &Vector3::zeros()) else { continue };
            let rim = disc.centre + inward.normalize() * disc.radius_m;
            if let Some(over) = other.over(&rim, n, slack_m) {
                visit(rim, over, feature::arc(2), edge);
            }
        }
    }
}

/// Calls `visit` for the common points of two caps beyond those of their rims: where the rims cross, and the middle of
/// either arc.
fn lens(a: &Disc, b: &Disc, n: &Vector3<f64>, slack_m: f64, visit: &mut impl FnMut(Opposite)) {
    if a.normal.cross(&b.normal).norm() > COAXIAL {
        return;
    }
    let Some(centre_b) = projected(&b.centre, n, &a.normal, &a.centre) else { return };
    let apart = centre_b - a.centre;
    let d = apart.norm();
    // One inside the other, or too far away.
    if d <= (a.radius_m - b.radius_m).abs() + slack_m || d >= a.radius_m + b.radius_m - slack_m {
        return;
    }
    let toward = apart / d;
    let x = (d * d + a.radius_m * a.radius_m - b.radius_m * b.radius_m) / (2.0 * d);
    let y = (a.radius_m * a.radius_m - x * x).max(0.0).sqrt();
    let aside = a.normal.cross(&toward);
    let points = [
        a.centre + toward * x + aside * y,
        a.centre + toward * x - aside * y,
        a.centre + toward * a.radius_m,
        centre_b - toward * b.radius_m,
    ];
    for (k, on_a) in points.into_iter().enumerate() {
        if let Some(on_b) = projected(&on_a, n, &b.normal, &b.centre) {
            visit(Opposite { on_a, on_b, feature: (feature::arc(k as u32), feature::arc(k as u32)) });
        }
    }
}

/// Calls `visit` for the points where no face is involved: one, or two where straight lines lie side by side.
pub fn of_lines(a: &Placed, b: &Placed, n: &Vector3<f64>, size_m: f64, visit: &mut impl FnMut(Opposite)) {
    let slack_m = ONE_POINT * size_m;
    let [(i, p0), (j, p1)] = a.support_line(&-n, slack_m);
    let [(k, q0), (l, q1)] = b.support_line(n, slack_m);
    let (u, v) = (p1 - p0, q1 - q0);
    let long_u = u.norm();
    let are_lines = i != j && k != l;
    if !are_lines || !lie_along(a, b, &u, &v, slack_m) {
        let (s, t) = closest_parts(&p0, &u, &q0, &v);
        let name = |i, j| if i == j { feature::vertex(i) } else { feature::edge(i, j) };
        return visit(Opposite { on_a: p0 + u * s, on_b: q0 + v * t, feature: (name(i, j), name(k, l)) });
    }
    let along = u / long_u;
    let (q_from, q_to) = (along.dot(&(q0 - p0)), along.dot(&(q1 - p0)));
    let (start, end) = (q_from.min(q_to).max(0.0), q_from.max(q_to).min(long_u));
    let on_b = |x: f64| q0 + v * ((x - q_from) / (q_to - q_from)).clamp(0.0, 1.0);
    let both = (feature::edge(i, j), feature::edge(k, l));
    for (is_second, x) in [(false, start), (true, end)] {
        if !is_second || end - start > slack_m {
            let x = if start > end { 0.5 * (start + end) } else { x };
            let (on_a, on_b) = (p0 + along * x.clamp(0.0, long_u), on_b(x));
            // What is sharp is touched where it is, what is round there as well.
            let apart = n * n.dot(&(on_a - on_b));
            let (on_a, on_b) = match [a, b].map(Placed::round_m) {
                [0.0, round_m] if round_m > 0.0 => (on_a, on_a - apart),
                [round_m, 0.0] if round_m > 0.0 => (on_b + apart, on_b),
                _ => (on_a, on_b),
            };
            visit(Opposite { on_a, on_b, feature: side_by_side(both, is_second) });
        }
    }
}

/// Of unit vectors: a normal that was found nearly, and the one that it is.
const NEARLY_IT: f64 = 1e-4;

/// The direction between a corner and a round side that face each other along this one, which is known to the root of
/// rounding: as far as the distance tells. None: something else does.
pub fn of_corner_on_round(a: &Placed, b: &Placed, n: &Vector3<f64>, size_m: f64) -> Option<Vector3<f64>> {
    // Edges that cross, most of all, ask no further.
    if a.round_m() == 0.0 && b.round_m() == 0.0 {
        return None;
    }
    let slack_m = ONE_POINT * size_m;
    let corner = |of: &Placed, d: Vector3<f64>| {
        let [(i, corner), (j, _)] = of.support_line(&d, slack_m);
        (of.is_polytope() && of.radius_m() == 0.0 && i == j).then_some(corner)
    };
    let (from, sign) = match (corner(a, -n), corner(b, *n)) {
        (Some(corner), None) => (b.beside_round(&corner, n)?, 1.0),
        (None, Some(corner)) => (a.beside_round(&corner, n)?, -1.0),
        _ => return None,
    };
    let exact = from.try_normalize(0.0)? * sign;
    ((exact - n).norm() <= NEARLY_IT).then_some(exact)
}

/// Whether two lines are parallel, or what is round is nowhere along them farther from the other one than what is one
/// point: it would roll over all of them within less than rounding of a turn.
fn lie_along(a: &Placed, b: &Placed, u: &Vector3<f64>, v: &Vector3<f64>, slack_m: f64) -> bool {
    let (long_u, long_v) = (u.norm(), v.norm());
    let sine = u.cross(v).norm() / (long_u * long_v);
    let aside_m = 0.5 * sine * long_u.min(long_v);
    sine <= PARALLEL || aside_m * aside_m <= 2.0 * (a.round_m() + b.round_m()) * slack_m
}

/// Parameters of the nearest points of two segments p + s u, q + t v (C. Ericson, Real-Time Collision Detection, 2005,
/// 5.1.9).
pub fn closest_parts(p: &Vector3<f64>, u: &Vector3<f64>, q: &Vector3<f64>, v: &Vector3<f64>) -> (f64, f64) {
    let r = p - q;
    let (uu, vv, uv) = (u.norm_squared(), v.norm_squared(), u.dot(v));
    let (ur, vr) = (u.dot(&r), v.dot(&r));
    match (uu > 0.0, vv > 0.0) {
        (false, false) => (0.0, 0.0),
        (false, true) => (0.0, (vr / vv).clamp(0.0, 1.0)),
        (true, false) => ((-ur / uu).clamp(0.0, 1.0), 0.0),
        (true, true) => {
            let across = u.cross(v).norm_squared();
            let s = if across > PARALLEL * PARALLEL * uu * vv {
                ((uv * vr - ur * vv) / across).clamp(0.0, 1.0)
            } else {
                0.0
            };
            let t = (uv * s + vr) / vv;
            if (0.0..=1.0).contains(&t) {
                return (s, t);
            }
            let t = t.clamp(0.0, 1.0);
            (((uv * t - ur) / uu).clamp(0.0, 1.0), t)
        }
    }
}

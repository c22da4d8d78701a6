//! Axis along which two convex cores are nearest, or least deep inside each other.
//!
//! Both are the unit n with the largest separation s(n) = −h_a(−n) − h_b(n), h the support functions: the distance
//! where it is positive, else minus the depth. Where s has its peak on the normal of a face, that normal is the axis.
//!
//! - Polytopes that overlap: the peak is at a face of one or at a pair of edges, one of each (S. Gottschalk, M. C. Lin
//!   & D. Manocha, SIGGRAPH 1996, for boxes). Separated ones: GJK, which is exact after finitely many steps.
//! - With curved bodies: a is moved along n until they are apart, and the direction between them is the next n. That
//!   never lowers s: the moved bodies are at least s(n) + move apart, of which the move explains no more than itself
//!   along any other direction. Then Newton's iteration on the sphere of directions, held on great circles where
//!   straight lines meet the other body. Deep inside each other they have several peaks; of pairs a tenth of their size
//!   deep, one in 10⁴ ends at one that is not the highest.

use super::gjk::{between, between_from};
use super::placed::Placed;
use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};

/// Difference of separations that are equal, of the size; the simpler axis is then taken.
const EQUAL: f64 = 1e-12;
/// Distance of cores, of the size, below which they have no direction between them that rounding leaves alone.
const TOUCHING: f64 = 1e-10;
/// Depth, of the smaller body, up to which two have one peak: another one is no higher than by that (`band::BAND`).
const SHALLOW: f64 = 1e-9;

fn shallow_m(a: &Placed, b: &Placed) -> f64 {
    SHALLOW * a.solid.bounding_radius_m().min(b.solid.bounding_radius_m())
}

pub struct Axis {
    /// Unit direction from b to a.
    pub normal: Vector3<f64>,
    /// Gap of the cores, in metres.
    pub gap_m: f64,
    pub face: Option<Face>,
}

/// Body whose face has the axis as its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Face {
    OfA(u32),
    OfB(u32),
}

pub fn separation(a: &Placed, b: &Placed, n: &Vector3<f64>) -> f64 {
    n.dot(&(a.support(&-n) - b.support(n)))
}

/// The largest separation along a direction that is not nearly an axis' own: another one that may part two bodies.
struct Second {
    best: (Vector3<f64>, f64),
    pub gap_m: f64,
}

/// Cosine above which two directions are nearly one.
const ONE_DIRECTION: f64 = 0.99;

impl Second {
    fn new() -> Self {
        Second { best: (Vector3::zeros(), f64::NEG_INFINITY), gap_m: f64::NEG_INFINITY }
    }

    /// Takes note of a direction; if it is a new best one, what was best may be the second.
    fn note(&mut self, normal: &Vector3<f64>, gap_m: f64) {
        let is_other = self.best.0.dot(normal) < ONE_DIRECTION;
        if gap_m > self.best.1 {
            if is_other {
                self.gap_m = self.best.1;
            }
            self.best = (*normal, gap_m);
        } else if is_other && gap_m > self.gap_m {
            self.gap_m = gap_m;
        }
    }
}

/// The axis; where it belongs to a face, the best one that does not (should the faces not lie opposite each other); and
/// the largest separation along any other face's normal or across other edges.
pub fn axis(a: &Placed, b: &Placed, size_m: f64) -> (Axis, Vector3<f64>, f64) {
    let mut second = Second::new();
    let flat = best_face(a, b, size_m, &mut second);
    let (normal, gap_m) = if a.is_polytope() && b.is_polytope() {
        of_polytopes(a, b, &flat, size_m, &mut second)
    } else if let Some(flat) = flat.as_ref().filter(|flat| is_nearest_there(a, b, flat)) {
        (flat.normal, flat.gap_m)
    } else {
        of_curved(a, b, &flat, size_m)
    };
    second.note(&normal, gap_m);
    match flat {
        Some(flat) if flat.gap_m >= gap_m - EQUAL * size_m => (flat, normal, second.gap_m),
        _ => (Axis { normal, gap_m, face: None }, normal, second.gap_m),
    }
}

/// The face with the largest separation; of equals a's.
fn best_face(a: &Placed, b: &Placed, size_m: f64, second: &mut Second) -> Option<Axis> {
    let mut best: Option<Axis> = None;
    let of_a = (0..a.faces()).map(|face| (-a.face_normal(face), Face::OfA(face), 0.0));
    let of_b = (0..b.faces()).map(|face| (b.face_normal(face), Face::OfB(face), EQUAL * size_m));
    for (normal, face, handicap_m) in of_a.chain(of_b) {
        let gap_m = separation(a, b, &normal);
        second.note(&normal, gap_m);
        if best.as_ref().is_none_or(|best| gap_m > best.gap_m + handicap_m) {
            best = Some(Axis { normal, gap_m, face: Some(face) });
        }
    }
    best
}

/// Whether bodies that do not overlap, or hardly, are nearest over a face: no two points are nearer than along its
/// normal, and two are as near.
fn is_nearest_there(a: &Placed, b: &Placed, flat: &Axis) -> bool {
    let n = &flat.normal;
    let is_over = match flat.face {
        Some(Face::OfA(face)) => a.is_below(face, &b.support(n)),
        Some(Face::OfB(face)) => b.is_below(face, &a.support(&-n)),
        None => false,
    };
    is_over && flat.gap_m >= -shallow_m(a, b)
}

fn of_polytopes(a: &Placed, b: &Placed, flat: &Option<Axis>, size_m: f64, second: &mut Second) -> (Vector3<f64>, f64) {
    let mut best = flat.as_ref().map_or((Vector3::y(), f64::NEG_INFINITY), |flat| (flat.normal, flat.gap_m));
    for i in 0..a.lines() {
        for j in 0..b.lines() {
            let across = a.line(i).cross(&b.line(j));
            let length = across.norm();
            if length < 1e-6 {
                continue;
            }
            for normal in [across / length, -across / length] {
                let gap_m = separation(a, b, &normal);
                second.note(&normal, gap_m);
                if gap_m > best.1 + EQUAL * size_m {
                    best = (normal, gap_m);
                }
            }
        }
    }
    if best.1 <= TOUCHING * size_m {
        return best;
    }
    let apart = between(a, b, &Vector3::zeros());
    let distance_m = apart.norm();
    if distance_m > best.1 + EQUAL * size_m { (apart / distance_m, distance_m) } else { best }
}

fn of_curved(a: &Placed, b: &Placed, flat: &Option<Axis>, size_m: f64) -> (Vector3<f64>, f64) {
    let guesses = first_guesses(a, b, flat);
    let mut best = climb(a, b, guesses[0], size_m);
    // Separated bodies have one peak; overlapping ones a few, of similar height where they overlap in a corner.
    if best.1 < -shallow_m(a, b) {
        for guess in &guesses[1..] {
            let other = climb(a, b, *guess, size_m);
            if other.1 > best.1 + EQUAL * size_m {
                best = other;
            }
        }
    }
    best
}

/// To the peak of s near a direction with its separation.
fn climb(a: &Placed, b: &Placed, guess: (Vector3<f64>, f64), size_m: f64) -> (Vector3<f64>, f64) {
    let mut best = guess;
    // Long moves blunt, short ones leave little between the bodies to measure a direction by.
    let (apart_m, mut turned) = (LONG * size_m, 0.0);
    for _ in 0..100 {
        let (n, gap_m) = best;
        let moved_m = (apart_m - gap_m).max(0.0);
        let next = between(a, b, &(n * moved_m)).normalize();
        let next_gap_m = separation(a, b, &next);
        if next_gap_m <= gap_m {
            break;
        }
        (best, turned) = ((next, next_gap_m), (next - n).norm());
        if moved_m == 0.0 || turned < 1e-4 {
            break;
        }
    }
    best = sharpened(a, b, best, size_m);
    // What is beside a face turns from its normal by no more than its distance in such a move. A short one tells.
    let may_be_beside = a.faces() + b.faces() > 0 && turned > EQUAL && best.1 >= -shallow_m(a, b);
    for _ in 0..if may_be_beside { CLOSER } else { 0 } {
        if moved(a, b, best, SHORT * size_m).1 <= best.1 + EQUAL * size_m {
            break;
        }
        // Which lines are across it is known only from the second on.
        best = sharpened(a, b, closer(a, b, best, size_m), size_m);
        best = sharpened(a, b, best, size_m);
    }
    best
}

/// The peak near a direction that is near it.
fn sharpened(a: &Placed, b: &Placed, best: (Vector3<f64>, f64), size_m: f64) -> (Vector3<f64>, f64) {
    // Straight lines that are nearly across the axis may be meant to be; the separation tells.
    let mut refined = (best.0, f64::NEG_INFINITY);
    let mut tried = None;
    for slack in [1e-2, 1e-3, 1e-5, 0.0] {
        let lines = straight_lines(a, b, &best.0, slack);
        // The same lines are across the axis as before.
        if tried.replace(lines) == Some(lines) {
            continue;
        }
        let (n, gap_m) = refine(a, b, best.0, lines);
        if gap_m > refined.1 + EQUAL * size_m {
            refined = (n, gap_m);
        }
    }
    if refined.1 >= best.1 - EQUAL * size_m { refined } else { best }
}

/// Moves apart that a direction is measured by, of the size: a long one, how much shorter the next one is, and one
/// that shows whether any is needed.
const LONG: f64 = 0.05;
const SHORTER: f64 = 0.05;
const SHORT: f64 = 1e-7;
/// Most looks at bodies that are closer than a long move tells.
const CLOSER: usize = 8;

/// The direction between two bodies that are moved apart by so much along a direction with its separation.
fn moved(a: &Placed, b: &Placed, (n, gap_m): (Vector3<f64>, f64), apart_m: f64) -> (Vector3<f64>, f64) {
    let next = between_from(a, b, &(n * (apart_m - gap_m).max(0.0)), &n).normalize();
    (next, separation(a, b, &next))
}

/// The same of bodies that are beside each other by less than a long move tells, as a rim that all but comes to a
/// corner at its height: moved by ever less.
fn closer(a: &Placed, b: &Placed, guess: (Vector3<f64>, f64), size_m: f64) -> (Vector3<f64>, f64) {
    let mut best = guess;
    let mut apart_m = SHORTER * LONG * size_m;
    while apart_m > TOUCHING * size_m {
        let next = moved(a, b, best, apart_m);
        if next.1 > best.1 {
            best = next;
        }
        apart_m *= SHORTER;
    }
    best
}

/// Directions to begin with.
const GUESSES: usize = 8;

/// The best of the line of centres, the bodies' axes, what is across a straight line of each, and the best face.
fn first_guesses(a: &Placed, b: &Placed, flat: &Option<Axis>) -> [(Vector3<f64>, f64); GUESSES] {
    let mut best = [(Vector3::y(), f64::NEG_INFINITY); GUESSES];
    let mut consider = |n: Vector3<f64>| {
        let guess = (n, separation(a, b, &n));
        if let Some(place) = best.iter().position(|other| guess.1 > other.1) {
            best[place..].rotate_right(1);
            best[place] = guess;
        }
    };
    flat.iter().for_each(|flat| consider(flat.normal));
    (a.p - b.p).try_normalize(0.0).into_iter().for_each(&mut consider);
    a.axes().into_iter().chain(b.axes()).flat_map(|n| [n, -n]).for_each(&mut consider);
    for i in 0..a.lines() {
        for j in 0..b.lines() {
            let across = a.line(i).cross(&b.line(j)).try_normalize(1e-6);
            across.into_iter().flat_map(|n| [n, -n]).for_each(&mut consider);
        }
    }
    best
}

/// Straight lines of either core that are across a direction within `slack` (rad), where it is farthest.
fn straight_lines(a: &Placed, b: &Placed, n: &Vector3<f64>, slack: f64) -> Vec2 {
    let mut lines = Vec2::default();
    if slack > 0.0 {
        straight(a, &-n, slack, &mut lines);
        straight(b, n, slack, &mut lines);
    }
    lines
}

/// Newton's iteration for the peak of s on the unit sphere, from a direction near it, perpendicular to straight lines.
fn refine(a: &Placed, b: &Placed, start: Vector3<f64>, lines: Vec2) -> (Vector3<f64>, f64) {
    let mut n = start;
    match lines {
        Vec2 { first: Some(first), second: Some(second) } => {
            let across = first.cross(&second).normalize();
            n = across * 1f64.copysign(across.dot(&start));
        }
        Vec2 { first: Some(line), .. } => {
            n = (n - line * line.dot(&n)).normalize();
            for _ in 0..20 {
                let t = line.cross(&n);
                let (w, H) = (a.support(&-n) - b.support(&n), a.curvature(&-n) + b.curvature(&n));
                let turn = t.dot(&w) / (t.dot(&(H * t)) + n.dot(&w));
                if !step(&mut n, &(t * turn)) {
                    break;
                }
            }
        }
        _ => {
            for _ in 0..20 {
                let t1 = Vector3::ith(n.iamin(), 1.0).cross(&n).normalize();
                let t2 = n.cross(&t1);
                let (w, H) = (a.support(&-n) - b.support(&n), a.curvature(&-n) + b.curvature(&n));
                let Some(turn) = turn(&H, &w, &n, &t1, &t2) else { break };
                if !step(&mut n, &(t1 * turn.x + t2 * turn.y)) {
                    break;
                }
            }
        }
    }
    (n, separation(a, b, &n))
}

/// −∇s / ∇²s in the tangent plane: ∇s is the vector w between the support points, ∇²s = −H_a − H_b − s on the sphere.
fn turn(
    H: &Matrix3<f64>,
    w: &Vector3<f64>,
    n: &Vector3<f64>,
    t1: &Vector3<f64>,
    t2: &Vector3<f64>,
) -> Option<Vector2<f64>> {
    let s = n.dot(w);
    let (h11, h12, h22) = (t1.dot(&(H * t1)) + s, t1.dot(&(H * t2)), t2.dot(&(H * t2)) + s);
    Matrix2::new(h11, h12, h12, h22).try_inverse().map(|inverse| inverse * Vector2::new(t1.dot(w), t2.dot(w)))
}

/// False at the end of the iteration: a turn that rounding makes, or one so wide that the start was not near.
fn step(n: &mut Vector3<f64>, turn: &Vector3<f64>) -> bool {
    let angle = turn.norm();
    if angle.is_nan() || angle >= 0.5 {
        return false;
    }
    *n = (*n + turn).normalize();
    angle > 1e-15
}

/// Up to two perpendicular directions.
#[derive(Clone, Copy, Default, PartialEq)]
struct Vec2 {
    first: Option<Vector3<f64>>,
    second: Option<Vector3<f64>>,
}

impl Vec2 {
    fn add(&mut self, line: &Vector3<f64>) {
        match self.first {
            None => self.first = Some(line.normalize()),
            Some(first) if self.second.is_none() => {
                let rest = line - first * first.dot(line);
                if rest.norm() > 1e-2 * line.norm() {
                    self.second = Some(rest.normalize());
                }
            }
            _ => {}
        }
    }
}

/// Straight lines of the core at its support along `d` that are across `d` within `slack`.
fn straight(of: &Placed, d: &Vector3<f64>, slack: f64, lines: &mut Vec2) {
    if of.is_polytope() {
        let farthest = of.support(d);
        for i in 0..of.vertices() {
            let edge = of.vertex(i) - farthest;
            if edge.norm() > 0.0 && -d.dot(&edge) < slack * edge.norm() {
                lines.add(&edge);
            }
        }
    } else if of.faces() > 0 {
        let axis = of.axis();
        if d.dot(&axis).abs() < slack {
            lines.add(&axis);
        } else if d.cross(&axis).norm() < slack {
            let across = Vector3::ith(axis.iamin(), 1.0).cross(&axis);
            lines.add(&across);
            lines.add(&axis.cross(&across));
        }
    }
}

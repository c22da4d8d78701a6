//! Vector between two separated convex bodies (E. G. Gilbert, D. W. Johnson & S. S. Keerthi, IEEE J. Robotics
//! Automation 4 (1988) 193), from support points alone.

use super::placed::Placed;
use nalgebra::Vector3;

/// Most steps. Curved bodies take some ten, each with one more digit.
const MOST_STEPS: usize = 64;
/// Bound on what is left to gain, of the distance squared.
const CONVERGED: f64 = 1e-15;

/// The shortest vector from the core of `b` to the core of `a` moved by `shift`. They must not overlap.
pub fn between(a: &Placed, b: &Placed, shift: &Vector3<f64>) -> Vector3<f64> {
    between_from(a, b, shift, &(a.p + shift - b.p))
}

/// The same, from a guess of its direction: what is far from it among large bodies costs digits.
pub fn between_from(a: &Placed, b: &Placed, shift: &Vector3<f64>, guess: &Vector3<f64>) -> Vector3<f64> {
    let support = |d: &Vector3<f64>| a.support(&-d) + shift - b.support(d);
    let mut v = support(guess);
    let mut simplex = [v; 4];
    let mut corners = 1;
    for _ in 0..MOST_STEPS {
        let next = support(&v);
        if v.norm_squared() - v.dot(&next) <= CONVERGED * v.norm_squared() || simplex[..corners].contains(&next) {
            break;
        }
        simplex[corners] = next;
        let (nearest, kept, count) = nearest(&simplex[..=corners]);
        if nearest.norm_squared() >= v.norm_squared() {
            break;
        }
        (v, simplex, corners) = (nearest, kept, count);
    }
    v
}

/// The simplex's point nearest to the origin, which is outside, and the one to three corners that span it: the best of
/// all ways to choose them, as there are few. The last corner is one of them, as it is nearer than all the others span.
fn nearest(simplex: &[Vector3<f64>]) -> (Vector3<f64>, [Vector3<f64>; 4], usize) {
    let mut best = (Vector3::repeat(f64::INFINITY), [simplex[0]; 4], 0);
    let mut consider = |point: Vector3<f64>, corners: &[Vector3<f64>]| {
        if point.norm_squared() < best.0.norm_squared() {
            best.0 = point;
            best.1[..corners.len()].copy_from_slice(corners);
            best.2 = corners.len();
        }
    };
    let [earlier @ .., last] = simplex else { return best };
    consider(*last, &[*last]);
    for (i, a) in earlier.iter().enumerate() {
        let e = last - a;
        let part = -a.dot(&e) / e.norm_squared();
        if part > 0.0 && part < 1.0 {
            consider(a + e * part, &[*a, *last]);
        }
        for b in &earlier[i + 1..] {
            if let Some(point) = on_triangle(a, &(b - a), &e) {
                consider(point, &[*a, *b, *last]);
            }
        }
    }
    best
}

/// Foot of the origin on the triangle at `a` with sides `e` and `f`, if it is inside; along the normal, as products of
/// the sides' lengths cancel in the thin triangles near the end.
fn on_triangle(a: &Vector3<f64>, e: &Vector3<f64>, f: &Vector3<f64>) -> Option<Vector3<f64>> {
    let m = e.cross(f);
    let square = m.norm_squared();
    let (s, t) = (f.cross(a).dot(&m) / square, a.cross(e).dot(&m) / square);
    (s > 0.0 && t > 0.0 && s + t < 1.0).then(|| m * (a.dot(&m) / square))
}

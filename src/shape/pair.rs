//! Points of contact of two solids.
//!
//! Spheres by the nearest point of the other surface, capsules among themselves by their segments; everything else by
//! the axis between the cores (`axis.rs`), then the corners of what lies opposite along it (`manifold.rs`).

use super::axis::{Axis, Face, axis};
use super::manifold::{Opposite, closest_parts, of_face, of_lines};
use super::placed::Placed;
use super::solid::{Meeting, Pose, Solid};
use nalgebra::Vector3;

/// Adds all points of two solids whose gap is below the margin. Solids that are apart by less than the margin touch in
/// one point at least.
pub fn touches(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose, margin_m: f64, out: &mut Vec<Meeting>) {
    let reach_m = a.bounding_radius_m() + b.bounding_radius_m();
    if (pose_a.p_W - pose_b.p_W).norm_squared() >= (reach_m + margin_m.max(0.0)) * (reach_m + margin_m.max(0.0)) {
        return;
    }
    match (a, b) {
        (Solid::Sphere { radius_m }, _) => out.extend(of_sphere(*radius_m, pose_a, b, pose_b, 1.0, margin_m)),
        (_, Solid::Sphere { radius_m }) => out.extend(of_sphere(*radius_m, pose_b, a, pose_a, -1.0, margin_m)),
        _ => {
            let origin_W = pose_b.p_W;
            let placed = [Placed::new(a, pose_a, &origin_W), Placed::new(b, pose_b, &origin_W)];
            let is_capsules = matches!((a, b), (Solid::Capsule { .. }, Solid::Capsule { .. }));
            let (axis, otherwise) =
                if is_capsules { of_capsules(&placed[0], &placed[1]) } else { axis(&placed[0], &placed[1], reach_m) };
            let mut collect = Collect { placed: &placed, origin_W, margin_m, visited: false, out };
            if axis.gap_m - collect.radii_m() < margin_m {
                collect.all(&axis, &otherwise, reach_m);
            }
        }
    }
}

struct Collect<'a> {
    placed: &'a [Placed<'a>; 2],
    origin_W: Vector3<f64>,
    margin_m: f64,
    /// Whether there was any point, near enough or not.
    visited: bool,
    out: &'a mut Vec<Meeting>,
}

impl Collect<'_> {
    fn radii_m(&self) -> f64 {
        self.placed[0].radius_m() + self.placed[1].radius_m()
    }

    fn all(&mut self, axis: &Axis, otherwise: &Vector3<f64>, size_m: f64) {
        let [a, b] = self.placed;
        let face = axis.face.or_else(|| nearly_facing(a, b, &axis.normal));
        of_face(a, b, &Axis { face, ..*axis }, size_m, &mut |at| self.add(&axis.normal, at));
        if !self.visited {
            let normal = if axis.face.is_some() { otherwise } else { &axis.normal };
            of_lines(a, b, normal, size_m, &mut |at| self.add(normal, at));
        }
    }

    fn add(&mut self, normal: &Vector3<f64>, at: Opposite) {
        self.visited = true;
        let [a, b] = self.placed;
        let gap_m = normal.dot(&(at.on_a - at.on_b)) - self.radii_m();
        if gap_m < self.margin_m {
            let middle = (at.on_a + at.on_b + normal * (b.radius_m() - a.radius_m())) * 0.5;
            self.out.push(Meeting { p_W: self.origin_W + middle, normal: *normal, gap_m, feature: at.feature });
        }
    }
}

/// Cosine above which a face nearly faces along the axis. Where edges cross over a face that lies almost flat, the axis
/// is theirs and the points are the face's: of two, one would be lost by a last bit, and a body that topples over an
/// edge would twist.
const NEARLY: f64 = 0.95;

/// The face of either that is nearest to facing along the axis, if it nearly does.
fn nearly_facing(a: &Placed, b: &Placed, normal: &Vector3<f64>) -> Option<Face> {
    let is_polyhedron = |of: &Placed| of.is_polytope() && of.faces() > 0;
    if !is_polyhedron(a) || !is_polyhedron(b) {
        return None;
    }
    let of_a = (0..a.faces()).map(|face| (-a.face_normal(face).dot(normal), Face::OfA(face)));
    let of_b = (0..b.faces()).map(|face| (b.face_normal(face).dot(normal), Face::OfB(face)));
    let best = of_a.chain(of_b).reduce(|best, next| if next.0 > best.0 { next } else { best });
    best.filter(|(along, _)| *along > NEARLY).map(|(_, face)| face)
}

/// Point of contact of a sphere, if there is one; `toward` is 1 if the sphere is a, −1 if it is b.
fn of_sphere(
    radius_m: f64,
    pose: &Pose,
    other: &Solid,
    pose_other: &Pose,
    toward: f64,
    margin_m: f64,
) -> Option<Meeting> {
    let centre = pose_other.q_W.inverse_transform_vector(&(pose.p_W - pose_other.p_W));
    let nearest = other.closest(&centre);
    let gap_m = nearest.distance_m - radius_m;
    (gap_m < margin_m).then(|| {
        let out = pose_other.q_W * nearest.normal;
        let p_W = pose.p_W - out * (radius_m + 0.5 * gap_m);
        Meeting { p_W, normal: out * toward, gap_m, feature: (0, 0) }
    })
}

/// Segments that cross have no direction between them but the one across both, or any across one of them.
fn of_capsules(a: &Placed, b: &Placed) -> (Axis, Vector3<f64>) {
    let (p, q) = (a.vertex(0), b.vertex(0));
    let (u, v) = (a.vertex(1) - p, b.vertex(1) - q);
    let (s, t) = closest_parts(&p, &u, &q, &v);
    let apart = p + u * s - q - v * t;
    let gap_m = apart.norm();
    let rounding_m = 1e-14 * (u.norm() + v.norm() + a.radius_m() + b.radius_m());
    let across = u.cross(&v);
    let normal = if gap_m > rounding_m {
        apart / gap_m
    } else if across.norm() > 1e-7 * u.norm() * v.norm() {
        across.normalize()
    } else {
        Vector3::ith(u.iamin(), 1.0).cross(&a.axis()).normalize()
    };
    (Axis { normal, gap_m, face: None }, normal)
}

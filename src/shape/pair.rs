//! Points of contact of two solids.
//!
//! Spheres by the nearest point of the other surface, capsules among themselves by their segments; everything else by
//! the axis between the cores (`axis.rs`), then the corners of what lies opposite along it (`manifold.rs`).

use super::axis::{Axis, Face, axis, separation};
use super::manifold::{Opposite, closest_parts, of_corner_on_round, of_face, of_lines, of_nearest_edges};
use super::placed::Placed;
use super::solid::{Meeting, Pose, Solid};
use nalgebra::Vector3;

/// How far apart two solids are, and along which axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apart {
    /// Unit axis of the largest separation, from b to a.
    pub normal: Vector3<f64>,
    /// The largest separation, in metres; of what overlaps minus the depth.
    pub gap_m: f64,
    /// The largest separation along another direction that may part them: a face's normal, or across edges.
    pub second_m: f64,
    /// Both have corners and edges alone, and the axis is a face's: it stays so as they move along it.
    pub is_flat: bool,
}

/// Adds all points of two solids whose gap is below the margin. Solids that are apart by less than the margin touch in
/// one point at least; how far apart they are is said if their bounding spheres are within the margin.
pub fn touches(
    a: &Solid,
    pose_a: &Pose,
    b: &Solid,
    pose_b: &Pose,
    margin_m: f64,
    out: &mut Vec<Meeting>,
) -> Option<Apart> {
    let reach_m = a.bounding_radius_m() + b.bounding_radius_m();
    if (pose_a.p_W - pose_b.p_W).norm_squared() >= (reach_m + margin_m.max(0.0)) * (reach_m + margin_m.max(0.0)) {
        return None;
    }
    if let Some((apart, meeting)) = of_any_sphere(a, pose_a, b, pose_b) {
        out.extend((apart.gap_m < margin_m).then_some(meeting));
        return Some(apart);
    }
    let placed = Placed::pair(a, pose_a, b, pose_b);
    let cores = of_cores(&placed, reach_m);
    touches_of(&placed, &pose_b.p_W, &cores, margin_m, out);
    Some(cores.2)
}

/// Adds all points of two placed solids, of which this is known, whose gap is below the margin.
pub(super) fn touches_of(
    placed: &[Placed; 2],
    origin_W: &Vector3<f64>,
    (axis, otherwise, apart): &(Axis, Vector3<f64>, Apart),
    margin_m: f64,
    out: &mut Vec<Meeting>,
) {
    if apart.gap_m < margin_m {
        let size_m = placed[0].solid.bounding_radius_m() + placed[1].solid.bounding_radius_m();
        Collect { placed, origin_W: *origin_W, margin_m, visited: false, out }.all(axis, otherwise, size_m);
    }
}

/// How far apart two solids are, wherever they are.
pub fn apart(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose) -> Apart {
    if let Some((apart, _)) = of_any_sphere(a, pose_a, b, pose_b) {
        return apart;
    }
    of_cores(&Placed::pair(a, pose_a, b, pose_b), a.bounding_radius_m() + b.bounding_radius_m()).2
}

/// Separation of two solids along a unit direction from b to a, in metres.
pub fn along(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose, normal: &Vector3<f64>) -> f64 {
    let [a, b] = Placed::pair(a, pose_a, b, pose_b);
    separation(&a, &b, normal) - a.radius_m() - b.radius_m()
}

/// Unit direction of an edge, or of a round side, by its name among a pair's features; None where it has no length.
pub fn edge_W(solid: &Solid, pose: &Pose, feature: u32) -> Option<Vector3<f64>> {
    let placed = Placed::new(solid, pose, &pose.p_W);
    let [from, to] = corners(feature);
    let along = if placed.is_polytope() { placed.vertex(to) - placed.vertex(from) } else { placed.axis() };
    along.try_normalize(0.0)
}

/// The ends of an edge, by its name among a pair's features; None: the solid has no corners.
pub fn edge_ends_W(solid: &Solid, pose: &Pose, feature: u32) -> Option<[Vector3<f64>; 2]> {
    let placed = Placed::new(solid, pose, &pose.p_W);
    placed.is_polytope().then(|| corners(feature).map(|corner| pose.p_W + placed.vertex(corner)))
}

/// Numbers of an edge's corners.
fn corners(feature: u32) -> [u32; 2] {
    [14, 0].map(|shift| feature >> shift & 0xfff)
}

/// The axis between two cores, what else it may be where no face lies opposite (`axis::axis`), and the solids'
/// distance.
pub(super) fn of_cores(placed: &[Placed; 2], reach_m: f64) -> (Axis, Vector3<f64>, Apart) {
    let [a, b] = placed;
    let is_capsules = matches!((a.solid, b.solid), (Solid::Capsule { .. }, Solid::Capsule { .. }));
    let (axis, otherwise, second_m) = if is_capsules { of_capsules(a, b) } else { axis(a, b, reach_m) };
    let radii_m = a.radius_m() + b.radius_m();
    let is_flat = axis.face.is_some() && a.is_polytope() && b.is_polytope() && radii_m == 0.0;
    let (normal, gap_m) = (axis.normal, axis.gap_m - radii_m);
    (axis, otherwise, Apart { normal, gap_m, second_m: second_m - radii_m, is_flat })
}

/// If one of the two is a sphere: how far apart they are, and their point of contact.
fn of_any_sphere(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose) -> Option<(Apart, Meeting)> {
    let meeting = match (a, b) {
        (Solid::Sphere { radius_m }, _) => of_sphere(*radius_m, pose_a, b, pose_b, 1.0),
        (_, Solid::Sphere { radius_m }) => of_sphere(*radius_m, pose_b, a, pose_a, -1.0),
        _ => return None,
    };
    let Meeting { normal, gap_m, .. } = meeting;
    Some((Apart { normal, gap_m, second_m: f64::NEG_INFINITY, is_flat: false }, meeting))
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
        let facing = Axis { face, ..*axis };
        of_face(a, b, &facing, size_m, &mut |at| self.add(&axis.normal, at));
        let normal = if axis.face.is_some() { otherwise } else { &axis.normal };
        if !self.visited && axis.normal.cross(normal).norm() <= BESIDE {
            of_nearest_edges(a, b, &facing, &mut |at| self.add(normal, self.turned(&axis.normal, normal, at)));
        }
        if !self.visited {
            let exact = of_corner_on_round(a, b, normal, size_m);
            let normal = exact.as_ref().unwrap_or(normal);
            of_lines(a, b, normal, size_m, &mut |at| self.add(normal, at));
        }
    }

    /// Points that are opposite along one axis, along another one. A round side faces there by another line, and what
    /// is nearest to that line touches it there: a point of it beside the line would come nearer as it rolls.
    fn turned(&self, from: &Vector3<f64>, to: &Vector3<f64>, at: Opposite) -> Opposite {
        let [a, b] = self.placed;
        let Opposite { mut on_a, mut on_b, feature } = at;
        let apart = |on_a: Vector3<f64>, on_b: Vector3<f64>| to * to.dot(&(on_a - on_b));
        if let (Some(before), Some(now)) = (a.round_side(&-from), a.round_side(&-to)) {
            on_a += now - before;
            on_b = on_a - apart(on_a, on_b);
        } else if let (Some(before), Some(now)) = (b.round_side(from), b.round_side(to)) {
            on_b += now - before;
            on_a = on_b + apart(on_a, on_b);
        }
        Opposite { on_a, on_b, feature }
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

/// Sine of the angle from a face's normal at which bodies touch that just do not lie over each other: which edges meet
/// there the axis does not tell.
const BESIDE: f64 = 0.1;

/// The same where one of the two is round: straight lines on it lie along the face, as far as rounding tells.
const NEARLY_ROUND: f64 = 1.0 - 1e-12;

/// The face of either that is nearest to facing along the axis, if it nearly does; of polyhedra.
fn nearly_facing(a: &Placed, b: &Placed, normal: &Vector3<f64>) -> Option<Face> {
    let [of_a, of_b] = [a, b].map(|of| if of.is_polytope() { of.faces() } else { 0 });
    let least = if of_a > 0 && of_b > 0 { NEARLY } else { NEARLY_ROUND };
    let of_a = (0..of_a).map(|face| (-a.face_normal(face).dot(normal), Face::OfA(face)));
    let of_b = (0..of_b).map(|face| (b.face_normal(face).dot(normal), Face::OfB(face)));
    let best = of_a.chain(of_b).reduce(|best, next| if next.0 > best.0 { next } else { best });
    best.filter(|(along, _)| *along > least).map(|(_, face)| face)
}

/// Point of contact of a sphere. `toward` is 1 if the sphere is a, −1 if it is b.
fn of_sphere(radius_m: f64, pose: &Pose, other: &Solid, pose_other: &Pose, toward: f64) -> Meeting {
    let centre = pose_other.q_W.inverse_transform_vector(&(pose.p_W - pose_other.p_W));
    let nearest = other.closest(&centre);
    let gap_m = nearest.distance_m - radius_m;
    let out = pose_other.q_W * nearest.normal;
    let p_W = pose.p_W - out * (radius_m + 0.5 * gap_m);
    Meeting { p_W, normal: out * toward, gap_m, feature: (0, 0) }
}

/// Segments that cross have no direction between them but the one across both, or any across one of them.
fn of_capsules(a: &Placed, b: &Placed) -> (Axis, Vector3<f64>, f64) {
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
    (Axis { normal, gap_m, face: None }, normal, f64::NEG_INFINITY)
}

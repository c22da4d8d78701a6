//! All axes along which two solids are as far apart as along the best one, within a band.
//!
//! Convex bodies are apart as long as one axis separates them. Where two bodies share an edge or a corner alone,
//! several do so equally, by nothing; which of them is the last to close says what the bodies do to each other, not
//! which of them rounding calls the largest. The directions of all separating axes of such a pair are a cone, and
//! along its extreme rays a face of one body, or an edge of each, is across the axis.

use super::axis::{Axis, Face, axis, separation};
use super::manifold::{Opposite, closest_parts, of_face, of_lines};
use super::pair::{of_cores, touches, touches_of};
use super::placed::Placed;
use super::solid::{Meeting, Pose, Solid};
use nalgebra::Vector3;

/// Band within which separations count alike, of the smaller body's bounding radius.
pub const BAND: f64 = 1e-9;

/// Sine of the angle up to which axes are one: a smooth surface turns by (2 · 10⁻⁹)^½ within the band.
const ONE_AXIS: f64 = 1e-4;

/// Sine of the angle below which straight lines have no direction across both.
const ALONG: f64 = 1e-6;

/// An axis that separates, and the points that are nearest along it.
#[derive(Clone, Debug)]
pub struct Along {
    /// Unit normal from b to a.
    pub normal: Vector3<f64>,
    pub gap_m: f64,
    pub points: Vec<Meeting>,
}

/// Half-width of the band of two solids.
pub fn band_m(a: &Solid, b: &Solid) -> f64 {
    BAND * a.bounding_radius_m().min(b.bounding_radius_m())
}

/// Axes within the band of the best one, the best first; none where there is but one by the shapes themselves: spheres
/// and capsules among each other are smooth.
pub fn axes(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose) -> Vec<Along> {
    let is_smooth = |solid: &Solid| matches!(solid, Solid::Sphere { .. } | Solid::Ellipsoid { .. });
    let is_capsule = |solid: &Solid| matches!(solid, Solid::Capsule { .. });
    if is_smooth(a) || is_smooth(b) || (is_capsule(a) && is_capsule(b)) {
        return Vec::new();
    }
    let [a, b] = Placed::pair(a, pose_a, b, pose_b);
    Axes { a: &a, b: &b, origin_W: pose_b.p_W }.within(band_m(a.solid, b.solid))
}

/// Adds the points of two solids whose gap is below the margin, as `pair::touches`; but what is round and beside a face
/// by less than its axis can tell has the direction to the face's edge. Whether it has.
pub fn touches_beside(
    a: &Solid,
    pose_a: &Pose,
    b: &Solid,
    pose_b: &Pose,
    margin_m: f64,
    out: &mut Vec<Meeting>,
) -> bool {
    let is_round = |solid: &Solid| matches!(solid, Solid::Capsule { .. } | Solid::Cylinder { .. });
    let has_corners = |solid: &Solid| matches!(solid, Solid::Box { .. } | Solid::Convex(_));
    if !((is_round(a) && has_corners(b)) || (is_round(b) && has_corners(a))) {
        touches(a, pose_a, b, pose_b, margin_m, out);
        return false;
    }
    let placed = Placed::pair(a, pose_a, b, pose_b);
    let axes = Axes { a: &placed[0], b: &placed[1], origin_W: pose_b.p_W };
    let cores = of_cores(&placed, axes.size_m());
    let beside = axes.beside(&cores.0);
    match &beside {
        Some(n) => out.extend(axes.of_lines(n).into_iter().filter(|meeting| meeting.gap_m < margin_m)),
        None => touches_of(&placed, &pose_b.p_W, &cores, margin_m, out),
    }
    beside.is_some()
}

struct Axes<'a> {
    a: &'a Placed<'a>,
    b: &'a Placed<'a>,
    origin_W: Vector3<f64>,
}

impl Axes<'_> {
    fn size_m(&self) -> f64 {
        self.a.solid.bounding_radius_m() + self.b.solid.bounding_radius_m()
    }

    fn within(&self, band_m: f64) -> Vec<Along> {
        let (best, ..) = axis(self.a, self.b, self.size_m());
        let least_m = best.gap_m - band_m;
        let mut found = vec![best];
        let mut consider = |normal: Vector3<f64>, face: Option<Face>| {
            let gap_m = separation(self.a, self.b, &normal);
            let is_known =
                |other: &Axis| normal.dot(&other.normal) > 0.0 && normal.cross(&other.normal).norm() < ONE_AXIS;
            if gap_m >= least_m && !found.iter().any(is_known) {
                found.push(Axis { normal, gap_m, face });
            }
        };
        (0..self.a.faces()).for_each(|face| consider(-self.a.face_normal(face), Some(Face::OfA(face))));
        (0..self.b.faces()).for_each(|face| consider(self.b.face_normal(face), Some(Face::OfB(face))));
        for i in 0..self.a.lines() {
            for j in 0..self.b.lines() {
                if let Some(across) = self.a.line(i).cross(&self.b.line(j)).try_normalize(ALONG) {
                    consider(across, None);
                    consider(-across, None);
                }
            }
        }
        found.iter().map(|axis| self.along(axis, band_m)).collect()
    }

    fn along(&self, axis: &Axis, band_m: f64) -> Along {
        let gap_m = axis.gap_m - self.radii_m();
        let mut points = Vec::new();
        of_face(self.a, self.b, axis, self.size_m(), &mut |at| points.push(self.meeting(&axis.normal, at)));
        points.retain(|point: &Meeting| point.gap_m <= gap_m + band_m);
        if points.is_empty() {
            points = self.of_lines(&axis.normal);
        }
        Along { normal: axis.normal, gap_m, points }
    }

    /// Direction from the edge of a face that is the axis, but over which nothing is, to the middle line of what is
    /// round.
    fn beside(&self, best: &Axis) -> Option<Vector3<f64>> {
        let (face, of, round, sign) = match best.face? {
            Face::OfA(face) => (face, self.a, self.b, -1.0),
            Face::OfB(face) => (face, self.b, self.a, 1.0),
        };
        let half_m = match round.solid {
            Solid::Capsule { half_height_m, .. } | Solid::Cylinder { half_height_m, .. } => *half_height_m,
            _ => return None,
        };
        // The middle line of a cylinder that is tilted tells nothing of its rim.
        let is_tilted = matches!(round.solid, Solid::Cylinder { .. }) && best.normal.dot(&round.axis()).abs() > ALONG;
        if is_tilted {
            return None;
        }
        let corners = of.face_corners(face);
        let mut is_over = corners.is_empty();
        of_face(self.a, self.b, best, self.size_m(), &mut |_| is_over = true);
        if is_over {
            return None;
        }
        let (from, along) = (round.p - round.axis() * half_m, round.axis() * (2.0 * half_m));
        let apart = (0..corners.len()).map(|i| {
            let [p, q] = [i, (i + 1) % corners.len()].map(|i| of.vertex(corners[i]));
            let (s, t) = closest_parts(&from, &along, &p, &(q - p));
            from + along * s - p - (q - p) * t
        });
        let nearest = apart.reduce(|best, next| if next.norm_squared() < best.norm_squared() { next } else { best })?;
        nearest.try_normalize(0.0).map(|out| out * sign)
    }

    fn of_lines(&self, n: &Vector3<f64>) -> Vec<Meeting> {
        let mut points = Vec::new();
        of_lines(self.a, self.b, n, self.size_m(), &mut |at| points.push(self.meeting(n, at)));
        points
    }

    fn meeting(&self, n: &Vector3<f64>, at: Opposite) -> Meeting {
        let gap_m = n.dot(&(at.on_a - at.on_b)) - self.radii_m();
        let middle = (at.on_a + at.on_b + n * (self.b.radius_m() - self.a.radius_m())) * 0.5;
        Meeting { p_W: self.origin_W + middle, normal: *n, gap_m, feature: at.feature }
    }

    fn radii_m(&self) -> f64 {
        self.a.radius_m() + self.b.radius_m()
    }
}

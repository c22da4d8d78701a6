//! All axes along which two solids are as far apart as along the best one, within a band.
//!
//! Convex bodies are apart as long as one axis separates them. Where two bodies share an edge or a corner alone, several
//! do so equally, by nothing; which of them is the last to close says what the bodies do to each other, not which of
//! them rounding calls the largest. The directions of all separating axes of such a pair are a cone, and along its
//! extreme rays a face of one body, or an edge of each, is across the axis.

use super::axis::{Axis, Face, axis, separation};
use super::manifold::{Opposite, of_face, of_lines};
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
    let origin_W = pose_b.p_W;
    let [a, b] = [Placed::new(a, pose_a, &origin_W), Placed::new(b, pose_b, &origin_W)];
    Axes { a: &a, b: &b, origin_W }.within(band_m(a.solid, b.solid))
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
        let (best, _) = axis(self.a, self.b, self.size_m());
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
        let (n, radii_m) = (axis.normal, self.a.radius_m() + self.b.radius_m());
        let meeting = |at: Opposite| {
            let gap_m = n.dot(&(at.on_a - at.on_b)) - radii_m;
            let middle = (at.on_a + at.on_b + n * (self.b.radius_m() - self.a.radius_m())) * 0.5;
            Meeting { p_W: self.origin_W + middle, normal: n, gap_m, feature: at.feature }
        };
        let gap_m = axis.gap_m - radii_m;
        let mut points = Vec::new();
        of_face(self.a, self.b, axis, self.size_m(), &mut |at| points.push(meeting(at)));
        points.retain(|point: &Meeting| point.gap_m <= gap_m + band_m);
        if points.is_empty() {
            of_lines(self.a, self.b, &n, self.size_m(), &mut |at| points.push(meeting(at)));
        }
        Along { normal: n, gap_m, points }
    }
}

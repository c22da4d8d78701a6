//! A solid in the world, as support functions see it: a core, and a ball of some radius that is rolled around it.
//!
//! The core of a sphere is its centre, of a capsule the segment between the centres of its spheres; all others are
//! their own core. Positions are relative to a point near both bodies, so that far from the world's origin nothing is
//! lost.

use super::cylinder::rim_directions;
use super::solid::{Pose, Solid};
use super::{capsule, convex, cuboid, cylinder, ellipsoid};
use nalgebra::{Matrix3, Vector3};

pub struct Placed<'a> {
    pub solid: &'a Solid,
    pub p: Vector3<f64>,
    R: Matrix3<f64>,
}

/// Angle within which directions are parallel (rad).
pub const PARALLEL: f64 = 1e-7;

/// A cap faces along directions within 45° of its normal, beyond them the side of the cylinder does.
pub const FACING: f64 = std::f64::consts::FRAC_1_SQRT_2;

impl<'a> Placed<'a> {
    pub fn new(solid: &'a Solid, pose: &Pose, origin_W: &Vector3<f64>) -> Self {
        Placed { solid, p: pose.p_W - origin_W, R: pose.q_W.to_rotation_matrix().into_inner() }
    }

    /// Two solids about the centre of the second.
    pub fn pair(a: &'a Solid, pose_a: &Pose, b: &'a Solid, pose_b: &Pose) -> [Self; 2] {
        [Placed::new(a, pose_a, &pose_b.p_W), Placed::new(b, pose_b, &pose_b.p_W)]
    }

    /// Radius of the ball around the core.
    pub fn radius_m(&self) -> f64 {
        match self.solid {
            Solid::Sphere { radius_m } | Solid::Capsule { radius_m, .. } => *radius_m,
            _ => 0.0,
        }
    }

    /// From the middle line of what is round to a point beside it; None: it faces along d with something else.
    pub fn beside_round(&self, p: &Vector3<f64>, d: &Vector3<f64>) -> Option<Vector3<f64>> {
        let from = p - self.p;
        let along_m = self.axis().dot(&from);
        match self.solid {
            Solid::Capsule { half_height_m, .. } => {
                Some(from - self.axis() * along_m.clamp(-half_height_m, *half_height_m))
            }
            Solid::Cylinder { .. } if d.dot(&self.axis()).abs() < PARALLEL => Some(from - self.axis() * along_m),
            _ => None,
        }
    }

    /// Radius of its round side; 0 of what has none.
    pub fn round_m(&self) -> f64 {
        match self.solid {
            Solid::Capsule { radius_m, .. } | Solid::Cylinder { radius_m, .. } => *radius_m,
            _ => 0.0,
        }
    }

    /// Whether a face has this point before or behind it, along its normal.
    pub fn is_below(&self, face: u32, p: &Vector3<f64>) -> bool {
        let normal = self.face_normal(face);
        if !self.is_polytope() {
            let (centre, radius_m) = self.cap(face);
            return normal.cross(&(p - centre)).norm() <= radius_m;
        }
        let corners = self.face_corners(face);
        (0..corners.len()).all(|i| {
            let [from, to] = [i, (i + 1) % corners.len()].map(|i| self.vertex(corners[i]));
            (to - from).cross(&normal).dot(&(p - from)) <= 0.0
        })
    }

    /// From its middle line to the line of the core's round side that faces along `d`; none: no round side does.
    pub fn round_side(&self, d: &Vector3<f64>) -> Option<Vector3<f64>> {
        let across = d - self.axis() * self.axis().dot(d);
        match self.solid {
            Solid::Capsule { .. } => Some(Vector3::zeros()),
            Solid::Cylinder { radius_m, .. } if across.norm() > FACING => Some(across.normalize() * *radius_m),
            _ => None,
        }
    }

    /// Point of the core farthest along `d`.
    pub fn support(&self, d: &Vector3<f64>) -> Vector3<f64> {
        let own = self.R.tr_mul(d);
        let point = match self.solid {
            Solid::Sphere { .. } => Vector3::zeros(),
            Solid::Box { half_m } => cuboid::support(half_m, &own),
            Solid::Cylinder { radius_m, half_height_m } => cylinder::support(*radius_m, *half_height_m, &own),
            Solid::Capsule { half_height_m, .. } => capsule::support(*half_height_m, &own),
            Solid::Ellipsoid { semi_axes_m } => ellipsoid::support(semi_axes_m, &own),
            Solid::Convex(hull) => convex::support(hull, &own),
        };
        self.p + self.R * point
    }

    /// Second derivative of the core's support function h(d) at a unit d, where it has one: 0 at a vertex.
    pub fn curvature(&self, d: &Vector3<f64>) -> Matrix3<f64> {
        let own = self.R.tr_mul(d);
        let curvature = match self.solid {
            Solid::Cylinder { radius_m, .. } => cylinder::curvature(*radius_m, &own),
            Solid::Ellipsoid { semi_axes_m } => ellipsoid::curvature(semi_axes_m, &own),
            _ => return Matrix3::zeros(),
        };
        self.R * curvature * self.R.transpose()
    }

    /// Whether the core is the hull of finitely many vertices.
    pub fn is_polytope(&self) -> bool {
        !matches!(self.solid, Solid::Cylinder { .. } | Solid::Ellipsoid { .. })
    }

    pub fn vertices(&self) -> u32 {
        match self.solid {
            Solid::Sphere { .. } => 1,
            Solid::Capsule { .. } => 2,
            Solid::Box { .. } => 8,
            Solid::Convex(hull) => hull.vertices.len() as u32,
            Solid::Cylinder { .. } | Solid::Ellipsoid { .. } => 0,
        }
    }

    pub fn vertex(&self, number: u32) -> Vector3<f64> {
        let own = match self.solid {
            Solid::Box { half_m } => cuboid::corner(half_m, number),
            Solid::Capsule { half_height_m, .. } => capsule::end(*half_height_m, number),
            Solid::Convex(hull) => hull.vertices[number as usize],
            _ => Vector3::zeros(),
        };
        self.p + self.R * own
    }

    /// Number of faces: polygons, or the two caps of a cylinder, −y first.
    pub fn faces(&self) -> u32 {
        match self.solid {
            Solid::Box { .. } => 6,
            Solid::Cylinder { .. } => 2,
            Solid::Convex(hull) => hull.faces.len() as u32,
            _ => 0,
        }
    }

    /// Unit normal of a face, outward.
    pub fn face_normal(&self, face: u32) -> Vector3<f64> {
        let sign = if face & 1 == 0 { -1.0 } else { 1.0 };
        match self.solid {
            Solid::Box { .. } => self.R.column(face as usize / 2) * sign,
            Solid::Cylinder { .. } => self.R.column(1) * sign,
            Solid::Convex(hull) => self.R * hull.faces[face as usize].normal,
            _ => Vector3::zeros(),
        }
    }

    /// Vertices around a face; empty for a cap.
    pub fn face_corners(&self, face: u32) -> &'a [u32] {
        match self.solid {
            Solid::Box { .. } => &cuboid::FACES[face as usize],
            Solid::Convex(hull) => &hull.faces[face as usize].corners,
            _ => &[],
        }
    }

    /// Number of directions of straight lines on the surface: edges, and a cylinder's and a capsule's generators.
    pub fn lines(&self) -> usize {
        match self.solid {
            Solid::Box { .. } => 3,
            Solid::Cylinder { .. } | Solid::Capsule { .. } => 1,
            Solid::Convex(hull) => hull.edge_directions.len(),
            Solid::Sphere { .. } | Solid::Ellipsoid { .. } => 0,
        }
    }

    pub fn line(&self, number: usize) -> Vector3<f64> {
        match self.solid {
            Solid::Box { .. } => self.R.column(number).into(),
            Solid::Convex(hull) => self.R * hull.edge_directions[number],
            _ => self.axis(),
        }
    }

    /// The body's y axis.
    pub fn axis(&self) -> Vector3<f64> {
        self.R.column(1).into()
    }

    /// The body's axes.
    pub fn axes(&self) -> [Vector3<f64>; 3] {
        [0, 1, 2].map(|i| self.R.column(i).into())
    }

    /// Ends of the edge or generator that is farthest along `d`, with their numbers: twice the same point where the
    /// support is one. A vertex belongs to it that is less far by at most `slack_m`.
    pub fn support_line(&self, d: &Vector3<f64>, slack_m: f64) -> [(u32, Vector3<f64>); 2] {
        match self.solid {
            Solid::Cylinder { radius_m, half_height_m } if d.dot(&self.axis()).abs() < PARALLEL => {
                let side = self.p + self.R * (rim_directions(&self.R.tr_mul(d))[0] * *radius_m);
                let half = self.axis() * *half_height_m;
                [(0, side - half), (1, side + half)]
            }
            Solid::Capsule { .. } if d.dot(&self.axis()).abs() < PARALLEL => [0, 1].map(|i| (i, self.vertex(i))),
            _ if !self.is_polytope() => [(0, self.support(d)); 2],
            _ => {
                let farthest = (0..self.vertices()).map(|i| d.dot(&self.vertex(i))).fold(f64::NEG_INFINITY, f64::max);
                let mut on = (0..self.vertices()).filter(|i| farthest - d.dot(&self.vertex(*i)) <= slack_m);
                let first = on.next().unwrap_or_default();
                let second = on.next().unwrap_or(first);
                [(first, self.vertex(first)), (second, self.vertex(second))]
            }
        }
    }

    /// Centre and radius of a cap.
    pub fn cap(&self, face: u32) -> (Vector3<f64>, f64) {
        match self.solid {
            Solid::Cylinder { radius_m, half_height_m } => {
                (self.p + self.face_normal(face) * *half_height_m, *radius_m)
            }
            _ => (self.p, 0.0),
        }
    }

    /// Four directions from a cap's centre to its rim, the one nearest to `along` first.
    pub fn rim(&self, along: &Vector3<f64>) -> [Vector3<f64>; 4] {
        rim_directions(&self.R.tr_mul(along)).map(|u| self.R * u)
    }
}

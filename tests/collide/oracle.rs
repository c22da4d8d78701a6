//! Solids by their definitions, written without the code under test: membership and support, and random poses.

use gotai::shape::hull::Hull;
use gotai::shape::solid::{Pose, Solid};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// SplitMix64 (G. L. Steele, D. Lea & C. H. Flood, OOPSLA 2014).
pub struct Draws(pub u64);

impl Draws {
    /// Uniform on [−1, 1).
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 * f64::EPSILON - 1.0
    }

    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.next(), self.next(), self.next())
    }

    pub fn direction(&mut self) -> Vector3<f64> {
        loop {
            let v = self.vector();
            if v.norm() < 1.0 && v.norm() > 0.1 {
                return v.normalize();
            }
        }
    }

    pub fn attitude(&mut self) -> UnitQuaternion<f64> {
        UnitQuaternion::from_quaternion(Quaternion::new(self.next(), self.next(), self.next(), self.next()))
    }
}

pub fn at(p_W: Vector3<f64>) -> Pose {
    Pose { p_W, q_W: UnitQuaternion::identity() }
}

pub fn about(axis: Vector3<f64>, angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_scaled_axis(axis.normalize() * angle)
}

/// One of each kind, of different sizes.
pub fn solids() -> Vec<Solid> {
    let gem = [
        [0.6, 0.0, 0.0],
        [-0.5, 0.1, 0.0],
        [0.0, 0.7, 0.1],
        [0.1, -0.6, 0.0],
        [0.0, 0.1, 0.5],
        [0.1, 0.0, -0.55],
        [0.35, 0.35, 0.3],
    ];
    vec![
        Solid::Sphere { radius_m: 0.5 },
        Solid::Box { half_m: Vector3::new(0.5, 0.3, 0.4) },
        Solid::Cylinder { radius_m: 0.4, half_height_m: 0.3 },
        Solid::Capsule { radius_m: 0.25, half_height_m: 0.4 },
        Solid::Ellipsoid { semi_axes_m: Vector3::new(0.6, 0.35, 0.45) },
        Solid::Convex(Hull::new(gem.map(Vector3::from).to_vec()).unwrap()),
    ]
}

/// In own axes: negative inside, 0 on the surface; a distance but near the ellipsoid, where it is at least a third of
/// it.
pub fn level(solid: &Solid, p: &Vector3<f64>) -> f64 {
    let radial = (p.x * p.x + p.z * p.z).sqrt();
    match solid {
        Solid::Sphere { radius_m } => p.norm() - radius_m,
        Solid::Box { half_m } => (p.abs() - half_m).max(),
        Solid::Cylinder { radius_m, half_height_m } => (radial - radius_m).max(p.y.abs() - half_height_m),
        Solid::Capsule { radius_m, half_height_m } => {
            Vector3::new(p.x, (p.y.abs() - half_height_m).max(0.0), p.z).norm() - radius_m
        }
        Solid::Ellipsoid { semi_axes_m } => (p.component_div(semi_axes_m).norm() - 1.0) * semi_axes_m.min(),
        Solid::Convex(hull) => {
            let height =
                |face: &gotai::shape::hull::Polygon| face.normal.dot(&(p - hull.vertices[face.corners[0] as usize]));
            hull.faces.iter().map(height).fold(f64::NEG_INFINITY, f64::max)
        }
    }
}

pub fn level_at(solid: &Solid, pose: &Pose, p_W: &Vector3<f64>) -> f64 {
    level(solid, &pose.q_W.inverse_transform_vector(&(p_W - pose.p_W)))
}

/// How far the solid reaches along a unit direction of the world, from the world's origin.
pub fn reach(solid: &Solid, pose: &Pose, d_W: &Vector3<f64>) -> f64 {
    let d = pose.q_W.inverse_transform_vector(d_W);
    let radial = (d.x * d.x + d.z * d.z).sqrt();
    let own = match solid {
        Solid::Sphere { radius_m } => *radius_m,
        Solid::Box { half_m } => half_m.dot(&d.abs()),
        Solid::Cylinder { radius_m, half_height_m } => radius_m * radial + half_height_m * d.y.abs(),
        Solid::Capsule { radius_m, half_height_m } => radius_m + half_height_m * d.y.abs(),
        Solid::Ellipsoid { semi_axes_m } => semi_axes_m.component_mul(&d).norm(),
        Solid::Convex(hull) => hull.vertices.iter().map(|v| v.dot(&d)).fold(f64::NEG_INFINITY, f64::max),
    };
    pose.p_W.dot(d_W) + own
}

/// By how much a plane with this normal parts the two.
pub fn separation(a: &Solid, pose_a: &Pose, b: &Solid, pose_b: &Pose, n: &Vector3<f64>) -> f64 {
    -reach(a, pose_a, &-n) - reach(b, pose_b, n)
}

/// A pose of `a` that lies `gap` from `b` along a random direction; the true gap is no smaller.
pub fn beside(draws: &mut Draws, a: &Solid, b: &Solid, gap_m: f64) -> (Pose, Pose) {
    let pose_b = Pose { p_W: draws.vector(), q_W: draws.attitude() };
    let mut pose_a = Pose { p_W: pose_b.p_W, q_W: draws.attitude() };
    let n = draws.direction();
    pose_a.p_W += n * (gap_m - separation(a, &pose_a, b, &pose_b, &n));
    (pose_a, pose_b)
}

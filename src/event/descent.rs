//! How the rim of a cap that is nearly flat comes down to a plane.

use nalgebra::Vector3;

/// All points of a rim on their way down to a plane: to first order, its lowest one is
/// g + r|λ| + ċ t − r|λ + λ̇ t| above it, c the height of its centre and λ its lean.
pub struct Descent {
    pub(super) radius_m: f64,
    pub(super) centre_m_s: f64,
    pub(super) lean: Vector3<f64>,
    pub(super) leaning_rad_s: Vector3<f64>,
}

/// Halvings of the time in which a rim may come down.
const HALVINGS: u32 = 48;

impl Descent {
    /// The time in which no point of it comes down, the lowest being so high, and none accelerated more toward the
    /// plane. What is left of the height is concave, and has one root.
    pub fn safe_s(&self, gap_m: f64, toward_m_s2: f64) -> f64 {
        let (r, m) = (self.radius_m, toward_m_s2);
        let left_m = |t_s: f64| {
            let sags_m = r * ((self.lean + self.leaning_rad_s * t_s).norm() - self.lean.norm());
            gap_m + self.centre_m_s * t_s - sags_m - 0.5 * m * t_s * t_s
        };
        let most_m_s = self.centre_m_s.abs() + r * self.leaning_rad_s.norm();
        let (mut safe_s, mut late_s) = (0.0, (most_m_s + (most_m_s * most_m_s + 2.0 * m * gap_m).sqrt()) / m);
        if !late_s.is_finite() {
            return 0.0;
        }
        for _ in 0..HALVINGS {
            let middle_s = 0.5 * (safe_s + late_s);
            *(if left_m(middle_s) >= 0.0 { &mut safe_s } else { &mut late_s }) = middle_s;
        }
        safe_s
    }
}

//! Two rims that cross, of caps that are tilted against each other.
//!
//! They touch in the points x_a and x_b of the two circles that are nearest to each other, across both tangents, and
//! their normal is n ∥ t_a × t_b. Where the tilt is small, the normal hardly tells the points (`curved`), but the
//! points tell the normal.

use super::rates::Rates;
use crate::collide::Contact;
use crate::state::BodyState;
use nalgebra::Vector3;

/// A rim in the world; its axis is out of the cap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Circle {
    pub(super) centre: Vector3<f64>,
    pub(super) axis: Vector3<f64>,
    pub(super) radius_m: f64,
}

/// Steps to the nearest points, which are known nearly.
const STEPS: u32 = 20;

/// Sine of the angle between two rims that cross; less, and they are as good as tangent.
const CROSSES: f64 = 1e-3;

/// Nearest points, directions from the centres to them and along the rims there, of the two.
pub(super) struct TwoRims {
    radii_m: [f64; 2],
    x: [Vector3<f64>; 2],
    toward: [Vector3<f64>; 2],
    t: [Vector3<f64>; 2],
    /// Out of the first one; and its length before it is made one, with its sign.
    out: Vector3<f64>,
    length: f64,
    /// How far the normal is from where the one cap or the other, or a side, is nearer.
    pub(super) inside_m: f64,
}

impl TwoRims {
    /// Where they cross next to a point. None: they are next to tangent there.
    pub(super) fn near(circles: [&Circle; 2], p: &Vector3<f64>) -> Option<Self> {
        let flat = |circle: &Circle| {
            let from = p - circle.centre;
            (from - circle.axis * circle.axis.dot(&from)).try_normalize(0.0)
        };
        let mut toward = [flat(circles[0])?, flat(circles[1])?];
        let radii_m = circles.map(|circle| circle.radius_m);
        let along = |toward: &[Vector3<f64>; 2]| [0, 1].map(|i| circles[i].axis.cross(&toward[i]));
        let points = |toward: &[Vector3<f64>; 2]| [0, 1].map(|i| circles[i].centre + toward[i] * radii_m[i]);
        for _ in 0..STEPS {
            let (t, x) = (along(&toward), points(&toward));
            let (w, crosses) = (x[0] - x[1], t[0].dot(&t[1]));
            // w stays across both tangents.
            let [a, b] = [radii_m[0] - toward[0].dot(&w), radii_m[1] + toward[1].dot(&w)];
            let determinant = radii_m[0] * radii_m[1] * crosses * crosses - a * b;
            if determinant.abs() <= CROSSES * CROSSES * radii_m[0] * radii_m[1] {
                return None;
            }
            let [f, g] = [-t[0].dot(&w), -t[1].dot(&w)];
            let turns =
                [(radii_m[1] * crosses * g - b * f) / determinant, (a * g - radii_m[0] * crosses * f) / determinant];
            for (i, turn) in turns.iter().enumerate() {
                let (sin, cos) = libm::sincos(turn.clamp(-0.5, 0.5));
                toward[i] = (toward[i] * cos + t[i] * sin).normalize();
            }
            if turns.iter().all(|turn| turn.abs() <= f64::EPSILON) {
                break;
            }
        }
        let t = along(&toward);
        let across = t[0].cross(&t[1]);
        let axes = circles.map(|circle| circle.axis);
        // Out of a rim is what is between its cap's normal and outward.
        let away = axes[0] + toward[0] - axes[1] - toward[1];
        let length = across.norm().copysign(across.dot(&away));
        if length.abs() <= CROSSES {
            return None;
        }
        let out = across / length;
        let least = [out.dot(&axes[0]), out.dot(&toward[0]), -out.dot(&axes[1]), -out.dot(&toward[1])];
        let inside_m = least.into_iter().fold(f64::INFINITY, f64::min) * radii_m[0].min(radii_m[1]);
        Some(TwoRims { radii_m, x: points(&toward), toward, t, out, length, inside_m })
    }

    /// The contact, and its rates as the bodies move, to which the rims belong. `first`: the first is of the contact's
    /// first body.
    pub(super) fn here(&self, found: &Contact, at: [&BodyState; 2], first: bool) -> (Contact, Rates) {
        let TwoRims { radii_m, x, toward, t, out, length, .. } = self;
        let velocity = |i: usize| at[i].v_WB + at[i].w_WB.cross(&(x[i] - at[i].p_WB));
        let (u, crosses) = (velocity(0) - velocity(1), t[0].dot(&t[1]));
        // ẇ stays across both tangents, w being next to none.
        let [f, g] = [-t[0].dot(&u), -t[1].dot(&u)];
        let sine_squared = (1.0 - crosses) * (1.0 + crosses);
        let along_m_s = [(f - crosses * g) / sine_squared, (crosses * f - g) / sine_squared];
        let t_rate = |i: usize| at[i].w_WB.cross(&t[i]) - toward[i] * (along_m_s[i] / radii_m[i]);
        let across_rate = t_rate(0).cross(&t[1]) + t[0].cross(&t_rate(1));
        let out_rate = (across_rate - out * out.dot(&across_rate)) / *length;
        let rates = [0, 1].map(|i| velocity(i) + t[i] * along_m_s[i] - at[i].v_WB);
        let sign = if first { -1.0 } else { 1.0 };
        let gap_m = out.dot(&(x[1] - x[0]));
        let contact = Contact { p_WC: (x[0] + x[1]) * 0.5, normal: out * sign, gap_m, ..*found };
        let [r_A, r_B] = if first { rates } else { [rates[1], rates[0]] };
        (contact, Rates { r_A, r_B, normal: out_rate * sign })
    }
}

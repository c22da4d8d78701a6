//! What is rounding in a column. An error below it says nothing of a method, neither its order nor its rank; verdicts
//! and reports ask the same function.

use crate::experiment::types::Experiment;
use crate::heading::unit_of;

/// Sizes that rounding is relative to. Rows do not have them: they are those of an experiment's first case, at most one
/// of each unit, so that what is small is not taken for rounding and what is large may be judged a little too late.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Magnitudes {
    length_m: f64,
    speed_m_s: f64,
    turning_rad_s: f64,
}

/// Roundings of a number of that size which sums and differences of a run leave.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

impl Default for Magnitudes {
    fn default() -> Self {
        Magnitudes { length_m: 1.0, speed_m_s: 1.0, turning_rad_s: 1.0 }
    }
}

impl Magnitudes {
    /// Sizes of an experiment: where its bodies are and how far they go, how fast they are and how fast they turn.
    pub fn of(experiment: &Experiment) -> Self {
        let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let end_s = experiment.clock().end_s;
        let fall_m_s = norm(experiment.scene.gravity_m_s2) * end_s;
        let (mut place_m, mut speed_m_s, mut turning_rad_s) = (0.0f64, fall_m_s, 1.0 / end_s);
        for body in &experiment.scene.bodies {
            place_m = place_m.max(norm(body.position_m));
            speed_m_s = speed_m_s.max(norm(body.velocity_m_s.unwrap_or_default()));
            let turning = body.angular_velocity_rad_s.or(body.angular_velocity_body_rad_s).unwrap_or_default();
            turning_rad_s = turning_rad_s.max(norm(turning));
        }
        let length_m = place_m.max(speed_m_s * end_s);
        let of = |size: f64| if size > 0.0 { size.min(1.0) } else { 1.0 };
        Magnitudes {
            length_m: of(length_m),
            speed_m_s: of(speed_m_s.max(length_m / end_s)),
            turning_rad_s: of(turning_rad_s),
        }
    }

    /// The size below which a number of a column is rounding; 0 of a column of a unit that has no size here.
    pub fn floor(&self, column: &str) -> f64 {
        let size = match unit_of(column) {
            "" | "rad" => 1.0,
            "m" => self.length_m,
            "m/s" => self.speed_m_s,
            "rad/s" => self.turning_rad_s,
            _ => 0.0,
        };
        ROUNDINGS * size
    }
}

//! A ball that rolls on a level table turning at Ω about a vertical axis: with k = I/(m r²) its centre goes round a
//! circle at λ = Ω k/(1 + k), 2Ω/7 for a homogeneous ball, wherever it starts (Routh, Advanced Rigid Dynamics, § 224;
//! Weltner, Am. J. Phys. 47 (1979) 984). v̇ = λ n × v, r ω = n × v + Ω ρ along the table, and the spin about n stays.
//! SI units.
//!
//! The attitude is elementary for a circle about the table's axis, else by `attitude.rs`.

use super::attitude::{TERMS, turned};
use crate::state::BodyState;
use nalgebra::{UnitQuaternion, Vector3};

#[derive(Clone, Debug)]
pub struct Turntable {
    start: BodyState,
    /// Unit, up.
    normal: Vector3<f64>,
    /// λ.
    rate_rad_s: f64,
    /// What of ω does not turn with λ.
    steady_W: Vector3<f64>,
    /// What does, at the start.
    turning_W: Vector3<f64>,
}

impl Turntable {
    /// Of a ball that rolls at the start; `from_axis` to its centre, along the table.
    pub fn new(
        start: &BodyState,
        normal: Vector3<f64>,
        table_rad_s: f64,
        from_axis: Vector3<f64>,
        radius_m: f64,
        inertia: f64,
    ) -> Self {
        let rate_rad_s = table_rad_s * inertia / (1.0 + inertia);
        let v = start.v_WB;
        // ρ = ρ_c − n × v/λ, and Ω/λ = 1 + 1/k.
        let turning_W = -normal.cross(&v) / (inertia * radius_m);
        let across = (normal.cross(&v) + from_axis * table_rad_s) / radius_m;
        let steady_W = normal * normal.dot(&start.w_WB) + (across - turning_W);
        Turntable { start: *start, normal, rate_rad_s, steady_W, turning_W }
    }

    /// v̇, which friction must hold.
    pub fn acceleration_m_s2(&self) -> f64 {
        self.rate_rad_s.abs() * self.start.v_WB.norm()
    }

    /// Radius of the circle; none if the table is at rest.
    pub fn radius_m(&self) -> f64 {
        self.start.v_WB.norm() / self.rate_rad_s.abs()
    }

    /// From the ball's centre at the start to the circle's.
    pub fn to_centre_m(&self) -> Vector3<f64> {
        self.normal.cross(&self.start.v_WB) / self.rate_rad_s
    }

    pub fn at(&self, t_s: f64) -> BodyState {
        let (start, angle) = (&self.start, self.rate_rad_s * t_s);
        let (sin, half) = (libm::sin(angle), libm::sin(angle / 2.0));
        // sin x/x and (1 − cos x)/x.
        let (along, aside) = if angle == 0.0 { (1.0, 0.0) } else { (sin / angle, 2.0 * half * half / angle) };
        let v = start.v_WB;
        let across = self.normal.cross(&v);
        let turn = UnitQuaternion::from_scaled_axis(self.normal * angle);
        BodyState {
            p_WB: start.p_WB + (v * along + across * aside) * t_s,
            q_WB: self.attitude(t_s),
            v_WB: v * libm::cos(angle) + across * sin,
            w_WB: self.steady_W + turn * self.turning_W,
        }
    }

    fn attitude(&self, t_s: f64) -> UnitQuaternion<f64> {
        let (steady, turning, rate) = (self.steady_W, self.turning_W, self.rate_rad_s);
        let table_W = self.normal * rate;
        if self.normal.cross(&steady).norm() <= f64::EPSILON * (steady.norm() + turning.norm()) {
            let own = UnitQuaternion::from_scaled_axis((steady + turning - table_W) * t_s);
            return UnitQuaternion::from_scaled_axis(table_W * t_s) * own * self.start.q_WB;
        }
        let fastest = steady.norm() + turning.norm() + rate.abs();
        turned(&self.start.q_WB, t_s, fastest, |t_s| {
            let mut term = UnitQuaternion::from_scaled_axis(table_W * t_s) * turning;
            let mut series = [Vector3::zeros(); TERMS];
            for (n, coefficient) in series.iter_mut().enumerate() {
                *coefficient = if n == 0 { term + steady } else { term };
                term = table_W.cross(&term) / (n + 1) as f64;
            }
            series
        })
        .q_WB
    }
}

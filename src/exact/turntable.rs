//! A ball that rolls on a level table turning at Ω about a vertical axis: with k = I/(m r²) its centre goes round a
//! circle at λ = Ω k/(1 + k), 2Ω/7 for a homogeneous ball, wherever it starts (Routh, Advanced Rigid Dynamics, § 224;
//! Weltner, Am. J. Phys. 47 (1979) 984). v̇ = λ n × v, r ω = n × v + Ω ρ along the table, and the spin about n stays.
//! SI units.
//!
//! The attitude is elementary for a circle about the table's axis, else by `attitude.rs`.

use super::attitude::{TERMS, turned};
use super::facts::{Lacks, SAME, only_other};
use super::form::{ClosedForm, ExactMotion};
use super::touching::{ON, rounding_m, sphere, unhindered};
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::BodyState;
use crate::state::State;
use nalgebra::{UnitQuaternion, Vector3};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Circles at k/(1 + k) of the table's rate, k = I/(m r²): 2/7 of it for a homogeneous ball.",
    source: "Routh, Advanced Rigid Dynamics, 224; Weltner, Am. J. Phys. 47 (1979) 984",
    scenes: "A sphere that rolls on a level box or cylinder with a kinematic spin about its vertical axis; no \
           container.",
    motion,
};

#[derive(Clone, Debug)]
pub struct Turntable {
    start: BodyState,
    /// Unit normal, up.
    normal: Vector3<f64>,
    /// Rate λ.
    rate_rad_s: f64,
    /// Part of ω that does not turn with λ.
    steady_W: Vector3<f64>,
    /// Part of ω that does, at the start.
    turning_W: Vector3<f64>,
}

impl Turntable {
    /// The motion of a ball that rolls at the start; `from_axis` leads to its centre, along the table.
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

    /// Acceleration v̇, which friction must hold, in m/s².
    pub fn acceleration_m_s2(&self) -> f64 {
        self.rate_rad_s.abs() * self.start.v_WB.norm()
    }

    /// Radius of the circle, in metres; None if the table is at rest.
    pub fn radius_m(&self) -> f64 {
        self.start.v_WB.norm() / self.rate_rad_s.abs()
    }

    /// Vector from the ball's centre at the start to the circle's, in metres.
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
        // ω comes back with every turn of the circle: whole turns are powers of one (G. Floquet 1883).
        let turn_s = 2.0 * std::f64::consts::PI / rate.abs();
        let turns = (t_s / turn_s).floor();
        if turns <= 0.0 {
            return self.followed(t_s);
        }
        let rest = self.followed(t_s - turns * turn_s);
        let whole = self.followed(turn_s) * self.start.q_WB.inverse();
        rest * self.start.q_WB.inverse()
            * UnitQuaternion::from_scaled_axis(whole.scaled_axis() * turns)
            * self.start.q_WB
    }

    /// Attitude after a part of a turn.
    fn followed(&self, t_s: f64) -> UnitQuaternion<f64> {
        let (steady, turning, rate) = (self.steady_W, self.turning_W, self.rate_rad_s);
        let table_W = self.normal * rate;
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

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let (body, at) = (&model.bodies[index], &start.bodies[index]);
    let (radius_m, inertia) = sphere(body)?;
    let acceleration = unhindered(model, index)?;
    let table = only_other(model, index, "a ball and a table")?;
    let level = || format!("`{}` turning about the vertical axis through its middle", model.bodies[table].name);
    let press = acceleration.norm();
    let up = (-acceleration).try_normalize(0.0).ok_or("gravity")?;
    let (table_body, table_at) = (&model.bodies[table], &start.bodies[table]);
    let (height_m, reach_m) = table_top(table_body, table_at, &up).ok_or_else(level)?;
    let w = table_at.w_WB;
    if !table_body.driven || w.cross(&up).norm() > SAME * w.norm() || table_at.v_WB != Vector3::zeros() {
        return Err(level());
    }
    let to_ball = at.p_WB - table_at.p_WB;
    let from_axis = to_ball - up * up.dot(&to_ball);
    let gap_m = up.dot(&to_ball) - height_m - radius_m;
    let slip = at.v_WB - at.w_WB.cross(&up) * radius_m - w.cross(&from_axis);
    let speeds = at.v_WB.norm() + at.w_WB.norm() * radius_m + w.norm() * from_axis.norm();
    if gap_m.abs() > rounding_m(radius_m, at) || slip.norm() > SAME * speeds {
        return Err(format!("`{}` rolling on the table", body.name));
    }
    let turntable = Turntable::new(at, up, up.dot(&w), from_axis, radius_m, inertia);
    if turntable.acceleration_m_s2() > model.pair(index, Some(table)).friction * press {
        return Err("more friction than rolling takes".into());
    }
    let circle_m = (from_axis + turntable.to_centre_m()).norm() + turntable.radius_m();
    if w.norm() > 0.0 && circle_m > reach_m {
        return Err(format!("`{}` staying on the table", body.name));
    }
    Ok(ExactMotion::new(move |t_s| turntable.at(t_s)))
}

/// Height of a level top above the centre of mass, and how far from the axis it is there in every direction.
fn table_top(body: &Body, at: &BodyState, up: &Vector3<f64>) -> Option<(f64, f64)> {
    let Geometry::Solid { solid, centre } = &body.geometry else { return None };
    let up_B = at.q_WB.inverse_transform_vector(up);
    let axis = up_B.iamax();
    let level = (up_B.abs() - Vector3::ith(axis, 1.0)).norm() <= SAME;
    let (half_m, reach_m) = match solid {
        Solid::Box { half_m } => (half_m[axis], half_m[(axis + 1) % 3].min(half_m[(axis + 2) % 3])),
        Solid::Cylinder { radius_m, half_height_m } if axis == 1 => (*half_height_m, *radius_m),
        _ => return None,
    };
    (level && centre.norm() <= ON * half_m).then_some((half_m, reach_m))
}

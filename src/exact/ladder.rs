//! A ladder that slides down a smooth wall along a smooth floor (Routh, Elementary Rigid Dynamics, § 144): on both it
//! is an inverted pendulum, θ̈ = g sin θ/(l (1 + κ)), θ from the vertical, l half its length, κ = I/(m l²), 1/3 if
//! homogeneous. Whatever κ, it leaves the wall where cos θ = ⅔ cos θ₀; then it falls as a rod on a floor that was let
//! go at cos θₑ = cos θ₀ − 4/27 cos³ θ₀/(1 + κ), while its centre goes on at the speed that it has. SI units.
//!
//! Known limit: of an almost upright ladder the error grows, to 1e-11 from 0.001 rad.

use super::facts::{Lacks, SAME};
use super::falling_rod::{FallingRod, capsule_m, fallen, of_rod};
use super::form::{ClosedForm, ExactMotion};
use super::inverted_pendulum::InvertedPendulum;
use super::touching::{feet, only_faces, press_on, unhindered};
use crate::model::Model;
use crate::model::container::Face;
use crate::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "It leaves the wall at 2/3 of its height, by elliptic functions; then a falling rod that goes on sideways.",
    source: "Routh, Elementary Rigid Dynamics, 144",
    scenes: "One capsule leaning at rest, one end on each of a container's two planes, one level and one upright; no \
           friction, restitution 0.",
    motion,
};

#[derive(Clone, Debug)]
pub struct Ladder {
    half_length_m: f64,
    on_wall: InvertedPendulum,
    leaves_s: f64,
    /// Distance of the centre from the wall at that time; its speed follows.
    distance_m: f64,
    speed_m_s: f64,
    falling: FallingRod,
    /// Time since it would have been let go on the floor alone.
    let_go_s: f64,
}

/// Angle from the vertical and its rate; distance of the centre from the wall and its rate.
#[derive(Clone, Copy, Debug)]
pub struct Leaning {
    pub angle_rad: f64,
    pub rate_rad_s: f64,
    pub distance_m: f64,
    pub speed_m_s: f64,
}

impl Ladder {
    /// The motion from rest at 0 < θ₀ < π/2. None if rounding keeps it there.
    pub fn new(angle_rad: f64, inertia: f64, half_length_m: f64, gravity_m_s2: f64) -> Option<Self> {
        let start = libm::cos(angle_rad);
        let natural_rad_s = (gravity_m_s2 / (half_length_m * (1.0 + inertia))).sqrt();
        let on_wall = InvertedPendulum::new(natural_rad_s, angle_rad, 0.0);
        let leaving = libm::acos(2.0 / 3.0 * start);
        let (leaves_s, rate) = on_wall.comes_to(leaving)?;
        let let_go = libm::acos(start - 4.0 / 27.0 * start.powi(3) / (1.0 + inertia));
        let falling = FallingRod::new(let_go, inertia, half_length_m, gravity_m_s2);
        let let_go_s = falling.comes_to_s(leaving);
        let (distance_m, speed_m_s) = (half_length_m * libm::sin(leaving), half_length_m * libm::cos(leaving) * rate);
        Some(Ladder { half_length_m, on_wall, leaves_s, distance_m, speed_m_s, falling, let_go_s })
    }

    pub fn leaves_s(&self) -> f64 {
        self.leaves_s
    }

    pub fn flat_s(&self) -> f64 {
        self.leaves_s + self.falling.flat_s() - self.let_go_s
    }

    pub fn at(&self, t_s: f64) -> Leaning {
        if t_s < self.leaves_s {
            let (angle_rad, rate_rad_s) = self.on_wall.at(t_s);
            let (sin, cos) = (libm::sin(angle_rad), libm::cos(angle_rad));
            let (distance_m, speed_m_s) = (self.half_length_m * sin, self.half_length_m * cos * rate_rad_s);
            return Leaning { angle_rad, rate_rad_s, distance_m, speed_m_s };
        }
        let since_s = t_s - self.leaves_s;
        let flat = t_s >= self.flat_s();
        let (angle_rad, rate_rad_s) =
            if flat { (std::f64::consts::FRAC_PI_2, 0.0) } else { self.falling.at(self.let_go_s + since_s) };
        let distance_m = self.distance_m + self.speed_m_s * since_s;
        Leaning { angle_rad, rate_rad_s, distance_m, speed_m_s: self.speed_m_s }
    }
}

/// A rod between a wall and a floor.
struct LadderAt {
    ladder: Ladder,
    start: BodyState,
    angle_rad: f64,
    half_length_m: f64,
    axis_W: Vector3<f64>,
    up: Vector3<f64>,
    /// Direction out from the wall.
    out: Vector3<f64>,
}

impl LadderAt {
    fn at(&self, t_s: f64) -> BodyState {
        let (leaning, length) = (self.ladder.at(t_s), self.half_length_m);
        let angle = leaning.angle_rad;
        let gone_m = leaning.distance_m - length * libm::sin(self.angle_rad);
        let turn = UnitQuaternion::from_scaled_axis(self.axis_W * (angle - self.angle_rad));
        let sinking = length * libm::sin(angle) * leaning.rate_rad_s;
        BodyState {
            p_WB: self.start.p_WB + self.out * gone_m - self.up * (length * fallen(self.angle_rad, angle)),
            q_WB: turn * self.start.q_WB,
            v_WB: self.out * leaning.speed_m_s - self.up * sinking,
            w_WB: self.axis_W * leaning.rate_rad_s,
        }
    }
}

/// The motion of a capsule that leans on a smooth floor along a smooth wall.
fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let acceleration = unhindered(model, index)?;
    let faces: [Face; 2] = only_faces(model).ok_or("a `container` of two planes, and one body with a shape")?;
    let floor = faces.iter().position(|face| press_on(face, &acceleration).is_some());
    let floor = floor.ok_or("a level plane and an upright one")?;
    let (up, out) = (faces[floor].normal, faces[1 - floor].normal);
    if up.dot(&out).abs() > SAME {
        return Err("a level plane and an upright one".into());
    }
    let (body, surface) = (&model.bodies[index], model.pair(index, None));
    let half_length_m = capsule_m(body)?;
    if surface.friction != 0.0 || surface.restitution != 0.0 {
        return Err("no friction and no restitution".into());
    }
    let axis = at.q_WB * Vector3::y();
    let upward = axis * libm::copysign(1.0, axis.dot(&up));
    let (axis_W, angle_rad) = (out.cross(&up), libm::atan2(-upward.dot(&out), upward.dot(&up)));
    let leans = angle_rad > SAME && upward.dot(&up) > SAME && upward.dot(&axis_W).abs() <= SAME;
    let still = at.v_WB == Vector3::zeros() && at.w_WB == Vector3::zeros();
    if !leans || !still || faces.iter().any(|face| feet(body, at, face).len() != 1) {
        return Err(format!("`{}` leaning at rest, one end on each plane", body.name));
    }
    let inertia = of_rod(body, at, &axis_W, half_length_m)?;
    let ladder = Ladder::new(angle_rad, inertia, half_length_m, acceleration.norm())
        .ok_or_else(|| format!("`{}` leaning far enough to slide", body.name))?;
    let ladder = LadderAt { ladder, start: *at, angle_rad, half_length_m, axis_W, up, out };
    Ok(ExactMotion::new(move |t_s| ladder.at(t_s)))
}

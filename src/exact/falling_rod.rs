//! A thin rod that falls over on a smooth floor (Routh, Elementary Rigid Dynamics, § 136): its centre falls straight
//! down, θ̇² = 2 (g/l)(cos θ₀ − cos θ)/(κ + sin² θ), θ from the vertical, l half its length, κ = I/(m l²), 1/3 if
//! homogeneous. The floor presses all the way, as κ + sin² θ₀ + (cos θ − cos θ₀)² > 0, and flat it stays at rest if
//! κ ≤ 1. SI units.
//!
//! With sin(θ/2) = sin(θ₀/2) cosh u the time is √(l/g) ∫ √(κ + sin² θ)/cos(θ/2) du, whose integrand is smooth: Gauss
//! and Legendre's rule on short panels, inverted by Newton's method.

use super::facts::{Lacks, SAME};
use super::form::{ClosedForm, ExactMotion};
use super::touching::{feet, level};
use crate::math::quadrature;
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Its centre falls straight down, by a quadrature; then it lies flat, at rest.",
    source: "Routh, Elementary Rigid Dynamics, 136",
    scenes: "One capsule leaning at rest, one end on a container of one level plane; no friction, restitution 0.",
    motion,
};

const NODES: usize = 20;

/// Length of a panel, in u. The error of a panel is below rounding.
const PANEL: f64 = 0.25;

#[derive(Clone, Debug)]
pub struct FallingRod {
    /// The constant sin(θ₀/2).
    start: f64,
    inertia: f64,
    /// Unit of time √(l/g).
    unit_s: f64,
    rule: [(f64, f64); NODES],
    /// Times at u = 0, 1, 2 … panels, the last one flat.
    times_s: Vec<f64>,
    panel: f64,
}

impl FallingRod {
    /// The motion from rest at 0 < θ₀ < π/2.
    pub fn new(angle_rad: f64, inertia: f64, half_length_m: f64, gravity_m_s2: f64) -> Self {
        let start = libm::sin(angle_rad / 2.0);
        let flat = libm::acosh(std::f64::consts::FRAC_1_SQRT_2 / start);
        let panels = libm::ceil(flat / PANEL).max(1.0);
        let unit_s = (half_length_m / gravity_m_s2).sqrt();
        let panel = flat / panels;
        let mut rod = FallingRod { start, inertia, unit_s, rule: quadrature::legendre(), times_s: vec![0.0], panel };
        let mut time_s = 0.0;
        for i in 0..panels as usize {
            time_s += rod.between_s(i as f64 * panel, (i + 1) as f64 * panel);
            rod.times_s.push(time_s);
        }
        rod
    }

    pub fn flat_s(&self) -> f64 {
        self.times_s[self.times_s.len() - 1]
    }

    /// Angle θ and its rate θ̇, before it is flat.
    pub fn at(&self, t_s: f64) -> (f64, f64) {
        let begun = self.times_s.partition_point(|time_s| *time_s <= t_s).clamp(1, self.times_s.len() - 1) - 1;
        let (left, time_s) = (begun as f64 * self.panel, self.times_s[begun]);
        let mut u = left + (t_s - time_s) / (self.times_s[begun + 1] - time_s) * self.panel;
        for _ in 0..8 {
            u -= (time_s + self.between_s(left, u) - t_s) / self.slope_s(u);
        }
        let half = self.start * libm::cosh(u);
        let rate = 2.0 * self.start * libm::sinh(u) / ((1.0 - half * half).sqrt() * self.slope_s(u));
        (2.0 * libm::asin(half), rate)
    }

    /// Derivative dt/du.
    fn slope_s(&self, u: f64) -> f64 {
        let sin = self.start * libm::cosh(u);
        let cos_squared = 1.0 - sin * sin;
        self.unit_s * ((self.inertia + 4.0 * sin * sin * cos_squared) / cos_squared).sqrt()
    }

    /// Time at which it comes to an angle on its way, in seconds.
    pub fn comes_to_s(&self, angle_rad: f64) -> f64 {
        let u = libm::acosh((libm::sin(angle_rad / 2.0) / self.start).max(1.0));
        let begun = ((u / self.panel) as usize).min(self.times_s.len() - 2);
        self.times_s[begun] + self.between_s(begun as f64 * self.panel, u)
    }

    fn between_s(&self, a: f64, b: f64) -> f64 {
        let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
        self.rule.iter().map(|(x, weight)| weight * half * self.slope_s(middle + half * x)).sum()
    }
}

/// A rod that turns about a horizontal axis.
struct Rod {
    falling: FallingRod,
    start: BodyState,
    angle_rad: f64,
    half_length_m: f64,
    axis_W: Vector3<f64>,
    up: Vector3<f64>,
}

impl Rod {
    fn at(&self, t_s: f64) -> BodyState {
        let flat = t_s >= self.falling.flat_s();
        let (angle, rate) = if flat { (std::f64::consts::FRAC_PI_2, 0.0) } else { self.falling.at(t_s) };
        let turn = UnitQuaternion::from_scaled_axis(self.axis_W * (angle - self.angle_rad));
        BodyState {
            p_WB: self.start.p_WB - self.up * (self.half_length_m * fallen(self.angle_rad, angle)),
            q_WB: turn * self.start.q_WB,
            v_WB: self.up * (-self.half_length_m * libm::sin(angle) * rate),
            w_WB: self.axis_W * rate,
        }
    }
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let (face, gravity_m_s2) = level(model, index)?;
    let (body, up) = (&model.bodies[index], face.normal);
    let surface = model.pair(index, None);
    let half_length_m = capsule_m(body)?;
    if surface.friction != 0.0 || surface.restitution != 0.0 {
        return Err("no friction and no restitution".into());
    }
    let axis = at.q_WB * Vector3::y();
    let upward = axis * libm::copysign(1.0, axis.dot(&up));
    let sine = up.cross(&upward);
    let leaning = || format!("`{}` leaning at rest, one end on the plane", body.name);
    let axis_W = sine.try_normalize(SAME).ok_or_else(leaning)?;
    let angle_rad = libm::atan2(sine.norm(), up.dot(&upward));
    let moves = at.v_WB != Vector3::zeros() || at.w_WB != Vector3::zeros();
    if moves || up.dot(&upward) <= SAME || feet(body, at, &face).len() != 1 {
        return Err(leaning());
    }
    let inertia = of_rod(body, at, &axis_W, half_length_m)?;
    let falling = FallingRod::new(angle_rad, inertia, half_length_m, gravity_m_s2);
    let rod = Rod { falling, start: *at, angle_rad, half_length_m, axis_W, up };
    Ok(ExactMotion::new(move |t_s| rod.at(t_s)))
}

/// Difference cos θ₀ − cos θ, without cancellation.
pub(super) fn fallen(from_rad: f64, to_rad: f64) -> f64 {
    2.0 * libm::sin((to_rad + from_rad) / 2.0) * libm::sin((to_rad - from_rad) / 2.0)
}

/// Ratio I/(m l²), l half the length, about an axis that it can turn about and lie flat.
pub(super) fn of_rod(body: &Body, at: &BodyState, axis_W: &Vector3<f64>, half_length_m: f64) -> Result<f64, Lacks> {
    let I_axis = at.q_WB * (body.I_B * at.q_WB.inverse_transform_vector(axis_W));
    let about = axis_W.dot(&I_axis);
    let inertia = about / (body.mass_kg * half_length_m * half_length_m);
    if inertia > 1.0 || (I_axis - axis_W * about).norm() > SAME * I_axis.norm() {
        return Err(format!("`{}` turning about a principal axis, I of at most m (L/2)²", body.name));
    }
    Ok(inertia)
}

/// Half the distance between the centres of a capsule's two spheres, in metres.
pub(super) fn capsule_m(body: &Body) -> Result<f64, Lacks> {
    match &body.geometry {
        Geometry::Solid { solid: Solid::Capsule { half_height_m, .. }, centre }
            if centre.norm() <= SAME * half_height_m =>
        {
            Ok(*half_height_m)
        }
        _ => Err(format!("`{}` a capsule, its centre of mass in its middle", body.name)),
    }
}

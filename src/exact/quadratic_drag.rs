//! A point mass with Newton's drag along one line: v̇ = g − k |v| v, where the start velocity is parallel to g, or one
//! of them is zero (Parker, Am. J. Phys. 45 (1977) 606). SI units, k in 1/m.
//!
//! Along g, with the terminal speed v_t = √(g/k), τ = √(g k) t and W = v₀/v_t:
//!
//! - falling, W ≥ 0, also faster than v_t: v/v_t = (W + tanh τ)/(1 + W tanh τ), k s = ln(cosh τ + W sinh τ)
//! - rising with U = −W until τ = arctan U: v/v_t = −(U − tan τ)/(1 + U tan τ), k s = −ln(cos τ + U sin τ); then
//!   falling from rest
//! - g = 0: v = v₀/(1 + k v₀ t), k s = ln(1 + k v₀ t)
//! - k = 0: the parabola

use super::facts::{Lacks, constant_acceleration, unpinned};
use super::form::{ClosedForm, ExactMotion};
use super::free_motion::turning;
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector3;

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Newton's drag, tanh and ln cosh, and torque-free rotation.",
    source: "Parker, Am. J. Phys. 45 (1977) 606",
    scenes: "Gravity, constant forces of the world at the centre of mass, air with a `drag_coefficient`; velocity \
           along the line of the forces, or no forces.",
    motion,
};

/// Difference of directions that are one.
const PARALLEL: f64 = 1e-14;

#[derive(Clone, Copy, Debug)]
pub struct QuadraticDrag {
    position_m: Vector3<f64>,
    /// Direction of the line: that of g, or of the start velocity where there is no g.
    direction: Vector3<f64>,
    speed_m_s: f64,
    gravity_m_s2: f64,
    drag_per_m: f64,
}

impl QuadraticDrag {
    /// The motion from its start. None if the start velocity is not along gravity, or the drag is negative.
    pub fn new(
        position_m: Vector3<f64>,
        velocity_m_s: Vector3<f64>,
        gravity_m_s2: Vector3<f64>,
        drag_per_m: f64,
    ) -> Option<Self> {
        let (v, g) = (velocity_m_s.norm(), gravity_m_s2.norm());
        let along = if g > 0.0 { gravity_m_s2 / g } else { velocity_m_s / if v > 0.0 { v } else { 1.0 } };
        let parallel = along.cross(&velocity_m_s).norm() <= PARALLEL * v;
        let speed_m_s = libm::copysign(v, along.dot(&velocity_m_s));
        (parallel && drag_per_m >= 0.0).then_some(QuadraticDrag {
            position_m,
            direction: along,
            speed_m_s,
            gravity_m_s2: g,
            drag_per_m,
        })
    }

    /// Terminal speed, in m/s; None without gravity or without drag.
    pub fn terminal_speed_m_s(&self) -> Option<f64> {
        (self.gravity_m_s2 > 0.0 && self.drag_per_m > 0.0).then(|| (self.gravity_m_s2 / self.drag_per_m).sqrt())
    }

    /// Position and velocity at t ≥ 0.
    pub fn at(&self, t_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let (s, v) = match self.terminal_speed_m_s() {
            Some(terminal) => self.with_terminal(terminal, t_s),
            None => self.without_terminal(t_s),
        };
        (self.position_m + self.direction * s, self.direction * v)
    }

    fn without_terminal(&self, t_s: f64) -> (f64, f64) {
        let (v_0, x) = (self.speed_m_s, self.drag_per_m * self.speed_m_s * t_s);
        let slowing = if x == 0.0 { 1.0 } else { libm::log1p(x) / x };
        let g = self.gravity_m_s2;
        (v_0 * t_s * slowing + g * t_s / 2.0 * t_s, v_0 / (1.0 + x) + g * t_s)
    }

    fn with_terminal(&self, terminal: f64, t_s: f64) -> (f64, f64) {
        let (tau, W) = ((self.gravity_m_s2 * self.drag_per_m).sqrt() * t_s, self.speed_m_s / terminal);
        let turn = libm::atan(-W);
        let (ks, v) = if W >= 0.0 {
            falling(W, tau)
        } else if tau <= turn {
            rising(-W, tau)
        } else {
            let (down, v) = falling(0.0, tau - turn);
            (down - libm::log1p(W * W) / 2.0, v)
        };
        (ks / self.drag_per_m, v * terminal)
    }
}

fn falling(W: f64, tau: f64) -> (f64, f64) {
    /// Above it, exp(−2τ) is below rounding.
    const LATE: f64 = 20.0;
    let tanh = libm::tanh(tau);
    let v = (W + tanh) / (1.0 + W * tanh);
    if tau > LATE {
        return (tau + libm::log1p((W - 1.0) / 2.0), v);
    }
    let half = libm::sinh(tau / 2.0);
    (libm::log1p(2.0 * half * half + W * libm::sinh(tau)), v)
}

fn rising(U: f64, tau: f64) -> (f64, f64) {
    let (sin, cos, tan) = (libm::sin(tau / 2.0), libm::cos(tau / 2.0), libm::tan(tau));
    (-libm::log1p(2.0 * sin * (U * cos - sin)), -(U - tan) / (1.0 + U * tan))
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let body = unpinned(model, index)?;
    if body.drag.linear_n_s_m != 0.0 {
        return Err("no linear drag of the `air`".into());
    }
    let drag_per_m = body.drag.quadratic_n_s2_m2 / body.mass_kg;
    let drag = QuadraticDrag::new(at.p_WB, at.v_WB, constant_acceleration(model, index)?, drag_per_m)
        .ok_or_else(|| format!("`{}` moving along the line of its weight, or without one", body.name))?;
    let rotation = turning(body, at);
    Ok(ExactMotion::of(move |t_s| drag.at(t_s), move |t_s| rotation.at(t_s)))
}

//! A point mass with Stokes' drag: m v̇ = m g + F − c v (Stokes, Trans. Cambridge Philos. Soc. 9 (1851) 8). SI units.
//! Without force and with c = m, in one dimension, it is φ′ = −φ.
//!
//! With y = c t/m and a₀ = g + F/m: v = v₀ exp(−y) + a₀ t φ₁(−y) and p − p₀ = v₀ t φ₁(−y) + a₀ t² φ₂(−y), where
//! φ₁(x) = (exp x − 1)/x and φ₂(x) = (φ₁(x) − 1)/x. Nothing cancels as c → 0, the parabola.

use super::facts::{Lacks, constant_acceleration, unpinned};
use super::form::{ClosedForm, ExactMotion};
use super::free_motion::turning;
use crate::model::Model;
use crate::state::State;
use nalgebra::Vector3;

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Stokes' drag, exp(−c t/m), and torque-free rotation.",
    source: "lecture L2; Stokes 1851",
    scenes: "Gravity, constant forces of the world at the centre of mass, air with `linear_drag_n_s_m`.",
    motion,
};

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearDrag {
    pub position_m: Vector3<f64>,
    pub velocity_m_s: Vector3<f64>,
    /// Acceleration g + F/m.
    pub acceleration_m_s2: Vector3<f64>,
    /// Rate c/m.
    pub rate_per_s: f64,
}

impl LinearDrag {
    /// Position and velocity at a time of either sign.
    pub fn at(&self, t_s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let y = self.rate_per_s * t_s;
        let (once, twice) = (t_s * phi_1(-y), t_s * t_s * phi_2(-y));
        (
            self.position_m + self.velocity_m_s * once + self.acceleration_m_s2 * twice,
            self.velocity_m_s * libm::exp(-y) + self.acceleration_m_s2 * once,
        )
    }
}

fn phi_1(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { libm::expm1(x) / x }
}

fn phi_2(x: f64) -> f64 {
    /// Above it the difference keeps all but two bits.
    const DIRECT: f64 = 1.0;
    if x.abs() > DIRECT {
        return (phi_1(x) - 1.0) / x;
    }
    // 1/2! + x/3! + …, from the last term that counts.
    (3..20).rev().fold(1.0, |sum, n| 1.0 + sum * x / f64::from(n)) / 2.0
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let body = unpinned(model, index)?;
    if body.drag.quadratic_n_s2_m2 != 0.0 {
        return Err("no quadratic drag of the `air`".into());
    }
    let drag = LinearDrag {
        position_m: at.p_WB,
        velocity_m_s: at.v_WB,
        acceleration_m_s2: constant_acceleration(model, index)?,
        rate_per_s: body.drag.linear_n_s_m / body.mass_kg,
    };
    let rotation = turning(body, at);
    Ok(ExactMotion::of(move |t_s| drag.at(t_s), move |t_s| rotation.at(t_s)))
}

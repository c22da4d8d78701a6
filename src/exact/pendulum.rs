//! The compound plane pendulum, θ̈ = −(m g l/I) sin θ, at any amplitude (Whittaker, Analytical Dynamics, § 44). SI
//! units; θ from the lowest position, continuous: it counts turns.
//!
//! With ω₀² = m g l/I, p = θ̇₀/(2ω₀) and k² = p² + sin²(θ₀/2):
//!
//! - librating, k < 1: sin(θ/2) = k sn x, cos(θ/2) = dn x, θ̇ = 2 ω₀ k cn x, x = x₀ + ω₀ t, k′² = cos²(θ₀/2) − p²
//! - rotating, k > 1: θ/2 = am x of the modulus 1/k, θ̇ = 2 ω₀ k dn x, x = x₀ + k ω₀ t, k′² = (p² − cos²(θ₀/2))/k²
//! - the separatrix, k = 1: either, with k′ = 0
//!
//! Rates and k′ are double-double, whole periods are counted. At rest within rounding of the highest position it stays.

use super::facts::{Lacks, SAME, about, only_pin};
use super::form::{ClosedForm, ExactMotion};
use crate::math::dd::{Dd, sin_cos};
use crate::math::elliptic::{Jacobi, carlson_rf, cel};
use crate::model::Model;
use crate::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "The compound plane pendulum at any amplitude, by elliptic functions.",
    source: "Whittaker, Analytical Dynamics, 44",
    scenes: "Gravity; every body on one pin to the world, turning about a horizontal principal axis of the pin.",
    motion,
};

/// cos(θ₀/2) of a rounded π.
const TOP: f64 = 2e-16;

#[derive(Clone, Debug)]
pub struct Pendulum {
    /// Angle of the lowest position nearest to the start.
    turns_rad: f64,
    /// Sign of the start velocity: motion the other way is its mirror image.
    sign: f64,
    motion: Motion,
}

#[derive(Clone, Debug)]
enum Motion {
    Rest { angle: f64 },
    Librating { k: f64, course: Course },
    Rotating { course: Course },
}

/// x = x₀ + rate t.
#[derive(Clone, Debug)]
struct Course {
    jacobi: Jacobi,
    x_start: Dd,
    rate: Dd,
    /// Half period 2K; None on the separatrix.
    half_period: Option<Dd>,
}

impl Pendulum {
    /// The motion from its start; m g l and I, about the pivot, are positive.
    pub fn new(weight_moment_N_m: f64, inertia_kg_m2: f64, angle_rad: f64, rate_rad_s: f64) -> Self {
        let two_pi = Dd::PI + Dd::PI;
        let (turns, _) = Dd::from(angle_rad).reduce(two_pi);
        let sign = libm::copysign(1.0, rate_rad_s);
        let angle = (Dd::from(angle_rad) - two_pi * Dd::from(turns)) * Dd::from(sign);
        let (sin, cos) = sin_cos(angle * Dd::from(0.5));
        let natural_squared = Dd::from(weight_moment_N_m) / Dd::from(inertia_kg_m2);
        let half_rate = Dd::from(rate_rad_s) * Dd::from(0.5);
        let p_squared = half_rate.squared() / natural_squared;
        let (k_squared, short) = (p_squared + sin.squared(), cos.squared() - p_squared);
        let (k, natural) = (k_squared.sqrt(), natural_squared.sqrt());
        let rest = p_squared == Dd::ZERO && cos.f64().abs() < TOP;
        let motion = if k == Dd::ZERO || rest {
            Motion::Rest { angle: angle.f64() }
        } else if short >= Dd::ZERO {
            let [sn, cn] = [sin / k, (p_squared / k_squared).sqrt()];
            let course = Course::new(short.sqrt(), [sn, cn, cos], natural);
            Motion::Librating { k: k.f64(), course }
        } else {
            let dn = (p_squared / k_squared).sqrt();
            let course = Course::new((-short).sqrt() / k, [sin, cos, dn], k * natural);
            Motion::Rotating { course }
        };
        Pendulum { turns_rad: (two_pi * Dd::from(turns)).f64(), sign, motion }
    }

    /// Angle and rate (θ, θ̇) at a time of either sign.
    pub fn at(&self, t_s: f64) -> (f64, f64) {
        let (angle, rate) = match &self.motion {
            Motion::Rest { angle } => (*angle, 0.0),
            Motion::Librating { k, course } => {
                let (count, [sn, cn, dn]) = course.at(t_s);
                let sign = if count % 2.0 == 0.0 { 2.0 } else { -2.0 };
                (sign * libm::atan2(k * sn, dn), sign * k * course.rate.f64() * cn)
            }
            Motion::Rotating { course } => {
                let (count, [sn, cn, dn]) = course.at(t_s);
                let whole = (Dd::PI + Dd::PI) * Dd::from(count) + Dd::from(2.0 * libm::atan2(sn, cn));
                (whole.f64(), 2.0 * course.rate.f64() * dn)
            }
        };
        (self.turns_rad + self.sign * angle, self.sign * rate)
    }

    /// Period, in seconds: to and fro, or once around; None at rest and on the separatrix.
    pub fn period_s(&self) -> Option<f64> {
        let (course, times) = match &self.motion {
            Motion::Rest { .. } => return None,
            Motion::Librating { course, .. } => (course, 2.0),
            Motion::Rotating { course } => (course, 1.0),
        };
        course.half_period.map(|half| times * (half / course.rate).f64())
    }
}

impl Course {
    /// Course from k′ and sn, cn ≥ 0, dn of the start.
    fn new(kc: Dd, [sn, cn, dn]: [Dd; 3], rate: Dd) -> Self {
        let x_start = sn.f64() * carlson_rf(cn.squared().f64(), dn.squared().f64(), 1.0);
        let half_period = (kc.f64() > 0.0).then(|| cel(kc, Dd::ONE, Dd::ONE, Dd::ONE) * Dd::from(2.0));
        Course { jacobi: Jacobi::new(kc.f64()), x_start: Dd::from(x_start), rate, half_period }
    }

    /// Half periods, and the functions of what is left.
    fn at(&self, t_s: f64) -> (f64, [f64; 3]) {
        let x = self.x_start + self.rate * Dd::from(t_s);
        let (count, x) = self.half_period.map_or((0.0, x.f64()), |half| x.reduce(half));
        (count, self.jacobi.at(x))
    }
}

/// A body that turns about a horizontal axis through its pin.
struct Swing {
    pendulum: Pendulum,
    start: BodyState,
    angle: f64,
    axis_W: Vector3<f64>,
    pin_W: Vector3<f64>,
}

impl Swing {
    fn at(&self, t_s: f64) -> BodyState {
        let (angle, rate) = self.pendulum.at(t_s);
        let turn = UnitQuaternion::from_scaled_axis(self.axis_W * (angle - self.angle));
        let (r_W, w_WB) = (turn * (self.start.p_WB - self.pin_W), self.axis_W * rate);
        BodyState { p_WB: self.pin_W + r_W, q_WB: turn * self.start.q_WB, v_WB: w_WB.cross(&r_W), w_WB }
    }
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let (pin_W, r_B) = only_pin(model, index)?;
    let body = &model.bodies[index];
    let lacks = || format!("`{}` swinging about a horizontal principal axis of its pin, under gravity", body.name);
    let down = model.gravity_m_s2.try_normalize(0.0).ok_or_else(lacks)?;
    let r_W = -(at.q_WB * r_B);
    let (length, sine) = (r_W.norm(), down.cross(&r_W));
    // About which it swings: its spin, or at rest what gravity turns it about.
    let axis_W = at.w_WB.try_normalize(0.0).or_else(|| sine.try_normalize(SAME * length)).ok_or_else(lacks)?;
    let I_axis = at.q_WB * (about(body, &r_B) * at.q_WB.inverse_transform_vector(&axis_W));
    let inertia = axis_W.dot(&I_axis);
    let tilted = axis_W.dot(&down).abs().max(axis_W.dot(&r_W).abs() / length);
    if length == 0.0 || tilted > SAME || (I_axis - axis_W * inertia).norm() > SAME * inertia {
        return Err(lacks());
    }
    let angle = libm::atan2(sine.dot(&axis_W), down.dot(&r_W));
    let moment = body.mass_kg * model.gravity_m_s2.norm() * length;
    let pendulum = Pendulum::new(moment, inertia, angle, at.w_WB.dot(&axis_W));
    let swing = Swing { pendulum, start: *at, angle, axis_W, pin_W };
    Ok(ExactMotion::new(move |t_s| swing.at(t_s)))
}

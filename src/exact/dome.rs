//! A ball on top of a fixed one, let go at θ₀ from the top: it slides without friction, k = 0, or rolls, k = I/(m r²)
//! (Routh, Elementary Rigid Dynamics, § 137). Its centre is an inverted pendulum of θ̈ = g sin θ/(d (1 + k)), d the sum
//! of the radii, and would leave where cos θ = 2 cos θ₀/(3 + k): ⅔, and 10/17 for a homogeneous ball from the top. Then
//! it flies.
//!
//! Rolling takes k sin θ/((3 + k) cos θ − 2 cos θ₀) of friction, more than any before it leaves: it rolls until then.
//! SI units.

use super::facts::{Lacks, SAME, only_other};
use super::form::{ClosedForm, ExactMotion};
use super::inverted_pendulum::InvertedPendulum;
use super::touching::{rounding_m, sphere, unhindered};
use crate::model::Model;
use crate::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "It slides until it leaves at 2/3 of the height, then flies; or rolls until it slips; elliptic functions.",
    source: "Routh, Elementary Rigid Dynamics, 137",
    scenes: "One sphere at rest on a fixed one, off its top; restitution 0; no friction, or friction that holds until \
           the end.",
    motion,
};

#[derive(Clone, Debug)]
pub struct Dome {
    pub swing: InvertedPendulum,
    /// Time at which it leaves the dome, in seconds; infinite if it rolls.
    pub leaves_s: f64,
    /// Time up to which it rolls, in seconds; infinite if it slides.
    pub rolls_s: f64,
}

impl Dome {
    /// The motion from rest at 0 < θ₀ < π/2. None if it slips, and has friction.
    pub fn new(angle_rad: f64, distance_m: f64, inertia: f64, friction: f64, gravity_m_s2: f64) -> Option<Self> {
        let start = libm::cos(angle_rad);
        let k = if friction == 0.0 { 0.0 } else { inertia };
        let swing = InvertedPendulum::new((gravity_m_s2 / (distance_m * (1.0 + k))).sqrt(), angle_rad, 0.0);
        if friction == 0.0 {
            let (leaves_s, _) = swing.comes_to(libm::acos(2.0 / 3.0 * start))?;
            return Some(Dome { swing, leaves_s, rolls_s: f64::INFINITY });
        }
        let grip = friction * (3.0 + k);
        let slipping = libm::atan2(grip, k) - libm::asin(2.0 * friction * start / libm::hypot(k, grip));
        let (rolls_s, _) = if slipping > angle_rad { swing.comes_to(slipping)? } else { return None };
        Some(Dome { swing, leaves_s: f64::INFINITY, rolls_s })
    }
}

/// A ball on a dome where they are in the world.
struct OnDome {
    dome: Dome,
    start: BodyState,
    /// Angle of the line of centres at the start, from the vertical.
    angle_rad: f64,
    distance_m: f64,
    /// Centre of the fixed ball.
    centre_W: Vector3<f64>,
    up: Vector3<f64>,
    out: Vector3<f64>,
    axis_W: Vector3<f64>,
    gravity_m_s2: Vector3<f64>,
    /// Turns of the ball per turn about the dome's centre: the distance over its radius if it rolls.
    turns: f64,
}

impl OnDome {
    fn at(&self, t_s: f64) -> BodyState {
        let touching_s = t_s.min(self.dome.leaves_s);
        let (angle, rate) = self.dome.swing.at(touching_s);
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        let p_WB = self.centre_W + (self.up * cos + self.out * sin) * self.distance_m;
        let v_WB = (self.out * cos - self.up * sin) * (self.distance_m * rate);
        let turn = UnitQuaternion::from_scaled_axis(self.axis_W * (self.turns * (angle - self.angle_rad)));
        let flown_s = t_s - touching_s;
        BodyState {
            p_WB: p_WB + (v_WB + self.gravity_m_s2 * (flown_s / 2.0)) * flown_s,
            q_WB: turn * self.start.q_WB,
            v_WB: v_WB + self.gravity_m_s2 * flown_s,
            w_WB: self.axis_W * (self.turns * rate),
        }
    }
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let (body, at) = (&model.bodies[index], &start.bodies[index]);
    let (radius_m, inertia) = sphere(body)?;
    let gravity_m_s2 = unhindered(model, index)?;
    let under = only_other(model, index, "a ball on another one")?;
    let (fixed, fixed_at) = (&model.bodies[under], &start.bodies[under]);
    let (fixed_radius_m, _) = sphere(fixed)?;
    let moves = |at: &BodyState| at.v_WB != Vector3::zeros() || at.w_WB != Vector3::zeros();
    if !fixed.driven || moves(fixed_at) {
        return Err(format!("`{}` fixed", fixed.name));
    }
    let surface = model.pair(index, Some(under));
    if surface.restitution != 0.0 {
        return Err("no restitution".into());
    }
    let distance_m = radius_m + fixed_radius_m;
    let up = (-gravity_m_s2).try_normalize(0.0).ok_or("gravity")?;
    let from_centre = at.p_WB - fixed_at.p_WB;
    let sideways = from_centre - up * up.dot(&from_centre);
    let lacks = || format!("`{}` at rest on `{}`, on its upper half and off its top", body.name, fixed.name);
    let out = sideways.try_normalize(SAME * distance_m).ok_or_else(lacks)?;
    let (side, height) = (sideways.norm(), up.dot(&from_centre));
    let apart_m = (from_centre.norm() - distance_m).abs();
    if moves(at) || height <= 0.0 || apart_m > rounding_m(distance_m, at) {
        return Err(lacks());
    }
    let angle_rad = libm::atan2(side, height);
    let dome = Dome::new(angle_rad, distance_m, inertia, surface.friction, gravity_m_s2.norm())
        .ok_or("more friction than rolling takes, or none")?;
    let turns = if surface.friction > 0.0 { distance_m / radius_m } else { 0.0 };
    let axis_W = up.cross(&out);
    let centre_W = fixed_at.p_WB;
    let until_s = dome.rolls_s;
    let dome = OnDome { dome, start: *at, angle_rad, distance_m, centre_W, up, out, axis_W, gravity_m_s2, turns };
    Ok(ExactMotion::new(move |t_s| dome.at(t_s)).until(until_s))
}

//! A rimless wheel: a regular prism that rolls over its edges on a plane, without slip or restitution (T. McGeer, Int.
//! J. Robotics Research 9 (1990) 62).
//!
//! About an edge it is an inverted pendulum, θ̈ = p² sin θ, p² = (g/l)/(1 + κ), κ = I/(m l²), l from the edge to the
//! centre. The leg is at ψ = θ − γ from the plane's normal, γ the slope; at ψ = ±α, half the angle between two legs,
//! the next edge strikes and the part (κ + cos 2α)/(κ + 1) of the rate is left. It rolls on, or back and forth until it
//! stands. SI units.

use super::facts::{Lacks, SAME};
use super::form::{ClosedForm, ExactMotion};
use super::inverted_pendulum::InvertedPendulum;
use super::touching::{feet, on_its_own};
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::PI;

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "It rolls over its edges, on and on or back and forth until it stands; elliptic functions from impact to \
           impact.",
    source: "McGeer, Int. J. Robotics Research 9 (1990) 62",
    scenes: "One regular prism (a box or a convex) on a container of one plane, restitution 0, friction that holds; \
           tilted about a lower edge, or turning about one, along the line of slope.",
    motion,
};

/// Impacts slower than this part of the first leave the wheel standing: their times differ by less than rounding.
const WEAKEST: f64 = 1e-18;

#[derive(Clone, Copy, Debug)]
pub struct RimlessWheel {
    /// Half angle α between two legs.
    pub half_angle_rad: f64,
    /// Slope γ: downward in the direction of positive ψ.
    pub slope_rad: f64,
    /// Gravity over the leg's length, g/l, in 1/s².
    pub gravity_rad_s2: f64,
    /// Ratio κ = I/(m l²).
    pub inertia: f64,
    /// Angle ψ and its rate at the start.
    pub start: [f64; 2],
}

/// Motion from one impact to the next.
#[derive(Clone, Debug)]
struct Leg {
    begin_s: f64,
    /// Number of edges forward since the start.
    steps: i64,
    swing: InvertedPendulum,
}

/// Impact of the next edge: when, at which end of the leg's swing, at which rate.
#[derive(Clone, Copy, Debug)]
struct Impact {
    t_s: f64,
    side: f64,
    rate: f64,
}

/// Number of edges forward since the start, ψ, and its rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    pub steps: i64,
    pub angle_rad: f64,
    pub rate_rad_s: f64,
}

impl RimlessWheel {
    fn natural_rad_s(&self) -> f64 {
        (self.gravity_rad_s2 / (1.0 + self.inertia)).sqrt()
    }

    /// Part of the rate that an impact leaves.
    pub fn left(&self) -> f64 {
        (self.inertia + libm::cos(2.0 * self.half_angle_rad)) / (self.inertia + 1.0)
    }

    fn leg(&self, begin_s: f64, steps: i64, angle: f64, rate: f64) -> Leg {
        let swing = InvertedPendulum::new(self.natural_rad_s(), angle + self.slope_rad, rate);
        Leg { begin_s, steps, swing }
    }

    fn first(&self) -> Leg {
        self.leg(0.0, 0, self.start[0], self.start[1])
    }

    fn end(&self, leg: &Leg) -> Option<Impact> {
        let ends = [1.0, -1.0].into_iter().filter_map(|side| {
            let (after_s, rate) = leg.swing.comes_to(side * self.half_angle_rad + self.slope_rad)?;
            Some(Impact { t_s: leg.begin_s + after_s, side, rate })
        });
        ends.min_by(|a, b| a.t_s.total_cmp(&b.t_s))
    }

    fn next(&self, leg: &Leg, impact: &Impact) -> Leg {
        let steps = leg.steps + impact.side as i64;
        self.leg(impact.t_s, steps, -impact.side * self.half_angle_rad, impact.rate * self.left())
    }

    pub fn at(&self, t_s: f64) -> Stance {
        let (mut leg, mut weakest) = (self.first(), 0.0_f64);
        while let Some(impact) = self.end(&leg) {
            if impact.t_s > t_s {
                break;
            }
            if impact.rate.abs() <= weakest {
                return Stance { steps: leg.steps, angle_rad: impact.side * self.half_angle_rad, rate_rad_s: 0.0 };
            }
            weakest = weakest.max(WEAKEST * impact.rate.abs());
            leg = self.next(&leg, &impact);
        }
        let (angle, rate_rad_s) = leg.swing.at(t_s - leg.begin_s);
        Stance { steps: leg.steps, angle_rad: angle - self.slope_rad, rate_rad_s }
    }

    /// Least coefficient of friction that never slips; infinite if the wheel leaves the plane. In an impact it is cot α
    /// (1 − ε)/(1 + ε) for the part ε that is left of the rate.
    pub fn friction(&self) -> f64 {
        const SAMPLES: u32 = 100;
        const MOST: u32 = 10_000;
        /// Difference of the rates of legs that are the same, relative.
        const SAME: f64 = 1e-9;
        let (left, mut leg, mut before, mut fastest) = (self.left(), self.first(), [0.0; 2], 0.0_f64);
        let mut most = (1.0 - left) / (1.0 + left) / libm::tan(self.half_angle_rad);
        for _ in 0..MOST {
            let Some(impact) = self.end(&leg) else { return f64::INFINITY };
            let length_s = impact.t_s - leg.begin_s;
            most = (0..=SAMPLES)
                .map(|i| self.needed(leg.swing.at(length_s * f64::from(i) / f64::from(SAMPLES))))
                .fold(most, f64::max);
            // Two impacts ago: rolling repeats every step, rocking every other.
            fastest = fastest.max(impact.rate.abs());
            let repeats = (impact.rate - before[0]).abs() <= SAME * impact.rate.abs();
            if repeats || impact.rate.abs() <= SAME * fastest {
                break;
            }
            before = [before[1], impact.rate];
            leg = self.next(&leg, &impact);
        }
        most
    }

    /// Quotient of the contact's force along the plane and across it.
    fn needed(&self, (angle, rate): (f64, f64)) -> f64 {
        let psi = angle - self.slope_rad;
        let gain = libm::sin(angle) / (1.0 + self.inertia);
        let squared = rate * rate / self.gravity_rad_s2;
        let (sin, cos) = (libm::sin(psi), libm::cos(psi));
        let press = libm::cos(self.slope_rad) - gain * sin - squared * cos;
        let along = gain * cos - squared * sin - libm::sin(self.slope_rad);
        if press > 0.0 { along.abs() / press } else { f64::INFINITY }
    }
}

/// A wheel where it is in the world.
struct Wheel {
    wheel: RimlessWheel,
    start: BodyState,
    /// Normal of the plane, and the direction of rolling along it; about the axis the one turns to the other.
    normal: Vector3<f64>,
    forward: Vector3<f64>,
    axis_W: Vector3<f64>,
    /// The first edge.
    edge_W: Vector3<f64>,
    spoke_m: f64,
}

impl Wheel {
    fn at(&self, t_s: f64) -> BodyState {
        let stance = self.wheel.at(t_s);
        let (steps, angle, half) = (stance.steps as f64, stance.angle_rad, self.wheel.half_angle_rad);
        let edge_W = self.edge_W + self.forward * (2.0 * self.spoke_m * libm::sin(half) * steps);
        let r_W = (self.normal * libm::cos(angle) + self.forward * libm::sin(angle)) * self.spoke_m;
        let turned = 2.0 * half * steps + (angle - self.wheel.start[0]);
        let w_WB = self.axis_W * stance.rate_rad_s;
        BodyState {
            p_WB: edge_W + r_W,
            q_WB: UnitQuaternion::from_scaled_axis(self.axis_W * turned) * self.start.q_WB,
            v_WB: w_WB.cross(&r_W),
            w_WB,
        }
    }
}

/// Angle to the next edge below which a wheel stands on it, relative.
const STANDS: f64 = 1e-9;

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let (face, acceleration) = on_its_own(model, index)?;
    let (body, normal) = (&model.bodies[index], face.normal);
    let surface = model.pair(index, None);
    if surface.restitution != 0.0 {
        return Err("no restitution".into());
    }
    let speed = at.v_WB.norm() + at.w_WB.norm() * body.bounding_radius_m;
    let still = |r_W: &Vector3<f64>| (at.v_WB + at.w_WB.cross(r_W)).norm() <= SAME * speed;
    let on_edge = || format!("`{}` tilted about one of its lower edges, or turning about one", body.name);
    let feet: Vec<Vector3<f64>> = feet(body, at, &face).into_iter().filter(still).collect();
    let [first, second] = feet[..] else { return Err(on_edge()) };
    let (r_W, axis_W) = (-(first + second) / 2.0, (second - first).normalize());
    let (spoke_m, forward) = (r_W.norm(), axis_W.cross(&normal));
    let spokes = spokes(body, at, &axis_W, &-r_W)
        .ok_or_else(|| format!("`{}` a regular prism, or a box, its centre of mass in its middle", body.name))?;
    let I_axis = at.q_WB * (body.I_B * at.q_WB.inverse_transform_vector(&axis_W));
    let about = axis_W.dot(&I_axis);
    let press = -normal.dot(&acceleration);
    let across = axis_W.dot(&acceleration).abs() > SAME * acceleration.norm();
    if press <= 0.0 || across || (I_axis - axis_W * about).norm() > SAME * I_axis.norm() {
        return Err(format!("`{}` turning about a principal axis, along the line of slope", body.name));
    }
    let (half_angle_rad, slope_rad) = (PI / spokes as f64, libm::atan2(forward.dot(&acceleration), press));
    let mut angle = libm::atan2(r_W.dot(&forward), r_W.dot(&normal));
    if angle.abs() > half_angle_rad - STANDS {
        angle = libm::copysign(half_angle_rad, angle);
    }
    let rate = axis_W.dot(&at.w_WB);
    let falls = if rate == 0.0 { angle + slope_rad } else { rate };
    if falls == 0.0 || (angle.abs() == half_angle_rad && angle * falls > 0.0) {
        return Err(on_edge());
    }
    let wheel = RimlessWheel {
        half_angle_rad,
        slope_rad,
        gravity_rad_s2: acceleration.norm() / spoke_m,
        inertia: about / (body.mass_kg * spoke_m * spoke_m),
        start: [angle, rate],
    };
    if wheel.left() <= 0.0 {
        return Err(format!("`{}` of edges that leave some of its rate", body.name));
    }
    if wheel.friction() > surface.friction {
        return Err("more friction than rolling takes, and slowly enough to stay on the plane".into());
    }
    let wheel = Wheel { wheel, start: *at, normal, forward, axis_W, edge_W: at.p_WB - r_W, spoke_m };
    Ok(ExactMotion::new(move |t_s| wheel.at(t_s)))
}

/// Number of edges of a regular prism about the axis, one of them at `foot` from the centre of mass.
fn spokes(body: &Body, at: &BodyState, axis_W: &Vector3<f64>, foot: &Vector3<f64>) -> Option<usize> {
    let corners: Vec<Vector3<f64>> = match &body.geometry {
        Geometry::Solid { solid: Solid::Box { half_m }, centre } => {
            let sign = |i: usize, bit: usize| if i >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let corner = |i| centre + half_m.component_mul(&Vector3::new(sign(i, 0), sign(i, 1), sign(i, 2)));
            (0..8).map(corner).collect()
        }
        Geometry::Solid { solid: Solid::Convex(hull), centre } => hull.vertices.iter().map(|v| centre + v).collect(),
        _ => return None,
    };
    let (count, length) = (corners.len() / 2, foot.norm());
    let between = 2.0 * PI / count as f64;
    let side = axis_W.cross(foot);
    let is_spoke = |corner: &Vector3<f64>| {
        let corner = at.q_WB * corner;
        let radial = corner - axis_W * axis_W.dot(&corner);
        let spokes = libm::atan2(radial.dot(&side), radial.dot(foot)) / between;
        (radial.norm() - length).abs() <= SAME * length && (spokes - libm::round(spokes)).abs() <= SAME * count as f64
    };
    let centred = axis_W.dot(foot).abs() <= SAME * length && corners.len() == 2 * count && count >= 3;
    (centred && corners.iter().all(is_spoke)).then_some(count)
}

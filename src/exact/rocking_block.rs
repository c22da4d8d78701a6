//! A block that rocks on its two lower edges, without slip or restitution (Housner, Bull. Seism. Soc. Am. 53 (1963)
//! 403).
//!
//! ψ is the angle from the vertical through the edge to the centre of mass, α flat, p² = m g R/I of the edge. Between
//! impacts it is an inverted pendulum, ψ̇² = 4p² (sin²(ψ/2) − x₁²). An impact leaves the part
//! (I_c + m R² cos 2α)/(I_c + m R²) of the speed, 1 − ³/₂ sin² α for a homogeneous block. SI units.

use super::facts::{Lacks, SAME};
use super::form::{ClosedForm, ExactMotion};
use super::inverted_pendulum::{Turning, from_highest_s};
use super::touching::{feet, level};
use crate::model::{Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::{BodyState, State};
use nalgebra::{UnitQuaternion, Vector3};

pub(super) const FORM: ClosedForm = ClosedForm {
    what: "Elliptic functions from impact to impact, until it stands.",
    source: "Housner, Bull. Seism. Soc. Am. 53 (1963) 403",
    scenes: "One box on a container of one level plane, restitution 0, friction that holds; tilted about a lower edge, \
           or turning about it, not enough to overturn.",
    motion,
};

/// Impacts slower than this part of the first leave the block at rest: their times differ by less than rounding.
const WEAKEST: f64 = 1e-18;

#[derive(Clone, Debug)]
pub struct RockingBlock {
    alpha_rad: f64,
    /// Turning point x₁ of the first arc.
    highest: f64,
    /// Arcs: until the first impact, then from one to the next.
    arcs: Vec<Rock>,
    end_s: f64,
}

#[derive(Clone, Debug)]
struct Rock {
    begin_s: f64,
    highest_s: f64,
    turning: Turning,
}

impl RockingBlock {
    /// The motion from a tilt θ ≥ 0 and its rate; α, p and the part of the speed that an impact leaves. None if it
    /// overturns, or never leaves the ground.
    pub fn new(alpha_rad: f64, natural_rad_s: f64, left: f64, tilt_rad: f64, rate_rad_s: f64) -> Option<Self> {
        let flat = libm::sin(alpha_rad / 2.0);
        let kinetic = (rate_rad_s / (2.0 * natural_rad_s)).powi(2);
        // sin²(α/2) − sin²(ψ/2), without the difference.
        let fallen = libm::sin(alpha_rad - tilt_rad / 2.0) * libm::sin(tilt_rad / 2.0);
        let mut excess = fallen + kinetic;
        if excess >= flat * flat || tilt_rad >= alpha_rad || excess <= 0.0 {
            return None;
        }
        let weakest = excess * WEAKEST * WEAKEST;
        let time_s = |excess: f64, squared: f64| from_highest_s(natural_rad_s, excess, squared);
        let since = libm::copysign(time_s(kinetic, flat * flat - fallen), -rate_rad_s);
        let mut block =
            RockingBlock { alpha_rad, highest: (flat * flat - excess).sqrt(), arcs: Vec::new(), end_s: 0.0 };
        let (mut begin_s, mut highest_s) = (0.0, -since);
        while excess > weakest {
            let highest = (flat * flat - excess).sqrt();
            block.arcs.push(Rock { begin_s, highest_s, turning: Turning::new(natural_rad_s, highest) });
            begin_s = highest_s + time_s(excess, flat * flat);
            excess *= left * left;
            highest_s = begin_s + time_s(excess, flat * flat);
        }
        block.end_s = begin_s;
        Some(block)
    }

    /// Number of impacts so far, tilt about the edge of that number (0: the first; even and odd take turns) and its
    /// rate.
    pub fn at(&self, t_s: f64) -> (usize, f64, f64) {
        let begun = self.arcs.partition_point(|arc| arc.begin_s <= t_s).max(1);
        if t_s >= self.end_s {
            return (begun, 0.0, 0.0);
        }
        let arc = &self.arcs[begun - 1];
        let (psi, rate) = arc.turning.at(t_s - arc.highest_s);
        (begun - 1, self.alpha_rad - psi, -rate)
    }

    /// Least coefficient of friction that never slips, for `inertia` I/(m R²) about the edge. In an impact it is
    /// cot α (1 − ε)/(1 + ε) for the part ε that is left of the speed; in between |ẍ|/(g + z̈), which is monotone in
    /// ψ̇², 0 in some later arc.
    pub fn friction(&self, inertia: f64, left: f64) -> f64 {
        const SAMPLES: u32 = 1000;
        let highest = self.highest;
        let first = 2.0 * libm::asin(highest);
        let in_impacts = (1.0 - left) / (1.0 + left) / libm::tan(self.alpha_rad);
        (0..=SAMPLES).fold(in_impacts, |most, i| {
            let psi = first + (self.alpha_rad - first) * f64::from(i) / f64::from(SAMPLES);
            let (sin, cos, half) = (libm::sin(psi), libm::cos(psi), libm::sin(psi / 2.0));
            [0.0, 4.0 * (half * half - highest * highest)].into_iter().fold(most, |most, squared| {
                let press = inertia - sin * sin - squared * cos;
                let needed = (sin * cos - squared * sin).abs() / press;
                if press > 0.0 { most.max(needed) } else { f64::INFINITY }
            })
        })
    }

    /// Times of the impacts, in seconds.
    pub fn impacts_s(&self) -> impl Iterator<Item = f64> {
        let later = self.arcs.iter().skip(1).map(|arc| arc.begin_s);
        later.chain(std::iter::once(self.end_s))
    }
}

/// A block on its two lower edges.
struct Block {
    rocking: RockingBlock,
    flat: BodyState,
    edges_W: [Vector3<f64>; 2],
    /// Axis about which a tilt on the first edge is positive.
    axis_W: Vector3<f64>,
}

impl Block {
    fn at(&self, t_s: f64) -> BodyState {
        let (impacts, tilt, rate) = self.rocking.at(t_s);
        let sign = if impacts % 2 == 0 { 1.0 } else { -1.0 };
        let (edge, w_WB) = (self.edges_W[impacts % 2], self.axis_W * (sign * rate));
        let turn = UnitQuaternion::from_scaled_axis(self.axis_W * (sign * tilt));
        let r_W = turn * (self.flat.p_WB - edge);
        BodyState { p_WB: edge + r_W, q_WB: turn * self.flat.q_WB, v_WB: w_WB.cross(&r_W), w_WB }
    }
}

fn motion(model: &Model, start: &State, index: usize) -> Result<ExactMotion, Lacks> {
    let at = &start.bodies[index];
    let (face, gravity_m_s2) = level(model, index)?;
    let (body, normal) = (&model.bodies[index], face.normal);
    let surface = model.pair(index, None);
    let Geometry::Solid { solid: Solid::Box { half_m }, .. } = &body.geometry else {
        return Err(format!("`{}` a box without a mesh", body.name));
    };
    if surface.restitution != 0.0 {
        return Err("no restitution".into());
    }
    let on_edge = || format!("`{}` tilted about one of its lower edges, at rest or turning about it", body.name);
    let speed = at.v_WB.norm() + at.w_WB.norm() * body.bounding_radius_m;
    let still = |r_W: &Vector3<f64>| (at.v_WB + at.w_WB.cross(r_W)).norm() <= SAME * speed;
    let feet: Vec<Vector3<f64>> = feet(body, at, &face).into_iter().filter(still).collect();
    let [first, second] = feet[..] else { return Err(on_edge()) };
    let r_W = -(first + second) / 2.0;
    let along_edge = (second - first).normalize();
    let side = along_edge.cross(&normal);
    let side = side * libm::copysign(1.0, side.dot(&r_W));
    let axis_W = side.cross(&normal);
    let box_axes = [0, 1, 2].map(|i| at.q_WB * Vector3::ith(i, 1.0));
    // The face that it falls on reaches under the centre of mass, the other one away from it.
    let across = (0..3).filter(|i| box_axes[*i].dot(&along_edge).abs() < 0.5);
    let inward = across.map(|i| (i, box_axes[i] * libm::copysign(1.0, box_axes[i].dot(&r_W))));
    let (bottom, d) = inward.max_by(|a, b| side.dot(&a.1).total_cmp(&side.dot(&b.1))).ok_or_else(on_edge)?;
    let (half_base, size) = (r_W.dot(&d), r_W.norm());
    let I_axis = at.q_WB * (body.I_B * at.q_WB.inverse_transform_vector(&axis_W));
    let inertia = axis_W.dot(&I_axis);
    let is_centred = r_W.dot(&along_edge).abs().max((half_base - half_m[bottom]).abs()) <= SAME * size;
    if !is_centred || (I_axis - axis_W * inertia).norm() > SAME * inertia {
        return Err(format!("`{}` symmetric about the plane that it rocks in", body.name));
    }
    let tilt_rad = libm::atan2(normal.dot(&d), side.dot(&d)).max(0.0);
    let up = axis_W.cross(&d);
    let alpha_rad = libm::atan2(half_base, r_W.dot(&up));
    let about_edge = inertia + body.mass_kg * size * size;
    let left = (inertia + body.mass_kg * size * size * libm::cos(2.0 * alpha_rad)) / about_edge;
    if left <= 0.0 {
        return Err(format!("`{}` slender enough to rock", body.name));
    }
    let natural_rad_s = (body.mass_kg * gravity_m_s2 * size / about_edge).sqrt();
    let rocking = RockingBlock::new(alpha_rad, natural_rad_s, left, tilt_rad, at.w_WB.dot(&axis_W))
        .ok_or_else(|| format!("`{}` rocking without overturning", body.name))?;
    if rocking.friction(about_edge / (body.mass_kg * size * size), left) > surface.friction {
        return Err("more friction than rocking without slip takes".into());
    }
    let edge = at.p_WB - r_W;
    let back = UnitQuaternion::from_scaled_axis(axis_W * -tilt_rad);
    let still = Vector3::zeros();
    let flat = BodyState { p_WB: edge + back * r_W, q_WB: back * at.q_WB, v_WB: still, w_WB: still };
    let block = Block { rocking, flat, edges_W: [edge, edge + side * (2.0 * half_base)], axis_W };
    Ok(ExactMotion::new(move |t_s| block.at(t_s)))
}

//! From a scene to a regular prism that rolls over its edges.

use super::facts::{Lacks, SAME};
use super::rimless_wheel::RimlessWheel;
use super::touching::{feet, on_its_own};
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::BodyState;
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::PI;

#[derive(Clone, Debug)]
pub struct Wheel {
    wheel: RimlessWheel,
    start: BodyState,
    /// Of the plane, and the direction of rolling along it; about the axis the one turns to the other.
    normal: Vector3<f64>,
    forward: Vector3<f64>,
    axis_W: Vector3<f64>,
    /// The first edge.
    edge_W: Vector3<f64>,
    spoke_m: f64,
}

impl Wheel {
    pub fn at(&self, t_s: f64) -> BodyState {
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

/// Of an angle: a wheel that is nearer to the next edge stands on it.
const STANDS: f64 = 1e-9;

pub fn wheel(model: &Model, index: usize, at: &BodyState) -> Result<Wheel, Lacks> {
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
    Ok(Wheel { wheel, start: *at, normal, forward, axis_W, edge_W: at.p_WB - r_W, spoke_m })
}

/// How many edges a regular prism about the axis has, one of them at `foot` from the centre of mass.
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

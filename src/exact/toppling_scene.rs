//! From a scene to a block that rocks on a plane, a rod that falls over on one, or one that slides down a wall.

use super::facts::{Lacks, SAME};
use super::falling_rod::FallingRod;
use super::ladder::Ladder;
use super::rocking_block::RockingBlock;
use super::touching::{along, feet, on_its_own, only_faces, unhindered};
use crate::model::container::Face;
use crate::model::{Body, Geometry, Model};
use crate::shape::solid::Solid;
use crate::state::BodyState;
use nalgebra::{UnitQuaternion, Vector3};

/// A block on its two lower edges.
#[derive(Clone, Debug)]
pub struct Block {
    rocking: RockingBlock,
    flat: BodyState,
    edges_W: [Vector3<f64>; 2],
    /// About which a tilt on the first edge is positive.
    axis_W: Vector3<f64>,
}

/// A rod that turns about a horizontal axis.
#[derive(Clone, Debug)]
pub struct Rod {
    falling: FallingRod,
    start: BodyState,
    angle_rad: f64,
    half_length_m: f64,
    axis_W: Vector3<f64>,
    up: Vector3<f64>,
}

/// A rod between a wall and a floor.
#[derive(Clone, Debug)]
pub struct LadderAt {
    ladder: Ladder,
    start: BodyState,
    angle_rad: f64,
    half_length_m: f64,
    axis_W: Vector3<f64>,
    up: Vector3<f64>,
    /// From the wall.
    out: Vector3<f64>,
}

impl LadderAt {
    pub fn at(&self, t_s: f64) -> BodyState {
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

/// cos θ₀ − cos θ, without the difference.
fn fallen(from_rad: f64, to_rad: f64) -> f64 {
    2.0 * libm::sin((to_rad + from_rad) / 2.0) * libm::sin((to_rad - from_rad) / 2.0)
}

impl Block {
    pub fn at(&self, t_s: f64) -> BodyState {
        let (impacts, tilt, rate) = self.rocking.at(t_s);
        let sign = if impacts % 2 == 0 { 1.0 } else { -1.0 };
        let (edge, w_WB) = (self.edges_W[impacts % 2], self.axis_W * (sign * rate));
        let turn = UnitQuaternion::from_scaled_axis(self.axis_W * (sign * tilt));
        let r_W = turn * (self.flat.p_WB - edge);
        BodyState { p_WB: edge + r_W, q_WB: turn * self.flat.q_WB, v_WB: w_WB.cross(&r_W), w_WB }
    }
}

impl Rod {
    pub fn at(&self, t_s: f64) -> BodyState {
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

/// A level plane's normal, and g.
fn level(model: &Model, index: usize) -> Result<(Face, f64), Lacks> {
    let (face, acceleration) = on_its_own(model, index)?;
    Ok((face, press_on(&face, &acceleration).ok_or("a level plane")?))
}

/// g, if the plane is level.
fn press_on(face: &Face, acceleration: &Vector3<f64>) -> Option<f64> {
    let press = -face.normal.dot(acceleration);
    (press > 0.0 && along(acceleration, &face.normal, press).norm() <= SAME * press).then_some(press)
}

pub fn block(model: &Model, index: usize, at: &BodyState) -> Result<Block, Lacks> {
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
    Ok(Block { rocking, flat, edges_W: [edge, edge + side * (2.0 * half_base)], axis_W })
}

pub fn rod(model: &Model, index: usize, at: &BodyState) -> Result<Rod, Lacks> {
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
    Ok(Rod { falling, start: *at, angle_rad, half_length_m, axis_W, up })
}

/// On a smooth floor along a smooth wall.
pub fn ladder(model: &Model, index: usize, at: &BodyState) -> Result<LadderAt, Lacks> {
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
    Ok(LadderAt { ladder, start: *at, angle_rad, half_length_m, axis_W, up, out })
}

/// I/(m l²), l half the length, about an axis that it can turn about and lie flat.
fn of_rod(body: &Body, at: &BodyState, axis_W: &Vector3<f64>, half_length_m: f64) -> Result<f64, Lacks> {
    let I_axis = at.q_WB * (body.I_B * at.q_WB.inverse_transform_vector(axis_W));
    let about = axis_W.dot(&I_axis);
    let inertia = about / (body.mass_kg * half_length_m * half_length_m);
    if inertia > 1.0 || (I_axis - axis_W * about).norm() > SAME * I_axis.norm() {
        return Err(format!("`{}` turning about a principal axis, I of at most m (L/2)²", body.name));
    }
    Ok(inertia)
}

/// Half the distance between the centres of its two spheres.
fn capsule_m(body: &Body) -> Result<f64, Lacks> {
    match &body.geometry {
        Geometry::Solid { solid: Solid::Capsule { half_height_m, .. }, centre }
            if centre.norm() <= SAME * half_height_m =>
        {
            Ok(*half_height_m)
        }
        _ => Err(format!("`{}` a capsule, its centre of mass in its middle", body.name)),
    }
}

//! Facts of a scene, as far as closed forms ask: forces, the air, pins. What touches: `touching.rs`.

use super::point_motion::{Harmonic, PointMotion};
use crate::model::loads::AppliedForce;
use crate::model::pins::Anchor;
use crate::model::{Body, Model};
use crate::state::BodyState;
use nalgebra::{Matrix3, Vector3};

/// Relative difference of moments, directions and lengths that are the same: what is written with ten digits is.
pub(super) const SAME: f64 = 1e-10;

/// Sentence about what the scene lacks to be the closed form's.
pub type Lacks = String;

/// The other one of two bodies without a container; `two`: what they are.
pub(super) fn only_other(model: &Model, index: usize, two: &str) -> Result<usize, Lacks> {
    let others: Vec<usize> = (0..model.bodies.len()).filter(|i| *i != index).collect();
    let [other] = others[..] else { return Err(two.into()) };
    if model.container.is_some() { Err("no `container`".into()) } else { Ok(other) }
}

/// Acceleration of a point mass: by gravity, and by forces of the world at the centre of mass.
pub(super) fn point(model: &Model, index: usize, at: &BodyState) -> Result<PointMotion, Lacks> {
    let body = unpinned(model, index)?;
    if !body.drag.is_none() {
        return Err("no `air`".into());
    }
    let mut way = PointMotion {
        position_m: at.p_WB,
        velocity_m_s: at.v_WB,
        constant_m_s2: model.gravity_m_s2,
        harmonics: Vec::new(),
    };
    for force in central_forces(model, index)? {
        let amplitude_m_s2 = force.force_n / body.mass_kg;
        match force.cosine {
            None => way.constant_m_s2 += amplitude_m_s2,
            Some((rate_rad_s, phase_rad)) => way.harmonics.push(Harmonic { amplitude_m_s2, rate_rad_s, phase_rad }),
        }
    }
    Ok(way)
}

pub(super) fn constant_acceleration(model: &Model, index: usize) -> Result<Vector3<f64>, Lacks> {
    let mut acceleration = model.gravity_m_s2;
    for force in central_forces(model, index)? {
        if force.cosine.is_some() {
            return Err("forces that are constant".into());
        }
        acceleration += force.force_n / model.bodies[index].mass_kg;
    }
    Ok(acceleration)
}

pub(super) fn unpinned(model: &Model, index: usize) -> Result<&Body, Lacks> {
    if model.pins.iter().any(|pin| pin.holds(index)) { Err("no `pins`".into()) } else { Ok(&model.bodies[index]) }
}

/// Forces on a body, none of which turns it.
fn central_forces(model: &Model, index: usize) -> Result<Vec<&AppliedForce>, Lacks> {
    let forces: Vec<&AppliedForce> = model.forces.iter().filter(|force| force.body == index).collect();
    let is_central = |force: &&AppliedForce| {
        let in_world = force.frame == crate::experiment::types::Frame::World || force.force_n == Vector3::zeros();
        force.torque_n_m == Vector3::zeros() && force.r_B == Vector3::zeros() && in_world
    };
    if forces.iter().all(is_central) {
        Ok(forces)
    } else {
        Err("`forces` of the world's frame at the centre of mass".into())
    }
}

/// The one pin of a body to the world, and nothing else that acts on it but gravity.
pub(super) fn only_pin(model: &Model, index: usize) -> Result<(Vector3<f64>, Vector3<f64>), Lacks> {
    let body = &model.bodies[index];
    if !body.drag.is_none() || model.forces.iter().any(|force| force.body == index) {
        return Err("no `forces` and no `air`".into());
    }
    let held = || model.pins.iter().filter(|pin| pin.holds(index));
    match (held().next(), held().count()) {
        (Some(pin), 1) if pin.body == index => match pin.anchor {
            Anchor::World(p_W) => Ok((p_W, pin.r_B)),
            Anchor::Body(..) => Err(format!("`{}` pinned to the world", body.name)),
        },
        _ => Err(format!("`{}` on one pin, to the world", body.name)),
    }
}

/// Inertia about a point at `r_B` from the centre of mass.
pub(super) fn about(body: &Body, r_B: &Vector3<f64>) -> Matrix3<f64> {
    body.I_B + (Matrix3::identity() * r_B.norm_squared() - r_B * r_B.transpose()) * body.mass_kg
}

//! What applied forces and the air did in a step: their work and impulses, by Simpson's rule (L3) over the states at its
//! ends and a state in its middle, so that no solver's own forces are needed. The middle is that of the cubics through
//! positions and quaternions with their rates, right to O(h⁴): the work of a step is right to O(h⁵).
//!
//! The work of a constant force of the world is F·Δ(its point), exactly.

use crate::model::loads::{AppliedForce, Wrench};
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Of one step, over all bodies.
#[derive(Clone, Copy, Debug)]
pub struct Done {
    pub work_j: f64,
    pub impulse: Vector3<f64>,
    /// About a point given.
    pub angular_impulse: Vector3<f64>,
}

/// Angular impulses are about `origin`, the point that the ledger of momentum uses.
pub fn done(model: &Model, before: &State, after: &State, origin: &Vector3<f64>, h: f64) -> Done {
    let mut done = Done { work_j: 0.0, impulse: Vector3::zeros(), angular_impulse: Vector3::zeros() };
    if !model.has_loads() {
        return done;
    }
    let middle_s = before.time_s + h / 2.0;
    for (i, body) in model.bodies.iter().enumerate().filter(|(_, body)| !body.driven) {
        let (a, b) = (&before.bodies[i], &after.bodies[i]);
        let m = middle(a, b, h);
        for (at, t_s, weight) in [(a, before.time_s, 1.0), (&m, middle_s, 4.0), (b, before.time_s + h, 1.0)] {
            let part = weight * h / 6.0;
            let Wrench { force, torque } = model.load(i, t_s, at);
            done.impulse += force * part;
            done.angular_impulse += (torque + (at.p_WB - origin).cross(&force)) * part;
            done.work_j += varying_power(model, i, body, t_s, at) * part;
        }
        let steady = model.forces.iter().filter(|applied| applied.body == i && applied.is_weight_like());
        done.work_j += steady.map(|applied| applied.force_n.dot(&(point(applied, b) - point(applied, a)))).sum::<f64>();
    }
    done
}

/// F·v + τ·ω of all but the constant forces of the world.
fn varying_power(model: &Model, index: usize, body: &Body, t_s: f64, at: &BodyState) -> f64 {
    let drag = if body.drag.is_none() { 0.0 } else { body.drag.force(&at.v_WB).dot(&at.v_WB) };
    let varying = model.forces.iter().filter(|applied| applied.body == index && !applied.is_weight_like());
    let power = |wrench: Wrench| wrench.force.dot(&at.v_WB) + wrench.torque.dot(&at.w_WB);
    drag + varying.map(|applied| power(applied.wrench(t_s, at))).sum::<f64>()
}

fn point(applied: &AppliedForce, at: &BodyState) -> Vector3<f64> {
    at.p_WB + at.q_WB * applied.r_B
}

/// Half-way between two states that are h apart.
fn middle(a: &BodyState, b: &BodyState, h: f64) -> BodyState {
    let (qa, mut qb) = (a.q_WB.into_inner(), b.q_WB.into_inner());
    if qa.dot(&qb) < 0.0 {
        // The same attitude, on the side of the other.
        qb = -qb;
    }
    let rate = |q: &Quaternion<f64>, w_WB: &Vector3<f64>| Quaternion::from_imag(*w_WB) * q * 0.5;
    let (ra, rb) = (rate(&qa, &a.w_WB), rate(&qb, &b.w_WB));
    let q = (qa + qb) * 0.5 + (ra - rb) * (h / 8.0);
    let turning = ((qb - qa) * (1.5 / h) - (ra + rb) * 0.25) * q.conjugate() * (2.0 / q.norm_squared());
    BodyState {
        p_WB: (a.p_WB + b.p_WB) / 2.0 + (a.v_WB - b.v_WB) * (h / 8.0),
        q_WB: UnitQuaternion::new_normalize(q),
        v_WB: (b.p_WB - a.p_WB) * (1.5 / h) - (a.v_WB + b.v_WB) / 4.0,
        w_WB: turning.imag(),
    }
}

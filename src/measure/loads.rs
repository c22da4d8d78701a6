//! What applied forces and the air did in a step: their work and impulses, by Simpson's rule (L3) over the states at
//! its ends and a state in its middle, so that no solver's own forces are needed. The middle is that of the cubics
//! through positions and quaternions with their rates, right to O(h⁴): the work of a step is right to O(h⁵).
//!
//! The work of a constant force of the world is F·Δ(its point), exactly.

use crate::model::loads::Wrench;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Of one step, over all bodies.
#[derive(Clone, Copy, Debug)]
pub struct Done {
    pub work_j: f64,
    pub impulse: Vector3<f64>,
    /// About the pivot given, which may move.
    pub angular_impulse: Vector3<f64>,
}

impl Done {
    pub const NOTHING: Done =
        Done { work_j: 0.0, impulse: Vector3::new(0.0, 0.0, 0.0), angular_impulse: Vector3::new(0.0, 0.0, 0.0) };
}

impl std::ops::AddAssign for Done {
    fn add_assign(&mut self, more: Done) {
        self.work_j += more.work_j;
        self.impulse += more.impulse;
        self.angular_impulse += more.angular_impulse;
    }
}

/// With the state in the middle of the step, which is kept only for its memory.
pub fn done(
    model: &Model,
    [before, after]: [&State; 2],
    middle: &mut State,
    pivot: impl Fn(&State) -> Vector3<f64>,
    h: f64,
) -> Done {
    let mut done = Done::NOTHING;
    if !model.has_loads() || h == 0.0 {
        return done;
    }
    for ((m, a), b) in middle.bodies.iter_mut().zip(&before.bodies).zip(&after.bodies) {
        *m = half_way(a, b, h);
    }
    for (part, state) in [(0.0, before), (0.5, middle), (1.0, after)] {
        let (t_s, weight) = (before.time_s + part * h, if part == 0.5 { 4.0 } else { 1.0 } * h / 6.0);
        let pivot = pivot(state);
        for (i, (_, at)) in moving(model, state) {
            let Wrench { force, torque } = model.load(i, t_s, at);
            done.impulse += force * weight;
            done.angular_impulse += (torque + (at.p_WB - pivot).cross(&force)) * weight;
            done.work_j += varying_power(model, i, t_s, at) * weight;
        }
    }
    for applied in model.forces.iter().filter(|applied| applied.is_weight_like()) {
        let point = |state: &State| state.bodies[applied.body].p_WB + state.bodies[applied.body].q_WB * applied.r_B;
        done.work_j += applied.force_n.dot(&(point(after) - point(before)));
    }
    done
}

fn moving<'a>(model: &'a Model, state: &'a State) -> impl Iterator<Item = (usize, (&'a Body, &'a BodyState))> {
    model.bodies.iter().zip(&state.bodies).enumerate().filter(|(_, (body, _))| !body.driven)
}

/// F·v + τ·ω of all but the constant forces of the world.
fn varying_power(model: &Model, index: usize, t_s: f64, at: &BodyState) -> f64 {
    let drag = model.bodies[index].drag.force(&at.v_WB).dot(&at.v_WB);
    let varying = model.forces.iter().filter(|applied| applied.body == index && !applied.is_weight_like());
    let power = |wrench: Wrench| wrench.force.dot(&at.v_WB) + wrench.torque.dot(&at.w_WB);
    drag + varying.map(|applied| power(applied.wrench(t_s, at))).sum::<f64>()
}

/// Half-way between two states that are h apart.
fn half_way(a: &BodyState, b: &BodyState, h: f64) -> BodyState {
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

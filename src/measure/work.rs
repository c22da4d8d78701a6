//! What applied forces, the air and driven bodies did in a step: their work and impulses, by Gauss's quadrature over
//! states on the way, so that no solver's own forces are needed. The way of a step that kicks is that of the cubics
//! through positions and quaternions with their rates, right to O(h⁴): the work of a step is right to O(h⁵). A method
//! that knows its own way shows it at the nodes.
//!
//! The work of a constant force of the world is F·Δ(its point), exactly.

use crate::collide::SolvedContact;
use crate::model::Model;
use crate::model::loads::Wrench;
use crate::state::{BodyState, State};
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// What was done in one step, over all bodies.
#[derive(Clone, Copy, Debug)]
pub struct Done {
    pub work_j: f64,
    /// Sum of the sizes of the parts of the work.
    pub parts_j: f64,
    pub impulse: Vector3<f64>,
    /// About the pivot given, which may move.
    pub angular_impulse: Vector3<f64>,
    /// Sums of the sizes of the impulses and of their moments, of gravity too.
    pub impulse_size: f64,
    pub angular_size: f64,
}

impl Done {
    pub const NOTHING: Done = Done {
        work_j: 0.0,
        parts_j: 0.0,
        impulse: Vector3::new(0.0, 0.0, 0.0),
        angular_impulse: Vector3::new(0.0, 0.0, 0.0),
        impulse_size: 0.0,
        angular_size: 0.0,
    };

    pub fn add_work(&mut self, work_j: f64) {
        self.work_j += work_j;
        self.parts_j += work_j.abs();
    }

    /// Loads at one node of the quadrature.
    pub fn add_node(&mut self, model: &Model, state: &State, weight_s: f64, pivot: Vector3<f64>) {
        for (i, at) in state.bodies.iter().enumerate().filter(|(i, _)| !model.bodies[*i].driven) {
            let Wrench { force, torque } = model.load(i, state.time_s, at);
            let moment = torque + (at.p_WB - pivot).cross(&force);
            self.impulse += force * weight_s;
            self.angular_impulse += moment * weight_s;
            self.impulse_size += force.norm() * weight_s;
            self.angular_size += moment.norm() * weight_s;
            self.add_work(varying_power(model, i, state.time_s, at) * weight_s);
        }
    }

    /// The work of constant forces of the world between two states.
    pub fn add_constant(&mut self, model: &Model, [before, after]: [&State; 2]) {
        for applied in model.forces.iter().filter(|applied| applied.is_weight_like()) {
            let moved = |i: usize| {
                let [a, b] = [before, after].map(|state| &state.bodies[i]);
                (b.p_WB - a.p_WB) + (b.q_WB * applied.r_B - a.q_WB * applied.r_B)
            };
            self.add_work(applied.force_n.dot(&moved(applied.body)));
        }
    }

    /// The work of driven bodies through contacts whose impulses act at a state.
    pub fn add_driven(&mut self, model: &Model, state: &State, contacts: &[SolvedContact]) {
        for SolvedContact { contact, impulse_W } in contacts {
            for (i, r_W, sign) in contact.ends().filter(|(i, ..)| model.bodies[*i].driven) {
                let at = &state.bodies[i];
                // On the body itself acts the opposite of what it does to the other one.
                self.add_work(-sign * impulse_W.dot(&(at.v_WB + at.w_WB.cross(&r_W))));
            }
        }
    }
}

impl std::ops::AddAssign for Done {
    fn add_assign(&mut self, more: Done) {
        self.work_j += more.work_j;
        self.parts_j += more.parts_j;
        self.impulse += more.impulse;
        self.angular_impulse += more.angular_impulse;
        self.impulse_size += more.impulse_size;
        self.angular_size += more.angular_size;
    }
}

/// Nodes and weights of three points on 0..1 (C. F. Gauss, 1814): ½ ∓ √15/10.
const NODES: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Loads in a step of which the states at its ends are known. `middle` is kept for its memory alone.
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
    for (part, weight) in NODES {
        for ((m, a), b) in middle.bodies.iter_mut().zip(&before.bodies).zip(&after.bodies) {
            *m = on_the_way([a, b], part, h);
        }
        middle.time_s = before.time_s + part * h;
        done.add_node(model, middle, weight * h, pivot(middle));
    }
    done.add_constant(model, [before, after]);
    done
}

/// F·v + τ·ω of all but the constant forces of the world.
fn varying_power(model: &Model, index: usize, t_s: f64, at: &BodyState) -> f64 {
    let drag = model.bodies[index].drag.force(&at.v_WB).dot(&at.v_WB);
    let varying = model.forces.iter().filter(|applied| applied.body == index && !applied.is_weight_like());
    let power = |wrench: Wrench| wrench.force.dot(&at.v_WB) + wrench.torque.dot(&at.w_WB);
    drag + varying.map(|applied| power(applied.wrench(t_s, at))).sum::<f64>()
}

/// A part of the way between two states that are h apart, on the cubics that have their rates (C. Hermite, 1878).
fn on_the_way([a, b]: [&BodyState; 2], s: f64, h: f64) -> BodyState {
    let (qa, mut qb) = (a.q_WB.into_inner(), b.q_WB.into_inner());
    if qa.dot(&qb) < 0.0 {
        // The same attitude, on the side of the other.
        qb = -qb;
    }
    let rate = |q: &Quaternion<f64>, w_WB: &Vector3<f64>| Quaternion::from_imag(*w_WB) * q * 0.5;
    let (ra, rb) = (rate(&qa, &a.w_WB), rate(&qb, &b.w_WB));
    // Weights of the end, of the rate at the start and of that at the end; and their slopes.
    let [end, ra_s, rb_s] = [s * s * (3.0 - 2.0 * s), s * (1.0 - s) * (1.0 - s) * h, s * s * (s - 1.0) * h];
    let [end_v, ra_v, rb_v] = [6.0 * s * (1.0 - s) / h, (1.0 - s) * (1.0 - 3.0 * s), s * (3.0 * s - 2.0)];
    let (way_q, way_p) = (qb - qa, b.p_WB - a.p_WB);
    let q = qa + way_q * end + ra * ra_s + rb * rb_s;
    let turning = (way_q * end_v + ra * ra_v + rb * rb_v) * q.conjugate() * (2.0 / q.norm_squared());
    BodyState {
        p_WB: a.p_WB + way_p * end + a.v_WB * ra_s + b.v_WB * rb_s,
        q_WB: UnitQuaternion::new_normalize(q),
        v_WB: way_p * end_v + a.v_WB * ra_v + b.v_WB * rb_v,
        w_WB: turning.imag(),
    }
}

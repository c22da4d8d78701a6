//! Bodies moved out of each other, at no one's cost of energy and momentum.
//!
//! Of an island that nothing holds from outside linear momentum and height stay, as Σ m d = 0, but not the angular
//! momentum: it changes by Σ m d × v. The change is taken back by turning the whole island as one rigid body, of all
//! changes of its velocities the one of least kinetic energy, and none that any of its contacts would feel. What energy
//! that gives or takes comes from the motion of the bodies against each other, or goes to it.
//!
//! Bodies of any other island keep their velocities and their own angular momenta. What that costs, in height and in
//! what their inertia turns against the angular momentum, is no more than what the step has taken: else they go only
//! a part of the way. What is deeply inside goes on all the same, and its island's motion pays as long as there is any:
//! bodies that begin inside each other at rest are lifted at no one's cost.

use crate::integrate::rotation::{exponential, w_from_momentum};
use crate::model::{Body, Model};
use crate::solve::position::{Account, Push};
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use nalgebra::{Matrix3, Vector3};

/// Of the energy of the motion of an island's bodies against each other: where more is asked for there is next to none
/// of it, and what is left over is lost.
const LARGEST: f64 = 1.1;

/// Bodies of one island about their centre of mass.
struct Whole {
    p_m: Vector3<f64>,
    v_m_s: Vector3<f64>,
    L_W: Vector3<f64>,
    I_W: Matrix3<f64>,
    kinetic_j: f64,
}

impl Whole {
    fn new<'a>(bodies: impl Iterator<Item = (&'a Body, &'a BodyState)> + Clone) -> Self {
        let mass_kg = bodies.clone().map(|(body, _)| body.mass_kg).sum::<f64>();
        let mean = |of: fn(&BodyState) -> &Vector3<f64>| {
            bodies.clone().map(|(body, at)| of(at) * body.mass_kg).sum::<Vector3<f64>>() / mass_kg
        };
        let (p_m, v_m_s) = (mean(|at| &at.p_WB), mean(|at| &at.v_WB));
        let (mut L_W, mut I_W, mut kinetic_j) = (Vector3::zeros(), Matrix3::zeros(), 0.0);
        for (body, at) in bodies {
            let (r, v, own) = (at.p_WB - p_m, at.v_WB - v_m_s, body.I_W(at));
            L_W += r.cross(&v) * body.mass_kg + own * at.w_WB;
            I_W += own + (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * body.mass_kg;
            kinetic_j += (v.norm_squared() * body.mass_kg + at.w_WB.dot(&(own * at.w_WB))) / 2.0;
        }
        Whole { p_m, v_m_s, L_W, I_W, kinetic_j }
    }
}

/// Of what can be paid: a way that is nearly straight is found at once.
const ALMOST: f64 = 1.0 - 1e-3;
/// Shorter and shorter parts of a way that costs too much are tried so often.
const TRIES: u32 = 4;

/// Moves the bodies by what `push` has found.
pub(super) fn push_out(model: &Model, state: &mut State, push: &Push) {
    for first in 0..model.bodies.len() {
        let Some(account) = push.island(first).filter(|_| push.first[first] == first) else { continue };
        let is_own = |i: &usize| push.first[*i] == first && !model.bodies[*i].driven;
        let own = (first..model.bodies.len()).filter(is_own);
        let whole = |state: &State| Whole::new(own.clone().map(|i| (&model.bodies[i], &state.bodies[i])));
        if account.is_held {
            let cost_j = |part: f64| -> f64 {
                own.clone().map(|i| cost_j(model, i, &state.bodies[i], &push.moved[i].times(part))).sum()
            };
            let part = payable(account, cost_j);
            let owed_j = cost_j(part) - account.taken_j.max(0.0);
            for i in own.clone() {
                state.bodies[i] = moved(&model.bodies[i], &state.bodies[i], &push.moved[i].times(part));
            }
            if owed_j > 0.0 {
                pay(owed_j, model, own, state);
            }
        } else {
            let before = whole(state);
            for i in own.clone() {
                state.bodies[i] = moved(&model.bodies[i], &state.bodies[i], &push.moved[i]);
            }
            let now = whole(state);
            keep(&before, &now, own.clone(), state);
        }
    }
}

/// The body at another place, with its velocity and its own angular momentum.
fn moved(body: &Body, at: &BodyState, by: &Twist) -> BodyState {
    let mut moved = BodyState { p_WB: at.p_WB + by.v, q_WB: exponential(&by.w) * at.q_WB, ..*at };
    if !body.spins_steadily {
        moved.w_WB = w_from_momentum(body, &moved, &(body.I_W(at) * at.w_WB));
    }
    moved
}

/// What it costs to move a body.
fn cost_j(model: &Model, index: usize, at: &BodyState, by: &Twist) -> f64 {
    let body = &model.bodies[index];
    let lifted_j = -body.mass_kg * model.gravity_m_s2.dot(&by.v);
    let turned = moved(body, at, by).w_WB - at.w_WB;
    lifted_j + turned.dot(&(body.I_W(at) * at.w_WB)) / 2.0
}

/// Takes energy from the motion of an island, as much as there is.
fn pay(owed_j: f64, model: &Model, own: impl Iterator<Item = usize> + Clone, state: &mut State) {
    let kinetic_j = |(body, at): (&Body, &BodyState)| {
        (at.v_WB.norm_squared() * body.mass_kg + at.w_WB.dot(&(body.I_W(at) * at.w_WB))) / 2.0
    };
    let kinetic_j: f64 = own.clone().map(|i| kinetic_j((&model.bodies[i], &state.bodies[i]))).sum();
    let left = if kinetic_j > owed_j { (1.0 - owed_j / kinetic_j).sqrt() } else { 0.0 };
    for i in own {
        state.bodies[i].v_WB *= left;
        state.bodies[i].w_WB *= left;
    }
}

/// The part of a way that an island can pay for.
fn payable(account: &Account, cost_j: impl Fn(f64) -> f64) -> f64 {
    let mut part = 1.0;
    for _ in 0..TRIES {
        let cost_j = cost_j(part);
        if cost_j <= account.taken_j.max(0.0) {
            return part;
        }
        part *= (account.taken_j / cost_j).clamp(0.0, 1.0) * ALMOST;
        if part <= account.least {
            return account.least;
        }
    }
    account.least
}

/// Gives an island the angular momentum and the energy back that it had.
fn keep(before: &Whole, now: &Whole, own: impl Iterator<Item = usize>, state: &mut State) {
    let Some(inverse) = now.I_W.try_inverse() else { return };
    let (turns, turned) = (inverse * now.L_W, inverse * before.L_W);
    let rigid_j = [turns.dot(&now.L_W) / 2.0, turned.dot(&before.L_W) / 2.0];
    let [loose_j, wanted_j] = [now.kinetic_j - rigid_j[0], before.kinetic_j - rigid_j[1]];
    let square = if loose_j > 0.0 { wanted_j / loose_j } else { 1.0 };
    let factor = if square > LARGEST { 1.0 } else { square.max(0.0).sqrt() };
    for i in own {
        let at = &mut state.bodies[i];
        let r = at.p_WB - now.p_m;
        let loose = Twist { v: at.v_WB - now.v_m_s - turns.cross(&r), w: at.w_WB - turns }.times(factor);
        at.v_WB = now.v_m_s + loose.v + turned.cross(&r);
        at.w_WB = loose.w + turned;
    }
}

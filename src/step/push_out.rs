//! Bodies moved out of each other, at no cost of energy and momentum.
//!
//! A displacement moves bodies and turns them, velocities with them: kinetic energy stays what it is. Of an island that
//! nothing holds from outside linear momentum and height stay too, but not the angular momentum: it has changed by
//! Σ m d × v and by what has turned. The change is taken back by turning the whole island as one rigid body, of all
//! changes of its velocities the one of least kinetic energy, and none that any of its contacts would feel. What energy
//! that gives or takes comes from the motion of the bodies against each other, or goes to it.

use crate::integrate::rotation::exponential;
use crate::model::{Body, Model};
use crate::solve::position::Push;
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

/// Moves the bodies by what `push` has found.
pub(super) fn push_out(model: &Model, state: &mut State, push: &Push) {
    let alone: Vec<usize> = (0..model.bodies.len()).filter(|i| push.first[*i] == *i && push.is_alone(*i)).collect();
    let of = |first: usize, state: &State| -> Whole {
        let own = (0..model.bodies.len()).filter(|i| push.first[*i] == first);
        Whole::new(own.map(|i| (&model.bodies[i], &state.bodies[i])))
    };
    let before: Vec<Whole> = alone.iter().map(|first| of(*first, state)).collect();
    for ((body, at), moved) in model.bodies.iter().zip(&mut state.bodies).zip(&push.moved) {
        let turn = exponential(&moved.w);
        at.p_WB += moved.v;
        at.q_WB = turn * at.q_WB;
        if !body.isotropic && !body.driven {
            at.w_WB = turn * at.w_WB;
        }
    }
    for (first, before) in alone.into_iter().zip(before) {
        let now = of(first, state);
        let own = state.bodies.iter_mut().zip(&push.first).filter(|(_, of)| **of == first).map(|(at, _)| at);
        keep(&before, &now, own);
    }
}

/// Gives an island the angular momentum and the energy back that it had.
fn keep<'a>(before: &Whole, now: &Whole, bodies: impl Iterator<Item = &'a mut BodyState>) {
    let Some(inverse) = now.I_W.try_inverse() else { return };
    let (turns, turned) = (inverse * now.L_W, inverse * before.L_W);
    let rigid_j = [turns.dot(&now.L_W) / 2.0, turned.dot(&before.L_W) / 2.0];
    let [loose_j, wanted_j] = [now.kinetic_j - rigid_j[0], before.kinetic_j - rigid_j[1]];
    let square = if loose_j > 0.0 { wanted_j / loose_j } else { 1.0 };
    let factor = if square > LARGEST { 1.0 } else { square.max(0.0).sqrt() };
    for at in bodies {
        let r = at.p_WB - now.p_m;
        let loose = Twist { v: at.v_WB - now.v_m_s - turns.cross(&r), w: at.w_WB - turns }.times(factor);
        at.v_WB = now.v_m_s + loose.v + turned.cross(&r);
        at.w_WB = loose.w + turned;
    }
}

//! Impulses and forces of pins as their bodies' motion shows them, and the work that driven bodies do through them.
//!
//! A λ = c with A = J M⁻¹ Jᵀ: c is the change of the points' velocities that nothing else explains, or, of a smooth
//! motion, the acceleration against each other that the pins have to take away.

use super::exchange::{Exchange, Motion, Moved};
use crate::model::Model;
use crate::model::pins::{Anchor, Pin};
use crate::shown::ContactForce;
use crate::state::State;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Singular values below this part of the largest are none: pins that say the same twice share.
const REDUNDANT: f64 = 1e-11;

/// One end of a pin: its body, the arm in world axes, the sign of the pin's impulse.
type End = (usize, Vector3<f64>, f64);

fn ends(pin: &Pin, state: &State) -> impl Iterator<Item = End> + use<> {
    let arm = |body: usize, r_B: &Vector3<f64>| state.bodies[body].q_WB * r_B;
    let other = match &pin.anchor {
        Anchor::World(_) => None,
        Anchor::Body(other, r_B) => Some((*other, arm(*other, r_B), -1.0)),
    };
    std::iter::once((pin.body, arm(pin.body, &pin.r_B), 1.0)).chain(other)
}

/// Work of driven bodies through pins in an exchange at a state.
pub(super) fn work_of_impulses_j(model: &Model, state: &State, exchange: &Exchange) -> f64 {
    let of_pins = |i: usize| {
        let Moved { free, after, changed, .. } = exchange.moved[i];
        Motion { v: after.v - free.v - changed.v, w: after.w - free.w - changed.w }
    };
    work_j(model, state, |i, r| {
        let Motion { v, w } = of_pins(i);
        v + w.cross(r)
    })
}

/// Power of driven bodies through pins at a moment of a smooth motion, with its contacts.
pub(super) fn power_w(model: &Model, state: &State, contacts: &[ContactForce]) -> f64 {
    let push = |body: usize| {
        let mut sum = [Vector3::zeros(); 2];
        for ContactForce { contact, force_W } in contacts {
            for (_, r_W, sign) in contact.ends().filter(|(i, ..)| *i == body) {
                sum[0] += force_W * sign;
                sum[1] += r_W.cross(force_W) * sign;
            }
        }
        sum
    };
    work_j(model, state, |i, r| {
        let (body, at) = (&model.bodies[i], &state.bodies[i]);
        let turning = at.w_WB.cross(&at.w_WB.cross(r));
        if body.driven {
            return -turning;
        }
        let (load, [force, torque]) = (model.load(i, state.time_s, at), push(i));
        let a = model.gravity_m_s2 + (load.force + force) / body.mass_kg;
        let gyroscopic = at.w_WB.cross(&(body.I_W(at) * at.w_WB));
        let alpha = body.I_W_inverse(at) * (load.torque + torque - gyroscopic);
        -(a + alpha.cross(r) + turning)
    })
}

/// `missing`: what the pins did to a body's point, by its arm.
fn work_j(model: &Model, state: &State, missing: impl Fn(usize, &Vector3<f64>) -> Vector3<f64>) -> f64 {
    let n = model.pins.len();
    let (mut A, mut c) = (DMatrix::zeros(3 * n, 3 * n), DVector::zeros(3 * n));
    for (j, pin) in model.pins.iter().enumerate() {
        for (i, r, sign) in ends(pin, state) {
            let mut rows = c.fixed_rows_mut::<3>(3 * j);
            rows += missing(i, &r) * sign;
            if model.bodies[i].driven {
                continue;
            }
            let I_W_inverse = model.bodies[i].I_W_inverse(&state.bodies[i]);
            for (k, other) in model.pins.iter().enumerate() {
                for (_, r_k, sign_k) in ends(other, state).filter(|(body, ..)| *body == i) {
                    let linear = Matrix3::identity() / model.bodies[i].mass_kg;
                    let block = linear - r.cross_matrix() * I_W_inverse * r_k.cross_matrix();
                    let mut at = A.fixed_view_mut::<3, 3>(3 * j, 3 * k);
                    at += block * (sign * sign_k);
                }
            }
        }
    }
    let svd = A.svd(true, true);
    let least = REDUNDANT * svd.singular_values.amax();
    let Ok(impulses) = svd.solve(&c, least) else { return 0.0 };
    let of_pin = |(j, pin): (usize, &Pin)| {
        let driven = ends(pin, state).find(|(i, ..)| model.bodies[*i].driven);
        driven.map_or(0.0, |(i, r, sign)| {
            let at = &state.bodies[i];
            -sign * impulses.fixed_rows::<3>(3 * j).dot(&(at.v_WB + at.w_WB.cross(&r)))
        })
    };
    model.pins.iter().enumerate().map(of_pin).sum()
}

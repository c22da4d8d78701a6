//! Steps that need not be worked out: of bodies that rest, and of bodies that fly where nothing is near.
//!
//! A body that contacts hold, whose place a step changes by less than rounding, and whose velocities are what rounding
//! leaves of the step's forces, rests: it stays where it was, without velocities. So a step from there may be the one
//! before over again, and needs not be made. A body in flight is not held against the faces before it can have come to
//! one.

use crate::collide::SolvedContact;
use crate::collide::closed::MARGIN;
use crate::model::{Body, Model};
use crate::solve::twist::Twist;
use crate::state::{BodyState, State};
use nalgebra::Vector3;

/// Of the speed that the step's forces give a body: what contacts leave of it when they hold it. And of a residual that
/// kept impulses leave: that speed would be sent back by the next step, and come again for ever.
const NOTHING: f64 = 1e-13;
const OF_RESIDUAL: f64 = 4.0;

/// Of Coulomb's cone: within this no rounding makes a slip.
const WITHIN: f64 = 1.0 - 1e-6;

/// Of a place, or of an attitude: what does not move a body.
const HALF: f64 = f64::EPSILON / 2.0;

/// Whether nothing changes with time but what moves freely.
pub(super) fn is_steady(model: &Model, start: &State) -> bool {
    let moves = |(body, at): (&Body, &BodyState)| body.driven && (at.v_WB.norm() + at.w_WB.norm()) > 0.0;
    model.pins.is_empty()
        && model.forces.iter().all(|force| force.cosine.is_none())
        && !model.bodies.iter().zip(&start.bodies).any(moves)
}

/// Puts to rest what stands still. `began`: before the step; `free`: velocities with its forces; `response`: what
/// contacts did to them, by impulses `solved`, which were kept with that `residual`. Whether all bodies are as they
/// were, to the last bit.
pub(super) fn put_to_rest(
    model: &Model,
    state: &mut State,
    began: &[BodyState],
    (free, response): (&[Twist], &[Twist]),
    (solved, residual): (&[SolvedContact], f64),
) -> bool {
    let nothing = NOTHING.max(OF_RESIDUAL * residual);
    // Impulses that cancel, as those on a light body under a heavy one, leave what rounding is of them; along what does
    // not grip they do nothing.
    let mut all_n_s = None;
    let mut is_rounding = |i: usize, speed_m_s: f64, gained_m_s: f64| {
        let part = f64::EPSILON * model.bodies[i].compliance_1_kg();
        let all_n_s = *all_n_s.get_or_insert_with(|| solved.iter().map(|of| of.impulse_W.norm()).sum::<f64>());
        if speed_m_s > part * all_n_s {
            return false;
        }
        let own = || solved.iter().filter(|of| of.contact.body == i || of.contact.other == Some(i));
        let after = |i: usize| [free[i].v + response[i].v, free[i].w + response[i].w];
        let stays = |of: &SolvedContact| grips(of) || slip_W(of, after).norm() <= nothing * gained_m_s;
        speed_m_s <= part * own().map(|of| of.impulse_W.norm()).sum::<f64>() && own().all(stays)
    };
    let mut is_same = true;
    for (i, (at, before)) in state.bodies.iter_mut().zip(began).enumerate() {
        let body = &model.bodies[i];
        if body.driven {
            is_same &= at.has_bits_of(before);
            continue;
        }
        let moved_m = (at.p_WB - before.p_WB).amax();
        let is_placed = moved_m <= HALF * before.p_WB.amax().max(body.bounding_radius_m)
            && (at.q_WB.coords - before.q_WB.coords).amax() <= HALF;
        // What stood still, and was not left alone, is not led on by rounding, however long the step.
        let stood = before.v_WB == Twist::ZERO.v && before.w_WB == Twist::ZERO.w;
        if (is_placed || stood) && response[i] != Twist::ZERO {
            let speed = |v: f64, w: f64| v + w * body.bounding_radius_m;
            let gained = speed((free[i].v - before.v_WB).norm(), (free[i].w - before.w_WB).norm());
            let left = speed(at.v_WB.norm(), at.w_WB.norm());
            if (is_placed && left <= nothing * gained) || is_rounding(i, left, gained) {
                *at = BodyState { v_WB: Twist::ZERO.v, w_WB: Twist::ZERO.w, ..*before };
            }
        }
        is_same &= at.has_bits_of(before);
    }
    is_same
}

/// Whether friction holds a contact, with some of it left.
fn grips(SolvedContact { contact, impulse_W }: &SolvedContact) -> bool {
    let presses = contact.normal.dot(impulse_W);
    (impulse_W - contact.normal * presses).norm() < WITHIN * contact.friction * presses
}

fn slip_W(of: &SolvedContact, velocities: impl Fn(usize) -> [Vector3<f64>; 2]) -> Vector3<f64> {
    let (n, relative) = (of.contact.normal, of.contact.velocity(velocities));
    relative - n * n.dot(&relative)
}

/// Number of steps from a state in which no body can come to a face of the container: by gravity alone, whatever way
/// bodies turn. None are pairs of bodies that may touch.
pub(super) fn steps_of_flight(model: &Model, state: &State, step_s: f64) -> u64 {
    /// Of a way that is the most: rounding, with some to spare.
    const SURE: f64 = 0.99;
    /// Falls of a step that a contact test looks beyond the way of a body.
    const FALLS: f64 = 4.0;
    let is_simple = !model.touching_pairs
        && model.pins.is_empty()
        && model.forces.is_empty()
        && model.bodies.iter().all(|body| body.drag.is_none());
    let (Some(container), true) = (&model.container, is_simple) else { return 0 };
    let fall_m = model.gravity_m_s2.norm() * step_s * step_s;
    let mut most = f64::INFINITY;
    for (body, at) in model.bodies.iter().zip(&state.bodies).filter(|(body, _)| body.feels_container()) {
        let L_W = body.I_W(at) * at.w_WB;
        let turning_m = step_s * body.bounding_radius_m * (body.I_B_inverse.norm() * L_W.norm()).max(at.w_WB.norm());
        let beside_m = body.bounding_radius_m * (1.0 + 4.0 * MARGIN) + turning_m + FALLS * fall_m;
        let way_m = step_s * at.v_WB.norm();
        for face in &container.faces {
            let left_m = SURE * (face.gap_m(&at.p_WB) - 4.0 * MARGIN * at.p_WB.amax()) - beside_m;
            // n (way + n fall) is left.
            let root = (way_m * way_m + 4.0 * fall_m * left_m.max(0.0)).sqrt();
            most = most.min(if left_m > 0.0 { 2.0 * left_m / (way_m + root) } else { 0.0 });
        }
    }
    // The first of them is this one, the last is where it may touch.
    if most.is_finite() && most > 2.0 { (most as u64) - 2 } else { 0 }
}

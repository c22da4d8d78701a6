//! The end of a rocking that is cut off, or of a slip: impulses that leave no velocity along what holds.
//!
//! Contacts that strike together take them at once. Where what is left of a rocking is cut off, some contact would have
//! to pull for it; in truth the weight presses while the rocking ends. The impulses then act over the time in which the
//! forces that hold make a push of every one of them, in one step of that length: free motion, then all impulses where
//! it ends, by the law of contact.

use super::forces::{Gathered, Held, Solved, speed_m_s};
use super::impact::plastic;
use super::zeno::strikes;
use crate::collide::{Contact, SolvedContact};
use crate::integrate::momentum::{momentum_W, velocity_W};
use crate::model::Model;
use crate::solve::Impulse;
use crate::state::{BodyState, State};
use crate::work::Work;
use nalgebra::Vector3;

/// Changes of velocity below this part of a body's speed are the rounding of what holds.
pub const NOTHING: f64 = 1e-10;

/// Longest such time, of a fall by the body's size.
const LONGEST: f64 = 1e-3;

/// Beyond the edge of Coulomb's cone by this part of the impulse is rounding.
const OUTSIDE: f64 = 1e-9;

/// Whether an impulse (or a force), world axes, pushes along a unit normal and has its friction within Coulomb's cone.
pub fn is_lawful(of_W: &Vector3<f64>, normal: &Vector3<f64>, friction: f64) -> bool {
    let pushes = normal.dot(of_W);
    pushes >= 0.0 && (of_W - normal * pushes).norm() <= friction * pushes + OUTSIDE * of_W.norm()
}

/// Time over which impulses that put to rest are lawful together with the forces that hold after them: 0 at once, or
/// where there is none. Every contact pushes then, and has its friction within its cone.
pub fn lasts_s(
    model: &Model,
    (placing, at_once): (&Gathered, &[Impulse]),
    (holding, forces): (&Gathered, &Solved),
) -> f64 {
    let in_world = |gathered: &Gathered, p: &[Impulse]| -> Vec<Vector3<f64>> {
        gathered.problem.blocks.iter().zip(p).map(|(block, p)| block.in_world(p)).collect()
    };
    let (impulses, forces) = (in_world(placing, at_once), in_world(holding, &forces.p));
    let contacts: Vec<Contact> = placing.here.iter().map(|here| here.contact).collect();
    let g = model.gravity_m_s2.norm();
    if forces.len() < contacts.len() || g == 0.0 {
        return 0.0;
    }
    let are_lawful = |over_s: f64| {
        let of_contact = |(contact, (p, f)): (&Contact, (&Vector3<f64>, &Vector3<f64>))| {
            is_lawful(&(p + f * over_s), &contact.normal, contact.friction)
        };
        contacts.iter().zip(impulses.iter().zip(&forces)).all(of_contact)
    };
    let pushes_after_s = |(contact, (p, f)): (&Contact, (&Vector3<f64>, &Vector3<f64>))| {
        let [p, f] = [p, f].map(|of| contact.normal.dot(of));
        if p < 0.0 { -p / f.max(0.0) } else { 0.0 }
    };
    let least_s = contacts.iter().zip(impulses.iter().zip(&forces)).map(pushes_after_s).fold(0.0, f64::max);
    let longest_s = LONGEST * (model.largest_radius_m() / g).sqrt();
    if are_lawful(0.0) {
        return 0.0;
    }
    // Well within the cones, not on their edge.
    let mut over_s = if least_s > 0.0 { 2.0 * least_s } else { longest_s * f64::EPSILON };
    while over_s <= longest_s {
        if are_lawful(over_s) {
            return over_s;
        }
        over_s *= 2.0;
    }
    shared_s(&contacts, &impulses, &forces).min(longest_s)
}

/// Times the least in which all forces together could make up for all impulses.
const SHARED: f64 = 4.0;

/// Where redundant contacts share impulses and forces otherwise than the law would: the law itself says then what they
/// are, over a time in which the weight can make them.
fn shared_s(contacts: &[Contact], impulses: &[Vector3<f64>], forces: &[Vector3<f64>]) -> f64 {
    let needed = |(contact, p): (&Contact, &Vector3<f64>)| {
        let pushes = contact.normal.dot(p);
        let rubs = (p - contact.normal * pushes).norm();
        pushes.abs() + if contact.friction > 0.0 { rubs / contact.friction } else { 0.0 }
    };
    let needed: f64 = contacts.iter().zip(impulses).map(needed).sum();
    let presses: f64 = contacts.iter().zip(forces).map(|(contact, f)| contact.normal.dot(f).max(0.0)).sum();
    if presses > 0.0 { SHARED * needed / presses } else { 0.0 }
}

/// Puts all impulses of a step where a smooth motion has led, so that velocities are those of what holds; `kicked`
/// becomes the state that they act on. `others`: contacts that touch there and are not held. What they are.
pub fn end(
    model: &Model,
    [kicked, state]: [&mut State; 2],
    held: &[Held],
    others: &[Contact],
    gathered: &mut Gathered,
    work: &mut Work,
) -> Vec<SolvedContact> {
    let step_s = state.time_s - kicked.time_s;
    let is_held = |i: usize| {
        let touches = held.iter().any(|held| held.touch.bodies().any(|body| body == i))
            || others.iter().any(|contact| contact.ends().any(|(body, ..)| body == i));
        !model.bodies[i].driven && (touches || model.pins.iter().any(|pin| pin.holds(i)))
    };
    let bodies: Vec<usize> = (0..model.bodies.len()).filter(|i| is_held(*i)).collect();
    for &i in &bodies {
        let (body, from, to) = (&model.bodies[i], &kicked.bodies[i], &mut state.bodies[i]);
        let w_WB = velocity_W(body, &to.q_WB, &momentum_W(body, &from.q_WB, &from.w_WB));
        kicked.bodies[i] = BodyState { v_WB: from.v_WB, w_WB, ..*to };
        let (v, w) = model.gained(i, kicked.time_s, &kicked.bodies[i], step_s);
        (to.v_WB, to.w_WB) = (kicked.bodies[i].v_WB + v, w_WB + w);
    }
    let without_rebound = |contact: Contact| Contact { restitution: 0.0, tangential_restitution: 0.0, ..contact };
    let held = held.iter().map(|held| held.touch.here(state).contact);
    let contacts: Vec<Contact> = held.chain(others.iter().copied()).map(without_rebound).collect();
    gathered.gather_plain(model, state, &contacts);
    let mut p = vec![Impulse::zeros(); gathered.problem.blocks.len()];
    if !plastic(&gathered.problem, &mut p, gathered.deadline, work) {
        work.unsolved += 1;
    }
    let solved = gathered.solved(p, true);
    for &i in &bodies {
        state.bodies[i].v_WB += solved.added[i].v;
        state.bodies[i].w_WB += solved.added[i].w;
    }
    let of = contacts.iter().zip(&gathered.problem.blocks).zip(&solved.p);
    of.map(|((contact, block), p)| SolvedContact { contact: *contact, impulse_W: block.in_world(p) }).collect()
}

/// Whether a state differs from another in some velocity by more than a part of its body's speed.
pub fn changes(model: &Model, [before, after]: [&State; 2], part: f64) -> bool {
    let changes = |i: usize| {
        let (a, b, size_m) = (&before.bodies[i], &after.bodies[i], model.bodies[i].bounding_radius_m);
        let change = (b.v_WB - a.v_WB).norm() + (b.w_WB - a.w_WB).norm() * size_m;
        change > part * speed_m_s(model, &model.bodies[i], a)
    };
    (0..model.bodies.len()).any(changes)
}

/// Whether something that touches comes nearer in the second of two states, and not in the first.
pub fn pushes(model: &Model, [before, after]: [&State; 2], found: &[Contact]) -> bool {
    found.iter().any(|contact| strikes(model, after, contact) && !strikes(model, before, contact))
}

/// What touches and is not held.
pub fn others(held: &[Held], found: &[Contact]) -> Vec<Contact> {
    let is_held = |contact: &Contact| held.iter().any(|held| held.touch.key() == contact.key());
    found.iter().filter(|contact| !is_held(contact)).copied().collect()
}

/// The same, as far as it comes nearer.
pub fn coming(model: &Model, state: &State, held: &[Held], found: &[Contact]) -> Vec<Contact> {
    let mut coming = others(held, found);
    coming.retain(|contact| strikes(model, state, contact));
    coming
}

/// Forces of contacts, world axes; none if one of them pulls or is outside of its cone.
pub fn steady(gathered: &Gathered, solved: &Solved, contacts: usize) -> Vec<Vector3<f64>> {
    let blocks = || gathered.problem.blocks.iter().zip(&solved.p).take(contacts);
    let are_lawful = blocks().all(|(block, p)| is_lawful(&block.in_world(p), &block.frame[0], block.friction));
    if are_lawful { blocks().map(|(block, p)| block.in_world(p)).collect() } else { Vec::new() }
}

//! The outside judge of contact: how far impulses are from the law of contact, whoever found them.
//!
//! Signorini's condition, Coulomb's disc and maximum dissipation together say that p is in Coulomb's cone K, ũ in its
//! dual, and p ⟂ ũ, where ũ = u + μ|u_t| n and u is the velocity after the contacts (G. De Saxcé, Z.-Q. Feng, Math.
//! Comput. Modelling 28 (1998) 225). That is p = P_K(p − ρ ũ) for every ρ > 0, and what the two sides differ by is the
//! residual of a contact (V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems, Springer 2008).
//!
//! In an impact with tangential restitution u_t stands for u_t⁺ + ε_t u_t⁻, from the velocities before and after.
//!
//! With 1/ρ = the trace of the contact's own block of A all terms are impulses; divided by the largest impulse of the
//! island, neither masses nor lengths nor times matter. Rounding gives 1e-16 … 1e-13, a wrong impulse O(1).

use super::push::{Push, relative};
use crate::collide::approach::Approach;
use crate::collide::{Contact, SolvedContact};
use crate::model::Model;
use crate::state::State;
use nalgebra::{Matrix3, Vector3};

/// Impulses below this part of a body's momentum, as of a gap that just closes, are not asked to obey to the last
/// digit: the rounding of velocities, 1e-15, is then 1e-10 of them.
const SMALL: f64 = 1e-5;

#[derive(Clone, Copy, Debug)]
struct Motion {
    v: Vector3<f64>,
    w: Vector3<f64>,
}

/// One body in one step.
#[derive(Clone, Copy, Debug)]
struct Moved {
    /// V[n], V[n] + M⁻¹ F_E Δt, and that plus M⁻¹ Jᵀ p, all at the attitude before the step.
    before: Motion,
    free: Motion,
    after: Motion,
    /// Infinite, and 0, of a body that moves as it is told.
    mass_kg: f64,
    I_W_inverse: Matrix3<f64>,
}

impl Moved {
    /// With pins, whose impulses nobody tells, the motion after is that of the state after; turning freely keeps I ω.
    fn new(model: &Model, index: usize, [before, after]: [&State; 2], push: &Push, step_s: f64) -> Self {
        let (body, at) = (&model.bodies[index], &before.bodies[index]);
        let (v, w) = model.gained(index, before.time_s, at, step_s);
        let before = Motion { v: at.v_WB, w: at.w_WB };
        let free = Motion { v: at.v_WB + v, w: at.w_WB + w };
        if body.driven {
            return Moved { before, free, after: free, mass_kg: f64::INFINITY, I_W_inverse: Matrix3::zeros() };
        }
        let I_W_inverse = body.I_W_inverse(at);
        let after = if model.pins.is_empty() {
            Motion { v: free.v + push.linear / body.mass_kg, w: free.w + I_W_inverse * push.angular }
        } else {
            let at = &after.bodies[index];
            Motion { v: at.v_WB, w: I_W_inverse * (body.I_W(at) * at.w_WB) }
        };
        Moved { before, free, after, mass_kg: body.mass_kg, I_W_inverse }
    }

    /// Trace of E/m − [r] I⁻¹ [r].
    fn compliance(&self, r: &Vector3<f64>) -> f64 {
        let I = &self.I_W_inverse;
        3.0 / self.mass_kg + r.norm_squared() * I.trace() - r.dot(&(I * r))
    }
}

/// Impulses of an island: bodies that contacts join.
#[derive(Clone, Copy, Debug, Default)]
struct Stakes {
    /// Some contact strikes.
    struck: bool,
    /// Largest impulse; largest that would stop an approach; the largest momentum, as an impulse at a contact.
    largest: f64,
    stopping: f64,
    momentum: f64,
}

impl Stakes {
    /// What impulses are compared with.
    fn scale(&self) -> f64 {
        let at_stake = if self.largest > 0.0 { self.largest } else { self.stopping };
        at_stake.max(SMALL * self.momentum)
    }

    fn weigh(&mut self, of: &Seen, impulse_W: &Vector3<f64>) {
        self.struck |= of.strikes;
        self.largest = self.largest.max(impulse_W.norm());
        self.stopping = self.stopping.max(-of.step_length * of.approach);
        self.momentum = self.momentum.max(of.step_length * of.speed);
    }
}

/// A contact as its bodies' motions show it.
struct Seen {
    /// ρ: one over the trace of its own block of A.
    step_length: f64,
    /// The normal velocity that the law asks for at least: u_n ≥ least.
    least: f64,
    /// The same of a contact without restitution; and whether it strikes, so that restitution matters.
    floor: f64,
    strikes: bool,
    /// Normal velocity without an impulse, less that.
    approach: f64,
    /// Relative velocity after the contacts, and before them.
    u: Vector3<f64>,
    u_before: Vector3<f64>,
    /// Largest of its bodies' before the contacts.
    speed: f64,
}

impl Seen {
    fn new(model: &Model, contact: &Contact, moved: &[Moved], (approach, step_s): (Approach, f64)) -> Self {
        let relative = |motion: fn(&Moved) -> &Motion| -> Vector3<f64> {
            contact.velocity(|i| [motion(&moved[i]).v, motion(&moved[i]).w])
        };
        let u_before = relative(|m| &m.before);
        let before = contact.normal.dot(&u_before);
        let free = contact.normal.dot(&relative(|m| &m.free));
        let motion = [before, free - before];
        let least = approach.least(model, contact, motion, step_s).unwrap_or(f64::NAN);
        let plastic = Contact { restitution: 0.0, ..*contact };
        let floor = approach.least(model, &plastic, motion, step_s).unwrap_or(f64::NAN);
        let speed = |(i, r, _): (usize, Vector3<f64>, f64)| moved[i].free.v.norm() + moved[i].free.w.norm() * r.norm();
        Seen {
            step_length: 1.0 / contact.ends().map(|(i, r, _)| moved[i].compliance(&r)).sum::<f64>(),
            least,
            floor,
            strikes: approach.strikes(model, contact, motion, step_s),
            approach: free - least,
            u: relative(|m| &m.after),
            u_before,
            speed: contact.ends().map(speed).fold(0.0, f64::max),
        }
    }

    /// Of an impact by another law than Newton's, in impulses: how far p is outside of the cone, and of what would stop
    /// the approach that is left.
    fn missed_by_impact(&self, contact: &Contact, impulse_W: &Vector3<f64>) -> f64 {
        let outside = (impulse_W - in_cone(impulse_W, &contact.normal, contact.friction)).norm();
        let approach = self.floor - contact.normal.dot(&self.u);
        outside.max(self.step_length * approach)
    }

    /// Friction is against the velocity after; a kick half-way through the motion may put it against the mean instead.
    fn missed(&self, contact: &Contact, impulse_W: &Vector3<f64>, approach: Approach) -> f64 {
        let tangent = self.u_before - contact.normal * contact.normal.dot(&self.u_before);
        if self.strikes && contact.tangential_restitution > 0.0 {
            return self.missed_at(&(self.u + tangent * contact.tangential_restitution), contact, impulse_W);
        }
        let missed = self.missed_at(&self.u, contact, impulse_W);
        if approach != Approach::Middle {
            return missed;
        }
        missed.min(self.missed_at(&(self.u + tangent), contact, impulse_W))
    }

    /// |p − P_K(p − ρ ũ)|.
    fn missed_at(&self, u: &Vector3<f64>, contact: &Contact, impulse_W: &Vector3<f64>) -> f64 {
        let Contact { normal, friction, .. } = contact;
        let slip = (u - normal * normal.dot(u)).norm();
        let dual = u + normal * (friction * slip - self.least);
        let wanted = in_cone(&(impulse_W - dual * self.step_length), normal, *friction);
        (impulse_W - wanted).norm()
    }
}

/// The nearest point of Coulomb's cone.
fn in_cone(z: &Vector3<f64>, normal: &Vector3<f64>, friction: f64) -> Vector3<f64> {
    let z_n = normal.dot(z);
    let z_t = z - normal * z_n;
    let length = z_t.norm();
    if z_n >= 0.0 && length <= friction * z_n {
        return *z;
    }
    let along = (z_n + friction * length) / (1.0 + friction * friction);
    if along <= 0.0 { Vector3::zeros() } else { (normal + z_t * (friction / length)) * along }
}

/// The largest residual of all contacts of all steps.
#[derive(Clone, Debug)]
pub struct ResidualLedger {
    /// The method claims to solve the law of contact.
    judged: bool,
    /// Impacts obey Newton's law; else all that is asked of one is that it stays in its cone and stops the approach.
    newton: bool,
    moved: Vec<Moved>,
    /// Of every body, the first one of its island.
    island_of: Vec<usize>,
    stakes: Vec<Stakes>,
    pub max: Option<f64>,
}

impl ResidualLedger {
    pub fn new(judged: bool, newton: bool, model: &Model) -> Self {
        let bodies = model.bodies.len();
        ResidualLedger {
            judged,
            newton,
            moved: Vec::with_capacity(bodies),
            island_of: Vec::with_capacity(bodies),
            stakes: Vec::with_capacity(bodies),
            max: None,
        }
    }

    /// `states`: where the impulses acted, and after the step; how it went through contacts, and its length.
    pub fn observe(
        &mut self,
        model: &Model,
        states: [&State; 2],
        contacts: &[SolvedContact],
        pushes: &[Push],
        (approach, step_s): (Approach, f64),
    ) {
        if !self.judged || contacts.is_empty() {
            return;
        }
        self.moved.clear();
        self.moved.extend(pushes.iter().enumerate().map(|(i, push)| Moved::new(model, i, states, push, step_s)));
        self.find_islands(model, contacts);
        self.stakes.clear();
        self.stakes.resize(pushes.len(), Stakes::default());
        let seen = |contact: &Contact| Seen::new(model, contact, &self.moved, (approach, step_s));
        for SolvedContact { contact, impulse_W } in contacts {
            let island = self.island(model, contact);
            self.stakes[island].weigh(&seen(contact), impulse_W);
        }
        let missed = |SolvedContact { contact, impulse_W }: &SolvedContact| {
            let stakes = &self.stakes[self.island(model, contact)];
            let missed = if stakes.struck && !self.newton {
                seen(contact).missed_by_impact(contact, impulse_W)
            } else {
                seen(contact).missed(contact, impulse_W, approach)
            };
            relative(missed, stakes.scale())
        };
        let largest = contacts.iter().map(missed).fold(0.0, f64::max);
        self.max = Some(self.max.map_or(largest, |max| max.max(largest)));
    }

    /// Of a contact: that of a body which it can move.
    fn island(&self, model: &Model, contact: &Contact) -> usize {
        let moving = contact.ends().find(|(i, ..)| !model.bodies[*i].driven);
        root(&self.island_of, moving.map_or(contact.body, |(i, ..)| i))
    }

    /// Bodies that contacts join, but not through one that nothing moves.
    fn find_islands(&mut self, model: &Model, contacts: &[SolvedContact]) {
        self.island_of.clear();
        self.island_of.extend(0..model.bodies.len());
        for SolvedContact { contact, .. } in contacts {
            let Some(other) = contact.other else { continue };
            if !model.bodies[contact.body].driven && !model.bodies[other].driven {
                let (a, b) = (root(&self.island_of, contact.body), root(&self.island_of, other));
                self.island_of[a.max(b)] = a.min(b);
            }
        }
    }
}

/// The first body of an island: every other one points to one before it.
fn root(island_of: &[usize], mut body: usize) -> usize {
    while island_of[body] != body {
        body = island_of[body];
    }
    body
}

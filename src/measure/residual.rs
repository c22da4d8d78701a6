//! The outside judge of contact: how far impulses are from the law of contact, whoever found them.
//!
//! Signorini's condition, Coulomb's disc and maximum dissipation together say that p is in Coulomb's cone K, ũ in its
//! dual, and p ⟂ ũ, where ũ = u + μ|u_t| n and u is the velocity after the contacts (G. De Saxcé, Z.-Q. Feng, Math.
//! Comput. Modelling 28 (1998) 225). That is p = P_K(p − ρ ũ) for every ρ > 0, and what the two sides differ by is the
//! residual of a contact (V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems, Springer 2008).
//!
//! With 1/ρ = the trace of the contact's own block of A all terms are impulses; divided by the largest impulse of the
//! body's contacts, neither masses nor lengths nor times matter. Rounding gives 1e-16 … 1e-13, a wrong impulse O(1).

use super::{Push, relative};
use crate::collide::{Contact, SolvedContact};
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{Matrix3, Vector3};

/// Impulses below this part of a body's momentum, √ε, are half rounding: they are not asked to obey to the last digit.
const SMALL: f64 = 1.5e-8;

#[derive(Clone, Copy, Debug)]
struct Motion {
    v: Vector3<f64>,
    w: Vector3<f64>,
}

impl Motion {
    /// Velocity of the point `r` from the centre of mass.
    fn of_point(&self, r: &Vector3<f64>) -> Vector3<f64> {
        self.v + self.w.cross(r)
    }
}

/// One body in one step.
#[derive(Clone, Copy, Debug)]
struct Moved {
    /// V[n], V[n] + M⁻¹ F_E Δt, and that plus M⁻¹ Jᵀ p, all at the attitude before the step.
    before: Motion,
    free: Motion,
    after: Motion,
    mass_kg: f64,
    I_W_inverse: Matrix3<f64>,
    /// Largest impulse of its contacts; largest that would stop an approach; its momentum, as an impulse at a contact.
    largest: f64,
    stopping: f64,
    momentum: f64,
}

impl Moved {
    fn new(body: &Body, at: &BodyState, push: &Push, (gained_v, gained_w): (Vector3<f64>, Vector3<f64>)) -> Self {
        let before = Motion { v: at.v_WB, w: at.w_WB };
        let free = Motion { v: at.v_WB + gained_v, w: at.w_WB + gained_w };
        let I_W_inverse = body.I_W_inverse(at);
        let after = Motion { v: free.v + push.linear / body.mass_kg, w: free.w + I_W_inverse * push.angular };
        let mass_kg = body.mass_kg;
        Moved { before, free, after, mass_kg, I_W_inverse, largest: 0.0, stopping: 0.0, momentum: 0.0 }
    }

    /// ρ: one over the trace of E/m − [r] I⁻¹ [r].
    fn step_length(&self, r: &Vector3<f64>) -> f64 {
        let I = &self.I_W_inverse;
        1.0 / (3.0 / self.mass_kg + r.norm_squared() * I.trace() - r.dot(&(I * r)))
    }

    /// e v⁻ of an approaching contact: Newton's law asks for u_n + e v⁻ ≥ 0.
    fn rebound(&self, contact: &Contact) -> f64 {
        contact.restitution * contact.normal.dot(&self.before.of_point(&contact.r_BC_W)).min(0.0)
    }

    fn weigh(&mut self, contact: &Contact, impulse_W: &Vector3<f64>) {
        let (r, rho) = (&contact.r_BC_W, self.step_length(&contact.r_BC_W));
        let approach = contact.normal.dot(&self.free.of_point(r)) + self.rebound(contact);
        self.largest = self.largest.max(impulse_W.norm());
        self.stopping = self.stopping.max(-rho * approach);
        self.momentum = self.momentum.max(rho * (self.free.v.norm() + self.free.w.norm() * r.norm()));
    }

    /// What impulses are compared with.
    fn scale(&self) -> f64 {
        let at_stake = if self.largest > 0.0 { self.largest } else { self.stopping };
        at_stake.max(SMALL * self.momentum)
    }

    /// |p − P_K(p − ρ ũ)|.
    fn missed(&self, contact: &Contact, impulse_W: &Vector3<f64>) -> f64 {
        let Contact { normal, friction, r_BC_W, .. } = contact;
        let u = self.after.of_point(r_BC_W);
        let slip = (u - normal * normal.dot(&u)).norm();
        let dual = u + normal * (friction * slip + self.rebound(contact));
        let wanted = in_cone(&(impulse_W - dual * self.step_length(r_BC_W)), normal, *friction);
        (impulse_W - wanted).norm()
    }
}

/// The nearest point of Coulomb's cone.
fn in_cone(z: &Vector3<f64>, normal: &Vector3<f64>, friction: f64) -> Vector3<f64> {
    let z_n = normal.dot(z);
    let z_t = z - normal * z_n;
    let length = z_t.norm();
    if length <= friction * z_n {
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
    moved: Vec<Moved>,
    pub max: Option<f64>,
}

impl ResidualLedger {
    pub fn new(judged: bool, model: &Model) -> Self {
        ResidualLedger { judged, moved: Vec::with_capacity(model.bodies.len()), max: None }
    }

    pub fn observe(&mut self, model: &Model, before: &State, contacts: &[SolvedContact], pushes: &[Push], step_s: f64) {
        if !self.judged || contacts.is_empty() {
            return;
        }
        let bodies = model.bodies.iter().zip(&before.bodies).zip(pushes).enumerate();
        self.moved.clear();
        self.moved.extend(
            bodies
                .map(|(i, ((body, at), push))| Moved::new(body, at, push, model.gained(i, before.time_s, at, step_s))),
        );
        for SolvedContact { contact, impulse_W } in contacts {
            self.moved[contact.body].weigh(contact, impulse_W);
        }
        let missed = |SolvedContact { contact, impulse_W }: &SolvedContact| {
            let moved = &self.moved[contact.body];
            relative(moved.missed(contact, impulse_W), moved.scale())
        };
        let largest = contacts.iter().map(missed).fold(0.0, f64::max);
        self.max = Some(self.max.map_or(largest, |max| max.max(largest)));
    }
}

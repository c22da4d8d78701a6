//! The outside judge of contact: how far impulses are from the law of contact, whoever found them.
//!
//! Signorini's condition, Coulomb's disc and maximum dissipation together say that p is in Coulomb's cone K, ũ in its
//! dual, and p ⟂ ũ, where ũ = u + μ|u_t| n and u is the velocity after the contacts (G. De Saxcé, Z.-Q. Feng, Math.
//! Comput. Modelling 28 (1998) 225). That is p = P_K(p − ρ ũ) for every ρ > 0, and what the two sides differ by is the
//! residual of a contact (V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems, Springer 2008).
//!
//! In an impact with tangential restitution u_t stands for u_t⁺ + ε_t u_t⁻, from the velocities before and after.
//!
//! With 1/ρ = the trace of the contact's own block of A all terms are impulses. They are compared with the least of
//! ρᵢ sᵢ over the bodies that the contact can move, 1/ρᵢ the body's part of that trace and sᵢ what the step does to it
//! there: so that a light body under a heavy one counts, and neither masses nor lengths nor times matter. Rounding
//! gives 1e-16 … 1e-13 times the ratio of the masses, a wrong impulse O(1).

use super::exchange::{Exchange, Met, Motion, Moved};
use super::push::relative;
use crate::collide::approach::Approach;
use crate::collide::{Contact, SolvedContact};
use crate::model::Model;
use nalgebra::Vector3;

/// Least change of a body's velocity, of its speed: impulses as of a gap that just closes are not asked to obey to the
/// last digit. The rounding of velocities, 1e-15, is then 1e-10 of them.
const SMALL: f64 = 1e-5;

/// A contact as the law sees it.
struct Seen {
    met: Met,
    /// ρ: one over the trace of its own block of A.
    step_length: f64,
    /// The normal velocity that the law asks for at least: u_n ≥ least.
    least: f64,
    /// The same of a contact without restitution; and whether it strikes, so that restitution matters.
    floor: f64,
    strikes: bool,
}

impl Seen {
    fn new(
        model: &Model,
        (contact, met): (&Contact, &Met),
        moved: &[Moved],
        (approach, step_s): (Approach, f64),
    ) -> Self {
        let before = contact.normal.dot(&met.before);
        let motion = [before, contact.normal.dot(&met.free) - before];
        let least = approach.least(model, contact, motion, step_s).unwrap_or(f64::NAN);
        let plastic = Contact { restitution: 0.0, ..*contact };
        let floor = approach.least(model, &plastic, motion, step_s).unwrap_or(f64::NAN);
        // After an impact half-way the step's forces may take back what rebounds.
        let floor = if approach == Approach::Middle { floor.min(motion[1]) } else { floor };
        Seen {
            met: *met,
            step_length: 1.0 / contact.ends().map(|(i, r, _)| moved[i].compliance(&r)).sum::<f64>(),
            least,
            floor,
            strikes: approach.strikes(model, contact, motion, step_s),
        }
    }

    /// Of an impact by another law than Newton's, in impulses: how far p is outside of the cone, and of what would stop
    /// the approach that is left.
    fn missed_by_impact(&self, contact: &Contact, impulse_W: &Vector3<f64>) -> f64 {
        let outside = (impulse_W - in_cone(impulse_W, &contact.normal, contact.friction)).norm();
        let approach = self.floor - contact.normal.dot(&self.met.after);
        outside.max(self.step_length * approach)
    }

    /// Friction is against the velocity after; a kick half-way through the motion may put it against the mean instead.
    fn missed(&self, contact: &Contact, impulse_W: &Vector3<f64>, approach: Approach) -> f64 {
        let Met { before, after, .. } = &self.met;
        let tangent = before - contact.normal * contact.normal.dot(before);
        if self.strikes && contact.tangential_restitution > 0.0 {
            return self.missed_at(&(after + tangent * contact.tangential_restitution), contact, impulse_W);
        }
        let missed = self.missed_at(after, contact, impulse_W);
        if approach != Approach::Middle {
            return missed;
        }
        missed.min(self.missed_at(&(after + tangent), contact, impulse_W))
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

/// What the residual of a contact is compared with: the least impulse that would do to one of its bodies, at the
/// contact, what the step does to it there.
fn scale(contact: &Contact, moved: &[Moved]) -> f64 {
    let of_body = |(i, r, _): (usize, Vector3<f64>, f64)| {
        let (r_m, of) = (r.norm(), &moved[i]);
        let speed = |motion: &Motion| motion.reach(r_m);
        let changes = speed(&of.changed).max(speed(&of.gained)).max(SMALL * speed(&of.free));
        changes / of.compliance(&r)
    };
    // What is driven has no compliance: nothing moves it.
    let moving = contact.ends().filter(|(i, r, _)| moved[*i].compliance(r) > 0.0);
    moving.map(of_body).fold(f64::INFINITY, f64::min)
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
    /// Of every island by its first body: some contact strikes.
    struck: Vec<bool>,
    pub max: Option<f64>,
}

impl ResidualLedger {
    pub fn new(judged: bool, newton: bool, bodies: usize) -> Self {
        ResidualLedger { judged, newton, struck: Vec::with_capacity(bodies), max: None }
    }

    /// Contacts with their impulses; how the step went through them, and its length.
    pub(super) fn observe(
        &mut self,
        model: &Model,
        contacts: &[SolvedContact],
        exchange: &Exchange,
        (approach, step_s): (Approach, f64),
    ) {
        if !self.judged || contacts.is_empty() {
            return;
        }
        let seen = |of: (&Contact, &Met)| Seen::new(model, of, &exchange.moved, (approach, step_s));
        self.struck.clear();
        self.struck.resize(exchange.moved.len(), false);
        if !self.newton {
            for (SolvedContact { contact, .. }, met) in contacts.iter().zip(&exchange.met) {
                self.struck[met.island] |= seen((contact, met)).strikes;
            }
        }
        let missed = |(SolvedContact { contact, impulse_W }, met): (&SolvedContact, &Met)| {
            let missed = if self.struck[met.island] {
                seen((contact, met)).missed_by_impact(contact, impulse_W)
            } else {
                seen((contact, met)).missed(contact, impulse_W, approach)
            };
            relative(missed, scale(contact, &exchange.moved))
        };
        let largest = contacts.iter().zip(&exchange.met).map(missed).fold(0.0, f64::max);
        self.max = Some(self.max.map_or(largest, |max| max.max(largest)));
    }
}

//! The outside judge of contact: how far impulses are from the law of contact, whoever found them.
//!
//! Signorini's condition, Coulomb's disc and maximum dissipation together say that p is in Coulomb's cone K, ũ in its
//! dual, and p ⟂ ũ, where ũ = u + μ|u_t| n and u is the velocity after the contacts (G. De Saxcé, Z.-Q. Feng, Math.
//! Comput. Modelling 28 (1998) 225). That is p = P_K(p − ρ ũ) for every ρ > 0, and what the two sides differ by is the
//! residual of a contact (V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems, Springer 2008).
//!
//! A contact that lasts through steps whose kick is half-way (`collide::lasting`: by what the steps before it showed)
//! obeys the law in the mean of the velocities before and after: u is u⁻ + u⁺. Friction of one that slid may be against
//! the velocity at the end of the step instead, as of one that is new: it comes to rest then, where the mean would turn
//! its slip over for ever. That is u⁺ and half of what its slip changed by from the last kick to this one.
//!
//! In an impact with tangential restitution u_t stands for u_t⁺ + ε_t u_t⁻, from the velocities before and after.
//!
//! With 1/ρ = the trace of the contact's own block of A all terms are impulses. They are compared with the least of
//! ρᵢ sᵢ over the bodies that the contact can move, 1/ρᵢ the body's part of that trace and sᵢ what the step does to it
//! there: so that a light body under a heavy one counts, and neither masses nor lengths nor times matter. Rounding
//! gives 1e-16 … 1e-13 times the ratio of the masses, a wrong impulse O(1).

use super::exchange::{Exchange, Met, Motion, Moved};
use super::push::relative;
use crate::collide::approach::{Approach, NormalMotion, comes, rebounding};
use crate::collide::closed::is_closed_to_rounding;
use crate::collide::lasting::{Hold, Lasting};
use crate::collide::{Contact, Key, Partner, SolvedContact, pinned_to};
use crate::model::Model;
use nalgebra::Vector3;

/// Least change of a body's velocity, of its speed: impulses as of a gap that just closes are not asked to obey to the
/// last digit. The rounding of velocities, 1e-15, is then 1e-10 of them.
const SMALL: f64 = 1e-5;

/// Least change of a body's velocity, of the fastest that any has been: where nothing presses, what has come to rest is
/// left with the rounding of what it was.
const LEFT: f64 = 1e-10;

/// Of what forces do to a body in a step: what they do to one that is held, at most, as one that pivots.
const HELD: f64 = 3.0;

/// What presses a body.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Pressing {
    Nothing,
    One(Partner),
    Several,
}

impl Pressing {
    fn note(&mut self, partner: Partner) {
        *self = match self {
            Pressing::Nothing => Pressing::One(partner),
            Pressing::One(own) if *own == partner => return,
            _ => Pressing::Several,
        };
    }

    /// Whether there is something beside this.
    fn has_beside(self, partner: Partner) -> bool {
        self == Pressing::Several || matches!(self, Pressing::One(own) if own != partner)
    }
}

/// A contact as the law sees it, in a step that goes so through contacts and is so long.
struct Seen<'a> {
    model: &'a Model,
    contact: &'a Contact,
    met: &'a Met,
    through: (Approach, f64),
    /// What friction did before, where the contact lasts.
    hold: Option<Hold>,
    motion: NormalMotion,
    /// What the step's forces may do here to bodies one of which something else holds, in m/s; 0: nothing does.
    held_m_s: f64,
    /// The normal velocity that it is judged by; none: that of the law.
    asked: Option<f64>,
    /// ρ: one over the trace of its own block of A.
    step_length: f64,
    /// What the residual is compared with: the least impulse that would do to one of its bodies, at the contact, what
    /// the step does to it there.
    scale: f64,
}

impl<'a> Seen<'a> {
    fn new(
        model: &'a Model,
        (contact, met): (&'a Contact, &'a Met),
        (moved, pressing): (&[Moved], &[Pressing]),
        least_m_s: f64,
        through: (Approach, f64),
        hold: Option<Hold>,
    ) -> Self {
        let (mut trace, mut scale) = (0.0, f64::INFINITY);
        let (mut forced_m_s, mut is_held) = (0.0, false);
        for (i, r, _) in contact.ends() {
            forced_m_s += HELD * moved[i].gained.reach(r.norm());
            is_held |= pressing[i].has_beside(contact.partner_of(i));
            let (of, r_m, compliance) = (&moved[i], r.norm(), moved[i].compliance(&r));
            trace += compliance;
            // What is driven has no compliance: nothing moves it.
            if compliance > 0.0 {
                let speed = |motion: &Motion| motion.reach(r_m);
                let acted = speed(&of.changed).max(speed(&of.gained)).max(of.pressed_m_s);
                let changes = acted.max(SMALL * speed(&of.free)).max(least_m_s);
                scale = scale.min(changes / compliance);
            }
        }
        let [before, free, turning] = [met.before, met.free, met.turning].map(|u| contact.normal.dot(&u));
        let motion = NormalMotion { before, gained: free - before, turning };
        let held_m_s = if is_held { forced_m_s } else { 0.0 };
        Seen { model, contact, met, through, hold, motion, held_m_s, asked: None, step_length: 1.0 / trace, scale }
    }

    /// The normal velocity that the law asks for at least, u_n ≥ least. None: the contact is not there in this step.
    fn least(&self, contact: &Contact) -> Option<f64> {
        let (approach, step_s) = self.through;
        self.asked.or_else(|| approach.least_of(self.model, contact, self.motion, step_s, self.hold))
    }

    /// Whether restitution matters.
    fn strikes(&self) -> bool {
        let (approach, step_s) = self.through;
        self.hold.is_none() && approach.strikes(self.model, self.contact, self.motion, step_s)
    }

    /// What friction does where the contact lasts on.
    fn holds_on(&self, impulse_W: &Vector3<f64>) -> Option<Hold> {
        let (approach, step_s) = self.through;
        let normal = &self.contact.normal;
        let pressed = normal.dot(impulse_W);
        let hold = Hold::of(self.contact, pressed, (impulse_W - normal * pressed).norm(), &self.met.after)?;
        approach.lasts(self.model, self.contact, self.motion, step_s, self.hold).then_some(hold)
    }

    /// Of an impact by another law than Newton's, in impulses: how far p is outside of the cone, and of what would stop
    /// the approach that is left.
    fn missed_by_impact(&self, impulse_W: &Vector3<f64>) -> f64 {
        let Contact { normal, friction, .. } = self.contact;
        let outside = (impulse_W - in_cone(impulse_W, normal, *friction)).norm();
        let Some(floor) = self.least(&Contact { restitution: 0.0, ..*self.contact }) else { return impulse_W.norm() };
        // After an impact half-way the step's forces may take back what rebounds.
        let floor = if self.through.0 == Approach::Middle { floor.min(self.motion.gained) } else { floor };
        outside.max(self.step_length * (floor - normal.dot(&self.met.after)))
    }

    /// A gap closes by the mean velocity through the step, or, where the contacts would give energy for that, by the
    /// velocity after the impulses.
    fn missed(&self, impulse_W: &Vector3<f64>, is_struck: bool) -> f64 {
        let missed = |seen: &Seen| match is_struck {
            true => seen.missed_by_impact(impulse_W),
            false => seen.missed_by_mean(impulse_W),
        };
        let mut found = missed(self);
        if self.motion.turning != 0.0 {
            let motion = NormalMotion { turning: 0.0, ..self.motion };
            found = found.min(missed(&Seen { motion, ..*self }));
        }
        // What others hold the forces do not move: how much is left of that is the steps' affair.
        let is_start = self.through.0 == Approach::Start && !is_struck;
        if is_start && self.held_m_s > 0.0 && self.contact.restitution > 0.0 && self.strikes() {
            let asked = |gained| rebounding(self.model, self.contact, self.motion, gained, self.through.1);
            let after = self.contact.normal.dot(&self.met.after);
            let asked = Some(after.clamp(asked(-self.held_m_s), asked(0.0)));
            found = found.min(missed(&Seen { asked, ..*self }));
        }
        // A gap that stays open, as other impulses part the bodies first, has nothing to send back.
        let is_left = self.through.0 == Approach::Start && *impulse_W == Vector3::zeros();
        if is_left && self.contact.restitution > 0.0 && !is_closed_to_rounding(self.model, self.contact) {
            let contact = &Contact { restitution: 0.0, tangential_restitution: 0.0, ..*self.contact };
            found = found.min(missed(&Seen { contact, ..*self }));
        }
        found
    }

    /// Friction is against the velocity after, where a contact lasts against the mean.
    fn missed_by_mean(&self, impulse_W: &Vector3<f64>) -> f64 {
        let Contact { normal, tangential_restitution, .. } = self.contact;
        let Met { before, after, .. } = self.met;
        let Some(least) = self.least(self.contact) else { return impulse_W.norm() };
        let tangent = before - normal * normal.dot(before);
        if *tangential_restitution > 0.0 && self.strikes() {
            return self.missed_at(&(after + tangent * *tangential_restitution), least, impulse_W);
        }
        let missed = |u: &Vector3<f64>| self.missed_at(u, least, impulse_W);
        match self.hold {
            Some(Hold::Stuck) => missed(&(after + tangent)),
            Some(Hold::Slid(last)) => {
                let drift = (tangent - (last - normal * normal.dot(&last))) / 2.0;
                missed(&(after + tangent)).min(missed(&(after + drift)))
            }
            None if self.through.0 == Approach::Middle && !self.strikes() => {
                missed(&(after + tangent)).min(missed(after))
            }
            None => missed(after),
        }
    }

    /// |p − P_K(p − ρ ũ)|.
    fn missed_at(&self, u: &Vector3<f64>, least: f64, impulse_W: &Vector3<f64>) -> f64 {
        let Contact { normal, friction, .. } = self.contact;
        let slip = (u - normal * normal.dot(u)).norm();
        let dual = u + normal * (friction * slip - least);
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
    /// Of every island by its first body: some contact strikes.
    struck: Vec<bool>,
    /// Of every body: what presses it, where anything rebounds.
    pressing: Vec<Pressing>,
    /// What lasts into the next step, and what the step shows of that.
    /// None: no contact does, whatever a step shows.
    lasting: Option<Lasting>,
    last_on: Vec<(Key, Hold)>,
    /// The fastest that a body has been at a contact.
    fastest_m_s: f64,
    pub max: Option<f64>,
}

impl ResidualLedger {
    /// `lasting`: what is closed and at rest at the start, of a method whose steps kick half-way.
    pub fn new(judged: bool, newton: bool, bodies: usize, lasting: Option<Lasting>) -> Self {
        let (struck, pressing) = (Vec::with_capacity(bodies), Vec::with_capacity(bodies));
        ResidualLedger { judged, newton, struck, pressing, lasting, last_on: Vec::new(), fastest_m_s: 0.0, max: None }
    }

    /// Contacts with their impulses; how the step went through them, and its length.
    pub(super) fn observe(
        &mut self,
        model: &Model,
        contacts: &[SolvedContact],
        exchange: &Exchange,
        through: (Approach, f64),
    ) {
        if !self.judged {
            return;
        }
        let is_half_way = through.0 == Approach::Middle;
        self.fastest_m_s = exchange.moved.iter().map(|moved| moved.free.v.norm()).fold(self.fastest_m_s, f64::max);
        let least_m_s = LEFT * self.fastest_m_s;
        let ResidualLedger { newton, struck, pressing, lasting, last_on, max, .. } = self;
        pressing.clear();
        pressing.resize(exchange.moved.len(), Pressing::Nothing);
        if contacts.iter().any(|solved| solved.contact.restitution > 0.0) {
            for SolvedContact { contact, .. } in contacts.iter().filter(|solved| solved.impulse_W != Vector3::zeros()) {
                contact.ends().for_each(|(i, ..)| pressing[i].note(contact.partner_of(i)));
            }
            for (i, pressing) in pressing.iter_mut().enumerate().take_while(|_| !model.pins.is_empty()) {
                pinned_to(model, i).for_each(|partner| pressing.note(partner));
            }
        }
        let pressing = &*pressing;
        let seen = |contact, met| {
            let hold = lasting.as_ref().and_then(|lasting| lasting.of(contact)).filter(|_| is_half_way);
            Seen::new(model, (contact, met), (&exchange.moved, pressing), least_m_s, through, hold)
        };
        last_on.clear();
        struck.clear();
        struck.resize(exchange.moved.len(), false);
        if !*newton {
            for (solved, met) in contacts.iter().zip(&exchange.met) {
                let seen = seen(&solved.contact, met);
                let speeds = solved.contact.ends().map(|(i, r, _)| exchange.moved[i].free.reach(r.norm()));
                let is_impact = matches!(through.0, Approach::Inside | Approach::Touching);
                struck[met.island] |= seen.strikes() && (is_impact || comes(seen.motion, speeds));
            }
        }
        for (SolvedContact { contact, impulse_W }, met) in contacts.iter().zip(&exchange.met) {
            // What another law than Newton's has not struck does not rebound.
            let is_plastic = !*newton && through.0 == Approach::Start;
            let plastic = Contact { restitution: 0.0, tangential_restitution: 0.0, ..*contact };
            let (seen, is_struck) = (seen(contact, met), struck[met.island]);
            let seen = if is_plastic { Seen { contact: &plastic, ..seen } } else { seen };
            *max = Some(max.unwrap_or(0.0).max(relative(seen.missed(impulse_W, is_struck), seen.scale)));
            if lasting.is_some() && !is_struck {
                last_on.extend(seen.holds_on(impulse_W).map(|hold| (contact.key(), hold)));
            }
        }
        if let Some(lasting) = lasting {
            lasting.renew(last_on.drain(..));
        }
    }
}

//! One contact of a problem, gathered: its rows, its part of A and of b.

use super::end::{End, Inertia};
use super::law::Law;
use super::twist::Twist;
use super::{Impulse, corrected};
use crate::collide::Contact;
use crate::collide::approach::{Approach, NormalMotion, rebounding};
use crate::collide::lasting::Hold;
use crate::experiment::types::Cone;
use crate::model::Model;
use crate::state::BodyState;
use nalgebra::{Matrix3, Vector3};

/// One contact or pin: its three rows, its 3×3 block of A, its part of b.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    pub end: End,
    /// None: the container.
    pub other: Option<End>,
    pub friction: f64,
    pub A: Matrix3<f64>,
    /// D⁻¹ of the lecture.
    pub inverse_diagonal: Vector3<f64>,
    /// 1/λmax of the tangents' 2×2 block of A.
    pub tangent_step: f64,
    pub b: Vector3<f64>,
    /// The normal velocity that is asked for at least; b's normal row is relative to it.
    pub least: f64,
    /// As `least` has it (`NormalMotion::turning`).
    pub turning: f64,
    /// Of an impact: what the step's forces and what holds the bodies add to their approach, where that is not what the
    /// forces do alone, in m/s.
    pub held: Option<f64>,
    /// Relative velocity before the step, in the contact's frame.
    pub before: Vector3<f64>,
    /// ε_t of an impact, which b's tangents' rows are relative to; else 0.
    pub tangential_restitution: f64,
    /// The contact lasts: b's normal row is relative to the velocity before sent back.
    pub hold: Option<Hold>,
    /// Friction is against the mean of the velocities before and after.
    pub meant: bool,
    /// What friction is against beside the velocity after: the tangents' rows of b have it.
    pub(super) against: Vector3<f64>,
    /// Normal and two tangents, world axes.
    pub frame: [Vector3<f64>; 3],
    /// A⁻¹ of a pin, which takes any impulse; none: a contact.
    pub pin: Option<Matrix3<f64>>,
}

impl Block {
    /// c = b + J u.
    pub fn velocity(&self, u: &[Twist]) -> Vector3<f64> {
        self.b + self.motion(u)
    }

    /// J u.
    pub(super) fn motion(&self, u: &[Twist]) -> Vector3<f64> {
        let own = self.end.motion(&u[self.end.body]);
        self.other.as_ref().map_or(own, |other| own + other.motion(&u[other.body]))
    }

    /// u += M⁻¹ Jᵀ Δp.
    pub(super) fn apply(&self, change: &Impulse, u: &mut [Twist]) {
        self.end.apply(change, u);
        if let Some(other) = &self.other {
            other.apply(change, u);
        }
    }

    /// The contact as its one or two bodies see it.
    pub fn ends(&self) -> impl Iterator<Item = &End> {
        std::iter::once(&self.end).chain(&self.other)
    }

    /// The normal row of J u.
    pub fn normal_motion(&self, u: &[Twist]) -> f64 {
        self.ends().map(|end| end.rows[0].along(&u[end.body])).sum()
    }

    /// u += M⁻¹ J_nᵀ Δp.
    pub fn apply_normal(&self, change: f64, u: &mut [Twist]) {
        self.ends().for_each(|end| u[end.body].add_scaled(&end.rows[0].response, change));
    }

    /// The 3×3 block of A between two contacts.
    pub(super) fn coupling(&self, with: &Block) -> Matrix3<f64> {
        let mut A = Matrix3::zeros();
        for a in self.ends() {
            for b in with.ends().filter(|b| b.body == a.body) {
                A += a.coupling(b);
            }
        }
        A
    }

    /// M⁻¹ Jᵀ p of its body, and of its other one.
    #[inline]
    pub fn responses(&self, p: &Impulse) -> [Twist; 2] {
        [self.end.response(p), self.other.as_ref().map_or(Twist::ZERO, |other| other.response(p))]
    }

    /// One row of J times what a block, this or another, does to its two bodies.
    #[inline]
    pub fn row_of(&self, row: usize, with: &Block, responses: &[Twist; 2]) -> f64 {
        if self.other.is_none() && with.other.is_none() {
            let is_shared = self.end.body == with.end.body;
            return if is_shared { self.end.rows[row].along(&responses[0]) } else { 0.0 };
        }
        let of = |end: &End| {
            let on_it = with.ends().zip(responses).filter(|(other, _)| other.body == end.body);
            on_it.map(|(_, response)| end.rows[row].along(response)).sum::<f64>()
        };
        self.ends().map(of).sum()
    }

    pub(super) fn new(
        contact: &Contact,
        model: &Model,
        states: &[BodyState],
        free: &[Twist],
        inertias: &[Inertia],
        (approach, step_s): (Approach, f64),
        hold: Option<Hold>,
    ) -> Option<Self> {
        let frame = contact.frame();
        let own = End::new(contact.body, 1.0, &contact.r_BC_W, &frame, &inertias[contact.body]);
        let other = contact.other.map(|other| End::new(other, -1.0, &contact.r_OC_W, &frame, &inertias[other]));
        let of_free = |end: &End| end.motion(&free[end.body]);
        let of_before = |end: &End| end.motion(&Twist::of(&states[end.body]));
        let (mut b, mut before, mut A) = (of_free(&own), of_before(&own), own.coupling(&own));
        if let Some(other) = &other {
            b += of_free(other);
            before += of_before(other);
            A += other.coupling(other);
        }
        let motion = NormalMotion { before: before.x, gained: b.x - before.x, turning: 0.0 };
        let least = approach.least_of(model, contact, motion, step_s, hold)?;
        let strikes =
            hold.is_none() && contact.tangential_restitution > 0.0 && approach.strikes(model, contact, motion, step_s);
        let tangential_restitution = if strikes { contact.tangential_restitution } else { 0.0 };
        b.x -= least;
        let sent_back = if hold.is_some() { 1.0 } else { tangential_restitution };
        let against = Vector3::new(0.0, before.y, before.z) * sent_back;
        if sent_back > 0.0 {
            b += against;
        }
        Some(Block {
            end: own,
            other,
            friction: contact.friction,
            A,
            inverse_diagonal: A.diagonal().map(|d| 1.0 / d),
            tangent_step: 1.0 / largest_eigenvalue(A[(1, 1)], A[(2, 2)], A[(1, 2)]),
            b,
            least,
            turning: 0.0,
            held: None,
            before,
            tangential_restitution,
            hold,
            meant: hold.is_some(),
            against,
            frame,
            pin: None,
        })
    }

    /// Asks for another normal velocity at least.
    pub fn ask_for(&mut self, least: f64) {
        self.b.x += self.least - least;
        self.least = least;
    }

    /// Asks an impact for the rebound of bodies that others hold: these and the step's forces add `gained` to it, in
    /// m/s.
    pub fn hold_at(&mut self, contact: &Contact, model: &Model, gained: f64, step_s: f64) {
        self.held = Some(gained);
        let motion = NormalMotion { before: self.before.x, gained, turning: self.turning };
        self.ask_for(rebounding(model, contact, motion, gained, step_s));
    }

    /// Asks for what the bodies' free turning beyond their angular velocities after the step leaves of the gap.
    pub(super) fn turn(&mut self, contact: &Contact, model: &Model, turning: f64, (approach, step_s): (Approach, f64)) {
        let gained = self.b.x + self.least - self.before.x;
        let motion = NormalMotion { before: self.before.x, gained, turning };
        let held = self.held.map(|held| rebounding(model, contact, motion, held, step_s));
        if let Some(least) = held.or_else(|| approach.least(model, contact, motion, step_s)) {
            self.ask_for(least);
            self.turning = turning;
        }
    }

    /// Puts friction against the velocity after the step, or against the mean of those before and after.
    pub(super) fn mean(&mut self, meant: bool) {
        if meant != self.meant {
            self.put_against(if meant { Vector3::new(0.0, self.before.y, self.before.z) } else { Vector3::zeros() });
            self.meant = meant;
        }
    }

    fn put_against(&mut self, against: Vector3<f64>) {
        self.b += against - self.against;
        self.against = against;
    }

    /// Lets a contact that slid come to rest, if that is what it would turn its slip over for. The kick is half-way:
    /// what the slip has changed by since the last one, as bodies and what they slide on moved on, half of it belongs
    /// to this step, and as much comes after the kick. Whether it does. `small`: a slip that is none.
    pub(super) fn stop(&mut self, u: &[Twist], small: f64) -> bool {
        let Some(Hold::Slid(last_W)) = self.hold else { return false };
        let changed = self.before - self.in_frame(&last_W);
        let drift = Vector3::new(0.0, changed.y, changed.z) / 2.0;
        let (began, ends) = (self.before - drift, self.after(u) + drift);
        let is_some = |slip: &Vector3<f64>| slip.yz().norm() > small;
        let turns = began.yz().dot(&ends.yz()) < 0.0 && is_some(&began) && is_some(&ends);
        if turns {
            self.hold = Some(Hold::Stuck);
            self.meant = false;
            self.put_against(drift);
        }
        turns
    }

    /// Normal velocity after the step and what of it is along the surface.
    pub(super) fn after(&self, u: &[Twist]) -> Vector3<f64> {
        self.velocity(u) + Vector3::new(self.least, 0.0, 0.0) - self.against
    }

    /// Twice the energy that an impulse gives the bodies, from their velocities with the step's forces on, and the size
    /// of its terms.
    pub fn given_j(&self, p: &Impulse, u: &[Twist]) -> (f64, f64) {
        let least = Vector3::new(self.least, 0.0, 0.0);
        let (free, after) = (self.b + least, self.velocity(u) + least);
        (p.dot(&(free + after)), p.norm() * (free.norm() + after.norm()))
    }

    /// How far the gap of a contact that lasts swings in a step, at most.
    pub(super) fn swing(&self, step_s: f64) -> f64 {
        let gained = self.b.x + self.least - self.before.x;
        let swings = step_s * (self.before.x.abs() + gained.abs());
        if self.hold.is_some() { swings } else { 0.0 }
    }

    pub(super) fn law(&self) -> Law {
        if self.pin.is_some() { Law::Pin } else { Law::Contact { friction: self.friction } }
    }

    /// The impulse back in its cone.
    pub(super) fn corrected(&self, p: &Impulse, cone: Cone) -> Impulse {
        if self.pin.is_some() { *p } else { corrected(p, self.friction, cone) }
    }

    /// The part of a vector along the surface, in world axes.
    pub fn along_W(&self, v: &Vector3<f64>) -> Vector3<f64> {
        self.frame[1] * v.y + self.frame[2] * v.z
    }

    /// An impulse of world axes in the contact's.
    pub fn in_frame(&self, impulse_W: &Vector3<f64>) -> Impulse {
        Impulse::new(self.frame[0].dot(impulse_W), self.frame[1].dot(impulse_W), self.frame[2].dot(impulse_W))
    }

    /// An impulse in world axes.
    pub fn in_world(&self, p: &Impulse) -> Vector3<f64> {
        self.frame[0] * p.x + self.frame[1] * p.y + self.frame[2] * p.z
    }
}

/// Of the symmetric matrix [a c; c b].
pub(super) fn largest_eigenvalue(a: f64, b: f64, c: f64) -> f64 {
    let half = (a - b) / 2.0;
    (a + b) / 2.0 + (half * half + c * c).sqrt()
}

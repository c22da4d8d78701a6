//! Contacts gathered once for every solver (L12, L13, L16): J, M⁻¹ and b, with A = J M⁻¹ Jᵀ as a view of them.
//!
//! With impulses p = F Δt the slide's ᶜV_C[n+1] = b + A ᶜF_C reads c = b + (J M⁻¹ Jᵀ) p. Rows of a contact are ordered
//! normal, tangent 1, tangent 2. The target is c = 0; what else is asked of the
//! normal velocity (restitution, a gap that may close) is taken off the normal row of b (`collide::approach`), and an
//! impact's tangential restitution off the tangents' rows: friction is then against the slip u_t⁺ + ε_t u_t⁻.

use crate::collide::Contact;
use crate::collide::approach::Approach;
use crate::experiment::types::Cone;
use crate::model::{Body, Model};
use crate::state::{BodyState, State};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::law::Law;
use super::{Impulse, corrected};

/// Velocity of a body, or a change of it: the lecture's generalised V (L13).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    pub v: Vector3<f64>,
    pub w: Vector3<f64>,
}

impl Twist {
    pub const ZERO: Twist = Twist { v: Vector3::new(0.0, 0.0, 0.0), w: Vector3::new(0.0, 0.0, 0.0) };

    pub fn of(at: &BodyState) -> Self {
        Twist { v: at.v_WB, w: at.w_WB }
    }

    /// A part of the way to another one.
    pub fn toward(&self, other: &Twist, part: f64) -> Twist {
        Twist { v: self.v + (other.v - self.v) * part, w: self.w + (other.w - self.w) * part }
    }

    pub fn times(&self, factor: f64) -> Twist {
        Twist { v: self.v * factor, w: self.w * factor }
    }

    fn add_scaled(&mut self, other: &Twist, factor: f64) {
        self.v += other.v * factor;
        self.w += other.w * factor;
    }
}

/// One row of J and of M⁻¹Jᵀ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    /// [eᵀ (u_c × e)ᵀ]: times V, the contact point's velocity along e.
    pub(super) j: Twist,
    /// What a unit impulse along e does to V.
    response: Twist,
}

impl Row {
    fn along(&self, u: &Twist) -> f64 {
        self.j.v.dot(&u.v) + self.j.w.dot(&u.w)
    }
}

/// What a contact is to one of its bodies.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub body: usize,
    pub(super) rows: [Row; 3],
}

impl End {
    /// `sign`: of the contact's impulse on this body.
    fn new(body: usize, sign: f64, r_W: &Vector3<f64>, frame: &[Vector3<f64>; 3], inertia: &Inertia) -> Self {
        let rows = frame.map(|e| {
            let e = e * sign;
            let j = Twist { v: e, w: r_W.cross(&e) };
            Row { j, response: Twist { v: e / inertia.mass_kg, w: inertia.inverse_W * j.w } }
        });
        End { body, rows }
    }

    /// J u.
    fn motion(&self, u: &Twist) -> Vector3<f64> {
        Vector3::new(self.rows[0].along(u), self.rows[1].along(u), self.rows[2].along(u))
    }

    /// u += M⁻¹ Jᵀ Δp.
    fn apply(&self, change: &Impulse, u: &mut [Twist]) {
        for (row, p) in self.rows.iter().zip(change.iter()) {
            u[self.body].add_scaled(&row.response, *p);
        }
    }

    /// J M⁻¹ Jᵀ of two contacts, if it is the same body's.
    fn coupling(&self, other: &End) -> Option<Matrix3<f64>> {
        let (rows, others) = (&self.rows, &other.rows);
        (self.body == other.body).then(|| Matrix3::from_fn(|i, j| rows[i].along(&others[j].response)))
    }
}

/// M of one body; infinite where nothing moves it.
#[derive(Clone, Copy, Debug)]
pub struct Inertia {
    pub mass_kg: f64,
    pub inverse_W: Matrix3<f64>,
}

impl Inertia {
    pub fn of(body: &Body, at: &BodyState) -> Self {
        if body.driven {
            return Inertia { mass_kg: f64::INFINITY, inverse_W: Matrix3::zeros() };
        }
        Inertia { mass_kg: body.mass_kg, inverse_W: body.I_W_inverse(at) }
    }
}

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
    /// Relative velocity before the step, in the contact's frame.
    pub before: Vector3<f64>,
    /// ε_t of an impact, which b's tangents' rows are relative to; else 0.
    pub tangential_restitution: f64,
    /// Normal and two tangents, world axes.
    pub frame: [Vector3<f64>; 3],
    /// A⁻¹ of a pin, which takes any impulse; none: a contact.
    pub pin: Option<Matrix3<f64>>,
}

/// A point of a body that is held, or follows a point of another body: v_rel + A p = `velocity_W`, p any impulse, in
/// world axes.
#[derive(Clone, Copy, Debug)]
pub struct Pin {
    pub end: PinEnd,
    pub other: Option<PinEnd>,
    /// Wanted, of the first end's point against the other's times their signs.
    pub velocity_W: Vector3<f64>,
}

#[derive(Clone, Copy, Debug)]
pub struct PinEnd {
    pub body: usize,
    /// Of the pin's impulse on this body.
    pub sign: f64,
    /// From the centre of mass to the point, world axes.
    pub r_W: Vector3<f64>,
}

/// All contacts of a step.
#[derive(Clone, Debug, Default)]
pub struct ContactProblem {
    pub blocks: Vec<Block>,
    bodies: usize,
    pub(super) inertias: Vec<Inertia>,
    /// Empty for many contacts.
    A_blocks: Vec<Matrix3<f64>>,
}

/// Contacts up to which A is worked out. A sweep costs 9 L² products with A and 36 L (in long chains) without it.
const DENSE: usize = 32;

impl ContactProblem {
    pub fn with_capacity(contacts: usize, bodies: usize) -> Self {
        ContactProblem {
            blocks: Vec::with_capacity(contacts),
            bodies: 0,
            inertias: Vec::with_capacity(bodies),
            A_blocks: Vec::with_capacity(contacts.min(DENSE) * contacts.min(DENSE)),
        }
    }

    /// `V = V[n] + M⁻¹ F_E Δt` is in `free`, the state before the step in `state`.
    /// Contacts that `approach` does not see in this step are dropped.
    pub fn gather(
        &mut self,
        model: &Model,
        state: &State,
        free: &[Twist],
        contacts: &mut Vec<Contact>,
        (approach, step_s): (Approach, f64),
    ) {
        self.blocks.clear();
        self.bodies = model.bodies.len();
        self.inertias.clear();
        if !contacts.is_empty() {
            self.inertias.extend(model.bodies.iter().zip(&state.bodies).map(|(body, at)| Inertia::of(body, at)));
        }
        contacts.retain(|contact| {
            let block = Block::new(contact, model, &state.bodies, free, &self.inertias, (approach, step_s));
            self.blocks.extend(block);
            block.is_some()
        });
        self.couple();
    }

    /// Adds pins to the contacts gathered; their impulses are the last ones.
    pub fn pin(&mut self, model: &Model, state: &State, free: &[Twist], pins: &[Pin]) {
        if self.inertias.is_empty() {
            self.inertias.extend(model.bodies.iter().zip(&state.bodies).map(|(body, at)| Inertia::of(body, at)));
        }
        self.blocks.extend(pins.iter().map(|pin| Block::of_pin(pin, free, &self.inertias)));
        self.couple();
    }

    fn couple(&mut self) {
        self.A_blocks.clear();
        if self.blocks.len() <= DENSE {
            let blocks = &self.blocks;
            self.A_blocks.extend(blocks.iter().flat_map(|row| blocks.iter().map(|column| row.coupling(column))));
        }
    }

    /// A was worked out: for few contacts that costs less than going through the bodies in every sweep.
    pub fn is_dense(&self) -> bool {
        !self.blocks.is_empty() && self.A_blocks.len() == self.blocks.len() * self.blocks.len()
    }

    /// A p by A's 3×3 blocks. Only if `is_dense`.
    pub fn dense(&self) -> Dense<'_> {
        Dense { A_blocks: &self.A_blocks }
    }

    /// A p = J (M⁻¹ Jᵀ p), without A.
    pub fn through_bodies<'a>(&self, impulses: &[Impulse], memory: &'a mut Memory) -> ThroughBodies<'a> {
        self.response(impulses, &mut memory.u);
        ThroughBodies { u: &mut memory.u }
    }

    /// u = M⁻¹ Jᵀ p.
    pub fn response(&self, impulses: &[Impulse], u: &mut Vec<Twist>) {
        u.clear();
        u.resize(self.bodies, Twist::ZERO);
        for (block, p) in self.blocks.iter().zip(impulses) {
            block.apply(p, u);
        }
    }

    /// ½ pᵀ A p + pᵀ b: for plastic contacts the kinetic energy that `p` adds.
    pub fn energy(&self, impulses: &[Impulse], u: &[Twist]) -> f64 {
        let half = |block: &Block, p: &Impulse| p.dot(&(block.velocity(u) + block.b)) / 2.0;
        self.blocks.iter().zip(impulses).map(|(block, p)| half(block, p)).sum()
    }

    /// Energy that the impulses take from bodies that were at `before`: −Σ p·½(c⁻ + c⁺).
    pub fn dissipated_j(&self, before: &State, free: &[Twist], impulses: &[Impulse], u: &[Twist]) -> f64 {
        let mean = |end: &End| {
            let (at, free, u) = (&before.bodies[end.body], &free[end.body], &u[end.body]);
            end.motion(&Twist { v: (at.v_WB + free.v + u.v) / 2.0, w: (at.w_WB + free.w + u.w) / 2.0 })
        };
        let taken = |(block, p): (&Block, &Impulse)| -p.dot(&block.ends().map(mean).sum::<Vector3<f64>>());
        self.blocks.iter().zip(impulses).map(taken).sum()
    }

    /// Impulses of an iteration that has not settled may add energy (a bar at μ = 1: up to 1.004 of it): only that part
    /// of them is kept which takes the most. The cones allow it, as they are cones; approaches that remain are next
    /// step's.
    pub fn take_back(&self, impulses: &mut [Impulse], u: &[Twist]) {
        let added = self.energy(impulses, u);
        // What holds a pin is no cone's to choose a part of.
        if added > 0.0 && self.blocks.iter().all(|block| block.pin.is_none()) {
            let linear: f64 = self.blocks.iter().zip(&*impulses).map(|(block, p)| p.dot(&block.b)).sum();
            let part = (-linear / (2.0 * (added - linear))).max(0.0);
            impulses.iter_mut().for_each(|p| *p *= part);
        }
    }

    /// b as it was before the bodies' velocities changed by `u`.
    pub fn take_off(&mut self, u: &[Twist]) {
        self.blocks.iter_mut().for_each(|block| block.b -= block.motion(u));
    }

    /// The same contacts once their bodies' velocities have changed by `u`: b is now c.
    pub fn after(&self, u: &[Twist]) -> ContactProblem {
        let mut after = self.clone();
        after.blocks.iter_mut().for_each(|block| block.b = block.velocity(u));
        after
    }

    /// The 3×3 block of A between two contacts.
    pub fn coupling(&self, i: usize, j: usize) -> Matrix3<f64> {
        if self.is_dense() {
            self.A_blocks[i * self.blocks.len() + j]
        } else {
            self.blocks[i].coupling(&self.blocks[j])
        }
    }

    /// A as a dense matrix, 3L × 3L.
    pub fn A(&self) -> DMatrix<f64> {
        let n = self.blocks.len();
        DMatrix::from_fn(3 * n, 3 * n, |i, j| self.blocks[i / 3].coupling(&self.blocks[j / 3])[(i % 3, j % 3)])
    }

    pub fn b(&self) -> DVector<f64> {
        DVector::from_iterator(3 * self.blocks.len(), self.blocks.iter().flat_map(|block| block.b.iter().copied()))
    }
}

/// How contacts feel each other: c = b + A p.
pub trait Coupling {
    /// c of contact `i` at the present impulses.
    fn velocity(&self, i: usize, block: &Block, p: &[Impulse]) -> Vector3<f64>;
    /// The contact's impulse has changed.
    fn moved(&mut self, block: &Block, change: &Impulse);
}

/// Through A itself.
pub struct Dense<'a> {
    /// Block (i, j) at i L + j.
    A_blocks: &'a [Matrix3<f64>],
}

impl Coupling for Dense<'_> {
    #[inline(always)]
    fn velocity(&self, i: usize, block: &Block, p: &[Impulse]) -> Vector3<f64> {
        let row = &self.A_blocks[i * p.len()..][..p.len()];
        row.iter().zip(p).fold(block.b, |c, (A, p)| c + A * p)
    }

    #[inline(always)]
    fn moved(&mut self, _: &Block, _: &Impulse) {}
}

/// Through the bodies' velocities.
pub struct ThroughBodies<'a> {
    /// M⁻¹ Jᵀ p.
    u: &'a mut [Twist],
}

impl Coupling for ThroughBodies<'_> {
    fn velocity(&self, _: usize, block: &Block, _: &[Impulse]) -> Vector3<f64> {
        block.velocity(self.u)
    }

    fn moved(&mut self, block: &Block, change: &Impulse) {
        if *change != Impulse::zeros() {
            block.apply(change, self.u);
        }
    }
}

/// Memory of `ThroughBodies` between steps.
#[derive(Clone, Debug, Default)]
pub struct Memory {
    u: Vec<Twist>,
}

impl Memory {
    pub fn with_capacity(bodies: usize) -> Self {
        Memory { u: Vec::with_capacity(bodies) }
    }
}

impl Block {
    /// c = b + J u.
    pub fn velocity(&self, u: &[Twist]) -> Vector3<f64> {
        self.b + self.motion(u)
    }

    /// J u.
    fn motion(&self, u: &[Twist]) -> Vector3<f64> {
        let own = self.end.motion(&u[self.end.body]);
        self.other.as_ref().map_or(own, |other| own + other.motion(&u[other.body]))
    }

    /// u += M⁻¹ Jᵀ Δp.
    fn apply(&self, change: &Impulse, u: &mut [Twist]) {
        self.ends().for_each(|end| end.apply(change, u));
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
    fn coupling(&self, with: &Block) -> Matrix3<f64> {
        let pairs = self.ends().flat_map(|a| with.ends().map(move |b| (a, b)));
        pairs.filter_map(|(a, b)| a.coupling(b)).reduce(|a, b| a + b).unwrap_or_else(Matrix3::zeros)
    }

    fn new(
        contact: &Contact,
        model: &Model,
        before: &[BodyState],
        free: &[Twist],
        inertias: &[Inertia],
        (approach, step_s): (Approach, f64),
    ) -> Option<Self> {
        let frame = contact.frame();
        let own = End::new(contact.body, 1.0, &contact.r_BC_W, &frame, &inertias[contact.body]);
        let other = contact.other.map(|other| End::new(other, -1.0, &contact.r_OC_W, &frame, &inertias[other]));
        let ends = || std::iter::once(&own).chain(&other);
        let sum = |of: &dyn Fn(&End) -> Vector3<f64>| ends().map(of).reduce(|a, b| a + b).unwrap_or_default();
        let mut b = sum(&|end| end.motion(&free[end.body]));
        let before = sum(&|end| {
            let at = &before[end.body];
            end.motion(&Twist::of(at))
        });
        let motion = [before.x, b.x - before.x];
        let least = approach.least(model, contact, motion, step_s)?;
        let strikes = contact.tangential_restitution > 0.0 && approach.strikes(model, contact, motion, step_s);
        let tangential_restitution = if strikes { contact.tangential_restitution } else { 0.0 };
        b.x -= least;
        if strikes {
            b += Vector3::new(0.0, before.y, before.z) * tangential_restitution;
        }
        let A = ends().filter_map(|end| end.coupling(end)).reduce(|a, b| a + b).unwrap_or_default();
        Some(Block {
            end: own,
            other,
            friction: contact.friction,
            A,
            inverse_diagonal: A.diagonal().map(|d| 1.0 / d),
            tangent_step: 1.0 / largest_eigenvalue(A[(1, 1)], A[(2, 2)], A[(1, 2)]),
            b,
            least,
            before,
            tangential_restitution,
            frame,
            pin: None,
        })
    }

    fn of_pin(pin: &Pin, free: &[Twist], inertias: &[Inertia]) -> Self {
        let frame = [Vector3::x(), Vector3::y(), Vector3::z()];
        let end = |end: &PinEnd| End::new(end.body, end.sign, &end.r_W, &frame, &inertias[end.body]);
        let (end, other) = (end(&pin.end), pin.other.as_ref().map(end));
        let ends = || std::iter::once(&end).chain(&other);
        let A = ends().filter_map(|end| end.coupling(end)).reduce(|a, b| a + b).unwrap_or_default();
        Block {
            end,
            other,
            friction: 0.0,
            A,
            inverse_diagonal: A.diagonal().map(|d| 1.0 / d),
            tangent_step: 1.0 / largest_eigenvalue(A[(1, 1)], A[(2, 2)], A[(1, 2)]),
            b: ends().map(|end| end.motion(&free[end.body])).sum::<Vector3<f64>>() - pin.velocity_W,
            frame,
            pin: Some(A.try_inverse().unwrap_or_default()),
            least: 0.0,
            before: Vector3::zeros(),
            tangential_restitution: 0.0,
        }
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

    /// An impulse in world axes.
    pub fn in_world(&self, p: &Impulse) -> Vector3<f64> {
        self.frame[0] * p.x + self.frame[1] * p.y + self.frame[2] * p.z
    }
}

/// Of the symmetric matrix [a c; c b].
fn largest_eigenvalue(a: f64, b: f64, c: f64) -> f64 {
    let half = (a - b) / 2.0;
    (a + b) / 2.0 + (half * half + c * c).sqrt()
}

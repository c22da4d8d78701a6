//! An island: bodies that contacts join, as a problem without units that a solver of the whole law works on.
//!
//! Bodies that move as they are told, and the container, join nothing. With M = L⁻ᵀL⁻¹ the unknown velocities are y =
//! L⁻¹ M⁻¹ Jᵀ p, six numbers a body however many contacts it has, and A = G Gᵀ with G = J L. Every contact is scaled by
//! σ, its own block of A having the trace 1/σ²: velocities are σ u, impulses p/σ, and Coulomb's cone stays what it is.
//! Masses are in a unit of the island's own, a power of two, so that a scene twice as heavy has the same bits.

use super::Impulse;
use super::block::Block;
use super::end::{End, Inertia};
use super::law::{self, Law};
use super::problem::ContactProblem;
use super::speeds::{Acted, Speeds, relative};
use crate::deadline::Deadline;
use crate::math::block_lu::{BlockMatrix, Factors, Pattern};
use nalgebra::{DVector, Matrix3, Matrix3x6, Vector3};

/// The rows of G of one of a contact's bodies.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// Where the body's six numbers begin in y.
    at: usize,
    rows: Matrix3x6<f64>,
    /// From the centre of mass to the contact.
    arm_m: f64,
    /// The body's part of the trace of the contact's block.
    part: f64,
}

/// A contact without units.
#[derive(Clone, Copy, Debug)]
pub struct Share {
    /// Its place in the problem.
    pub index: usize,
    pub law: Law,
    /// σ.
    pub scale: f64,
    /// Velocity without impulses.
    pub b: Vector3<f64>,
    sides: [Option<Side>; 2],
}

/// Contacts of one island.
#[derive(Clone, Debug)]
pub struct Island {
    pub touches: Vec<Share>,
    bodies: Vec<Mover>,
    /// The power of two that is next below its first body's mass.
    unit_kg: f64,
    /// As `ContactProblem` has it.
    cancelling: f64,
    pattern: Pattern,
    /// Nothing goes on later.
    pub deadline: Deadline,
}

/// All islands that something can move, in the order of their first bodies; until when they may be worked on.
pub fn islands(problem: &ContactProblem, deadline: Deadline) -> Vec<Island> {
    let mut islands = islands_without_pattern(problem, deadline);
    for island in &mut islands {
        island.pattern = Pattern::new(island.bodies(), island.touches.iter().filter_map(Share::pair));
    }
    islands
}

/// The same, none of which can make a linear system yet.
pub fn islands_without_pattern(problem: &ContactProblem, deadline: Deadline) -> Vec<Island> {
    let moves: Vec<bool> = problem.inertias.iter().map(|inertia| inertia.mass_kg.is_finite()).collect();
    let moving = |end: &&End| moves[end.body];
    let mut root_of: Vec<usize> = (0..moves.len()).collect();
    for block in &problem.blocks {
        let mut first = block.ends().filter(moving).map(|end| root(&root_of, end.body));
        if let (Some(a), Some(b)) = (first.next(), first.next()) {
            root_of[a.max(b)] = a.min(b);
        }
    }
    // Of every body where its numbers begin, and of every first body its island.
    let (mut at, mut island_of) = (vec![0; moves.len()], vec![usize::MAX; moves.len()]);
    let mut whitened = vec![None; moves.len()];
    let mut islands: Vec<Island> = Vec::new();
    let mut touched = vec![false; moves.len()];
    problem.blocks.iter().flat_map(Block::ends).for_each(|end| touched[end.body] = true);
    for body in (0..moves.len()).filter(|body| moves[*body] && touched[*body]) {
        let first = root(&root_of, body);
        if first == body {
            island_of[body] = islands.len();
            islands.push(Island {
                touches: Vec::new(),
                bodies: Vec::new(),
                unit_kg: unit_kg(problem.inertias[body].mass_kg),
                cancelling: problem.cancelling,
                pattern: Pattern::default(),
                deadline,
            });
        }
        let island = &mut islands[island_of[first]];
        at[body] = island.unknowns();
        let own = Whitened::new(&problem.inertias[body], island.unit_kg);
        whitened[body] = Some(own);
        island.bodies.push(Mover { whitened: own, speeds: problem.speeds[body] });
    }
    for (index, block) in problem.blocks.iter().enumerate() {
        if let Some(end) = block.ends().find(moving) {
            let island = &mut islands[island_of[root(&root_of, end.body)]];
            island.touches.push(Share::new(index, block, &whitened, &at, island.unit_kg));
        }
    }
    islands
}

/// The first body of an island: every other one points to one before it.
fn root(root_of: &[usize], mut body: usize) -> usize {
    while root_of[body] != body {
        body = root_of[body];
    }
    body
}

/// A body of an island.
#[derive(Clone, Copy, Debug)]
struct Mover {
    whitened: Whitened,
    speeds: Speeds,
}

/// The power of two next below a mass.
fn unit_kg(mass_kg: f64) -> f64 {
    const EXPONENT: u64 = 0x7FF0_0000_0000_0000;
    let unit_kg = f64::from_bits(mass_kg.to_bits() & EXPONENT);
    if unit_kg > 0.0 { unit_kg } else { 1.0 }
}

/// L of one body: M⁻¹ = L Lᵀ, in a unit of mass.
#[derive(Clone, Copy, Debug)]
struct Whitened {
    linear: f64,
    angular: Matrix3<f64>,
}

impl Whitened {
    fn new(inertia: &Inertia, unit_kg: f64) -> Self {
        let inverse_W = inertia.inverse_W * unit_kg;
        let angular = inverse_W.cholesky().map_or_else(Matrix3::zeros, |cholesky| cholesky.l());
        Whitened { linear: 1.0 / (inertia.mass_kg / unit_kg).sqrt(), angular }
    }
}

impl Share {
    /// `whitened`: of the bodies that something can move.
    fn new(index: usize, block: &Block, whitened: &[Option<Whitened>], at: &[usize], unit_kg: f64) -> Self {
        let scale = 1.0 / (block.A.trace() * unit_kg).sqrt();
        let side = |end: &End| {
            let Whitened { linear, angular } = whitened[end.body].as_ref()?;
            let mut rows = Matrix3x6::zeros();
            for (i, row) in end.rows.iter().enumerate() {
                rows.fixed_view_mut::<1, 3>(i, 0).copy_from(&(row.j.v.transpose() * (*linear * scale)));
                rows.fixed_view_mut::<1, 3>(i, 3).copy_from(&(angular.tr_mul(&row.j.w).transpose() * scale));
            }
            let part = rows.norm_squared();
            Some(Side { at: at[end.body], rows, arm_m: end.arm_m(), part })
        };
        let sides = [side(&block.end), block.other.as_ref().and_then(side)];
        Share { index, law: block.law(), scale, b: block.b * scale, sides }
    }

    /// The two bodies that it couples.
    fn pair(&self) -> Option<(usize, usize)> {
        let [a, b] = self.sides.each_ref().map(|side| side.as_ref().map(|side| side.at / 6));
        a.zip(b)
    }

    /// G y.
    pub fn motion(&self, y: &DVector<f64>) -> Vector3<f64> {
        self.sides.iter().flatten().map(|side| side.rows * y.fixed_rows::<6>(side.at)).sum()
    }

    /// y += Gᵀ p.
    fn push(&self, p: &Impulse, y: &mut DVector<f64>) {
        for side in self.sides.iter().flatten() {
            let mut own = y.fixed_rows_mut::<6>(side.at);
            own += side.rows.tr_mul(p);
        }
    }
}

impl Island {
    /// Gets the pattern of its linear systems, if it has no more bodies and factors take no more products of blocks.
    pub fn is_affordable(&mut self, most_bodies: usize, most_products: usize) -> bool {
        let bodies = self.bodies();
        let pairs = || self.touches.iter().filter_map(Share::pair);
        let pattern = (bodies <= most_bodies).then(|| Pattern::within(bodies, pairs(), most_products)).flatten();
        let is_affordable = pattern.is_some();
        self.pattern = pattern.unwrap_or_default();
        is_affordable
    }

    /// Number of its bodies.
    pub fn bodies(&self) -> usize {
        self.bodies.len()
    }

    /// Of y: six a body.
    pub fn unknowns(&self) -> usize {
        6 * self.bodies()
    }

    /// Whether a residual is the tolerance, or rounding; a tolerance of 0 asks for more than there is.
    pub fn is_enough(&self, residual: f64, tolerance: f64, p: &[Impulse]) -> bool {
        residual <= tolerance || (tolerance > 0.0 && residual <= self.rounding(p))
    }

    /// Gᵀ p.
    pub fn pushed(&self, p: &[Impulse]) -> DVector<f64> {
        let mut y = DVector::zeros(self.unknowns());
        self.touches.iter().zip(p).for_each(|(touch, p)| touch.push(p, &mut y));
        y
    }

    /// E + Gᵀ D G in factors, with the 3×3 blocks of D. None: it is singular, or out of time.
    pub fn system(&self, D: &[Matrix3<f64>]) -> Option<Factors<'_>> {
        self.coupled(D, 1.0).factors(self.deadline)
    }

    /// Gᵀ D G with so much more on the diagonal.
    pub fn coupled(&self, D: &[Matrix3<f64>], on_diagonal: f64) -> BlockMatrix<'_> {
        let mut H = BlockMatrix::diagonal(&self.pattern, on_diagonal);
        for (touch, D) in self.touches.iter().zip(D).filter(|(_, D)| **D != Matrix3::zeros()) {
            for a in touch.sides.iter().flatten() {
                let left = a.rows.tr_mul(D);
                for b in touch.sides.iter().flatten() {
                    H.add(a.at / 6, b.at / 6, &(left * b.rows));
                }
            }
        }
        H
    }

    /// Of every contact, at the bodies' y.
    pub fn velocities(&self, y: &DVector<f64>) -> Vec<Vector3<f64>> {
        self.touches.iter().map(|touch| touch.b + touch.motion(y)).collect()
    }

    /// Its contacts' impulses without units, of those of all.
    pub fn impulses(&self, all: &[Impulse]) -> Vec<Impulse> {
        self.touches.iter().map(|touch| all[touch.index] / self.unit_n_s(touch)).collect()
    }

    /// Puts them back among all, with units.
    pub fn put(&self, p: &[Impulse], all: &mut [Impulse]) {
        self.touches.iter().zip(p).for_each(|(touch, p)| all[touch.index] = p * self.unit_n_s(touch));
    }

    /// Its own impulses with units.
    pub fn with_units(&self, p: &[Impulse]) -> Vec<Impulse> {
        self.touches.iter().zip(p).map(|(touch, p)| p * self.unit_n_s(touch)).collect()
    }

    /// Its own impulses without units.
    pub fn without_units(&self, p: &[Impulse]) -> Vec<Impulse> {
        self.touches.iter().zip(p).map(|(touch, p)| p / self.unit_n_s(touch)).collect()
    }

    /// Impulse of a contact that is 1 without units.
    fn unit_n_s(&self, touch: &Share) -> f64 {
        touch.scale * self.unit_kg
    }

    /// What the impulse of every contact (without units) is compared with, as the judge has it: the least, over the
    /// bodies that it can move, of what would do to the body there what the step does (`Acted`). So a light body under
    /// a heavy one counts.
    pub fn scales(&self, p: &[Impulse], y: &DVector<f64>) -> Vec<f64> {
        self.scales_with(self.cancelling, p, y)
    }

    /// `cancelling`: part of Σ|p|/m that counts beside what all impulses together change.
    fn scales_with(&self, cancelling: f64, p: &[Impulse], y: &DVector<f64>) -> Vec<f64> {
        let mut pressed = vec![0.0; self.bodies.len()];
        for (touch, p) in self.touches.iter().zip(p) {
            touch.sides.iter().flatten().for_each(|side| pressed[side.at / 6] += touch.scale * p.norm());
        }
        let acted = |(i, Mover { whitened, speeds }): (usize, &Mover)| {
            let [v, w] = [y.fixed_rows::<3>(6 * i), y.fixed_rows::<3>(6 * i + 3)];
            let changed = [whitened.linear * v.norm(), (whitened.angular * w).norm()];
            Acted { speeds: *speeds, changed, pressed: cancelling * pressed[i] * whitened.linear * whitened.linear }
        };
        let acted: Vec<Acted> = self.bodies.iter().enumerate().map(acted).collect();
        let least = |touch: &Share| {
            let sides = touch.sides.iter().flatten().filter(|side| side.part > 0.0);
            let of = |side: &Side| touch.scale * acted[side.at / 6].at(side.arm_m) / side.part;
            sides.map(of).fold(f64::INFINITY, f64::min)
        };
        self.touches.iter().map(least).collect()
    }

    /// A residual that rounding of the velocities leaves: impulses may be next to nothing beside the speed of a body,
    /// which slips past or rolls.
    pub fn rounding(&self, p: &[Impulse]) -> f64 {
        let scales = self.scales(p, &self.pushed(p));
        let of = |(touch, scale): (&Share, &f64)| {
            let sides = touch.sides.iter().flatten();
            let speeds = sides.map(|side| touch.scale * self.bodies[side.at / 6].speeds.at(side.arm_m));
            relative(4.0 * f64::EPSILON * speeds.fold(touch.b.norm(), f64::max), *scale)
        };
        self.touches.iter().zip(&scales).map(of).fold(0.0, f64::max)
    }

    /// How far the worst contact is from the law: the judge's residual.
    pub fn residual(&self, p: &[Impulse]) -> f64 {
        self.residual_with(self.cancelling, p)
    }

    /// Whether the residual by what every body gets alone, however much presses it, is the tolerance, or rounding: what
    /// bodies that rest may be left with for ever.
    pub fn is_strictly_met(&self, tolerance: f64, p: &[Impulse]) -> bool {
        self.is_enough(self.residual_with(0.0, p), tolerance, p)
    }

    fn residual_with(&self, cancelling: f64, p: &[Impulse]) -> f64 {
        let y = self.pushed(p);
        let (u, scales) = (self.velocities(&y), self.scales_with(cancelling, p, &y));
        let missed = |(((touch, p), u), scale): (((&Share, &Impulse), &Vector3<f64>), &f64)| {
            let missed = relative(law::missed(p, u, touch.law), *scale);
            if missed.is_nan() { f64::INFINITY } else { missed }
        };
        self.touches.iter().zip(p).zip(&u).zip(&scales).map(missed).fold(0.0, f64::max)
    }
}

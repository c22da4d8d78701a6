//! An island: bodies that contacts join, as a problem without units that a solver of the whole law works on.
//!
//! Bodies that move as they are told, and the container, join nothing. With M = L⁻ᵀL⁻¹ the unknown velocities are y =
//! L⁻¹ M⁻¹ Jᵀ p, six numbers a body however many contacts it has, and A = G Gᵀ with G = J L. Every contact is scaled by
//! σ, its own block of A having the trace 1/σ²: velocities are σ u, impulses p/σ, and Coulomb's cone stays what it is.

use super::Impulse;
use super::block::Block;
use super::end::{End, Inertia};
use super::law::{self, Law};
use super::problem::ContactProblem;
use crate::deadline::Deadline;
use crate::math::block_lu::{BlockMatrix, Factors, Pattern};
use nalgebra::{DVector, Matrix3, Matrix3x6, Vector3};

/// The rows of G of one of a contact's bodies.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// Where the body's six numbers begin in y.
    at: usize,
    rows: Matrix3x6<f64>,
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
    /// Of y: six a body.
    pub unknowns: usize,
    pattern: Pattern,
    /// Nothing goes on later.
    pub deadline: Deadline,
}

/// All islands that something can move, in the order of their first bodies; until when they may be worked on.
pub fn islands(problem: &ContactProblem, deadline: Deadline) -> Vec<Island> {
    let whitened: Vec<Whitened> = problem.inertias.iter().map(Whitened::new).collect();
    let moves = |end: &&End| whitened[end.body].moves;
    let mut root_of: Vec<usize> = (0..whitened.len()).collect();
    for block in &problem.blocks {
        let mut moving = block.ends().filter(moves).map(|end| root(&root_of, end.body));
        if let (Some(a), Some(b)) = (moving.next(), moving.next()) {
            root_of[a.max(b)] = a.min(b);
        }
    }
    // Of every body where its numbers begin, and of every first body its island.
    let (mut at, mut island_of) = (vec![0; whitened.len()], vec![usize::MAX; whitened.len()]);
    let mut islands: Vec<Island> = Vec::new();
    let mut touched = vec![false; whitened.len()];
    problem.blocks.iter().flat_map(Block::ends).for_each(|end| touched[end.body] = true);
    for body in (0..whitened.len()).filter(|body| whitened[*body].moves && touched[*body]) {
        let first = root(&root_of, body);
        if first == body {
            island_of[body] = islands.len();
            islands.push(Island { touches: Vec::new(), unknowns: 0, pattern: Pattern::default(), deadline });
        }
        let island = &mut islands[island_of[first]];
        at[body] = island.unknowns;
        island.unknowns += 6;
    }
    for (index, block) in problem.blocks.iter().enumerate() {
        if let Some(end) = block.ends().find(moves) {
            islands[island_of[root(&root_of, end.body)]].touches.push(Share::new(index, block, &whitened, &at));
        }
    }
    for island in &mut islands {
        let pairs = island.touches.iter().filter_map(Share::pair);
        island.pattern = Pattern::new(island.unknowns / 6, pairs);
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

/// L of one body: M⁻¹ = L Lᵀ.
struct Whitened {
    moves: bool,
    linear: f64,
    angular: Matrix3<f64>,
}

impl Whitened {
    fn new(inertia: &Inertia) -> Self {
        let angular = inertia.inverse_W.cholesky().map_or_else(Matrix3::zeros, |cholesky| cholesky.l());
        Whitened { moves: inertia.mass_kg.is_finite(), linear: 1.0 / inertia.mass_kg.sqrt(), angular }
    }
}

impl Share {
    fn new(index: usize, block: &Block, whitened: &[Whitened], at: &[usize]) -> Self {
        let scale = 1.0 / block.A.trace().sqrt();
        let side = |end: &End| {
            let Whitened { linear, angular, .. } = &whitened[end.body];
            let mut rows = Matrix3x6::zeros();
            for (i, row) in end.rows.iter().enumerate() {
                rows.fixed_view_mut::<1, 3>(i, 0).copy_from(&(row.j.v.transpose() * (*linear * scale)));
                rows.fixed_view_mut::<1, 3>(i, 3).copy_from(&(angular.tr_mul(&row.j.w).transpose() * scale));
            }
            whitened[end.body].moves.then_some(Side { at: at[end.body], rows })
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
    /// Gᵀ p.
    pub fn pushed(&self, p: &[Impulse]) -> DVector<f64> {
        let mut y = DVector::zeros(self.unknowns);
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

    /// Its contacts' impulses without units.
    pub fn impulses(&self, all: &[Impulse]) -> Vec<Impulse> {
        self.touches.iter().map(|touch| all[touch.index] / touch.scale).collect()
    }

    /// Puts them back among all, with units.
    pub fn put(&self, p: &[Impulse], all: &mut [Impulse]) {
        self.touches.iter().zip(p).for_each(|(touch, p)| all[touch.index] = p * touch.scale);
    }

    /// What impulses (with units) are compared with: the largest; without any, what would stop an approach; but not
    /// less than 10⁻⁵ of what the velocities amount to, as the judge has it.
    pub fn scale(&self, p: &[Impulse]) -> f64 {
        const SMALL: f64 = 1e-5;
        let most = |of: &dyn Fn((&Share, &Impulse)) -> f64| self.touches.iter().zip(p).map(of).fold(0.0, f64::max);
        let largest = most(&|(touch, p)| touch.scale * p.norm());
        let stopping =
            most(&|(touch, _)| touch.scale * if touch.law == Law::Pin { touch.b.norm() } else { -touch.b.x });
        (if largest > 0.0 { largest } else { stopping }).max(SMALL * self.moving())
    }

    /// What the velocities amount to.
    fn moving(&self) -> f64 {
        self.touches.iter().map(|touch| touch.scale * touch.b.norm()).fold(0.0, f64::max)
    }

    /// A residual that rounding of the velocities leaves: impulses may be next to nothing beside a slip.
    pub fn rounding(&self, p: &[Impulse]) -> f64 {
        let scale = self.scale(p);
        if scale > 0.0 { 4.0 * f64::EPSILON * self.moving() / scale } else { 0.0 }
    }

    /// How far the worst contact is from the law: the judge's residual.
    pub fn residual(&self, p: &[Impulse]) -> f64 {
        let u = self.velocities(&self.pushed(p));
        let missed = |((touch, p), u): ((&Share, &Impulse), &Vector3<f64>)| {
            let missed = touch.scale * law::missed(p, u, touch.law);
            if missed.is_nan() { f64::INFINITY } else { missed }
        };
        let worst = self.touches.iter().zip(p).zip(&u).map(missed).fold(0.0, f64::max);
        if worst == 0.0 { 0.0 } else { worst / self.scale(p) }
    }
}

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
use super::slope::Slope;
use super::speeds::{Acted, Speeds, relative};
use crate::deadline::Deadline;
use crate::math::block_lu::{BlockMatrix, Pattern};
use crate::math::few::{BlockVector, Few, OneOrTwo};
use crate::math::six::{self, Six};
use nalgebra::{Matrix3, Vector3};
use std::borrow::Borrow;

/// At one moment nothing but rounding may reach a body that others shield: what is done to it counts as at least this
/// part of the most that is done to one of its island, as the judge has it.
const AMONG: f64 = 1e-8;

fn largest_pressed(all: &[Acted]) -> f64 {
    all.iter().map(|acted| acted.pressed).fold(0.0, f64::max)
}

/// The rows of G of one of a contact's bodies.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// The body's place in the island.
    body: usize,
    rows: [Six; 3],
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
    bodies: OneOrTwo<Mover>,
    /// The power of two that is next below its first body's mass.
    unit_kg: f64,
    /// As `ContactProblem` has it.
    cancelling: f64,
    pattern: Pattern,
    /// Nothing goes on later.
    pub deadline: Deadline,
}

/// Impulses of an island's contacts, without units, and the velocities that they make.
#[derive(Clone, Debug)]
pub struct Point {
    pub p: Few<Impulse>,
    /// Gᵀ p.
    pub y: BlockVector,
    /// Of every contact.
    pub u: Few<Vector3<f64>>,
}

/// All islands that something can move, in the order of their first bodies; until when they may be worked on.
pub fn islands(problem: &ContactProblem, deadline: Deadline) -> Vec<Island> {
    let mut islands = islands_without_pattern(problem, deadline);
    for island in &mut islands {
        island.pattern = Pattern::new(island.bodies(), island.touches.iter().filter_map(Share::pair));
    }
    islands
}

/// A body of the problem on the way to its island.
#[derive(Clone, Debug)]
struct Found {
    /// One before it in the same island, or itself.
    root: usize,
    is_touched: bool,
    /// Its place in the island.
    at: usize,
    island: usize,
    /// None: nothing moves it.
    whitened: Option<Whitened>,
}

/// The same, none of which can make a linear system yet.
pub fn islands_without_pattern(problem: &ContactProblem, deadline: Deadline) -> Vec<Island> {
    let moves = |body: usize| problem.inertias[body].mass_kg.is_finite();
    let begin = |root| Found { root, is_touched: false, at: 0, island: usize::MAX, whitened: None };
    let mut found: OneOrTwo<Found> = (0..problem.inertias.len()).map(begin).collect();
    for block in &problem.blocks {
        block.ends().for_each(|end| found[end.body].is_touched = true);
        if let Some(other) = block.other.as_ref().filter(|other| moves(other.body) && moves(block.end.body)) {
            let (a, b) = (root(&found, block.end.body), root(&found, other.body));
            found[a.max(b)].root = a.min(b);
        }
    }
    let mut islands: Vec<Island> = Vec::new();
    for body in 0..found.len() {
        if !found[body].is_touched || !moves(body) {
            continue;
        }
        let first = root(&found, body);
        if first == body {
            found[body].island = islands.len();
            islands.push(Island {
                touches: Vec::with_capacity(if islands.is_empty() { problem.blocks.len() } else { 0 }),
                bodies: OneOrTwo::new(),
                unit_kg: unit_kg(problem.inertias[body].mass_kg),
                cancelling: problem.cancelling,
                pattern: Pattern::default(),
                deadline,
            });
        }
        let island = &mut islands[found[first].island];
        let whitened = Whitened::new(&problem.inertias[body], island.unit_kg);
        (found[body].at, found[body].whitened) = (island.bodies(), Some(whitened));
        island.bodies.push(Mover { whitened, speeds: problem.speeds[body] });
    }
    for (index, block) in problem.blocks.iter().enumerate() {
        if let Some(end) = block.ends().find(|end| moves(end.body)) {
            let island = &mut islands[found[root(&found, end.body)].island];
            island.touches.push(Share::new(index, block, &found, island.unit_kg));
        }
    }
    islands
}

/// The first body of an island: every other one points to one before it.
fn root(found: &[Found], mut body: usize) -> usize {
    while found[body].root != body {
        body = found[body].root;
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
    fn new(index: usize, block: &Block, found: &[Found], unit_kg: f64) -> Self {
        let scale = 1.0 / (block.A.trace() * unit_kg).sqrt();
        let side = |end: &End| {
            let Whitened { linear, angular } = found[end.body].whitened.as_ref()?;
            let rows = end.rows.map(|row| {
                let (v, w) = (row.j.v * (*linear * scale), angular.tr_mul(&row.j.w) * scale);
                [v.x, v.y, v.z, w.x, w.y, w.z]
            });
            let part = rows.iter().flatten().map(|x| x * x).sum();
            Some(Side { body: found[end.body].at, rows, arm_m: end.arm_m(), part })
        };
        let sides = [side(&block.end), block.other.as_ref().and_then(side)];
        Share { index, law: block.law(), scale, b: block.b * scale, sides }
    }

    /// The two bodies that it couples.
    fn pair(&self) -> Option<(usize, usize)> {
        let [a, b] = self.sides.each_ref().map(|side| side.as_ref().map(|side| side.body));
        a.zip(b)
    }

    /// G y.
    pub fn motion(&self, y: &BlockVector) -> Vector3<f64> {
        let mut u = Vector3::zeros();
        for side in self.sides.iter().flatten() {
            let (own, y) = (&side.rows, &y[side.body]);
            u += Vector3::new(six::dot(&own[0], y), six::dot(&own[1], y), six::dot(&own[2], y));
        }
        u
    }

    /// The least, over the bodies that it can move, of what would do to the body there what is done to it.
    fn least(&self, acted: &[Acted]) -> f64 {
        let sides = self.sides.iter().flatten().filter(|side| side.part > 0.0);
        let of = |side: &Side| self.scale * acted[side.body].at(side.arm_m) / side.part;
        sides.map(of).fold(f64::INFINITY, f64::min)
    }

    /// H += Σ left rightᵀ, of which every one of its bodies has its own.
    #[inline(always)]
    fn couple<const N: usize>(
        &self,
        H: &mut BlockMatrix,
        left: impl Fn(&[Six; 3]) -> [Six; N],
        right: impl Fn(&[Six; 3]) -> [Six; N],
    ) {
        for b in self.sides.iter().flatten() {
            let right = right(&b.rows);
            for a in self.sides.iter().flatten() {
                six::add_products(H.block(a.body, b.body), &left(&a.rows), &right);
            }
        }
    }

    /// y += Gᵀ p.
    fn push(&self, p: &Impulse, y: &mut BlockVector) {
        for side in self.sides.iter().flatten() {
            let own: &mut Six = y[side.body].as_mut();
            for (row, p) in side.rows.iter().zip(p.iter()) {
                six::add_scaled(own, row, *p);
            }
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

    /// Whether a residual is the tolerance, or rounding; a tolerance of 0 asks for more than there is.
    pub fn is_enough(&self, residual: f64, tolerance: f64, at: &Point) -> bool {
        residual <= tolerance || (tolerance > 0.0 && residual <= self.rounding(at))
    }

    /// Gᵀ p.
    pub fn pushed(&self, p: impl Iterator<Item = Impulse>) -> BlockVector {
        let mut y = BlockVector::zeros(self.bodies());
        self.touches.iter().zip(p).for_each(|(touch, p)| touch.push(&p, &mut y));
        y
    }

    /// Gᵀ p of one contact's impulse.
    pub fn pushed_by(&self, touch: usize, p: &Impulse) -> BlockVector {
        let mut y = BlockVector::zeros(self.bodies());
        self.touches[touch].push(p, &mut y);
        y
    }

    /// Gᵀ D G with so much more on the diagonal.
    pub fn coupled(&self, D: impl Iterator<Item = impl Borrow<Slope>>, on_diagonal: f64) -> BlockMatrix<'_> {
        let mut H = BlockMatrix::diagonal(&self.pattern, on_diagonal);
        for (touch, D) in self.touches.iter().zip(D) {
            match D.borrow() {
                Slope::Nothing => {}
                Slope::Any(D) if *D == Matrix3::zeros() => {}
                Slope::Any(D) => {
                    let right = |rows: &_| [0, 1, 2].map(|k| six::combined(rows, [D[(k, 0)], D[(k, 1)], D[(k, 2)]]));
                    touch.couple(&mut H, |rows| *rows, right);
                }
                Slope::Diagonal(d) if d.y == 0.0 && d.z == 0.0 => {
                    touch.couple(&mut H, |rows| [rows[0]], |rows| [six::scaled(&rows[0], d.x)]);
                }
                Slope::Diagonal(d) => {
                    touch.couple(&mut H, |rows| *rows, |rows| [0, 1, 2].map(|k| six::scaled(&rows[k], d[k])));
                }
                Slope::Side { edge, s, normal, across } => {
                    let other = |rows: &[Six; 3]| six::combined_two(&rows[1], &rows[2], [s.y, s.z]);
                    let left = |rows: &[Six; 3]| [six::combined(rows, [edge.x, edge.y, edge.z]), other(rows)];
                    let right = |rows: &[Six; 3]| [six::scaled(&rows[0], *normal), six::scaled(&other(rows), *across)];
                    touch.couple(&mut H, left, right);
                }
            }
        }
        H
    }

    /// Of every contact, at the bodies' y.
    pub fn velocities(&self, y: &BlockVector) -> Few<Vector3<f64>> {
        self.touches.iter().map(|touch| touch.b + touch.motion(y)).collect()
    }

    /// Its contacts' impulses without units, of those of all.
    pub fn impulses(&self, all: &[Impulse]) -> Few<Impulse> {
        self.touches.iter().map(|touch| all[touch.index] / self.unit_n_s(touch)).collect()
    }

    /// Puts them back among all, with units.
    pub fn put(&self, p: &[Impulse], all: &mut [Impulse]) {
        self.touches.iter().zip(p).for_each(|(touch, p)| all[touch.index] = p * self.unit_n_s(touch));
    }

    /// Its own impulses with units.
    pub fn with_units(&self, p: &[Impulse]) -> Few<Impulse> {
        self.touches.iter().zip(p).map(|(touch, p)| p * self.unit_n_s(touch)).collect()
    }

    /// Its own impulses without units.
    pub fn without_units(&self, p: &[Impulse]) -> Few<Impulse> {
        self.touches.iter().zip(p).map(|(touch, p)| p / self.unit_n_s(touch)).collect()
    }

    /// Impulse of a contact that is 1 without units.
    fn unit_n_s(&self, touch: &Share) -> f64 {
        touch.scale * self.unit_kg
    }

    /// Impulses and the velocities that they make.
    pub fn at(&self, p: Few<Impulse>) -> Point {
        let y = self.pushed(p.iter().copied());
        Point { u: self.velocities(&y), p, y }
    }

    /// What the impulse of every contact (without units) is compared with, as the judge has it: the least, over the
    /// bodies that it can move, of what would do to the body there what the step does (`Acted`). So a light body under
    /// a heavy one counts.
    pub fn scales(&self, at: &Point) -> Few<f64> {
        let acted = self.acted_with(self.cancelling, at);
        self.touches.iter().map(|touch| touch.least(&acted)).collect()
    }

    /// What is done to every body. `cancelling`: part of Σ|p|/m that counts beside what all impulses together change.
    fn acted_with(&self, cancelling: f64, at: &Point) -> OneOrTwo<Acted> {
        let mut all = OneOrTwo::new();
        all.extend(self.bodies.iter().enumerate().map(|(i, Mover { whitened, speeds })| {
            let [v, w] = [at.y[i].fixed_rows::<3>(0), at.y[i].fixed_rows::<3>(3)];
            let changed = [whitened.linear * v.norm(), (whitened.angular * w).norm()];
            Acted { speeds: *speeds, changed, pressed: 0.0 }
        }));
        if cancelling > 0.0 {
            for (touch, p) in self.touches.iter().zip(&at.p) {
                touch.sides.iter().flatten().for_each(|side| all[side.body].pressed += touch.scale * p.norm());
            }
            for (acted, Mover { whitened, .. }) in all.iter_mut().zip(&self.bodies) {
                acted.pressed = cancelling * acted.pressed * whitened.linear * whitened.linear;
            }
            if self.is_instant() {
                let least = AMONG * largest_pressed(&all);
                all.iter_mut().for_each(|acted| acted.pressed = acted.pressed.max(least));
            }
        }
        all
    }

    /// Impulses of one moment, as `ContactProblem` says.
    fn is_instant(&self) -> bool {
        self.cancelling == 1.0
    }

    /// A residual that rounding of the velocities leaves: impulses may be next to nothing beside the speed of a body,
    /// which slips past or rolls, and at one moment beside those of others that it is joined to.
    pub fn rounding(&self, at: &Point) -> f64 {
        let acted = self.acted_with(self.cancelling, at);
        let beside = if self.is_instant() { largest_pressed(&acted) } else { 0.0 };
        let of = |touch: &Share| {
            let sides = touch.sides.iter().flatten();
            let speeds = sides.map(|side| self.bodies[side.body].speeds.at(side.arm_m));
            let fastest = touch.b.norm().max(touch.scale * speeds.fold(beside, f64::max));
            relative(4.0 * f64::EPSILON * fastest, touch.least(&acted))
        };
        self.touches.iter().map(of).fold(0.0, f64::max)
    }

    /// How far the worst contact is from the law: the judge's residual.
    pub fn residual(&self, p: &[Impulse]) -> f64 {
        self.residual_at(&self.at(p.into()))
    }

    /// The same of impulses whose velocities are known.
    pub fn residual_at(&self, at: &Point) -> f64 {
        self.residual_with(self.cancelling, at)
    }

    /// Whether the residual by what every body gets alone, however much presses it, is the tolerance, or rounding: what
    /// bodies that rest may be left with for ever.
    pub fn is_strictly_met(&self, tolerance: f64, at: &Point) -> bool {
        self.is_enough(self.residual_with(0.0, at), tolerance, at)
    }

    fn residual_with(&self, cancelling: f64, at: &Point) -> f64 {
        let acted = self.acted_with(cancelling, at);
        let missed = |((touch, p), u): ((&Share, &Impulse), &Vector3<f64>)| {
            let missed = relative(law::missed(p, u, touch.law), touch.least(&acted));
            if missed.is_nan() { f64::INFINITY } else { missed }
        };
        self.touches.iter().zip(&at.p).zip(&at.u).map(missed).fold(0.0, f64::max)
    }
}

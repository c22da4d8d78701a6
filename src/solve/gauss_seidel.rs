//! The lecture's iteration F^{i+1} = D⁻¹ (S F^i − b) and its correction (L20), in every literal variant.
//!
//! One implementation for all who iterate: `gauss-seidel` with `correction: per-contact` is projected Gauss–Seidel, the
//! solver `pgs` of time-stepping. `after-sweep` is the slide to the letter. As printed the slide's formula is Jacobi;
//! Gauss–Seidel uses the values already updated.

use super::block::Block;
use super::coupling::{Coupling, Memory};
use super::problem::ContactProblem;
use super::{Impulse, corrected, exact_contact};
use crate::deadline::Deadline;
use crate::experiment::types::{Cone, Correction, Iteration, Local, Order};
use crate::work::Work;
use nalgebra::Vector3;

/// How to iterate, and when to stop.
#[derive(Clone, Copy, Debug)]
pub struct Sweeps {
    pub iteration: Iteration,
    pub correction: Correction,
    pub cone: Cone,
    pub most: u32,
    /// Stop when no impulse changes by more than this part of the largest. At 0 that is when a sweep changes not one
    /// bit: the sweeps left out would have changed nothing.
    pub tolerance: f64,
    /// False where μ = 0 everywhere: tangent rows are left out (per-contact correction only; after a sweep the
    /// uncorrected tangents have already been felt by the normals).
    pub friction: bool,
    pub variant: Variant,
    /// No sweep begins later.
    pub deadline: Deadline,
}

/// Variants of `correction: per-contact`; the default is the lecture's.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    pub local: Local,
    /// Part of a contact's change that is made, before it is corrected.
    pub relaxation: f64,
    pub order: Order,
}

impl Default for Variant {
    fn default() -> Self {
        Variant { local: Local::Common, relaxation: 1.0, order: Order::Fixed }
    }
}

/// The solver's memory between steps, to spare the allocator.
#[derive(Clone, Debug)]
pub struct Scratch {
    pub(super) before: Vec<Impulse>,
    pub(super) order: Vec<usize>,
    pub(super) coupling: Memory,
}

impl Scratch {
    pub fn with_capacity(contacts: usize, bodies: usize) -> Self {
        Scratch {
            before: Vec::with_capacity(contacts),
            order: Vec::with_capacity(contacts),
            coupling: Memory::with_capacity(bodies),
        }
    }

    /// The order of the first sweep.
    pub(super) fn restart(&mut self, sweeps: &Sweeps, contacts: usize) {
        self.order.clear();
        if sweeps.variant.order == Order::Shuffled {
            self.order.extend(0..contacts);
        }
    }
}

/// Improves `p` by at most `sweeps.most` sweeps. Whether it has settled.
pub fn iterate(
    problem: &ContactProblem,
    sweeps: &Sweeps,
    p: &mut [Impulse],
    scratch: &mut Scratch,
    work: &mut Work,
) -> bool {
    scratch.restart(sweeps, p.len());
    let Scratch { before, order, coupling } = scratch;
    if problem.is_dense() {
        sweep_until_done(problem, &mut problem.dense(), sweeps, p, before, order, work)
    } else {
        sweep_until_done(problem, &mut problem.through_bodies(p, coupling), sweeps, p, before, order, work)
    }
}

/// Puts every impulse back into its cone.
pub fn correct_all(problem: &ContactProblem, cone: Cone, p: &mut [Impulse]) {
    for (block, p) in problem.blocks.iter().zip(p) {
        *p = block.corrected(p, cone);
    }
}

fn sweep_until_done(
    problem: &ContactProblem,
    coupling: &mut impl Coupling,
    sweeps: &Sweeps,
    p: &mut [Impulse],
    before: &mut Vec<Impulse>,
    order: &mut [usize],
    work: &mut Work,
) -> bool {
    for number in 0..sweeps.most {
        if sweeps.deadline.is_over() {
            break;
        }
        work.sweeps += 1;
        sweep(problem, coupling, sweeps, p, before, order, number);
        if has_settled(before, p, sweeps.tolerance) {
            return true;
        }
    }
    false
}

/// One pass over all contacts; `before` becomes the impulses before it.
pub(super) fn sweep(
    problem: &ContactProblem,
    coupling: &mut impl Coupling,
    sweeps: &Sweeps,
    p: &mut [Impulse],
    before: &mut Vec<Impulse>,
    order: &mut [usize],
    number: u32,
) {
    let cone = sweeps.cone;
    before.clear();
    before.extend_from_slice(p);
    match (sweeps.iteration, sweeps.correction) {
        (Iteration::Jacobi, _) => jacobi(problem, coupling, cone, before, p),
        (Iteration::GaussSeidel, Correction::AfterSweep) => {
            in_place(problem, coupling, p, 0..before.len(), three_rows);
            in_place(problem, coupling, p, 0..before.len(), |block, _, p| block.corrected(p, cone));
        }
        (Iteration::GaussSeidel, Correction::PerContact) => match sweeps.variant.order {
            Order::ForthAndBack if number % 2 == 1 => {
                per_contact(problem, coupling, p, (0..before.len()).rev(), sweeps)
            }
            Order::ForthAndBack | Order::Fixed => per_contact(problem, coupling, p, 0..before.len(), sweeps),
            Order::Shuffled => {
                shuffle(order, number);
                per_contact(problem, coupling, p, order.iter().copied(), sweeps);
            }
        },
    }
}

/// One sweep of projected Gauss–Seidel in any of its variants.
fn per_contact(
    problem: &ContactProblem,
    coupling: &mut impl Coupling,
    p: &mut [Impulse],
    order: impl Iterator<Item = usize>,
    sweeps: &Sweeps,
) {
    let (cone, Variant { local, relaxation: part, .. }) = (sweeps.cone, sweeps.variant);
    match local {
        _ if !sweeps.friction => in_place(problem, coupling, p, order, |block, c, p| {
            Impulse::new((p.x - c.x * block.inverse_diagonal.x * part).max(0.0), 0.0, 0.0)
        }),
        Local::Common => in_place(problem, coupling, p, order, |block, c, p| within_cone(block, c, p, part, cone)),
        Local::Rows => in_place(problem, coupling, p, order, |block, c, p| rows_within_cone(block, c, p, part, cone)),
        Local::Exact => in_place(problem, coupling, p, order, |block, c, p| {
            let exact = exact_contact::solve(&block.A, c, p, block.friction);
            corrected(&(p * (1.0 - part) + exact * part), block.friction, cone)
        }),
    }
}

/// Another order for every sweep, the same in every step (Fisher and Yates with the generator of G. Steele, D. Lea,
/// C. Flood, OOPSLA 2014): an iteration that goes round in circles in one order does not in all.
fn shuffle(order: &mut [usize], sweep: u32) {
    let mut seed = u64::from(sweep) << 32;
    for i in (1..order.len()).rev() {
        seed = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut x = seed;
        x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        order.swap(i, ((x ^ (x >> 31)) % (i as u64 + 1)) as usize);
    }
}

/// One pass over the contacts, each seeing what the ones before it have become.
///
/// A pin's three rows are solved together. With `AfterSweep` the rows pass through uncorrected: later contacts see
/// pulling and sticking forces of earlier ones, and that error grows with the number of contacts.
#[inline(always)]
fn in_place(
    problem: &ContactProblem,
    coupling: &mut impl Coupling,
    p: &mut [Impulse],
    order: impl Iterator<Item = usize>,
    improve: impl Fn(&Block, &Vector3<f64>, &Impulse) -> Impulse,
) {
    for i in order {
        let block = &problem.blocks[i];
        let c = coupling.velocity(i, block, p);
        let new = block.pin.map_or_else(|| improve(block, &c, &p[i]), |inverse| p[i] - inverse * c);
        coupling.moved(block, &(new - p[i]));
        p[i] = new;
    }
}

/// As printed: every row from the forces of the sweep before.
fn jacobi(problem: &ContactProblem, coupling: &mut impl Coupling, cone: Cone, before: &[Impulse], p: &mut [Impulse]) {
    for (i, block) in problem.blocks.iter().enumerate() {
        let c = coupling.velocity(i, block, before);
        p[i] = block.corrected(&(before[i] - c.component_mul(&block.inverse_diagonal)), cone);
    }
    for (i, block) in problem.blocks.iter().enumerate() {
        coupling.moved(block, &(p[i] - before[i]));
    }
}

/// Gauss–Seidel over the rows of one contact, from its velocity `c` = b + A p before.
#[inline(always)]
fn three_rows(block: &Block, c: &Vector3<f64>, p: &Impulse) -> Impulse {
    let (A, d) = (&block.A, &block.inverse_diagonal);
    let d1 = -c.x * d.x;
    let d2 = -(c.y + A[(1, 0)] * d1) * d.y;
    let d3 = -(c.z + A[(2, 0)] * d1 + A[(2, 1)] * d2) * d.z;
    p + Vector3::new(d1, d2, d3)
}

/// The normal row, its correction, then both tangent rows and theirs: projected Gauss–Seidel.
///
/// The tangents move by one step length, 1/λmax of their block: where the iteration settles the force of a slipping
/// contact then opposes its slip. With a length of its own for each row it points elsewhere, and the forces of
/// redundant contacts work against each other (measured: a slab on four corners slides 1.15 times too far).
#[inline(always)]
fn within_cone(block: &Block, c: &Vector3<f64>, p: &Impulse, part: f64, cone: Cone) -> Impulse {
    let normal = (p.x - c.x * block.inverse_diagonal.x * part).max(0.0);
    let change = normal - p.x;
    let tangent = |i: usize| p[i] - (c[i] + block.A[(i, 0)] * change) * block.tangent_step * part;
    corrected(&Impulse::new(normal, tangent(1), tangent(2)), block.friction, cone)
}

/// The same with each tangent row divided by its own diagonal, as textbooks have it: it settles, but elsewhere.
fn rows_within_cone(block: &Block, c: &Vector3<f64>, p: &Impulse, part: f64, cone: Cone) -> Impulse {
    let (A, d) = (&block.A, &block.inverse_diagonal);
    let normal = (p.x - c.x * d.x * part).max(0.0);
    let d1 = normal - p.x;
    let d2 = -(c.y + A[(1, 0)] * d1) * d.y * part;
    let d3 = -(c.z + A[(2, 0)] * d1 + A[(2, 1)] * d2) * d.z * part;
    corrected(&Impulse::new(normal, p.y + d2, p.z + d3), block.friction, cone)
}

pub(super) fn has_settled(before: &[Impulse], p: &[Impulse], tolerance: f64) -> bool {
    if tolerance == 0.0 {
        return before == p;
    }
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let change = largest(&mut before.iter().zip(p).map(|(old, new)| (new - old).amax()));
    change <= tolerance * largest(&mut p.iter().map(|p| p.amax()))
}

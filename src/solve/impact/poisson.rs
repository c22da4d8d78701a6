//! Poisson's law for all contacts at once, in two phases (Ch. Glocker, F. Pfeiffer, Nonlinear Dynamics 7 (1995) 471).
//!
//! Compression: the plastic impulses p_C with friction. Expansion: normal impulses e p_C,n, more only where contacts
//! would penetrate (p_n − e p_C,n ≥ 0 ⟂ u_n ≥ 0), and Coulomb friction within μ p_n of the expansion's own normal
//! impulse. There is no tangential restitution: a contact that sticks after compression stays stuck where friction
//! allows.
//!
//! Energetic bound: the expansion of an island that would gain energy over both phases is scaled by the largest factor
//! ≤ 1 that does not; cones, contacts that stick and contacts that separate allow any factor. Where the solver settles
//! the bound is hardly ever met: p = e p_C would gain nothing, as p_C · u_C ≤ 0, and of the tangent impulses that a
//! cone allows friction chooses those that leave the least energy. It is met where compression has not settled.
//!
//! The expansion is solved by projected Jacobi: all contacts at once, each as if its bodies' masses were shared among
//! their contacts (R. Tonge, F. Benevolenti, A. Voroshilov, ACM Trans. Graph. 31 (2012) 105). With normal impulses
//! given that only descends; it keeps symmetric scenes symmetric, which one contact after the other does not.
//! Approaches that are left where it has not settled are taken by another plastic solve.

use super::super::block::Block;
use super::super::island::islands;
use super::super::problem::ContactProblem;
use super::super::twist::Twist;
use super::super::{Impulse, exact_contact};
use super::disc;
use super::plastic::{Plastic, plastic, rounding};
use crate::deadline::Deadline;
use nalgebra::{Matrix3, Vector2, Vector3};

const MOST: usize = 2000;

/// Settled: no impulse changes by more than this part of the largest.
const TOLERANCE: f64 = 1e-13;

pub(super) fn resolve(
    problem: &ContactProblem,
    restitution: &[f64],
    solver: &mut Plastic,
    deadline: Deadline,
    p: &mut [Impulse],
) -> bool {
    let (compression, compressed) = plastic(problem, solver);
    let mut u = Vec::new();
    problem.response(&compression, &mut u);
    let after = problem.after(&u);
    let floors: Vec<f64> = compression.iter().zip(restitution).map(|(p, e)| e * p.x).collect();
    let (mut expansion, mut settled) = expand(&after, &floors, deadline);
    after.response(&expansion, &mut u);
    let end = after.after(&u);
    let rounding = rounding(problem);
    if end.blocks.iter().any(|block| block.b.x < -rounding) {
        let (left, taken) = plastic(&end, solver);
        expansion.iter_mut().zip(left).for_each(|(p, left)| *p += left);
        settled &= taken;
    }
    bound(problem, &after, &compression, &expansion, p);
    compressed && settled
}

/// Expansion from the velocities after compression. Whether it has settled.
fn expand(after: &ContactProblem, floors: &[f64], deadline: Deadline) -> (Vec<Impulse>, bool) {
    let mut p: Vec<Impulse> = floors.iter().map(|floor| Impulse::new(*floor, 0.0, 0.0)).collect();
    let shares = shares(after);
    let mut u: Vec<Twist> = Vec::new();
    for _ in 0..MOST {
        if deadline.is_over() {
            break;
        }
        after.response(&p, &mut u);
        let (mut largest, mut change) = (0.0_f64, 0.0_f64);
        for (i, block) in after.blocks.iter().enumerate() {
            let A = block.A * shares[i];
            let next = expanded(&A, &(block.velocity(&u) - A * p[i]), block.friction, floors[i]);
            change = change.max((next - p[i]).amax());
            largest = largest.max(next.amax());
            p[i] = next;
        }
        if change <= TOLERANCE * largest {
            return (p, true);
        }
    }
    (p, false)
}

/// Of every contact: among how many contacts its bodies share their masses.
fn shares(problem: &ContactProblem) -> Vec<f64> {
    let mut contacts = vec![0_u32; problem.inertias.len()];
    problem.blocks.iter().flat_map(Block::ends).for_each(|end| contacts[end.body] += 1);
    let moves = |body: usize| problem.inertias[body].mass_kg.is_finite();
    let of = |block: &Block| block.ends().filter(|end| moves(end.body)).map(|end| contacts[end.body]).max();
    problem.blocks.iter().map(|block| f64::from(of(block).unwrap_or(1))).collect()
}

/// The impulse of one contact that would have velocity `q` without it: at least `floor`, more if it would penetrate.
fn expanded(A: &Matrix3<f64>, q: &Vector3<f64>, friction: f64, floor: f64) -> Impulse {
    let at_floor = q + A.column(0) * floor;
    let slip = Vector2::new(at_floor.y, at_floor.z);
    let tangent = disc::least(&A.fixed_view::<2, 2>(1, 1).into_owned(), &-slip, friction * floor);
    if at_floor.x + A[(0, 1)] * tangent.x + A[(0, 2)] * tangent.y >= 0.0 {
        return Impulse::new(floor, tangent.x, tangent.y);
    }
    exact_contact::solve(A, q, &Impulse::zeros(), friction)
}

/// Compression and as much of the expansion as gains no energy, island by island.
fn bound(
    problem: &ContactProblem,
    after: &ContactProblem,
    compression: &[Impulse],
    expansion: &[Impulse],
    p: &mut [Impulse],
) {
    let mut u = Vec::new();
    after.response(expansion, &mut u);
    let end = after.after(&u);
    for island in islands(problem, Deadline::default()) {
        let sum = |of: &dyn Fn(usize) -> f64| island.touches.iter().map(|touch| of(touch.index)).sum::<f64>() / 2.0;
        // Energy gained at θ of the expansion: `compressed` + `linear` θ + `square` θ².
        let compressed = sum(&|i| compression[i].dot(&(problem.blocks[i].b + after.blocks[i].b)));
        let square = sum(&|i| expansion[i].dot(&(end.blocks[i].b - after.blocks[i].b)));
        let linear = sum(&|i| 2.0 * expansion[i].dot(&after.blocks[i].b));
        let part = largest_part(compressed.min(0.0), linear, square);
        for i in island.touches.iter().map(|touch| touch.index) {
            p[i] = compression[i] + expansion[i] * part;
        }
    }
}

/// The largest θ ≤ 1 with a + b θ + c θ² ≤ 0, where a ≤ 0 and c ≥ 0.
fn largest_part(a: f64, b: f64, c: f64) -> f64 {
    if a + b + c <= 0.0 {
        return 1.0;
    }
    let root = (b * b - 4.0 * a * c).sqrt();
    if b > 0.0 { -2.0 * a / (b + root) } else { (root - b) / (2.0 * c) }
}

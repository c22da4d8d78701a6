//! Poisson's law for all contacts at once, in two phases (Ch. Glocker, F. Pfeiffer, Nonlinear Dynamics 7 (1995) 471).
//!
//! Compression: the plastic impulses p_C with friction. Expansion: normal impulses e p_C,n, and of the tangent impulses
//! that Coulomb's discs of radius μ e p_C,n allow those that leave the least energy. What would penetrate after both
//! phases is held by another plastic solve. There is no tangential restitution: a contact that sticks after compression
//! stays stuck where friction allows.
//!
//! A face or a line is any number of contacts at once: what they give back in all is e times what they took, however it
//! is shared among them. Of several bodies each gets back through its contacts e times what it gave, at once: along a
//! chain of balls more than the last one moves.
//!
//! Energetic bound: the expansion of an island that would gain energy over both phases is scaled by the largest factor
//! ≤ 1 that does not; cones, contacts that stick and contacts that separate allow any factor. Where the solver settles
//! the bound is hardly ever met: p = e p_C would gain nothing, as p_C · u_C ≤ 0, and friction chooses what leaves the
//! least energy. It is met where compression has not settled.
//!
//! Friction of the expansion is a convex problem. It is solved by projected Jacobi: all contacts at once, each as if
//! its bodies' masses were shared among their contacts (R. Tonge, F. Benevolenti, A. Voroshilov, ACM Trans. Graph. 31
//! (2012) 105), which keeps symmetric scenes symmetric, as one contact after the other does not; with Nesterov's lead,
//! taken back where it leads uphill (B. O'Donoghue, E. Candès, Found. Comput. Math. 15 (2015) 715).

use super::super::Impulse;
use super::super::block::Block;
use super::super::island::islands;
use super::super::problem::ContactProblem;
use super::super::twist::Twist;
use super::disc;
use super::plastic::{Plastic, plastic, rounding};
use crate::deadline::Deadline;
use nalgebra::Vector2;

const MOST: usize = 2000;

/// Settled: no impulse changes by more than this part of the largest.
const TOLERANCE: f64 = 1e-12;

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
    let radii: Vec<f64> = after.blocks.iter().zip(floors).map(|(block, floor)| block.friction * floor).collect();
    if radii.iter().all(|radius| *radius <= 0.0) {
        return (p, true);
    }
    let shares = shares(after);
    let mut u: Vec<Twist> = Vec::new();
    // Where the next step begins, ahead of `p`, and by which weight.
    let (mut ahead, mut weight) = (p.clone(), 1.0_f64);
    for _ in 0..MOST {
        if deadline.is_over() {
            break;
        }
        after.response(&ahead, &mut u);
        let (mut largest, mut change, mut turned) = (0.0_f64, 0.0_f64, 0.0_f64);
        let next_weight = f64::midpoint(1.0, (1.0 + 4.0 * weight * weight).sqrt());
        let mut last = p.clone();
        for (i, block) in after.blocks.iter().enumerate() {
            let S = block.A.fixed_view::<2, 2>(1, 1) * shares[i];
            let slip = block.velocity(&u);
            let d = S * Vector2::new(ahead[i].y, ahead[i].z) - Vector2::new(slip.y, slip.z);
            let tangent = disc::least(&S, &d, radii[i]);
            let next = Impulse::new(floors[i], tangent.x, tangent.y);
            let moved = next - p[i];
            turned += (ahead[i] - next).dot(&moved) * block.A.trace();
            change = change.max((next - ahead[i]).amax());
            largest = largest.max(next.amax());
            last[i] = std::mem::replace(&mut p[i], next);
        }
        if change <= TOLERANCE * largest {
            return (p, true);
        }
        let lead = if turned > 0.0 { 0.0 } else { (weight - 1.0) / next_weight };
        weight = if turned > 0.0 { 1.0 } else { next_weight };
        ahead.iter_mut().zip(p.iter().zip(&last)).for_each(|(ahead, (p, last))| *ahead = p + (p - last) * lead);
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

//! The exact contact solver: the law of contact (`law.rs`) of all contacts of an island at once, to rounding.
//!
//! Impulses that are near (last step's, mostly) go straight to Newton's method on the law itself (`active_set.rs`:
//! quadratic, once it is known which contacts press), whose steps are complementary where the contacts that press
//! change for ever (`complementary.rs`). Otherwise an interior-point method (`interior.rs`) comes near from nothing.
//! Where friction wedges bodies and its path turns back, proximal problems with a falling η go on from there
//! (`proximal.rs`), and where one of those is not solved, sweeps of exact projected Gauss–Seidel. All of them work on
//! six velocities a body, in sparse blocks; contacts may be as redundant as they like, and pins are among them. Last,
//! redundant contacts share their impulses evenly: those that slip (`active_set::even`), and then, of all impulses that
//! make these velocities, the smallest are taken (`smallest.rs`), wherever the iteration started.
//!
//! Allocates. Residuals are the judge's (`measure::residual`), worked out from J and M⁻¹ as the solver has them.

use super::gauss_seidel::{self, Sweeps, Variant};
use super::island::{Island, Point, islands};
use super::problem::ContactProblem;
use super::{Impulse, active_set, interior, proximal, smallest};
use crate::deadline::Deadline;
use crate::experiment::types::{Cone, Correction, Iteration, Local, Order};
use crate::math::few::Few;
use crate::work::Work;

/// Sweeps to begin with: few contacts are mostly settled by them. And sweeps between two tries where nothing else
/// helps.
const SWEEPS: u32 = 20;
const SWEEPS_OF_FEW: u32 = 100;
const MORE_SWEEPS: u32 = 300;

/// η of the first proximal problem and least, contacts having blocks of trace 1 (rounding of a velocity is felt as 1/η
/// of it); what it is multiplied by when the problem was solved, and when it was not. The first is smaller the nearer
/// impulses are: so many times the residual, to a least first one.
const FIRST_ETA: f64 = 0.1;
const OF_RESIDUAL: f64 = 10.0;
const LEAST_FIRST_ETA: f64 = 1e-6;
const LEAST_ETA: f64 = 1e-8;
const ON: f64 = 0.5;
const BACK: f64 = 4.0;

/// Contacts of a face whose gaps differ by rounding cannot all press. What the wrong one of them has goes to others by
/// what is missing over η in a problem, which is no improvement until it is there: where a hair is missing (so many
/// times the tolerance) after so many problems in vain, η falls further.
const HAIR: f64 = 10.0;
const TRAVELS: u32 = 8;
const TRAVELLING_ETA: f64 = 1e-11;

/// The least η of the way to impulses shared evenly.
const EVEN_ETA: f64 = 1e-3;

/// Rounds toward impulses that contacts that slip share evenly: those of a step begin with the last step's.
pub(super) const ONCE: usize = 1;
const UNTIL_EVEN: usize = 6;

/// Proximal problems in vain after which a residual that is below this is what rounding leaves (masses 1 : 10⁷).
const NEARLY: f64 = 1e-6;
const PATIENCE: u32 = 100;

/// A residual from which Newton's method is worth a try before anything else.
pub(super) const NEAR: f64 = 1e-2;

/// How redundant contacts get even shares: in how many rounds of those that slip, and up to which residual the
/// smallest of all impulses are taken, though others come nearer to the law.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shares {
    pub(super) rounds: usize,
    pub(super) within: f64,
}

/// Improves `p` until the residual of every island is below the tolerance, by at most `sweeps.most` proximal problems
/// each, and makes it the smallest. Whether it is solved, to the tolerance or to rounding.
pub fn solve(
    problem: &ContactProblem,
    sweeps: &Sweeps,
    p: &mut [Impulse],
    scratch: &mut gauss_seidel::Scratch,
    work: &mut Work,
) -> bool {
    let shares = Shares { rounds: ONCE, within: sweeps.tolerance };
    improve(problem, &islands(problem, sweeps.deadline), sweeps, p, shares, scratch, work)
}

fn improve(
    problem: &ContactProblem,
    islands: &[Island],
    sweeps: &Sweeps,
    p: &mut [Impulse],
    shares: Shares,
    scratch: &mut gauss_seidel::Scratch,
    work: &mut Work,
) -> bool {
    let near = |island: &Island| island.residual(&island.impulses(p)) <= NEAR;
    if !islands.iter().all(near) {
        let most = if problem.is_dense() { SWEEPS_OF_FEW } else { SWEEPS };
        let first = Sweeps { most, tolerance: 0.0, ..*sweeps };
        gauss_seidel::iterate(problem, &first, p, scratch, work);
    }
    let mut solved = true;
    for island in islands {
        let mut own = island.at(island.impulses(p));
        let more = |own: &mut Few<Impulse>, work: &mut Work| {
            let mut others = p.to_vec();
            island.put(own, &mut others);
            gauss_seidel::iterate(problem, &more_sweeps(sweeps), &mut others, scratch, work);
            *own = island.impulses(&others);
        };
        solved &= solve_island(island, sweeps, &mut own, shares, more, work);
        island.put(&own.p, p);
    }
    solved
}

/// Sweeps where nothing else helps: another order every time, contact by contact exactly.
pub(super) fn more_sweeps(goal: &Sweeps) -> Sweeps {
    let variant = Variant { local: Local::Exact, order: Order::Shuffled, ..Variant::default() };
    Sweeps { most: MORE_SWEEPS, tolerance: 0.0, variant, ..*goal }
}

/// What whoever steps from event to event asks for.
pub fn to_rounding(most: u32, deadline: Deadline) -> Sweeps {
    Sweeps {
        iteration: Iteration::GaussSeidel,
        correction: Correction::PerContact,
        cone: Cone::Disc,
        most,
        tolerance: 1e-12,
        friction: true,
        variant: Variant::default(),
        deadline,
    }
}

/// `goal`: to rounding. From nothing, on a way that does not depend on the order of the contacts: by proximal
/// problems about nothing, with a falling η.
pub fn solve_evenly(problem: &ContactProblem, goal: &Sweeps, p: &mut [Impulse], work: &mut Work) -> bool {
    let islands = islands(problem, goal.deadline);
    for island in &islands {
        island.put(&evenly(island, work), p);
    }
    share_evenly(problem, &islands, goal, p, work)
}

/// The same from impulses that are near.
pub fn solve_near(problem: &ContactProblem, goal: &Sweeps, p: &mut [Impulse], work: &mut Work) -> bool {
    share_evenly(problem, &islands(problem, goal.deadline), goal, p, work)
}

fn share_evenly(
    problem: &ContactProblem,
    islands: &[Island],
    goal: &Sweeps,
    p: &mut [Impulse],
    work: &mut Work,
) -> bool {
    let mut scratch = gauss_seidel::Scratch::with_capacity(p.len(), 0);
    let shares = Shares { rounds: UNTIL_EVEN, within: goal.tolerance };
    improve(problem, islands, goal, p, shares, &mut scratch, work)
}

fn evenly(island: &Island, work: &mut Work) -> Few<Impulse> {
    let nothing = Few::from_elem(Impulse::zeros(), island.touches.len());
    let (mut p, mut eta) = (nothing.clone(), FIRST_ETA);
    while eta >= EVEN_ETA && !island.deadline.is_over() {
        let Some(next) = proximal::solve(island, &nothing, &p, eta, &mut work.newton_steps) else { break };
        p = next;
        eta /= BACK;
    }
    p
}

/// By at most `goal.most` proximal problems; `sweep` goes on where nothing else helps. Whether it is solved.
pub(super) fn solve_island(
    island: &Island,
    goal: &Sweeps,
    at: &mut Point,
    shares: Shares,
    mut sweep: impl FnMut(&mut Few<Impulse>, &mut Work),
    work: &mut Work,
) -> bool {
    let mut best = island.residual_at(at);
    let is_enough = |residual: f64, at: &Point| island.is_enough(residual, goal.tolerance, at);
    let keep = |best: &mut f64, at: &mut Point, mut tried: Point, residual: f64, work: &mut Work| {
        let mut residual = active_set::improve(island, &mut tried, residual, goal.tolerance, &mut work.newton_steps);
        if residual <= NEARLY && !is_enough(residual, &tried) {
            let steps = &mut work.newton_steps;
            residual = active_set::improve_near(island, &mut tried, residual, goal.tolerance, steps);
        }
        if residual < *best {
            (*best, *at) = (residual, tried);
        }
    };
    // What slips and is near goes to its even shares at once, or once it is nearer, and is solved there.
    let mut is_even = false;
    if best <= NEAR && active_set::may_be_shared(island, &at.p) {
        let (mut from, mut left, steps) = (at.clone(), best, &mut work.newton_steps);
        for is_nearly in [best <= NEARLY, true] {
            if is_nearly {
                left = active_set::approach(island, &mut from, left, NEARLY, steps);
            }
            if is_nearly && left > NEARLY {
                break;
            }
            let farthest = if is_nearly { f64::INFINITY } else { NEARLY };
            let mut tried = from.clone();
            let until = (shares.rounds, farthest, goal.tolerance);
            let residual = active_set::even(island, &mut tried, left, until, steps);
            is_even = is_enough(residual, &tried);
            if is_even {
                (best, *at) = (residual, tried);
            }
            if is_even || is_nearly {
                break;
            }
        }
    }
    if best <= NEAR && !is_even {
        let (tried, residual) = (at.clone(), best);
        keep(&mut best, at, tried, residual, work);
    }
    if !is_enough(best, at)
        && let Some((found, residual)) = interior::solve(island, &mut work.newton_steps)
    {
        keep(&mut best, at, found, residual, work);
    }
    let (mut centre, mut eta) = (at.p.clone(), (OF_RESIDUAL * best).clamp(LEAST_FIRST_ETA, FIRST_ETA));
    let (mut last, mut in_vain, mut may_travel) = (best, 0, true);
    for _ in 0..goal.most {
        in_vain = if best < last { 0 } else { in_vain + 1 };
        last = best;
        let is_rounding = best <= NEARLY && in_vain > PATIENCE;
        if is_enough(best, at) || is_rounding || island.deadline.is_over() {
            break;
        }
        if let Some(next) = proximal::solve(island, &centre, &centre, eta, &mut work.newton_steps) {
            let travels = may_travel && best <= HAIR * goal.tolerance && in_vain > TRAVELS;
            eta = (eta * ON).max(if travels { TRAVELLING_ETA } else { LEAST_ETA });
            centre = next;
        } else {
            may_travel &= eta >= LEAST_ETA;
            eta = eta.max(LEAST_ETA) * BACK;
            sweep(&mut centre, work);
        }
        let tried = island.at(centre.clone());
        let residual = island.residual_at(&tried);
        keep(&mut best, at, tried, residual, work);
    }
    if !is_even && is_enough(best, at) && active_set::may_be_shared(island, &at.p) {
        let until = (shares.rounds, f64::INFINITY, goal.tolerance);
        best = active_set::even(island, at, best, until, &mut work.newton_steps);
    }
    // The shares of what slips are even already, if one round is all that is asked for.
    if shares.rounds == ONCE && is_enough(best, at) && active_set::all_slip(island, &at.p) {
        return true;
    }
    // A velocity that so exact impulses leave is rounding.
    let small = (100.0 * best).clamp(1e-13, 1e-10);
    let (least, residual) = smallest::impulses(island, at, small, &mut work.newton_steps);
    let within = if goal.tolerance > 0.0 { shares.within.max(island.rounding(&least)) } else { 0.0 };
    if residual <= best.max(within) {
        (best, *at) = (residual, least);
    }
    is_enough(best, at)
}

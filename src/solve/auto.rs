//! The solver `auto`: every island, in every step, by the exact solver or, where that is too dear, by the best
//! iteration. Counts decide, never a clock: the products of blocks that the factors of its linear system take
//! (`AFFORDABLE_PRODUCTS`; `rule_of_auto` says it to people).
//!
//! One contact alone has a closed solution. From where impulses are near, Newton's method goes on alone, and what
//! redundant contacts share stays as it was. Few contacts that are not near are mostly so after some sweeps; only what
//! is left then goes the whole way of the exact solver, and so does what slips different ways, as there even shares are
//! a part of the answer. Islands that are too large, and what the exact solver is given up at, are left to conjugate
//! gradients, whose starts survive from step to step; where they miss the tolerance they say so.

use super::block::Block;
use super::gauss_seidel::{self, Sweeps};
use super::island::{Island, Point, islands_without_pattern};
use super::kept::{AT_REST, KEPT, Start};
use super::missed::shares_matter;
use super::problem::ContactProblem;
use super::twist::Twist;
use super::{Impulse, active_set, exact_contact, newton, nncg};
use crate::experiment::types::{AFFORDABLE_BODIES, AFFORDABLE_PROBLEMS, AFFORDABLE_PRODUCTS, FEWEST_PROBLEMS};
use crate::math::few::Few;
use crate::work::Work;

/// Sweeps before a look whether impulses are near enough for Newton's method: of few contacts, and of many.
const SWEEPS_OF_FEW: [u32; 4] = [0, 8, 16, 32];
/// The same of few contacts that are not near, before anything else is made: they mostly settle within some of them.
const FIRST_SWEEPS: u32 = 8;
const SWEEPS: [u32; 2] = [0, 20];
/// The same of an island that is too large for anything else.
const MANY_SWEEPS: [u32; 8] = [50; 8];

/// Improves `p` until the residual of every island is below the tolerance. Whether it is. `expected`: where islands
/// begin whose shares are a part of the answer, if that is nearer, or empty: what contacts share otherwise stays as it
/// was, which is no way to go on. `u`: M⁻¹ Jᵀ p.
pub(super) fn solve(
    problem: &ContactProblem,
    goal: &Sweeps,
    (p, mut expected): (&mut [Impulse], &[Impulse]),
    (mut start, u): (Start, &mut Vec<Twist>),
    scratch: &mut Scratch,
    work: &mut Work,
) -> bool {
    if problem.is_dense() && (start.residual > newton::NEAR || problem.blocks.len() == 1) {
        if let Some(alone) = alone(problem) {
            p[0] = exact_contact::solve(&alone.A, &alone.b, &Impulse::zeros(), alone.friction);
        } else {
            let sweeps = Sweeps { most: FIRST_SWEEPS, tolerance: AT_REST, ..*goal };
            gauss_seidel::iterate(problem, &sweeps, p, &mut scratch.nncg.sweeps, work);
        }
        (start, expected) = (Start::new(problem, p, u), &[]);
        if start.lasts(goal.tolerance) {
            work.exact_solves += 1;
            return true;
        }
    }
    let mut islands = islands_without_pattern(problem, goal.deadline);
    let alone = islands.len() == 1 && islands[0].touches.len() == problem.blocks.len();
    let mut solved = true;
    for island in &mut islands {
        let mut own = island.at(island.impulses(p));
        let is_new = own.p.iter().all(|p| *p == Impulse::zeros());
        let contacts = || island.touches.iter().map(|touch| touch.index);
        let is_shared = is_new || if alone { start.is_shared } else { shares_matter(problem, contacts(), p, u) };
        if scratch.keeps && !is_shared && island.is_strictly_met(KEPT * goal.tolerance, &own) {
            work.kept_solves += 1;
            continue;
        }
        if is_shared && !expected.is_empty() {
            let on = island.at(island.impulses(expected));
            if island.residual_at(&on) < island.residual_at(&own) {
                own = on;
            }
        }
        let part = (!alone).then(|| problem.part(contacts()));
        let problem = part.as_ref().unwrap_or(problem);
        let most = (AFFORDABLE_PROBLEMS / island.bodies() as u32).max(FEWEST_PROBLEMS);
        let goal = Sweeps { most, ..*goal };
        solved &= Part { problem, goal, is_shared, scratch: &mut scratch.nncg }.solve(island, &mut own, work);
        island.put(&own.p, p);
    }
    solved
}

/// The only contact, which has a closed solution.
fn alone(problem: &ContactProblem) -> Option<&Block> {
    match &problem.blocks[..] {
        [block] if block.pin.is_none() => Some(block),
        _ => None,
    }
}

/// The solver's memory between steps.
#[derive(Clone, Debug)]
pub struct Scratch {
    nncg: nncg::Scratch,
    /// Whether impulses of the last step that still obey the law are taken as they are.
    keeps: bool,
}

impl Scratch {
    pub fn with_capacity(contacts: usize, bodies: usize, keeps: bool) -> Self {
        Scratch { nncg: nncg::Scratch::with_capacity(contacts, bodies), keeps }
    }
}

/// An island's contacts, and what sweeps over them need.
struct Part<'a> {
    problem: &'a ContactProblem,
    goal: Sweeps,
    /// Even shares are a part of the answer.
    is_shared: bool,
    scratch: &'a mut nncg::Scratch,
}

impl Part<'_> {
    fn solve(&mut self, island: &mut Island, own: &mut Point, work: &mut Work) -> bool {
        let is_affordable = island.is_affordable(AFFORDABLE_BODIES, AFFORDABLE_PRODUCTS);
        *(if is_affordable { &mut work.exact_solves } else { &mut work.iterated_solves }) += 1;
        if !is_affordable {
            return self.sweep_until_solved(island, own, work);
        }
        let sweeps: &[u32] = if self.problem.is_dense() { &SWEEPS_OF_FEW } else { &SWEEPS };
        for most in sweeps {
            if *most > 0 {
                self.sweep(island, own, *most, work);
            }
            let residual = island.residual_at(own);
            if residual <= newton::NEAR && (self.is_shared || self.goes_on(island, own, residual, work)) {
                break;
            }
        }
        if !self.is_shared && island.is_strictly_met(KEPT * self.goal.tolerance, own) {
            return true;
        }
        let goal = self.goal;
        let within = if self.is_shared { goal.tolerance } else { AT_REST };
        let sweeps = newton::more_sweeps(&goal);
        let more = |own: &mut Few<Impulse>, work: &mut Work| {
            let mut p = island.with_units(own);
            gauss_seidel::iterate(self.problem, &sweeps, &mut p, &mut self.scratch.sweeps, work);
            *own = island.without_units(&p);
        };
        let shares = newton::Shares { rounds: newton::ONCE, within };
        newton::solve_island(island, &goal, own, shares, more, work) || self.sweep_on(island, own, work)
    }

    /// By conjugate gradients, from what the exact solver was given up at. Whether they got there.
    fn sweep_on(&mut self, island: &Island, own: &mut Point, work: &mut Work) -> bool {
        let mut swept = own.clone();
        let solved = self.sweep_until_solved(island, &mut swept, work);
        if solved || island.residual_at(&swept) < island.residual_at(own) {
            *own = swept;
        }
        solved
    }

    /// By Newton's method, from impulses that are near. Whether that was enough.
    fn goes_on(&self, island: &Island, own: &mut Point, residual: f64, work: &mut Work) -> bool {
        active_set::improve_near(island, own, residual, self.goal.tolerance, &mut work.newton_steps);
        island.is_strictly_met(KEPT * self.goal.tolerance, own)
    }

    /// By conjugate gradients.
    fn sweep(&mut self, island: &Island, own: &mut Point, most: u32, work: &mut Work) {
        let mut p = island.with_units(&own.p);
        let sweeps = Sweeps { most, tolerance: 0.0, ..self.goal };
        nncg::iterate(self.problem, &sweeps, &mut p, self.scratch, work);
        *own = island.at(island.without_units(&p));
    }

    /// Looks after every batch of sweeps.
    fn sweep_until_solved(&mut self, island: &Island, own: &mut Point, work: &mut Work) -> bool {
        MANY_SWEEPS.iter().any(|most| {
            self.sweep(island, own, *most, work);
            island.is_strictly_met(self.goal.tolerance, own)
        })
    }
}

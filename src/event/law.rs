//! The law of contact for accelerations, of all contacts at once, by the exact contact solver: for contacts that do not
//! slip it is the same law with accelerations for velocities; one that slips gets so large a fictitious slip that its
//! force is on the edge of the cone.
//!
//! It works on six numbers a body, and its forces are shared evenly: of many contacts, most of them redundant, this is
//! what elimination among their forces (`forces`) has no time for.

use super::forces::{self, Gathered, Held, Mode, Solved};
use crate::deadline::Deadline;
use crate::math::full_pivot::Selection;
use crate::solve::block::Block;
use crate::solve::island::islands;
use crate::solve::problem::ContactProblem;
use crate::solve::{Impulse, exact_contact, newton};
use crate::work::Work;
use nalgebra::Vector3;

/// What the law's solution leaves, relative to the largest acceleration or force: rounding of redundant contacts.
pub const ROUNDING: f64 = 1e-10;

/// Contacts above which forces of what holds are those of the law: leaving out one after another of those that pull
/// takes a minute of more than so many (measured: 400 take half an hour, the law 0.04 s).
pub const MANY: usize = 128;

/// Proximal problems of an island before it is looked at whether what is left is rounding, and before the law is given
/// up.
const FEW: u32 = 4;
const MOST: u32 = 100;

/// A residual that redundant contacts are left with, whatever is tried (measured: 1e-12 to 6e-11, where some of them
/// slip by a millionth of what others do).
const LEFT: f64 = 1e-10;

/// Fictitious slip over the largest acceleration.
const FAST: f64 = 1e3;

/// Times that the direction of the fictitious slip is set right, by a thousandth each time, and what of it is rounding.
const TURNS: u32 = 5;
const TURNED: f64 = 1e-13;

/// What is left of a fictitious slip that is stopped, relative to it: of one that is not, nearly all.
const STOPPED: f64 = 1e-6;

/// What the law of all contacts says.
pub enum Law {
    /// These contacts hold, by their places, so.
    Holds(Vec<(usize, Mode)>, Box<Solved>),
    Jams,
    Unsolved,
}

/// The law of all contacts, of which what slips slips on.
pub fn by_law(gathered: &Gathered, modes: &[Mode], work: &mut Work) -> Law {
    let scale = gathered.scale();
    let mut problem = gathered.problem.clone();
    let mut p = vec![Impulse::zeros(); problem.blocks.len()];
    let mut aside = vec![Vector3::zeros(); modes.len()];
    let mut solved = gathered.without_forces();
    // Forces are against the fictitious slip and what accelerates it: what of that is across is taken off.
    for turn in 0..TURNS {
        slip_fast(gathered, modes, &aside, &mut problem);
        // Little has changed after the first.
        let is_solved =
            turn > 0 && newton::solve_near(&problem, &newton::to_rounding(FEW, gathered.deadline), &mut p, work);
        if !is_solved && !solve_evenly(&problem, &mut p, gathered.deadline, work) {
            if gathered.deadline.is_over() || !is_nearly_solved(&problem, &p) {
                return Law::Unsolved;
            }
            work.unsolved += 1;
        }
        solved = gathered.solved(p.clone(), true);
        let mut turned = 0.0_f64;
        for (i, mode) in modes.iter().enumerate() {
            if let Mode::Slide(d) = mode
                && *d != Vector3::zeros()
            {
                let across = across_W(&gathered.problem.blocks[i], d, &solved);
                if solved.p[i].x > 0.0 {
                    turned = turned.max((across - aside[i]).norm());
                }
                aside[i] = across;
            }
        }
        if turned <= TURNED * FAST * scale {
            break;
        }
    }
    let mut held = Vec::new();
    for (i, mode) in modes.iter().enumerate() {
        let (block, p) = (&gathered.problem.blocks[i], &solved.p[i]);
        let a = block.velocity(&solved.added);
        if let Mode::Slide(d) = mode
            && is_stopped(block, p, &a, FAST * scale * d - aside[i])
        {
            return Law::Jams;
        }
        if a.x > ROUNDING * scale {
            continue;
        }
        let a_W = block.along_W(&a);
        let mode = match mode {
            // Against its force, which is known to more digits than an acceleration that has just begun.
            Mode::Stick if a_W.norm() > ROUNDING * scale => {
                let p_W = block.along_W(p);
                Mode::Slide((-p_W).try_normalize(0.0).unwrap_or_else(|| a_W.normalize()))
            }
            mode => *mode,
        };
        held.push((i, mode));
    }
    Law::Holds(held, Box::new(solved))
}

/// Gives what slides its fictitious slip, less what of it is aside.
pub fn slip_fast(gathered: &Gathered, modes: &[Mode], aside: &[Vector3<f64>], problem: &mut ContactProblem) {
    let fast = FAST * gathered.scale();
    for (((block, own), mode), aside) in problem.blocks.iter_mut().zip(&gathered.problem.blocks).zip(modes).zip(aside) {
        if let Mode::Slide(d) = mode {
            let slip_W = d * fast - aside;
            block.b.y = own.b.y + slip_W.dot(&block.frame[1]);
            block.b.z = own.b.z + slip_W.dot(&block.frame[2]);
        }
    }
}

/// Of a contact's acceleration, what is across its direction, along the surface.
pub fn across_W(block: &Block, d: &Vector3<f64>, solved: &Solved) -> Vector3<f64> {
    let a_W = block.along_W(&block.velocity(&solved.added));
    a_W - d * d.dot(&a_W)
}

/// Contacts that one of the simple answers is looked for of.
const FEW_CONTACTS: usize = 4;

/// Simple answers of the law, of few contacts: all of them stick, or one alone presses. Whether there is one.
fn solve_at_once(problem: &ContactProblem, p: &mut [Impulse], deadline: Deadline) -> bool {
    let blocks = &problem.blocks;
    if blocks.len() > FEW_CONTACTS || blocks.iter().any(|block| block.pin.is_some()) {
        return false;
    }
    if let Some(sticking) = forces::stop(problem, deadline) {
        let is_lawful = |(block, p): (&Block, &Impulse)| p.x >= 0.0 && p.yz().norm() <= block.friction * p.x;
        if blocks.iter().zip(&sticking).all(is_lawful) {
            p.copy_from_slice(&sticking);
            return true;
        }
    }
    for (i, block) in blocks.iter().enumerate().filter(|(_, block)| block.b.x < 0.0) {
        let alone = exact_contact::solve(&block.A, &block.b, &Impulse::zeros(), block.friction);
        let responses = block.responses(&alone);
        let opens = |other: &Block| other.b.x + other.row_of(0, block, &responses) >= 0.0;
        if blocks.iter().enumerate().all(|(j, other)| j == i || opens(other)) {
            p.fill(Impulse::zeros());
            p[i] = alone;
            return true;
        }
    }
    false
}

/// Impulses, or forces, that obey the law, from nothing. Whether they do, to rounding.
pub(super) fn solve_evenly(problem: &ContactProblem, p: &mut [Impulse], deadline: Deadline, work: &mut Work) -> bool {
    if solve_at_once(problem, p, deadline) {
        return true;
    }
    if newton::solve_evenly(problem, &newton::to_rounding(FEW, deadline), p, work) {
        return true;
    }
    let left = islands(problem, deadline).iter().map(|island| island.residual(&island.impulses(p))).fold(0.0, f64::max);
    left <= LEFT || newton::solve_evenly(problem, &newton::to_rounding(MOST, deadline), p, work)
}

/// What a solution may leave that is not one to rounding, relative to the largest acceleration and force: column
/// `work_unsolved` counts it.
const NEARLY: f64 = 1e-8;

/// The law of every contact, to `NEARLY`.
fn is_nearly_solved(problem: &ContactProblem, p: &[Impulse]) -> bool {
    let mut added = Vec::new();
    problem.response(p, &mut added);
    let largest = p.iter().map(|p| p.norm()).fold(0.0, f64::max);
    let scale = problem.blocks.iter().map(|block| block.b.norm()).fold(0.0, f64::max);
    let (force, acceleration) = (NEARLY * largest, NEARLY * scale);
    problem.blocks.iter().zip(p).all(|(block, p)| {
        let (a, most) = (block.velocity(&added), block.friction * p.x);
        let (slips, rubs) = (a.yz(), p.yz());
        let presses = p.x >= -force && a.x >= -acceleration && (p.x <= force || a.x <= acceleration);
        let against = slips.norm() <= acceleration || (rubs + slips.normalize() * most).norm() <= force;
        block.pin.is_some() || (presses && rubs.norm() <= most + force && (p.x <= force || against))
    })
}

/// Even the fictitious slip.
fn is_stopped(block: &Block, p: &Impulse, a: &Vector3<f64>, slip_W: Vector3<f64>) -> bool {
    let left = Vector3::new(0.0, a.y + slip_W.dot(&block.frame[1]), a.z + slip_W.dot(&block.frame[2]));
    slip_W != Vector3::zeros() && p.x > 0.0 && left.norm() <= STOPPED * slip_W.norm()
}

/// Forces for what holds, pins with it.
pub fn hold(gathered: &Gathered, held: &[Held], choice: Selection, work: &mut Work) -> Solved {
    if held.len() > MANY {
        let modes: Vec<Mode> = gathered.modes(held).collect();
        if let Law::Holds(now, solved) = by_law(gathered, &modes, work)
            && goes_on(&now, &modes)
        {
            return *solved;
        }
    }
    gathered.hold(held, choice)
}

/// All contacts hold as they did.
pub fn goes_on(now: &[(usize, Mode)], before: &[Mode]) -> bool {
    now.len() == before.len() && now.iter().zip(before).all(|((_, now), before)| now == before)
}

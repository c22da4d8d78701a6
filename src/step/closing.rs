//! Gaps and depths that an iteration makes under what it holds.
//!
//! Sweeps that end before they have settled leave some velocity at contacts that press, and that opens gaps. If such a
//! gap had to close within a step, impulses would follow places. An iteration takes many steps to mend a slow mode of
//! its bodies, and what then follows places swings further and further: a stack of 20 cubes at 4 ms swayed by 0.25 m
//! within a minute, fed by the height that it lost and was given back. It comes to rest where gaps close more slowly
//! than the slowest mode is mended, and where as much depth is left as bodies sink by before the sweeps have found what
//! holds them: so that they press on all their contacts.

use crate::collide::Contact;
use crate::solve::Impulse;
use crate::solve::block::Block;
use crate::solve::problem::ContactProblem;
use crate::solve::twist::Twist;
use crate::state::State;
use nalgebra::Vector3;

/// Part of such a gap that closes in a step. A tenth still lets a stack of 20 sway.
const PART: f64 = 0.01;

/// A depth that is left, in ways that the step's forces lead a body: a stack of 20 sinks by 1.6 of them.
const DEPTH: f64 = 2.0;

/// Lets gaps of contacts that pressed in the last step close by a part. `last`: its impulses.
pub(super) fn close_slowly(problem: &mut ContactProblem, contacts: &[Contact], last: &[Impulse], step_s: f64) {
    let contacts = problem.blocks.iter_mut().zip(contacts).zip(last);
    let closes = |block: &Block, contact: &Contact, p: &Impulse| p.x > 0.0 && contact.gap_m > 0.0 && block.least < 0.0;
    for ((block, contact), _) in contacts.filter(|((block, contact), p)| closes(block, contact, p)) {
        block.ask_for((block.least + contact.gap_m / step_s * (1.0 - PART)).min(0.0));
    }
}

/// The depth that is left to a contact in a step that is not solved.
pub(super) fn left_m(contact: &Contact, before: &State, free: &[Twist], step_s: f64) -> f64 {
    let fall_m = |(i, ..): (usize, Vector3<f64>, f64)| step_s * (free[i].v - before.bodies[i].v_WB).norm();
    DEPTH * contact.ends().map(fall_m).fold(0.0, f64::max)
}

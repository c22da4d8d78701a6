//! Friction of contacts side by side in one proportion to their normal forces.
//!
//! What sticks on several points shares its forces in many ways, and the smallest ones may be outside of some cone
//! where others are in all of them. A pile that slides as one has friction at the very edge of every cone of one
//! coefficient: one way alone is left then, all friction in proportion to what presses, and iteration comes to it
//! slowly, if at all. It is one linear system, as the sum of each pair's friction and of what presses is known from
//! any other way.

use super::forces::{Gathered, Mode, Solved};
use super::law::ROUNDING;
use crate::math::few::Few;
use crate::math::full_pivot::Selection;
use nalgebra::Vector3;

/// Normals that differ by less are one.
const SAME_NORMAL: f64 = 1e-9;

/// Of the friction that contacts side by side have: that they need all of it.
const ALL: f64 = 1e-9;

/// Forces with the motion of these, in cones, of contacts that stick side by side in one proportion. None: their
/// friction turns the bodies against each other, or some contact pulls or needs more friction than it has.
pub fn in_proportion(gathered: &Gathered, modes: &[Mode], solved: &Solved) -> Option<Solved> {
    let blocks = &gathered.problem.blocks;
    let now = rubbing(gathered, modes, solved, 0.0)?;
    let shared = gathered.hold_as(now.into_iter(), Selection::Least);
    let largest = shared.largest();
    let presses = shared.p.iter().take(modes.len()).all(|p| p.x >= -ROUNDING * largest);
    let rounding = ROUNDING * gathered.scale();
    let sticks = |i: usize| modes[i] != Mode::Stick || blocks[i].velocity(&shared.added).norm() <= rounding;
    (shared.holds && presses && (0..modes.len()).all(sticks)).then_some(shared)
}

/// Modes by which contacts that stick side by side, and need all of their friction, can have it in one direction alone.
/// None: they need more.
pub fn at_edge(gathered: &Gathered, modes: &[Mode], solved: &Solved) -> Option<Few<Mode>> {
    rubbing(gathered, modes, solved, 1.0 - ALL)
}

/// Modes of contacts that stick side by side, and need so much of their friction: it is in one proportion to what
/// presses. None: some need more than they have.
fn rubbing(gathered: &Gathered, modes: &[Mode], solved: &Solved, part: f64) -> Option<Few<Mode>> {
    let blocks = &gathered.problem.blocks;
    let mut now: Few<Mode> = modes.iter().copied().collect();
    for i in (0..modes.len()).filter(|i| modes[*i] == Mode::Stick) {
        let together = || (0..modes.len()).filter(|j| modes[*j] == Mode::Stick && are_beside(gathered, [i, *j]));
        if together().next() != Some(i) {
            continue;
        }
        let rubs_W: Vector3<f64> = together().map(|j| blocks[j].along_W(&solved.p[j])).sum();
        let most = blocks[i].friction * together().map(|j| solved.p[j].x).sum::<f64>();
        if most <= 0.0 || rubs_W.norm() > most * (1.0 + ROUNDING) {
            return None;
        }
        // What slides has all of its friction against its direction, which is of length 1; this has a part of it.
        if rubs_W.norm() >= part * most {
            together().for_each(|j| now[j] = Mode::Slide(-rubs_W / most));
        }
    }
    Some(now)
}

/// Whether two contacts are of one pair of bodies, in one plane, and rub alike.
pub fn are_beside(gathered: &Gathered, [i, j]: [usize; 2]) -> bool {
    let [a, b] = [i, j].map(|k| &gathered.here[k].contact);
    let same = a.friction == b.friction && (a.normal - b.normal).norm() <= SAME_NORMAL;
    (a.body, a.other) == (b.body, b.other) && same
}

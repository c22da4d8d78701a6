//! Shares of forces by which all contacts go on as they do.
//!
//! Redundant contacts share their forces in many ways, and what sticks goes on as long as there is one in which none of
//! them pulls or needs more friction than it has. The law's solver may come to another answer, where some of them slip,
//! as friction is not associated: which one it comes to is then a matter of rounding. What forces do to the bodies is
//! linear in them and their cones are convex, so that whether there are such forces has one answer, and the smallest of
//! them are found (`solve::smallest`).

use super::forces::{Gathered, Mode, Solved};
use super::last_forces::is_lawful;
use super::law::{ROUNDING, across_W, slip_fast};
use super::proportion::{at_edge, in_proportion};
use crate::solve::island::islands;
use crate::solve::smallest;
use crate::work::Work;
use nalgebra::Vector3;

/// Forces with the motion of these, of contacts that press and have their friction within their cones. None: there are
/// none.
pub fn lawful_shares(gathered: &Gathered, modes: &[Mode], solved: &Solved, work: &mut Work) -> Option<Solved> {
    in_proportion(gathered, modes, solved).or_else(|| smallest_shares(gathered, modes, solved, work))
}

/// The smallest of them.
fn smallest_shares(gathered: &Gathered, modes: &[Mode], solved: &Solved, work: &mut Work) -> Option<Solved> {
    if !solved.holds || solved.largest() == 0.0 {
        return None;
    }
    let edges = at_edge(gathered, modes, solved)?;
    let mut problem = gathered.problem.clone();
    // Along its direction, that is.
    let aside = |(mode, block)| match mode {
        &Mode::Slide(d) if d != Vector3::zeros() => across_W(block, &d, solved),
        _ => Vector3::zeros(),
    };
    let aside: Vec<Vector3<f64>> = edges.iter().zip(&gathered.problem.blocks).map(aside).collect();
    slip_fast(gathered, &edges, &aside, &mut problem);
    let mut p = solved.p.clone();
    for island in islands(&problem, gathered.deadline) {
        let (least, _) = smallest::impulses(&island, &island.at(island.impulses(&p)), ROUNDING, &mut work.newton_steps);
        island.put(&least.p, &mut p);
    }
    let found = gathered.solved(p, true);
    let is_lawful = |(i, mode): (usize, &Mode)| is_lawful(gathered, i, *mode, &found);
    modes.iter().enumerate().all(is_lawful).then_some(found)
}

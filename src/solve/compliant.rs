//! Contacts that give a little, all alike: of the impulses that redundant contacts may share, those with the least
//! Σ|p|², at once with the velocities that these make, where contacts slip different ways.
//!
//! The proximal problem about nothing (`proximal.rs`) is that of such contacts. From one step to the next they mostly
//! go on as they are, so that one linear system comes near. What giving leaves is taken away by Newton's method on the
//! law itself (`active_set.rs`), which keeps the shares.

use super::Impulse;
use super::active_set;
use super::island::{Island, Share};
use super::proximal::Problem;

/// η of contacts, whose blocks have a trace of 1.
const ETA: f64 = 1e-5;

/// Those of problems about what was found, where faces that are not quite flat bear on a part of their points.
const LESS: [f64; 3] = [1e-6, 1e-7, 1e-8];

/// Linear systems of a problem whose contacts go on as they are, and of others.
const FEW: usize = 8;
const MOST: usize = 15;

/// Of |y| what may be missing.
const FINE: f64 = 1e-4;

/// The impulses, and their residual. None: not found.
pub(super) fn solve(island: &Island, p: &[Impulse], tolerance: f64, steps: &mut u64) -> Option<(Vec<Impulse>, f64)> {
    let nothing = vec![Impulse::zeros(); p.len()];
    let largest = island.touches.iter().map(|touch| touch.scale).fold(0.0, f64::max);
    let etas = |eta: f64| -> Vec<f64> {
        let of = |touch: &Share| eta * (touch.scale / largest) * (touch.scale / largest);
        island.touches.iter().map(of).collect()
    };
    let fine = etas(ETA);
    let problem = Problem { island, centre: &nothing, etas: &fine, tolerance: FINE };
    let mut found = problem.solve(problem.as_before(p, steps)?, FEW, steps)?;
    let mut best = found.p.clone();
    let mut residual = active_set::try_to_improve(island, &mut best, tolerance, steps);
    for eta in LESS {
        if island.is_enough(residual, tolerance, &best) {
            break;
        }
        let etas = etas(eta);
        let problem = Problem { etas: &etas, centre: &found.p, ..problem };
        let Some(next) = problem.solve(found.y.clone(), MOST, steps) else { break };
        let mut tried = next.p.clone();
        let reached = active_set::try_to_improve(island, &mut tried, tolerance, steps);
        if reached < residual {
            (best, residual) = (tried, reached);
        }
        found = next;
    }
    Some((best, residual))
}

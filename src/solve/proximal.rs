//! The proximal problem of an island (R. T. Rockafellar, SIAM J. Control Optim. 14 (1976) 877): the law of contact with
//! ũ + η (p − p_centre) in place of ũ. Then p is a function of the velocity,
//!
//! p(y) = P_K(p_centre − ũ(y)/η),
//!
//! and y = Gᵀ p(y) a semi-smooth equation in six numbers a body that is regular however redundant the contacts are (the
//! augmented Lagrangian of P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92 (1991) 353 with De Saxcé's
//! cone).

use super::island::{Island, Share};
use super::slope::Slope;
use super::{Impulse, law};
use crate::math::few::{BlockVector, Few};
use nalgebra::{Matrix3, Vector3};

/// Newton steps after which the problem is given up: with a larger η it is easier.
const MOST: usize = 15;

/// Of |y| what may be missing: the next problem has another centre, or another η, anyway.
const TOLERANCE: f64 = 1e-6;

/// Halvings of a step before it is given up.
const HALVINGS: usize = 30;

/// p(y) and what it follows from.
struct At {
    y: BlockVector,
    u: Few<Vector3<f64>>,
    /// p_centre − ũ/η.
    z: Few<Vector3<f64>>,
    p: Few<Impulse>,
    /// y − Gᵀ p(y).
    missing: BlockVector,
}

impl At {
    fn new(island: &Island, centre: &[Impulse], eta: f64, y: BlockVector) -> Self {
        let u = island.velocities(&y);
        let touches = || island.touches.iter();
        let point = |((touch, p), u): ((&Share, &Impulse), &Vector3<f64>)| p - law::dual(u, touch.law) / eta;
        let z: Few<_> = touches().zip(centre).zip(&u).map(point).collect();
        let p: Few<_> = touches().zip(&z).map(|(touch, z)| law::in_cone(z, touch.law)).collect();
        let missing = y.minus(&island.pushed(p.iter().copied()));
        At { y, u, z, p, missing }
    }

    fn is_found(&self) -> bool {
        self.missing.norm() <= TOLERANCE * self.y.norm()
    }

    /// What p(y) changes with −u.
    fn slopes(&self, island: &Island, eta: f64) -> Few<Matrix3<f64>> {
        let slope = |((touch, z), u): ((&Share, &Vector3<f64>), &Vector3<f64>)| {
            law::in_cone_slope(z, touch.law) / eta * law::dual_slope(u, touch.law)
        };
        island.touches.iter().zip(&self.z).zip(&self.u).map(slope).collect()
    }
}

/// The impulses of the proximal problem about `centre`, from the velocities that those of `from` make. None: not found.
pub fn solve(island: &Island, centre: &[Impulse], from: &[Impulse], eta: f64, steps: &mut u64) -> Option<Few<Impulse>> {
    let mut at = At::new(island, centre, eta, island.pushed(from.iter().copied()));
    for _ in 0..MOST {
        if at.is_found() {
            return Some(at.p);
        }
        *steps += 1;
        let slopes = at.slopes(island, eta);
        let change = island
            .coupled(slopes.iter().map(|D| Slope::Any(*D)), 1.0)
            .solve(&at.missing.negative(), island.deadline)?;
        at = descend(island, centre, eta, &at, &change)?;
    }
    at.is_found().then_some(at.p)
}

/// The longest of the halved steps after which less is missing.
fn descend(island: &Island, centre: &[Impulse], eta: f64, at: &At, change: &BlockVector) -> Option<At> {
    /// Of the decrease that the slope promises.
    const PART: f64 = 1e-4;
    let mut part = 1.0;
    for _ in 0..HALVINGS {
        let next = At::new(island, centre, eta, at.y.plus_scaled(change, part));
        if next.missing.norm() <= (1.0 - PART * part) * at.missing.norm() {
            return Some(next);
        }
        part /= 2.0;
    }
    None
}

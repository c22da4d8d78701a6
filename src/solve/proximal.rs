//! The proximal problem of an island (R. T. Rockafellar, SIAM J. Control Optim. 14 (1976) 877): the law of contact with
//! ũ + η (p − p_centre) in place of ũ. Then p is a function of the velocity,
//!
//! p(y) = P_K(p_centre − ũ(y)/η),
//!
//! and y = Gᵀ p(y) a semi-smooth equation in six numbers a body that is regular however redundant the contacts are (the
//! augmented Lagrangian of P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92 (1991) 353 with De Saxcé's
//! cone).

use super::island::{Island, Share};
use super::law::{Law, Place};
use super::{Impulse, law};
use nalgebra::{DVector, Matrix3, Vector3};

/// Newton steps after which the problem is given up: with a larger η it is easier.
const MOST: usize = 15;

/// Of |y| what may be missing: the next problem has another centre, or another η, anyway.
const TOLERANCE: f64 = 1e-6;

/// Halvings of a step before it is given up.
const HALVINGS: usize = 30;

/// What is to be solved: η of every contact, and what of |y| may be missing.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    pub island: &'a Island,
    pub centre: &'a [Impulse],
    pub etas: &'a [f64],
    pub tolerance: f64,
}

/// p(y) and what it follows from.
pub(super) struct At {
    pub y: DVector<f64>,
    u: Vec<Vector3<f64>>,
    /// p_centre − ũ/η.
    z: Vec<Vector3<f64>>,
    pub p: Vec<Impulse>,
    /// y − Gᵀ p(y).
    missing: DVector<f64>,
}

impl Problem<'_> {
    fn at(&self, y: DVector<f64>) -> At {
        let u = self.island.velocities(&y);
        let touches = || self.island.touches.iter();
        let point =
            |(((touch, p), u), eta): (((&Share, &Impulse), &Vector3<f64>), &f64)| p - law::dual(u, touch.law) / *eta;
        let z: Vec<_> = touches().zip(self.centre).zip(&u).zip(self.etas).map(point).collect();
        let p: Vec<_> = touches().zip(&z).map(|(touch, z)| law::in_cone(z, touch.law)).collect();
        let missing = &y - self.island.pushed(&p);
        At { y, u, z, p, missing }
    }

    fn is_found(&self, at: &At) -> bool {
        at.missing.norm() <= self.tolerance * at.y.norm()
    }

    /// What p(y) changes with −u.
    fn slopes(&self, at: &At) -> Vec<Matrix3<f64>> {
        let slope = |(((touch, z), u), eta): (((&Share, &Vector3<f64>), &Vector3<f64>), &f64)| {
            law::in_cone_slope(z, touch.law) / *eta * law::dual_slope(u, touch.law)
        };
        self.island.touches.iter().zip(&at.z).zip(&at.u).zip(self.etas).map(slope).collect()
    }

    /// From these velocities, in at most so many steps. None: not found.
    pub fn solve(&self, y: DVector<f64>, most: usize, steps: &mut u64) -> Option<At> {
        let mut at = self.at(y);
        for _ in 0..most {
            if self.is_found(&at) {
                return Some(at);
            }
            *steps += 1;
            let change = self.island.system(&self.slopes(&at))?.solve(&-&at.missing)?;
            at = self.descend(&at, &change)?;
        }
        self.is_found(&at).then_some(at)
    }

    /// The longest of the halved steps after which less is missing.
    fn descend(&self, at: &At, change: &DVector<f64>) -> Option<At> {
        /// Of the decrease that the slope promises.
        const PART: f64 = 1e-4;
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let next = self.at(&at.y + change * part);
            if next.missing.norm() <= (1.0 - PART * part) * at.missing.norm() {
                return Some(next);
            }
            part /= 2.0;
        }
        None
    }

    /// Velocities at which contacts would do, about no impulse, what those of `p` do: stick, slip, or nothing at all.
    pub fn as_before(&self, p: &[Impulse], steps: &mut u64) -> Option<DVector<f64>> {
        let y = self.island.pushed(p);
        let u = self.island.velocities(&y);
        let mut pushed = Vec::with_capacity(p.len());
        let mut slopes = Vec::with_capacity(p.len());
        for (((touch, p), u), eta) in self.island.touches.iter().zip(p).zip(&u).zip(self.etas) {
            let friction = touch.law.friction();
            let slip = (u.y * u.y + u.z * u.z).sqrt();
            let square = 1.0 + friction * friction;
            let (push, slope) = match law::place(&(p - law::dual(u, touch.law)), touch.law) {
                _ if touch.law != Law::Pin && p.x <= 0.0 => (Impulse::zeros(), Matrix3::zeros()),
                Place::Side { t, .. } if slip > 0.0 || friction == 0.0 => {
                    let (edge, across) = (law::edge(&t, friction), law::across(&t));
                    let turns = if friction > 0.0 { friction * p.x / slip } else { 0.0 };
                    let turning = across * across.transpose() * turns;
                    let pressed = edge * Vector3::x().transpose() / (square * *eta);
                    (edge * (-u.x / (square * *eta)), pressed + turning)
                }
                _ => {
                    let slope = Matrix3::identity() / *eta * law::dual_slope(u, touch.law);
                    (-law::dual(u, touch.law) / *eta, slope)
                }
            };
            pushed.push(push);
            slopes.push(slope);
        }
        *steps += 1;
        let missing = self.island.pushed(&pushed) - &y;
        let change = self.island.system(&slopes)?.solve(&missing)?;
        Some(y + change)
    }
}

/// The impulses of the proximal problem about `centre`, from the velocities that those of `from` make. None: not found.
pub fn solve(island: &Island, centre: &[Impulse], from: &[Impulse], eta: f64, steps: &mut u64) -> Option<Vec<Impulse>> {
    let etas = vec![eta; centre.len()];
    let problem = Problem { island, centre, etas: &etas, tolerance: TOLERANCE };
    problem.solve(island.pushed(from), MOST, steps).map(|at| at.p)
}

//! Newton's method on the law of contact itself, from where it is nearly known which contacts stick, slip and separate:
//! the natural map says which, their equalities are linearised, and solved together (P. Alart, A. Curnier 1991).
//!
//! A sticking contact has u = 0; a slipping one u_n = 0, p on the cone and opposite to the slip, so that with E =
//! |u_t|/μ p_n turning p across by q takes u_across = −E q; a separating one p = 0. With η on the diagonal, tiny
//! against A's eigenvalues, redundant contacts are no trouble, and since the changes of p are worked out, not p, what
//! rounding leaves shrinks from step to step.

use super::island::{Island, Point, Share};
use super::law::{self, Law};
use super::modes::{Mode, against, onto_cone, slip, turning};
use super::slope::Slope;
use super::{Impulse, complementary, impulse};
use crate::math::few::{BlockVector, Few};
use nalgebra::Vector3;

const ETA: f64 = 1e-8;
const LARGEST_ETA: f64 = 1e-2;

/// Some units of rounding of a velocity, of what residuals are compared with.
const NOISE: f64 = 1e-15;

/// Steps without an improvement before it is given up, and after the tolerance is met.
const PATIENCE: usize = 6;
const SOLVED_PATIENCE: usize = 1;
const MOST: usize = 15;

/// A residual that no step improves.
const ROUNDING: f64 = 1e-14;

/// When Newton's method has done enough: below the one residual no step more, below the other few.
struct Until {
    enough: f64,
    tolerance: f64,
    /// Steps alone that leave redundant contacts their shares, as far as they may.
    keeps_shares: bool,
}

/// Improves impulses whose residual is known, or leaves them. Their residual.
pub fn improve(island: &Island, at: &mut Point, residual: f64, tolerance: f64, steps: &mut u64) -> f64 {
    improve_with(|_| ETA, island, at, residual, Until { enough: ROUNDING, tolerance, keeps_shares: false }, steps)
}

/// The same up to a residual and no further.
pub fn approach(island: &Island, at: &mut Point, residual: f64, enough: f64, steps: &mut u64) -> f64 {
    improve_with(|_| ETA, island, at, residual, Until { enough, tolerance: enough, keeps_shares: false }, steps)
}

/// The same from impulses that are near already. What rounds a velocity is felt as 1/η of it in impulses that redundant
/// contacts share, and pushes those at the side of their cone out of it: η is so large that this is less than what is
/// to be mended.
pub fn improve_near(island: &Island, at: &mut Point, residual: f64, tolerance: f64, steps: &mut u64) -> f64 {
    let eta = |best: f64| (NOISE / best).clamp(ETA, LARGEST_ETA);
    improve_with(eta, island, at, residual, Until { enough: ROUNDING, tolerance, keeps_shares: false }, steps)
}

fn improve_with(
    eta: impl Fn(f64) -> f64,
    island: &Island,
    at: &mut Point,
    residual: f64,
    until: Until,
    steps: &mut u64,
) -> f64 {
    let (mut best, mut worse) = (residual, 0);
    let mut tried: Option<Point> = None;
    let mut by = By::NaturalMap;
    for _ in 0..MOST {
        let is_solved = best <= until.tolerance;
        if best <= until.enough || worse > PATIENCE || (worse > SOLVED_PATIENCE && is_solved) {
            break;
        }
        *steps += 1;
        let from = tried.as_ref().unwrap_or(at);
        let next = match by {
            By::NaturalMap => step(island, from, eta(best)),
            By::Complementarity => complementary::step(island, from),
        };
        let Some(next) = next else { break };
        let residual = island.residual_at(&next);
        if residual < best {
            (best, worse) = (residual, 0);
            *at = next;
            tried = None;
            continue;
        }
        worse += 1;
        tried = Some(next);
        let may_choose = !is_solved && !until.keeps_shares && complementary::is_affordable(island);
        if by == By::NaturalMap && may_choose {
            // From the best point again.
            (by, tried) = (By::Complementarity, None);
        }
    }
    best
}

/// What tells which contacts press after a step of Newton's method.
#[derive(Clone, Copy, Debug, PartialEq)]
enum By {
    /// The natural map where the step begins.
    NaturalMap,
    /// The step itself (`complementary.rs`). Of redundant contacts it takes some, and leaves others nothing.
    Complementarity,
}

/// η where redundant impulses are measured from zero: of |p| squared so much is added to what is least.
const EVEN_ETA: f64 = 1e-5;

/// How often they are measured again from what they were found to be: every time leaves η of what was left.
const CENTRES: usize = 2;

/// Of the tolerance: a residual that is enough for contacts that slip, of which no body is at rest.
const ENOUGH: f64 = 1e-3;

/// Of the largest impulse: a change that is none.
const SAME: f64 = 1e-10;

/// Redundant contacts that slip different ways leave a continuum of solutions, each with velocities of its own. Goes,
/// within it, to the one with the least Σ|p|² (p with units), that of contacts that give a little, all alike. What
/// pulls there is left out. What is farther from the law after a step than it was, and than `farthest`, is given up.
/// The residual, which was `residual`.
pub fn even(
    island: &Island,
    at: &mut Point,
    mut residual: f64,
    (rounds, farthest, tolerance): (usize, f64, f64),
    steps: &mut u64,
) -> f64 {
    for _ in 0..rounds {
        *steps += 1;
        let Some(mut next) = step_even(island, at) else { break };
        let first = island.residual_at(&next);
        if first > residual.max(farthest) {
            break;
        }
        let until = Until { enough: ROUNDING.max(ENOUGH * tolerance), tolerance, keeps_shares: true };
        let reached = improve_with(|_| ETA, island, &mut next, first, until, steps);
        if reached > residual.max(tolerance) && reached > island.rounding(&next) {
            break;
        }
        let largest = next.p.iter().map(|p| p.norm()).fold(0.0, f64::max);
        let change = next.p.iter().zip(&at.p).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        (residual, *at) = (reached, next);
        if change <= SAME * largest {
            break;
        }
    }
    residual
}

/// Whether there may be such a continuum: four normals have three directions to press a body.
pub fn may_be_shared(island: &Island, p: &[Impulse]) -> bool {
    p.len() > 3 && island.touches.iter().zip(p).any(|(touch, p)| slips(touch, p))
}

/// Whether every contact that presses slips.
pub fn all_slip(island: &Island, p: &[Impulse]) -> bool {
    let is_open = |touch: &Share, p: &Impulse| touch.law != Law::Pin && *p == Impulse::zeros();
    island.touches.iter().zip(p).all(|(touch, p)| slips(touch, p) || is_open(touch, p))
}

fn slips(touch: &Share, p: &Impulse) -> bool {
    impulse::slips(p, touch.law.friction())
}

/// What a contact's impulse does when velocities change: Δp = `jump` − D (u + Δu).
struct Linear {
    jump: Impulse,
    D: Slope,
    slips: bool,
    /// It is measured from zero.
    is_even: bool,
}

impl Linear {
    fn new(touch: &Share, p: &Impulse, u: &Vector3<f64>, eta: f64) -> Self {
        let friction = touch.law.friction();
        let stay = |D| Linear { jump: Impulse::zeros(), D, slips: false, is_even: false };
        match Mode::of(touch, p, u) {
            Mode::Open => Linear { jump: -p, D: Slope::Nothing, slips: false, is_even: false },
            Mode::Held if touch.law != Law::Pin && friction == 0.0 => stay(Slope::Diagonal(Vector3::x() / eta)),
            Mode::Held => stay(Slope::alike(1.0 / eta)),
            Mode::Slips(t) => {
                let D = Slope::along_side(&t, friction, 1.0 / eta, turning(p, u, friction, eta));
                Linear { jump: law::edge(&t, friction) * p.x.max(0.0) - p, D, slips: true, is_even: false }
            }
        }
    }

    /// With impulses measured from zero. `small`: velocities that are rounding.
    fn even(touch: &Share, p: &Impulse, u: &Vector3<f64>, eta: f64, small: f64) -> Self {
        let friction = touch.law.friction();
        let t = match Mode::of(touch, p, u) {
            _ if touch.law == Law::Pin || friction == 0.0 => return Linear::new(touch, p, u, ETA),
            // It touches without a force: it may have one.
            Mode::Open => match against(u) {
                Some(t) if u.x <= small && slip(u) > small => t,
                _ => return Linear::new(touch, p, u, ETA),
            },
            Mode::Held => {
                return Linear { jump: -p, D: Slope::alike(1.0 / eta), slips: false, is_even: true };
            }
            Mode::Slips(t) => t,
        };
        let D = Slope::along_side(&t, friction, 1.0 / eta, turning(p, u, friction, ETA));
        Linear { jump: -p, D, slips: true, is_even: true }
    }

    /// Of an impulse that is measured from zero, what η alone makes of a velocity.
    fn made(&self, u: &Vector3<f64>) -> Impulse {
        match self.D {
            _ if !self.is_even => Impulse::zeros(),
            Slope::Side { edge, normal, .. } => edge * (-normal * u.x),
            D => -D.times(u),
        }
    }
}

/// A step of Newton's method.
fn step(island: &Island, at: &Point, eta: f64) -> Option<Point> {
    let touches = island.touches.iter().zip(&at.p).zip(&at.u);
    let linear: Few<Linear> = touches.map(|((touch, p), u)| Linear::new(touch, p, u, eta)).collect();
    let H = island.coupled(linear.iter().map(|linear| &linear.D), 1.0);
    Some(moved(island, at, &linear, &H.solve(&pulled(island, at, &linear), island.deadline)?))
}

/// A step toward even shares. Measured from zero with η, normal velocities would be η p; so the impulses that this
/// makes are a centre to measure from once more (the method of multipliers), which changes no shares.
fn step_even(island: &Island, at: &Point) -> Option<Point> {
    let small = island.scales(at).into_iter().map(|scale| ROUNDING.sqrt() * scale);
    let largest = island.touches.iter().map(|touch| touch.scale).fold(0.0, f64::max);
    let eta = |touch: &Share| {
        let part = touch.scale / largest;
        EVEN_ETA * part * part
    };
    let even = |(((touch, p), u), small)| Linear::even(touch, p, u, eta(touch), small);
    let mut linear: Few<Linear> = island.touches.iter().zip(&at.p).zip(&at.u).zip(small).map(even).collect();
    let factors = island.coupled(linear.iter().map(|linear| &linear.D), 1.0).factors(island.deadline)?;
    let mut change = factors.solve(&pulled(island, at, &linear))?;
    for _ in 0..CENTRES {
        for ((linear, touch), u) in linear.iter_mut().zip(&island.touches).zip(&at.u) {
            linear.jump += linear.made(&(u + touch.motion(&change)));
        }
        change = factors.solve(&pulled(island, at, &linear))?;
    }
    Some(moved(island, at, &linear, &change))
}

/// Gᵀ of what all impulses would change if no velocity did.
fn pulled(island: &Island, at: &Point, linear: &[Linear]) -> BlockVector {
    island.pushed(linear.iter().zip(&at.u).map(|(linear, u)| linear.jump - linear.D.times(u)))
}

/// The point after velocities have changed.
fn moved(island: &Island, at: &Point, linear: &[Linear], change: &BlockVector) -> Point {
    let touches = island.touches.iter().zip(&at.p).zip(&at.u).zip(linear);
    let next = touches.map(|(((touch, p), u), linear)| {
        let new = p + linear.jump - linear.D.times(&(u + touch.motion(change)));
        if linear.slips { onto_cone(&new, touch.law.friction()) } else { new }
    });
    island.at(next.collect())
}

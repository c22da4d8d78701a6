//! Newton's method on the law of contact itself, from where it is nearly known which contacts stick, slip and separate:
//! the natural map says which, their equalities are linearised, and solved together (P. Alart, A. Curnier 1991).
//!
//! A sticking contact has u = 0; a slipping one u_n = 0, p on the cone and opposite to the slip, so that with E =
//! |u_t|/μ p_n turning p across by q takes u_across = −E q; a separating one p = 0. With η on the diagonal, tiny
//! against A's eigenvalues, redundant contacts are no trouble, and since the changes of p are worked out, not p, what
//! rounding leaves shrinks from step to step.

use super::Impulse;
use super::island::{Island, Point, Share};
use super::law::{self, Law, Place};
use crate::math::few::Few;
use nalgebra::{Matrix3, Vector3};

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
}

/// Improves impulses whose residual is known, or leaves them. Their residual.
pub fn improve(island: &Island, at: &mut Point, residual: f64, tolerance: f64, steps: &mut u64) -> f64 {
    improve_with(|_| ETA, island, at, residual, Until { enough: ROUNDING, tolerance }, steps)
}

/// The same up to a residual and no further.
pub fn approach(island: &Island, at: &mut Point, residual: f64, enough: f64, steps: &mut u64) -> f64 {
    improve_with(|_| ETA, island, at, residual, Until { enough, tolerance: enough }, steps)
}

/// The same from impulses that are near already. What rounds a velocity is felt as 1/η of it in impulses that redundant
/// contacts share, and pushes those at the side of their cone out of it: η is so large that this is less than what is
/// to be mended.
pub fn improve_near(island: &Island, at: &mut Point, residual: f64, tolerance: f64, steps: &mut u64) -> f64 {
    let eta = |best: f64| (NOISE / best).clamp(ETA, LARGEST_ETA);
    improve_with(eta, island, at, residual, Until { enough: ROUNDING, tolerance }, steps)
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
    for _ in 0..MOST {
        let is_solved = best <= until.tolerance;
        if best <= until.enough || worse > PATIENCE || (worse > SOLVED_PATIENCE && is_solved) {
            break;
        }
        *steps += 1;
        let Some(next) = step(island, tried.as_ref().unwrap_or(at), Some(eta(best))) else { break };
        let residual = island.residual_at(&next);
        if residual < best {
            (best, worse) = (residual, 0);
            *at = next;
            tried = None;
        } else {
            worse += 1;
            tried = Some(next);
        }
    }
    best
}

/// η where redundant impulses are measured from zero: of |p| squared so much is added to what is least.
const EVEN_ETA: f64 = 1e-5;

/// Of the largest impulse: a change that is none.
const SAME: f64 = 1e-10;

/// Redundant contacts that slip different ways leave a continuum of solutions, each with velocities of its own. Goes,
/// within it, to the one with the least Σ|p|² (p with units), that of contacts that give a little, all alike. What
/// pulls there is left out. The residual, which was `residual`.
pub fn even(island: &Island, at: &mut Point, mut residual: f64, rounds: usize, tolerance: f64, steps: &mut u64) -> f64 {
    for _ in 0..rounds {
        *steps += 1;
        let Some(mut next) = step(island, at, None) else { break };
        let first = island.residual_at(&next);
        let reached = improve(island, &mut next, first, tolerance, steps);
        if reached > residual.max(tolerance).max(island.rounding(&next)) {
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

/// At the side of the cone.
fn slips(touch: &Share, p: &Impulse) -> bool {
    let friction = touch.law.friction();
    friction > 0.0 && p.x > 0.0 && p.yz().norm() >= friction * p.x * (1.0 - 1e-9)
}

/// What a contact's impulse does when velocities change: Δp = `jump` − K (u + Δu).
struct Linear {
    jump: Impulse,
    K: Matrix3<f64>,
    slips: bool,
}

impl Linear {
    fn new(touch: &Share, p: &Impulse, u: &Vector3<f64>, eta: f64) -> Self {
        let friction = touch.law.friction();
        let stay = |K| Linear { jump: Impulse::zeros(), K, slips: false };
        match law::place(&(p - law::dual(u, touch.law)), touch.law) {
            Place::Tip => Linear { jump: -p, K: Matrix3::zeros(), slips: false },
            _ if touch.law == Law::Pin => stay(Matrix3::from_diagonal_element(1.0 / eta)),
            _ if friction == 0.0 => stay(Matrix3::from_partial_diagonal(&[1.0 / eta])),
            Place::Inside => stay(Matrix3::from_diagonal_element(1.0 / eta)),
            Place::Side { t, .. } => {
                let K = along_edge(&t, friction, 1.0 / eta, turning(p, u, friction, eta));
                Linear { jump: law::edge(&t, friction) * p.x.max(0.0) - p, K, slips: true }
            }
        }
    }

    /// With impulses measured from zero. `small`: velocities that are rounding.
    fn even(touch: &Share, p: &Impulse, u: &Vector3<f64>, eta: f64, small: f64) -> Self {
        let friction = touch.law.friction();
        let slip = (u.y * u.y + u.z * u.z).sqrt();
        let t = match law::place(&(p - law::dual(u, touch.law)), touch.law) {
            _ if touch.law == Law::Pin || friction == 0.0 => return Linear::new(touch, p, u, ETA),
            // It touches without a force: it may have one.
            Place::Tip if u.x > small || slip <= small => return Linear::new(touch, p, u, ETA),
            Place::Tip => Vector3::new(0.0, -u.y / slip, -u.z / slip),
            Place::Inside => return Linear { jump: -p, K: Matrix3::from_diagonal_element(1.0 / eta), slips: false },
            Place::Side { t, .. } => t,
        };
        Linear { jump: -p, K: along_edge(&t, friction, 1.0 / eta, turning(p, u, friction, ETA)), slips: true }
    }
}

/// How fast p turns with what slips across.
fn turning(p: &Impulse, u: &Vector3<f64>, friction: f64, eta: f64) -> f64 {
    let slip = (u.y * u.y + u.z * u.z).sqrt();
    let E = if p.x > 0.0 { slip / (friction * p.x) } else { f64::INFINITY };
    1.0 / (E + eta)
}

/// `normal` (n + μ t) nᵀ + `across` s sᵀ, s the other tangent.
fn along_edge(t: &Vector3<f64>, friction: f64, normal: f64, across: f64) -> Matrix3<f64> {
    let s = law::across(t);
    let (y, z) = (across * s.y, across * s.z);
    Matrix3::new(normal, 0.0, 0.0, friction * t.y * normal, y * s.y, y * s.z, friction * t.z * normal, z * s.y, z * s.z)
}

/// `eta`: none, to even shares.
fn step(island: &Island, at: &Point, eta: Option<f64>) -> Option<Point> {
    let touches = || island.touches.iter().zip(&at.p).zip(&at.u);
    let mut linear: Few<Linear> = Few::new();
    if let Some(eta) = eta {
        linear.extend(touches().map(|((touch, p), u)| Linear::new(touch, p, u, eta)));
    } else {
        let small = island.scales(at).into_iter().map(|scale| ROUNDING.sqrt() * scale);
        let largest = island.touches.iter().map(|touch| touch.scale).fold(0.0, f64::max);
        let eta = |touch: &Share| {
            let part = touch.scale / largest;
            EVEN_ETA * part * part
        };
        let even = |(((touch, p), u), small)| Linear::even(touch, p, u, eta(touch), small);
        linear.extend(touches().zip(small).map(even));
    }
    let at_rest = island.pushed(linear.iter().zip(&at.u).map(|(linear, u)| linear.jump - linear.K * u));
    let change = island.coupled(linear.iter().map(|linear| &linear.K), 1.0).solve(&at_rest, island.deadline)?;
    let mut next = Few::new();
    next.extend(touches().zip(&linear).map(|(((touch, p), u), linear)| {
        let new = p + linear.jump - linear.K * (u + touch.motion(&change));
        if linear.slips { onto_cone(&new, touch.law.friction()) } else { new }
    }));
    Some(island.at(next))
}

/// Along the tangent the cone is left to second order.
fn onto_cone(p: &Impulse, friction: f64) -> Impulse {
    let length = (p.y * p.y + p.z * p.z).sqrt();
    if p.x <= 0.0 || length == 0.0 {
        return Impulse::zeros();
    }
    let scale = friction * p.x / length;
    Impulse::new(p.x, p.y * scale, p.z * scale)
}

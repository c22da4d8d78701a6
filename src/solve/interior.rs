//! An interior-point method for the law of contact of an island, from nothing to near the solution in a few dozen
//! linear systems whatever the number of contacts: p and ũ stay inside their cones while p ∘ ũ falls (for a given slip
//! V. Acary, P. Armand, H. M. Nguyen, M. Shpakovych, Second-order cone programming for frictional contact mechanics
//! using interior point algorithm, Optim. Methods Softw. 2024; here the slip in ũ changes with p).
//!
//! With x = (μ p_n, p_t) and z = (ũ_n/μ, ũ_t) both cones are Lorentz's. The steps are Nesterov and Todd's with
//! Mehrotra's predictor and corrector (L. Vandenberghe, The CVXOPT linear and quadratic cone program solvers, 2010).
//! Without friction a contact has its normal row alone; a pin has x = p without a cone and −η Δx = u. With much
//! friction the path that is followed may turn back before its end: then the best impulses on it are a start for
//! others.

use super::Impulse;
use super::island::{Island, Point, Share};
use super::law::{self, Law};
use super::slope::Slope;
use crate::math::block_lu::Factors;
use crate::math::few::{BlockVector, Few};
use nalgebra::{Matrix3, Vector3};

const MOST: usize = 60;

/// p ∘ ũ that is aimed at, of the present one.
const LEAST_AIM: f64 = 1e-6;

/// Of the way to the nearest cone's side.
const WITHIN: f64 = 0.99;

/// p ∘ ũ, of what it begins with.
const TOLERANCE: f64 = 1e-10;

/// Steps in which p ∘ ũ has not halved: the path turns back.
const STALLED: usize = 8;

/// Nesterov and Todd's scaling of a contact: W x = W⁻¹ z = λ.
struct Scaling {
    W: Matrix3<f64>,
    inverse: Matrix3<f64>,
    lambda: Vector3<f64>,
}

/// η of pins, the blocks having trace 1.
const ETA: f64 = 1e-8;

const J: Vector3<f64> = Vector3::new(1.0, -1.0, -1.0);

fn tail(x: &Vector3<f64>) -> f64 {
    (x.y * x.y + x.z * x.z).sqrt()
}

/// √(xᵀ J x).
fn size(x: &Vector3<f64>) -> f64 {
    let t = tail(x);
    ((x.x - t) * (x.x + t)).max(0.0).sqrt()
}

/// Jordan's product.
fn product(x: &Vector3<f64>, y: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(x.dot(y), x.x * y.y + y.x * x.y, x.x * y.z + y.x * x.z)
}

/// y of x ∘ y = r.
fn quotient(x: &Vector3<f64>, r: &Vector3<f64>) -> Vector3<f64> {
    let across = x.y * r.y + x.z * r.z;
    let first = (x.x * r.x - across) / (size(x) * size(x));
    Vector3::new(first, (r.y - first * x.y) / x.x, (r.z - first * x.z) / x.x)
}

impl Scaling {
    fn new(x: &Vector3<f64>, z: &Vector3<f64>) -> Option<Self> {
        let (size_x, size_z) = (size(x), size(z));
        let (unit_x, unit_z) = (x / size_x, z / size_z);
        let gamma = ((1.0 + unit_x.dot(&unit_z)) / 2.0).sqrt();
        let w = (unit_z + unit_x.component_mul(&J)) / (2.0 * gamma);
        let scale = (size_z / size_x).sqrt();
        let along = Vector3::new(0.0, w.y, w.z);
        let mut W = Matrix3::identity() + along * along.transpose() / (1.0 + w.x);
        (W[(0, 0)], W[(0, 1)], W[(1, 0)], W[(0, 2)], W[(2, 0)]) = (w.x, w.y, w.y, w.z, w.z);
        let turn = Matrix3::from_diagonal(&J);
        let inverse = turn * W * turn / scale;
        let W = W * scale;
        let found = Scaling { lambda: W * x, W, inverse };
        (size_x > 0.0 && size_z > 0.0 && found.lambda.iter().all(|l| l.is_finite())).then_some(found)
    }

    fn of_pin() -> Self {
        let W = Matrix3::identity() * ETA.sqrt();
        Scaling { W, inverse: Matrix3::identity() / ETA.sqrt(), lambda: Vector3::x() }
    }
}

/// The longest part of `change` that leaves x in Lorentz's cone, at most `most`.
fn part_within(x: &Vector3<f64>, change: &Vector3<f64>, most: f64) -> f64 {
    let form = |a: &Vector3<f64>, b: &Vector3<f64>| a.x * b.x - a.y * b.y - a.z * b.z;
    let (a, b, c) = (form(change, change), form(x, change), form(x, x).max(0.0));
    // a t² + 2 b t + c = 0; x₀ + t Δx₀ = 0.
    let root = (b * b - a * c).max(0.0).sqrt();
    let at = if b <= 0.0 && b * b >= a * c {
        c / (root - b)
    } else if a < 0.0 {
        (b + root) / -a
    } else {
        f64::INFINITY
    };
    let at = if at >= 0.0 { at } else { f64::INFINITY };
    let tip = if change.x < 0.0 { -x.x / change.x } else { f64::INFINITY };
    at.min(tip).min(most)
}

/// A contact's variables.
#[derive(Clone, Copy)]
struct Pair {
    x: Vector3<f64>,
    z: Vector3<f64>,
}

struct Method<'a> {
    island: &'a Island,
    y: BlockVector,
    pairs: Few<Pair>,
}

/// diag(1/μ, 1, 1): p of x, and z of ũ.
fn scale(law: Law) -> Matrix3<f64> {
    let diagonal = match law {
        Law::Pin => Vector3::new(1.0, 1.0, 1.0),
        Law::Contact { friction: 0.0 } => Vector3::x(),
        Law::Contact { friction } => Vector3::new(1.0 / friction, 1.0, 1.0),
    };
    Matrix3::from_diagonal(&diagonal)
}

/// Impulses near the solution, wherever the island was, and their residual. None: it came to nothing.
pub fn solve(island: &Island, steps: &mut u64) -> Option<(Point, f64)> {
    let mut method = Method::new(island);
    let first = method.gap();
    let mut gaps: Vec<f64> = Vec::with_capacity(MOST);
    let mut best: Option<(Point, f64)> = None;
    for round in 0..MOST {
        let gap = method.gap();
        gaps.push(gap);
        let at = island.at(method.impulses());
        let residual = island.residual_at(&at);
        if best.as_ref().is_none_or(|(_, least)| residual < *least) {
            best = Some((at, residual));
        }
        if gap <= TOLERANCE * first || round >= STALLED && gap > gaps[round - STALLED] / 2.0 {
            break;
        }
        *steps += 1;
        if method.step(gap).is_none() {
            break;
        }
    }
    best
}

impl<'a> Method<'a> {
    fn new(island: &'a Island) -> Self {
        let fastest = island.touches.iter().map(|touch| touch.b.norm()).fold(0.0, f64::max);
        let begin = |touch: &Share| match touch.law {
            Law::Pin => Pair { x: Vector3::zeros(), z: Vector3::zeros() },
            Law::Contact { .. } => Pair { x: Vector3::x() * fastest, z: Vector3::x() * fastest },
        };
        let pairs = island.touches.iter().map(begin).collect();
        let mut method = Method { island, y: BlockVector::zeros(island.bodies()), pairs };
        method.y = island.pushed(method.impulses().into_iter());
        method
    }

    fn impulses(&self) -> Few<Impulse> {
        self.island.touches.iter().zip(&self.pairs).map(|(touch, pair)| scale(touch.law) * pair.x).collect()
    }

    /// The mean of x·z after a part of a change; a pin has z = 0.
    fn gap_after(&self, changes: &[Pair], part: f64) -> f64 {
        let contacts = self.island.touches.iter().filter(|touch| touch.law != Law::Pin).count();
        let product = |(now, change): (&Pair, &Pair)| (now.x + change.x * part).dot(&(now.z + change.z * part));
        self.pairs.iter().zip(changes).map(product).sum::<f64>() / contacts.max(1) as f64
    }

    fn gap(&self) -> f64 {
        self.gap_after(&self.pairs, 0.0)
    }

    /// The longest part of a change that stays in the cones.
    fn longest(&self, changes: &[Pair]) -> f64 {
        let of = |part: f64, ((touch, now), change): ((&Share, &Pair), &Pair)| match touch.law {
            Law::Pin => part,
            Law::Contact { .. } => part_within(&now.z, &change.z, part_within(&now.x, &change.x, part)),
        };
        self.island.touches.iter().zip(&self.pairs).zip(changes).fold(1.0 / WITHIN, of)
    }

    /// None: the systems are singular.
    fn step(&mut self, gap: f64) -> Option<()> {
        let linear = Linear::new(self)?;
        let factors =
            self.island.coupled(linear.D.iter().map(|D| Slope::Any(*D)), 1.0).factors(self.island.deadline)?;
        let (_, predicted) = linear.direction(self, &factors, |_, lambda| -product(lambda, lambda))?;
        let part = self.longest(&predicted).min(1.0);
        let left = (self.gap_after(&predicted, part) / gap).clamp(0.0, 1.0);
        let aim = Vector3::x() * ((left * left * left).max(LEAST_AIM) * gap);
        let (y, changes) = linear.direction(self, &factors, |i, lambda| {
            let Scaling { W, inverse, .. } = &linear.scalings[i];
            let second = product(&(W * predicted[i].x), &(inverse * predicted[i].z)) * (part * part);
            aim - product(lambda, lambda) - second
        })?;
        let part = WITHIN * self.longest(&changes);
        self.y.add_scaled(&y, part);
        for (pair, change) in self.pairs.iter_mut().zip(&changes) {
            pair.x += change.x * part;
            pair.z += change.z * part;
        }
        Some(())
    }
}

/// The equations about the present point.
struct Linear {
    scalings: Few<Scaling>,
    /// What z changes with u.
    slopes: Few<Matrix3<f64>>,
    /// What p changes with −u.
    D: Few<Matrix3<f64>>,
    /// Gᵀ p − y and ũ − z.
    r_y: BlockVector,
    r_z: Few<Vector3<f64>>,
}

impl Linear {
    fn new(at: &Method) -> Option<Self> {
        let touches = || at.island.touches.iter();
        let scaling = |(touch, pair): (&Share, &Pair)| match touch.law {
            Law::Pin => Some(Scaling::of_pin()),
            Law::Contact { .. } => Scaling::new(&pair.x, &pair.z),
        };
        let scalings: Few<Scaling> = touches().zip(&at.pairs).map(scaling).collect::<Option<_>>()?;
        let u = at.island.velocities(&at.y);
        let slopes: Few<_> =
            touches().zip(&u).map(|(touch, u)| scale(touch.law) * law::dual_slope(u, touch.law)).collect();
        let push =
            |((touch, s), slope): ((&Share, &Scaling), &Matrix3<f64>)| scale(touch.law) * s.inverse * s.inverse * slope;
        let D = touches().zip(&scalings).zip(&slopes).map(push).collect();
        let missing = |((touch, u), pair): ((&Share, &Vector3<f64>), &Pair)| {
            let along =
                if touch.law.friction() > 0.0 || touch.law == Law::Pin { pair.z } else { Vector3::x() * pair.z.x };
            scale(touch.law) * law::dual(u, touch.law) - along
        };
        let r_z = touches().zip(&u).zip(&at.pairs).map(missing).collect();
        Some(Linear { scalings, slopes, D, r_y: at.island.pushed(at.impulses().into_iter()).minus(&at.y), r_z })
    }

    /// The changes of y, x and z with λ ∘ (W Δx + W⁻¹ Δz) = wanted.
    fn direction(
        &self,
        at: &Method,
        factors: &Factors,
        wanted: impl Fn(usize, &Vector3<f64>) -> Vector3<f64>,
    ) -> Option<(BlockVector, Few<Pair>)> {
        let touches = &at.island.touches;
        let d = |(i, s): (usize, &Scaling)| match touches[i].law {
            Law::Pin => Vector3::zeros(),
            Law::Contact { .. } => quotient(&s.lambda, &wanted(i, &s.lambda)),
        };
        let d: Few<Vector3<f64>> = self.scalings.iter().enumerate().map(d).collect();
        let x_of = |i: usize, z: &Vector3<f64>| {
            let inverse = &self.scalings[i].inverse;
            inverse * (d[i] - inverse * z)
        };
        let pushes = touches.iter().enumerate().map(|(i, touch)| scale(touch.law) * x_of(i, &self.r_z[i]));
        let y = factors.solve(&self.r_y.plus(&at.island.pushed(pushes)))?;
        let change = |(i, touch): (usize, &Share)| {
            let z = self.slopes[i] * touch.motion(&y) + self.r_z[i];
            Pair { x: x_of(i, &z), z: if touch.law == Law::Pin { Vector3::zeros() } else { z } }
        };
        let changes = touches.iter().enumerate().map(change).collect();
        Some((y, changes))
    }
}

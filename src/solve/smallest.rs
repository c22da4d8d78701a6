//! The smallest impulses (Σ|p|² least) that make given velocities and obey the law of contact: redundant contacts share
//! a force evenly, and symmetric scenes have symmetric forces.
//!
//! With the velocities given the law leaves every contact a convex cone F: none where it separates, the ray opposite to
//! the slip where it slips, all of K where it sticks (and at a pin). The smallest p in F with Gᵀ p = y is p = P_F(G w),
//! and w is the root of the slope of a convex function, Gᵀ P_F(G w) = y: Newton's method in six numbers a body.

use super::Impulse;
use super::island::{Island, Point, Share};
use super::law::{self, Law};
use super::slope::Slope;
use crate::math::few::{BlockVector, Few};
use nalgebra::{Matrix3, Vector3};

const MOST: usize = 60;
const HALVINGS: usize = 12;

/// On the diagonal, of the largest element: bodies that no force holds leave it singular.
const REGULAR: f64 = 1e-13;

/// Steps without an improvement after the first.
const PATIENCE: usize = 4;

/// What velocities leave to a contact.
#[derive(Clone, Copy)]
enum Face {
    Open,
    Ray(Vector3<f64>),
    Cone,
}

impl Face {
    /// `small`: a velocity that is rounding.
    fn new(touch: &Share, u: &Vector3<f64>, small: f64) -> Self {
        let slip = (u.y * u.y + u.z * u.z).sqrt();
        if touch.law == Law::Pin {
            Face::Cone
        } else if u.x > small {
            Face::Open
        } else if touch.law.friction() == 0.0 {
            Face::Ray(Vector3::x())
        } else if slip > small {
            Face::Ray(law::edge(&(-u / slip), touch.law.friction()))
        } else {
            Face::Cone
        }
    }

    fn nearest(&self, z: &Vector3<f64>, law: Law) -> Impulse {
        match self {
            Face::Open => Impulse::zeros(),
            Face::Ray(along) => along * (along.dot(z) / along.norm_squared()).max(0.0),
            Face::Cone => law::in_cone(z, law),
        }
    }

    /// What `nearest` changes with z.
    fn slope(&self, z: &Vector3<f64>, law: Law) -> Matrix3<f64> {
        match self {
            Face::Cone => law::in_cone_slope(z, law),
            Face::Ray(along) if along.dot(z) <= 0.0 => Matrix3::zeros(),
            _ => self.span(),
        }
    }

    /// As if impulses could pull.
    fn span(&self) -> Matrix3<f64> {
        match self {
            Face::Open => Matrix3::zeros(),
            Face::Ray(along) => along * along.transpose() / along.norm_squared(),
            Face::Cone => Matrix3::identity(),
        }
    }
}

/// The contacts' faces, and 1/σ² of their impulses without units relative to the largest: what is least has units.
struct Faces<'a> {
    island: &'a Island,
    faces: Few<Face>,
    weights: Few<f64>,
    wanted: &'a BlockVector,
}

/// z = G w, kept up to date instead of w: near the root its changes are small, and so is their rounding.
struct At {
    z: Few<Vector3<f64>>,
    point: Point,
    missing: BlockVector,
}

/// The smallest impulses that make the velocities of a point, the best by the residual that was met, and that.
/// Velocities are told from 0 when a residual of `small` is.
pub fn impulses(island: &Island, of: &Point, small: f64, steps: &mut u64) -> (Point, f64) {
    let faces = Faces::new(island, of, small);
    let mut at = faces.at(Few::from_elem(Vector3::zeros(), of.p.len()));
    let (mut best, mut least, mut worse) = (at.point.clone(), f64::INFINITY, 0);
    for round in 0..MOST {
        *steps += 1;
        let Some(next) = faces.step(&at, round == 0) else { break };
        at = next;
        let residual = island.residual_at(&at.point);
        if residual < least {
            (best, least, worse) = (at.point.clone(), residual, 0);
        } else {
            worse += 1;
        }
        if worse > PATIENCE || at.missing.amax() <= f64::EPSILON * faces.wanted.amax() {
            break;
        }
    }
    (best, least)
}

impl<'a> Faces<'a> {
    fn new(island: &'a Island, of: &'a Point, small: f64) -> Self {
        let scales = island.scales(of);
        let face = |((touch, u), scale): ((&Share, &Vector3<f64>), &f64)| Face::new(touch, u, small * scale);
        let faces = island.touches.iter().zip(&of.u).zip(&scales).map(face).collect();
        let smallest = island.touches.iter().map(|touch| touch.scale).fold(f64::INFINITY, f64::min);
        let weights = island.touches.iter().map(|touch| (smallest / touch.scale) * (smallest / touch.scale)).collect();
        Faces { island, faces, weights, wanted: &of.y }
    }

    fn at(&self, z: Few<Vector3<f64>>) -> At {
        let nearest = |((face, touch), z): ((&Face, &Share), &Vector3<f64>)| face.nearest(z, touch.law);
        let point = self.island.at(self.faces.iter().zip(&self.island.touches).zip(&z).map(nearest).collect());
        At { z, missing: self.wanted.minus(&point.y), point }
    }

    /// `first`: from nothing, where no cone has a slope.
    fn step(&self, at: &At, first: bool) -> Option<At> {
        let touches = || self.island.touches.iter().zip(&self.faces).zip(&self.weights);
        let slope = |(((touch, face), weight), z): (((&Share, &Face), &f64), &Vector3<f64>)| {
            let slope = if first { face.span() } else { face.slope(z, touch.law) };
            slope * *weight
        };
        let slopes: Few<Matrix3<f64>> = touches().zip(&at.z).map(slope).collect();
        let mut H = self.island.coupled(slopes.iter().map(|D| Slope::Any(*D)), 0.0);
        H.add_on_diagonal(REGULAR * H.largest());
        let change = H.solve(&at.missing, self.island.deadline)?;
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            let moved = |(((touch, _), weight), z): (((&Share, &Face), &f64), &Vector3<f64>)| {
                z + touch.motion(&change) * (weight * part)
            };
            let next = self.at(touches().zip(&at.z).map(moved).collect());
            if first || next.missing.norm() < at.missing.norm() {
                return Some(next);
            }
            part /= 2.0;
        }
        None
    }
}

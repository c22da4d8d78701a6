//! A step along a slip that turns, by Taylor series (as A. Jorba, M. Zou, Exp. Math. 14 (2005) 99).
//!
//! With dp_n = |u_t| dτ/σ, σ = |A_tn| + μ |A_tt|, the slip is u_t′ = (|u_t| A_tn − μ A_tt u_t)/σ: no direction to
//! divide by, so that everything is analytic down to slip 0, which is τ = ∞ (the slip falls exponentially), and τ has
//! no unit: a mass of any size gives the same series. A series is its own dense output: where the normal velocity turns
//! and the impact ends is a root of a polynomial.

use super::path::{Path, Phase};
use nalgebra::Vector2;

const ORDER: usize = 24;

/// A step is at most so long, whatever the series says.
const LONGEST: f64 = 4.0;

/// Halvings of an interval until it is rounding.
const HALVINGS: usize = 60;

type Series = [f64; ORDER + 1];

/// Series of slip, slip speed, normal velocity, work in store and impulses.
pub(super) struct Turn {
    u_t: [Vector2<f64>; ORDER + 1],
    speed: Series,
    u_n: Series,
    store: Series,
    p_n: Series,
    step: f64,
    /// σ.
    rate: f64,
}

impl Turn {
    pub fn new(path: &Path) -> Self {
        let (a, B) = (path.coupling(), path.tangents() * path.friction);
        let sigma = a.norm() + B.norm();
        let (A_nn, rate) = (path.A[(0, 0)], path.store_rate());
        let zero = [0.0; ORDER + 1];
        let mut s = Turn {
            u_t: [Vector2::zeros(); ORDER + 1],
            speed: zero,
            u_n: zero,
            store: zero,
            p_n: zero,
            step: 0.0,
            rate: sigma,
        };
        s.u_t[0] = path.slip();
        s.speed[0] = s.u_t[0].norm();
        (s.u_n[0], s.store[0], s.p_n[0]) = (path.u.x, path.store, path.p.x);
        for k in 0..ORDER {
            let next = 1.0 / ((k + 1) as f64 * sigma);
            let power: f64 = (0..=k).map(|i| s.u_n[i] * s.speed[k - i]).sum();
            s.u_t[k + 1] = (a * s.speed[k] - B * s.u_t[k]) * next;
            s.u_n[k + 1] = (A_nn * s.speed[k] - path.friction * a.dot(&s.u_t[k])) * next;
            s.store[k + 1] = -rate * power * next;
            s.p_n[k + 1] = s.speed[k] * next;
            // Of |u_t|² = u_t · u_t.
            let square: f64 = (0..=k + 1).map(|i| s.u_t[i].dot(&s.u_t[k + 1 - i])).sum();
            let known: f64 = (1..=k).map(|i| s.speed[i] * s.speed[k + 1 - i]).sum();
            s.speed[k + 1] = (square - known) / (2.0 * s.speed[0]);
        }
        s.step = [ORDER - 1, ORDER].map(|k| s.reach(k)).into_iter().fold(LONGEST, f64::min);
        s
    }

    /// Where term k is rounding.
    fn reach(&self, k: usize) -> f64 {
        let term = self.speed[k].abs().max(self.u_t[k].norm()) / self.speed[0];
        libm::pow(f64::EPSILON / term, 1.0 / k as f64)
    }

    /// To the step's end or the first event in it.
    pub fn step(&self, path: &mut Path) {
        let compresses = path.phase == Phase::Compression;
        let has_turned = |h: f64| (at(&self.u_n, h) >= 0.0) == compresses;
        let is_empty = |h: f64| at(&self.store, h) <= 0.0;
        let mut h = self.step;
        let turns = has_turned(h);
        if turns {
            h = first(h, has_turned);
        }
        let ends = !compresses && is_empty(h);
        if ends {
            h = first(h, is_empty);
        }
        let slip = self.u_t.iter().rev().fold(Vector2::zeros(), |sum, term| sum * h + term);
        // ∫ u_t dτ.
        let way =
            (0..ORDER).rev().fold(Vector2::zeros(), |sum, k| sum * h + self.u_t[k] / (k + 1) as f64) * (h / self.rate);
        (path.u.x, path.u.y, path.u.z) = (at(&self.u_n, h), slip.x, slip.y);
        (path.p.x, path.p.y, path.p.z) =
            (at(&self.p_n, h), path.p.y - path.friction * way.x, path.p.z - path.friction * way.y);
        path.store = at(&self.store, h);
        if ends {
            path.phase = Phase::Over;
        } else if turns {
            path.turn();
        }
    }
}

fn at(series: &Series, h: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, term| sum * h + term)
}

/// Where in (0, h] something begins that is so at `h`.
fn first(h: f64, is: impl Fn(f64) -> bool) -> f64 {
    let (mut before, mut after) = (0.0, h);
    for _ in 0..HALVINGS {
        let middle = (before + after) / 2.0;
        if is(middle) {
            after = middle;
        } else {
            before = middle;
        }
    }
    after
}

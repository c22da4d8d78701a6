//! The attitude of a body whose angular velocity is ω = w + α t (world axes), however often it turns: a two-level
//! system with Landau's and Zener's crossing (Zener, Proc. R. Soc. A 137 (1932) 696), followed along the direction
//! that does not precess about ω (Berry, Proc. R. Soc. A 429 (1990) 61).
//!
//! In units of 1/√|α| and along e_1 = α/|α|, e_2 (ω − its part along α) and e_3: ω = (s, B, 0), |ω| = ρ. Of the
//! solutions of u̇ = ω × u one does not oscillate. Its h = u·ω has h‴ + ρ² h′ = s h, so that by powers of ρ
//! (ρ ^ n)‴ = n (n−2) [(n−1) ρ² − (n−4) B²] s ρ^(n−6):
//!
//!   h = ρ Σ c_kj (B/ρ)^2j ρ^−4k,   u = (h′, (h − s h′)/B, h″/B).
//!
//! The body turns about u: against the frame (u, e_3 across u, …) by ∫ h/(1 − u_3²) ds, of which ∫ρ ds is elementary
//! and the rest small and smooth. The elementary part is in double-double: of many turns the last one counts. The
//! series is asymptotic; where ρ is small, the steps of `attitude.rs` are few.

use super::attitude::{self, Turned};
use super::principal::cross;
use crate::math::dd::{Dd, dot};
use crate::math::quadrature::legendre;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// The least ρ of the series: with K orders what is left is below 10⁻¹⁸; at ρ = 8 it is 10⁻¹⁵.
const FAR: f64 = 10.0;

/// Orders of the series. More gain nothing at `FAR`.
const K: usize = 8;

/// Nodes on a stretch no longer than its distance from the singularities at s = ±iB: 10⁻¹⁷ of the integral.
const NODES: usize = 12;

/// A phase that is rounding (rad).
const NO_PHASE: f64 = 1e-18;

/// ω in its own axes and units.
struct Passage {
    e: Matrix3<f64>,
    /// Unit √|α|: radians per second at ρ = 1.
    unit_rad_s: Dd,
    /// The constant B.
    aside: Dd,
    series: [[f64; K + 1]; K + 1],
}

/// The attitude after a time (s), from ω at its beginning; α is not zero, nor along ω.
pub fn turned(q_WB: &UnitQuaternion<f64>, w: &Vector3<f64>, alpha: &Vector3<f64>, t_s: f64) -> Turned {
    let (passage, from) = Passage::new(w, alpha);
    let mut width = passage.unit_rad_s * Dd::from(t_s);
    let to = from + width;
    let aside = passage.aside.f64();
    let near = (FAR * FAR - aside * aside).max(0.0).sqrt();
    let (first, last, backward) = (from.f64(), to.f64(), t_s < 0.0);
    let between = |cut: f64| if backward { last < cut && cut < first } else { first < cut && cut < last };
    let cuts = if backward { [near, -near] } else { [-near, near] };
    let cuts = cuts.into_iter().filter(|cut| near > 0.0 && between(*cut)).map(Dd::from);
    let (mut at, mut turned) = (from, Turned { q_WB: *q_WB, steps: 0 });
    for next in cuts.chain([to]) {
        // The whole way, if it is uncut, is known better than from a difference.
        let part = if next == to { width } else { next - at };
        if ((at.f64() + next.f64()) / 2.0).abs() < near {
            let through = passage.stepped(&turned.q_WB, at, part);
            turned = Turned { q_WB: through.q_WB, steps: turned.steps + through.steps };
        } else {
            turned.q_WB = passage.followed([at, next], part) * turned.q_WB;
        }
        (at, width) = (next, to - next);
    }
    turned
}

/// Coefficients c_kj, at [k][j].
fn series() -> [[f64; K + 1]; K + 1] {
    let mut c = [[0.0; K + 1]; K + 1];
    c[0][0] = 1.0;
    for k in 0..K {
        for j in 0..=k {
            let n = power(k, j);
            c[k + 1][j] -= c[k][j] * n * (n - 1.0) * (n - 2.0) / (n - 5.0);
            c[k + 1][j + 1] += c[k][j] * n * (n - 2.0) * (n - 4.0) / (n - 7.0);
        }
    }
    c
}

/// Exponent n of ρ^n.
fn power(k: usize, j: usize) -> f64 {
    1.0 - (4 * k + 2 * j) as f64
}

impl Passage {
    /// The passage, and the s of its beginning.
    fn new(w: &Vector3<f64>, alpha: &Vector3<f64>) -> (Self, Dd) {
        let e_1 = alpha.normalize();
        let across = |v: Vector3<f64>| v - e_1 * e_1.dot(&v);
        // Twice: the first time what is left of w may be its rounding.
        let e_2 = across(across(*w)).normalize();
        let e = Matrix3::from_columns(&[e_1, e_2, e_1.cross(&e_2)]);
        let [w, alpha] = [w, alpha].map(|v| [v.x, v.y, v.z].map(Dd::from));
        let square = dot(&alpha, &alpha).sqrt();
        let unit_rad_s = square.sqrt();
        let [x, y, z] = cross(&w, &alpha);
        let aside = dot(&[x, y, z], &[x, y, z]).sqrt() / (square * unit_rad_s);
        let from = dot(&w, &alpha) / (square * unit_rad_s);
        (Passage { e, unit_rad_s, aside, series: series() }, from)
    }

    /// Length |ω|.
    fn rho(&self, s: f64) -> f64 {
        (s * s + self.aside.f64() * self.aside.f64()).sqrt()
    }

    /// The attitude by steps of at most a radian.
    fn stepped(&self, q_WB: &UnitQuaternion<f64>, from: Dd, width: Dd) -> Turned {
        let unit = self.unit_rad_s.f64();
        let w = |s: Dd| self.e * Vector3::new(s.f64(), self.aside.f64(), 0.0) * unit;
        let alpha = self.e.column(0) * (unit * unit);
        let fastest = w(from).norm().max(w(from + width).norm()).max(unit);
        attitude::turned(q_WB, width.f64() / unit, fastest, |t| [w(from) + alpha * t, alpha])
    }

    /// The rotation from one s to another along u.
    fn followed(&self, [from, to]: [Dd; 2], width: Dd) -> UnitQuaternion<f64> {
        let (_, angle) = self.phase([from, to], width).reduce(Dd::PI * Dd::from(4.0));
        let about_u = UnitQuaternion::from_scaled_axis(Vector3::x() * angle);
        let own = self.frame(to.f64()) * about_u * self.frame(from.f64()).inverse();
        let e = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(self.e));
        UnitQuaternion::new_normalize((e * own * e.inverse()).into_inner())
    }

    /// Rotation (u, e_3 across u, …) → e.
    fn frame(&self, s: f64) -> UnitQuaternion<f64> {
        let (_, u) = self.direction(s);
        let v = (Vector3::z() - u * u.z).normalize();
        let frame = Matrix3::from_columns(&[u, v, u.cross(&v)]);
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(frame))
    }

    /// The number h/ρ − 1, and u.
    fn direction(&self, s: f64) -> (f64, Vector3<f64>) {
        let (rho, aside) = (self.rho(s), self.aside.f64());
        let (p, y) = ((aside / rho) * (aside / rho), 1.0 / (rho * rho * rho * rho));
        let (mut more, mut u) = (0.0, Vector3::repeat(1.0));
        let mut order = 1.0;
        for k in 1..=K {
            order *= y;
            // p^(j − 1) y^k
            let mut term = order;
            for j in 1..=k {
                let (n, part) = (power(k, j), self.series[k][j] * term);
                more += part * p;
                u.x += part * p * n;
                u.y += part * (1.0 - n + n * p);
                u.z += part * n * (n - 1.0 - (n - 2.0) * p);
                term *= p;
            }
        }
        let lead = Vector3::new(s / rho, aside / rho, aside / (rho * rho * rho));
        (more, u.component_mul(&lead))
    }

    /// Angle by which the body turns about u.
    fn phase(&self, [from, to]: [Dd; 2], width: Dd) -> Dd {
        let zero = Dd::ZERO;
        if width.f64() < 0.0 {
            -self.phase([to, from], -width)
        } else if to.f64() <= 0.0 {
            self.phase([-to, -from], width)
        } else if from.f64() < 0.0 {
            self.phase([zero, -from], -from) + self.phase([zero, to], to)
        } else {
            self.swept([from, to], width) + Dd::from(self.beyond(from.f64(), to.f64()))
        }
    }

    /// Integral ∫ρ ds, 0 ≤ from ≤ to: (s ρ + B² asinh(s/B))/2 without differences of what is large.
    fn swept(&self, [from, to]: [Dd; 2], width: Dd) -> Dd {
        let square = self.aside.squared();
        let [rho, rho_to] = [from, to].map(|s| (s.squared() + square).sqrt());
        let slope = (from + to) / (rho + rho_to);
        let angle = log_of_more(width * (Dd::ONE + slope) / (from + rho));
        Dd::from(0.5) * (width * (rho_to + from * slope) + square * angle)
    }

    /// Integral ∫ h/(1 − u_3²) − ρ ds, 0 ≤ from ≤ to, over stretches that grow with ρ.
    fn beyond(&self, from: f64, to: f64) -> f64 {
        let nodes = legendre::<NODES>();
        let (mut at, mut sum) = (from, 0.0);
        while at < to {
            let rho = self.rho(at);
            // All of what follows.
            let part = self.aside.f64() / (rho * rho);
            if part * part < NO_PHASE {
                break;
            }
            let half = (to - at).min(rho) / 2.0;
            for (x, weight) in nodes {
                let s = at + half * (1.0 + x);
                let (more, u) = self.direction(s);
                let square = u.z * u.z;
                sum += weight * half * self.rho(s) * (more + square) / (1.0 - square);
            }
            at += 2.0 * half;
        }
        sum
    }
}

/// Logarithm ln(1 + x), x ≥ 0, by roots until x is small, then atanh.
fn log_of_more(mut x: Dd) -> Dd {
    let mut times = 2.0;
    while x.f64() > 0.1 {
        x = x / (Dd::ONE + (Dd::ONE + x).sqrt());
        times *= 2.0;
    }
    let z = x / (Dd::from(2.0) + x);
    // z^25 is below 10⁻³².
    let terms = (0..12).rev().map(|k| Dd::ONE / Dd::from(f64::from(2 * k + 1)));
    Dd::from(times) * z * terms.fold(Dd::ZERO, |sum, term| sum * z.squared() + term)
}

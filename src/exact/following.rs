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
//! and the rest small and smooth. The series is asymptotic; where ρ is small, the steps of `attitude.rs` are few.

use super::attitude::{self, Turned};
use crate::math::quadrature::legendre;
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};

/// The least ρ of the series: with K orders what is left is below 10⁻¹⁸; at ρ = 8 it is 10⁻¹⁵.
const FAR: f64 = 10.0;

/// Orders of the series. More gain nothing at `FAR`.
const K: usize = 8;

/// Of a stretch no longer than its distance from the singularities at s = ±iB: 10⁻¹⁷ of the integral.
const NODES: usize = 12;

/// A phase that is rounding (rad).
const NO_PHASE: f64 = 1e-18;

/// ω in its own axes and units.
struct Passage {
    e: Matrix3<f64>,
    /// √|α|: radians per second at ρ = 1.
    unit_rad_s: f64,
    /// B.
    aside: f64,
    series: [[f64; K + 1]; K + 1],
}

/// After a time, from ω at its beginning; α is not zero, nor along ω.
pub fn turned(q_WB: &UnitQuaternion<f64>, w: &Vector3<f64>, alpha: &Vector3<f64>, t_s: f64) -> Turned {
    let passage = Passage::new(w, alpha);
    let from = passage.e.column(0).dot(w) / passage.unit_rad_s;
    let to = from + passage.unit_rad_s * t_s;
    let near = (FAR * FAR - passage.aside * passage.aside).max(0.0).sqrt();
    let backward = t_s < 0.0;
    let between =
        |cut: &f64| near > 0.0 && (if backward { to < *cut && *cut < from } else { from < *cut && *cut < to });
    let cuts = if backward { [near, -near] } else { [-near, near] };
    let (mut at, mut left, mut turned) = (from, passage.unit_rad_s * t_s, Turned { q_WB: *q_WB, steps: 0 });
    for next in cuts.into_iter().filter(between).chain([to]) {
        // Of the last stretch without a difference of what is large, if it is the first.
        let width = if next == to { left } else { next - at };
        if ((at + next) / 2.0).abs() < near {
            let through = passage.stepped(&turned.q_WB, at, width);
            turned = Turned { q_WB: through.q_WB, steps: turned.steps + through.steps };
        } else {
            turned.q_WB = passage.followed([at, next], width) * turned.q_WB;
        }
        (at, left) = (next, to - next);
    }
    turned
}

/// c_kj, at [k][j].
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

/// n of ρ^n.
fn power(k: usize, j: usize) -> f64 {
    1.0 - (4 * k + 2 * j) as f64
}

impl Passage {
    fn new(w: &Vector3<f64>, alpha: &Vector3<f64>) -> Self {
        let e_1 = alpha.normalize();
        let across = |v: Vector3<f64>| v - e_1 * e_1.dot(&v);
        // Twice: the first time what is left of w may be its rounding.
        let beside = across(across(*w));
        let e_2 = beside.normalize();
        let unit_rad_s = alpha.norm().sqrt();
        let e = Matrix3::from_columns(&[e_1, e_2, e_1.cross(&e_2)]);
        Passage { e, unit_rad_s, aside: beside.norm() / unit_rad_s, series: series() }
    }

    /// |ω|.
    fn rho(&self, s: f64) -> f64 {
        (s * s + self.aside * self.aside).sqrt()
    }

    /// By steps of at most a radian.
    fn stepped(&self, q_WB: &UnitQuaternion<f64>, from: f64, width: f64) -> Turned {
        let w = |s: f64| self.e * Vector3::new(s, self.aside, 0.0) * self.unit_rad_s;
        let alpha = self.e.column(0) * (self.unit_rad_s * self.unit_rad_s);
        let fastest = w(from).norm().max(w(from + width).norm()).max(self.unit_rad_s);
        attitude::turned(q_WB, width / self.unit_rad_s, fastest, |t| [w(from) + alpha * t, alpha])
    }

    /// The rotation from one s to another along u.
    fn followed(&self, [from, to]: [f64; 2], width: f64) -> UnitQuaternion<f64> {
        let about_u = UnitQuaternion::from_scaled_axis(Vector3::x() * self.phase([from, to], width));
        let own = self.frame(to) * about_u * self.frame(from).inverse();
        let e = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(self.e));
        UnitQuaternion::new_normalize((e * own * e.inverse()).into_inner())
    }

    /// (u, e_3 across u, …) → e.
    fn frame(&self, s: f64) -> UnitQuaternion<f64> {
        let (_, u) = self.direction(s);
        let v = (Vector3::z() - u * u.z).normalize();
        let frame = Matrix3::from_columns(&[u, v, u.cross(&v)]);
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(frame))
    }

    /// h/ρ − 1, and u.
    fn direction(&self, s: f64) -> (f64, Vector3<f64>) {
        let rho = self.rho(s);
        let (p, y) = ((self.aside / rho) * (self.aside / rho), 1.0 / (rho * rho * rho * rho));
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
        let lead = Vector3::new(s / rho, self.aside / rho, self.aside / (rho * rho * rho));
        (more, u.component_mul(&lead))
    }

    /// By which the body turns about u from one s to another; their distance is known better than from their
    /// difference.
    fn phase(&self, [from, to]: [f64; 2], width: f64) -> f64 {
        if width < 0.0 {
            -self.phase([to, from], -width)
        } else if to <= 0.0 {
            self.phase([-to, -from], width)
        } else if from < 0.0 {
            self.phase([0.0, -from], -from) + self.phase([0.0, to], to)
        } else {
            self.swept([from, to], width) + self.beyond(from, to)
        }
    }

    /// ∫ρ ds, 0 ≤ from ≤ to, without differences of what is large.
    fn swept(&self, [from, to]: [f64; 2], width: f64) -> f64 {
        let square = self.aside * self.aside;
        let (rho, rho_to) = (self.rho(from), self.rho(to));
        let slope = (from + to) / (rho + rho_to);
        let angle = libm::log1p(width * (1.0 + slope) / (from + rho));
        0.5 * (width * (rho_to + from * slope) + square * angle)
    }

    /// ∫ h/(1 − u_3²) − ρ ds, 0 ≤ from ≤ to, over stretches that grow with ρ.
    fn beyond(&self, from: f64, to: f64) -> f64 {
        let nodes = legendre::<NODES>();
        let (mut at, mut sum) = (from, 0.0);
        while at < to {
            let rho = self.rho(at);
            // All of what follows.
            if self.aside * self.aside / (rho * rho * rho * rho) < NO_PHASE {
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

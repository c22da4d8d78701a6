//! Cayley's and Klein's parameters of a heavy top on one half period, without their constants: the formulae are those
//! of heavy_top.rs.

use super::top_roots::Roots;
use crate::math::dd::Dd;
use crate::math::elliptic::{Jacobi, ThirdKind, cel};
use nalgebra::Complex;

/// A wave √2 α from u₁ or √2 β from u₂, but for ρt: over √2, |α| or |β|.
#[derive(Clone, Debug)]
pub struct Wave {
    shape: Shape,
    modulus_squared: f64,
    third: ThirdKind,
    /// Phase = linear x + weight J(x).
    linear: f64,
    weight: f64,
    /// Gain of the phase in 2K.
    pub half_period: Dd,
}

#[derive(Clone, Debug)]
enum Shape {
    /// (p cn dn + i q sn)/√(1 + κ sn²), over dn if so.
    Crossing { p: f64, q: f64, kappa: f64, over_dn: bool },
    /// p √(1 + c sn²)/dn: the axis stays clear of the pole.
    Clear { p: f64, c: f64 },
    /// p cn, on the separatrix.
    Asymptotic { p: f64 },
}

/// The complex amplitude and the phase in front of it, with their derivatives by x.
pub struct Amplitude {
    pub value: Complex<f64>,
    pub slope: Complex<f64>,
    pub phase: f64,
    pub phase_slope: f64,
}

impl Wave {
    /// The wave α; `sum` is b + a.
    pub fn hanging(roots: &Roots, sum: Dd, twice_lambda: Dd, kc: Dd) -> Wave {
        let Roots { z, gap_31, .. } = roots;
        let shape = Shape::Crossing {
            p: z[0].sqrt().f64(),
            q: signed((z[1] * z[2] / *gap_31).sqrt(), sum),
            kappa: (z[0] / *gap_31).f64(),
            over_dn: false,
        };
        Wave::new(shape, roots, z[2] / *gap_31, [Dd::ZERO, sum / (twice_lambda * z[2])], kc)
    }

    /// The wave β; `d` is b − a.
    pub fn upright(roots: &Roots, d: Dd, twice_lambda: Dd, kc: Dd) -> Wave {
        let Roots { y, gap_21, gap_32, gap_31, .. } = roots;
        let over = -y[2];
        if kc.f64() == 0.0 {
            return Wave::new(Shape::Asymptotic { p: y[0].sqrt().f64() }, roots, Dd::ONE, [Dd::ZERO; 2], kc);
        }
        if y[1] <= over {
            let shape = Shape::Crossing {
                p: y[1].sqrt().f64(),
                q: signed(*gap_32 * (y[0] / (*gap_31 * over)).sqrt(), d),
                kappa: (y[1] / over).f64(),
                over_dn: true,
            };
            let weight = d / (twice_lambda * over);
            return Wave::new(shape, roots, *gap_32 / over, [-weight, weight], kc);
        }
        let (linear, c) = (d / (twice_lambda * y[1]), *gap_21 * over / (*gap_31 * y[1]));
        let shape = Shape::Clear { p: y[1].sqrt().f64(), c: c.f64() };
        Wave::new(shape, roots, Dd::ONE + c, [linear, -linear * *gap_21 / y[0]], kc)
    }

    fn new(shape: Shape, roots: &Roots, c: Dd, [linear, weight]: [Dd; 2], kc: Dd) -> Wave {
        let half_period = if kc.f64() == 0.0 {
            Dd::ZERO
        } else {
            let quarter = linear * cel(kc, Dd::ONE, Dd::ONE, Dd::ONE) + weight * cel(kc, c, Dd::ZERO, c);
            quarter + quarter
        };
        Wave {
            shape,
            modulus_squared: (roots.gap_21 / roots.gap_31).f64(),
            third: ThirdKind { c: c.f64() },
            linear: linear.f64(),
            weight: weight.f64(),
            half_period,
        }
    }

    /// Whether the amplitude changes its sign in 2K; else its period is 2K.
    pub fn changes_sign(&self) -> bool {
        matches!(self.shape, Shape::Crossing { .. })
    }

    /// The amplitude at |x| ≤ K.
    pub fn at(&self, x: f64, jacobi: &Jacobi) -> Amplitude {
        let functions = jacobi.at(x);
        let [sn, cn, _] = functions;
        let c = self.third.c;
        let (value, slope) = self.shape.at(functions, self.modulus_squared);
        let integrand = c * sn * sn / (cn * cn + c * sn * sn);
        Amplitude {
            value,
            slope,
            phase: self.linear * x + self.weight * self.third.at(x, functions, jacobi),
            phase_slope: self.linear + self.weight * integrand,
        }
    }
}

impl Shape {
    /// The amplitude's number and its derivative by x, with sn′ = cn dn, cn′ = −sn dn, dn′ = −k² sn cn.
    fn at(&self, [sn, cn, dn]: [f64; 3], kk: f64) -> (Complex<f64>, Complex<f64>) {
        let real = |x: f64| Complex::new(x, 0.0);
        match *self {
            Shape::Crossing { p, q, kappa, over_dn } => {
                let top = Complex::new(p * cn * dn, q * sn);
                let top_slope = Complex::new(-p * sn * (dn * dn + kk * cn * cn), q * cn * dn);
                let squared = 1.0 + kappa * sn * sn;
                let (under, dn_slope) =
                    if over_dn { (squared.sqrt() * dn, kk * sn * cn / dn) } else { (squared.sqrt(), 0.0) };
                let slope = dn_slope - kappa * sn * cn * dn / squared;
                (top / under, (top_slope + top * slope) / under)
            }
            Shape::Clear { p, c } => {
                let squared = 1.0 + c * sn * sn;
                let value = p * squared.sqrt() / dn;
                (real(value), real(value * sn * cn * (c * dn / squared + kk / dn)))
            }
            Shape::Asymptotic { p } => (real(p * cn), real(-p * sn * dn)),
        }
    }
}

fn signed(x: Dd, sign: Dd) -> f64 {
    if sign < Dd::ZERO { -x.f64() } else { x.f64() }
}

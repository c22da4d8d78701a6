//! Double-double numbers hi + lo of about 32 digits, for rates that are multiplied by long times: Dekker, Numer. Math.
//! 18 (1971) 224; Knuth, The Art of Computer Programming 2, 4.2.2; Hida, Li & Bailey, ARITH-15 (2001) 155.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number hi + lo. hi is the sum, rounded: the order of two numbers is that of the pairs.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Dd {
    hi: f64,
    lo: f64,
}

impl Dd {
    pub const ZERO: Dd = Dd { hi: 0.0, lo: 0.0 };
    pub const ONE: Dd = Dd { hi: 1.0, lo: 0.0 };
    pub const PI: Dd = Dd { hi: std::f64::consts::PI, lo: 1.2246467991473532e-16 };

    pub fn f64(self) -> f64 {
        self.hi
    }

    pub fn abs(self) -> Dd {
        if self.hi < 0.0 { -self } else { self }
    }

    pub fn max(self, other: Dd) -> Dd {
        if self < other { other } else { self }
    }

    pub fn min(self, other: Dd) -> Dd {
        if other < self { other } else { self }
    }

    pub fn squared(self) -> Dd {
        self * self
    }

    /// Square root, by one Newton step from the rounded root.
    pub fn sqrt(self) -> Dd {
        if self.hi <= 0.0 {
            return Dd::ZERO;
        }
        let root = Dd::from(self.hi.sqrt());
        root + (self - root * root) / (root + root)
    }

    /// The nearest multiple of the period, and what is left: a few ulp of the period.
    pub fn reduce(self, period: Dd) -> (f64, f64) {
        let count = (self.hi / period.hi).round();
        (count, (self - period * Dd::from(count)).hi)
    }
}

impl From<f64> for Dd {
    fn from(hi: f64) -> Dd {
        Dd { hi, lo: 0.0 }
    }
}

/// Sum as a pair; exact if |a| ≥ |b|.
fn fast_two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    Dd { hi, lo: b - (hi - a) }
}

fn two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    let part = hi - a;
    Dd { hi, lo: (a - (hi - part)) + (b - part) }
}

fn two_product(a: f64, b: f64) -> Dd {
    let hi = a * b;
    Dd { hi, lo: a.mul_add(b, -hi) }
}

impl Add for Dd {
    type Output = Dd;
    fn add(self, other: Dd) -> Dd {
        let (high, low) = (two_sum(self.hi, other.hi), two_sum(self.lo, other.lo));
        let sum = fast_two_sum(high.hi, high.lo + low.hi);
        fast_two_sum(sum.hi, sum.lo + low.lo)
    }
}

impl Neg for Dd {
    type Output = Dd;
    fn neg(self) -> Dd {
        Dd { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for Dd {
    type Output = Dd;
    fn sub(self, other: Dd) -> Dd {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Dd;
    fn mul(self, other: Dd) -> Dd {
        let product = two_product(self.hi, other.hi);
        fast_two_sum(product.hi, product.lo + (self.hi * other.lo + self.lo * other.hi))
    }
}

/// Long division, three digits of f64 each.
impl Div for Dd {
    type Output = Dd;
    fn div(self, other: Dd) -> Dd {
        let first = self.hi / other.hi;
        let rest = self - other * Dd::from(first);
        let second = rest.hi / other.hi;
        let third = (rest - other * Dd::from(second)).hi / other.hi;
        fast_two_sum(first, second) + Dd::from(third)
    }
}

pub fn dot(a: &[Dd; 3], b: &[Dd; 3]) -> Dd {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Sine and cosine by their power series, of an angle within ±π.
pub fn sin_cos(angle: Dd) -> (Dd, Dd) {
    /// xⁿ/n! is below 10⁻³² for x < 0.4.
    const LAST: u32 = 20;
    let x = angle * Dd::from(0.125);
    // sin x and 1 − cos x.
    let (mut sin, mut versine, mut term) = (Dd::ZERO, Dd::ZERO, Dd::ONE);
    for n in 1..=LAST {
        term = term * x / Dd::from(f64::from(n));
        match n % 4 {
            0 => versine = versine - term,
            1 => sin = sin + term,
            2 => versine = versine + term,
            _ => sin = sin - term,
        }
    }
    let two = Dd::from(2.0);
    for _ in 0..3 {
        (sin, versine) = (two * sin * (Dd::ONE - versine), two * sin.squared());
    }
    (sin, Dd::ONE - versine)
}

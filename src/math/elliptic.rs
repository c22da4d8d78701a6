//! Jacobi's elliptic functions and the elliptic integrals of the free rotation, from the complementary modulus, so that
//! k → 1 loses nothing: Bulirsch, Numer. Math. 7 (1965) 78 (sn, cn, dn) and 13 (1969) 305 (cel); Carlson, Numer.
//! Algorithms 10 (1995) 13 (R_F, R_J), as in DLMF 19.36.

use super::dd::Dd;

/// Most of Carlson's steps, and of those of `cel`: each but the first few divides what is left by 4. What takes more
/// ends at NaN.
const MOST: u32 = 100;

/// Most steps of the mean: from k′ = 10⁻¹⁵⁰, 15 are made. What takes more ends at NaN.
const MEANS: usize = 24;

/// sn, cn, dn of one modulus: the steps of the arithmetic-geometric mean of 1 and k′.
#[derive(Clone, Debug)]
pub struct Jacobi {
    means: [(f64, f64); MEANS],
    used: usize,
    /// Rate π/(2K); 0 if k = 1.
    rate: f64,
}

impl Jacobi {
    pub fn new(kc: f64) -> Self {
        /// Convergence is quadratic: the next difference would be below rounding.
        const CLOSE: f64 = 1e-9;
        let (mut jacobi, mut a, mut g) = (Jacobi { means: [(0.0, 0.0); MEANS], used: 0, rate: 0.0 }, 1.0, kc);
        if kc == 0.0 {
            return jacobi;
        }
        for means in &mut jacobi.means {
            *means = (a, g);
            jacobi.used += 1;
            jacobi.rate = (a + g) / 2.0;
            if (a - g).abs() <= CLOSE * a {
                break;
            }
            (a, g) = (jacobi.rate, (a * g).sqrt());
        }
        jacobi
    }

    /// Functions (sn, cn, dn) at |x| ≤ K.
    pub fn at(&self, x: f64) -> [f64; 3] {
        /// Least sine of an angle whose cotangent, squared, is finite.
        const TINY: f64 = 1e-150;
        if self.rate == 0.0 {
            let sech = 1.0 / libm::cosh(x);
            return [libm::tanh(x), sech, sech];
        }
        let (sin, cos) = (libm::sin(self.rate * x), libm::cos(self.rate * x));
        if sin.abs() < TINY {
            return [x, 1.0, 1.0];
        }
        let (mut a, mut dn) = (cos / sin, 1.0);
        let mut c = self.rate * a;
        for &(mean, root) in self.means[..self.used].iter().rev() {
            a *= c;
            c *= dn;
            dn = (root + a) / (mean + a);
            a = c / mean;
        }
        let sn = libm::copysign(1.0 / (c * c + 1.0).sqrt(), sin);
        [sn, c * sn, dn]
    }
}

/// Integral ∫ (a cos² + b sin²) / ((cos² + p sin²) √(cos² + k′² sin²)) dφ over 0..π/2, p > 0, k′ > 0.
pub fn cel(kc: Dd, p: Dd, a: Dd, b: Dd) -> Dd {
    const CLOSE: f64 = 1e-16;
    let (mut a, mut p, mut kc) = (a, p.sqrt(), kc);
    let (mut b, mut e, mut mean) = (b / p, kc, Dd::ONE);
    for _ in 0..MOST {
        let (f, g) = (a, e / p);
        a = a + b / p;
        b = b + f * g;
        b = b + b;
        p = p + g;
        let before = mean;
        mean = mean + kc;
        if (before - kc).abs().f64() <= CLOSE * before.f64() {
            return Dd::PI * Dd::from(0.5) * (b + a * mean) / (mean * (mean + p));
        }
        kc = e.sqrt();
        kc = kc + kc;
        e = kc * mean;
    }
    Dd::from(f64::NAN)
}

/// Integral ½ ∫ dt / √((t+x)(t+y)(t+z)) over 0..∞; at most one argument may be zero.
pub fn carlson_rf(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    /// The series leaves 3 r⁶.
    const SMALL: f64 = 2e-3;
    for _ in 0..MOST {
        let mean = (x + y + z) / 3.0;
        let (X, Y, Z) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean);
        if X.abs().max(Y.abs()).max(Z.abs()) < SMALL {
            let (E2, E3) = (X * Y - Z * Z, X * Y * Z);
            let series = 1.0 - E2 / 10.0 + E3 / 14.0 + E2 * E2 / 24.0 - 3.0 / 44.0 * E2 * E3;
            return series / mean.sqrt();
        }
        let shift = (x * y).sqrt() + (x * z).sqrt() + (y * z).sqrt();
        (x, y, z) = ((x + shift) / 4.0, (y + shift) / 4.0, (z + shift) / 4.0);
    }
    f64::NAN
}

/// Integral 3/2 ∫ dt / ((t+p) √((t+x)(t+y)(t+z))) over 0..∞ for p no less than x, y, z. δ = (p−x)(p−y)(p−z) is the
/// caller's, who knows it without cancellation.
pub fn carlson_rj(mut x: f64, mut y: f64, mut z: f64, mut p: f64, delta: f64) -> f64 {
    /// The series leaves 3 r⁶.
    const SMALL: f64 = 2e-3;
    let (mut sum, mut power, mut delta) = (0.0, 1.0, delta);
    for _ in 0..MOST {
        let mean = (x + y + z + 2.0 * p) / 5.0;
        let (X, Y, Z, P) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean, 1.0 - p / mean);
        if X.abs().max(Y.abs()).max(Z.abs()).max(P.abs()) < SMALL {
            let E2 = X * Y + X * Z + Y * Z - 3.0 * P * P;
            let E3 = X * Y * Z + 2.0 * E2 * P + 4.0 * P * P * P;
            let E4 = (2.0 * X * Y * Z + E2 * P + 3.0 * P * P * P) * P;
            let E5 = X * Y * Z * P * P;
            let series =
                1.0 - 3.0 / 14.0 * E2 + E3 / 6.0 + 9.0 / 88.0 * E2 * E2 - 3.0 / 22.0 * E4 - 9.0 / 52.0 * E2 * E3
                    + 3.0 / 26.0 * E5;
            return power * series / (mean * mean.sqrt()) + 6.0 * sum;
        }
        let (root_x, root_y, root_z, root_p) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let d = (root_p + root_x) * (root_p + root_y) * (root_p + root_z);
        let root_e = delta.sqrt() / d;
        // R_C(1, 1 + e).
        let rc = if root_e > 0.0 { libm::atan(root_e) / root_e } else { 1.0 };
        sum += power / d * rc;
        let shift = root_x * root_y + root_x * root_z + root_y * root_z;
        (x, y, z, p) = ((x + shift) / 4.0, (y + shift) / 4.0, (z + shift) / 4.0, (p + shift) / 4.0);
        (power, delta) = (power / 4.0, delta / 64.0);
    }
    f64::NAN
}

/// Integral J(x) = ∫ c sn²/(cn² + c sn²) dx.
#[derive(Clone, Debug)]
pub struct ThirdKind {
    pub c: f64,
}

impl ThirdKind {
    pub fn at(&self, x: f64, functions: [f64; 3], jacobi: &Jacobi) -> f64 {
        /// cn² < 4 exp(−2x): from here on the integrand is one.
        const FLAT: f64 = 20.0;
        if x.abs() > FLAT {
            let flat = libm::copysign(FLAT, x);
            return self.of_functions(jacobi.at(flat)) + (x - flat);
        }
        self.of_functions(functions)
    }

    fn of_functions(&self, [sn, cn, dn]: [f64; 3]) -> f64 {
        let c = self.c;
        let (ss, cc, dd) = (sn * sn, cn * cn, dn * dn);
        let p = cc + c * ss;
        // (p − cn²)(p − dn²)(p − 1), where dn² = cn² + k′² sn².
        let delta = (c * ss) * (c * ss - (dd - cc)) * ((c - 1.0) * ss);
        c / 3.0 * sn * ss * carlson_rj(cc, dd, 1.0, p, delta.max(0.0))
    }
}

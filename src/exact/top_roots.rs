//! The turning points of a heavy top: the roots u₁ ≤ u₂ ≤ 1 ≤ u₃ of u̇² = (1 − u²)(α − βu) − (b − au)², each as its
//! distances from the start, from the upright and from the hanging position, in double-double.
//!
//! In v = u − u₀ the cubic is βv³ + c₂v² + c₁v + u̇₀² with c₁ = 2ah − 2u₀T − βs², c₂ = 2u₀β − T − a², s² = 1 − u₀², h =
//! b − au₀ and T = |ω⊥|²; in y = 1 − u the product of the roots is −(b − a)²/β. The root that is far from the other two
//! is found by Newton's method from outside, which is monotonic; the others have a product of known sign, in v or in y,
//! so that their quadratic does not cancel.

use crate::math::dd::Dd;

/// Data of the start; β > 0.
pub struct Start {
    pub a: Dd,
    pub beta: Dd,
    /// Distances 1 − u₀ and 1 + u₀.
    pub y: Dd,
    pub z: Dd,
    /// Numbers b − a u₀, u̇₀ and |ω⊥|².
    pub h: Dd,
    pub u_dot: Dd,
    pub T: Dd,
}

#[derive(Debug)]
pub struct Roots {
    /// Distances uᵢ − u₀ from the start.
    pub v: [Dd; 3],
    /// Distances 1 − uᵢ from the upright position.
    pub y: [Dd; 3],
    /// Distances 1 + uᵢ from the hanging position.
    pub z: [Dd; 3],
    /// Gaps u₂ − u₁, u₃ − u₂ and u₃ − u₁.
    pub gap_21: Dd,
    pub gap_32: Dd,
    pub gap_31: Dd,
}

impl Start {
    /// Difference b − a.
    pub fn d(&self) -> Dd {
        self.h - self.a * self.y
    }

    /// Sum b + a.
    pub fn sum(&self) -> Dd {
        self.h + self.a * self.z
    }

    pub fn roots(&self) -> Roots {
        let two = Dd::from(2.0);
        let (beta, u_0) = (self.beta, Dd::ONE - self.y);
        let c = [
            self.u_dot.squared(),
            two * self.a * self.h - two * u_0 * self.T - beta * self.y * self.z,
            two * u_0 * beta - self.T - self.a.squared(),
            beta,
        ];
        let (far, highest) = far_root(&c);
        if highest {
            let product = -c[0] / (beta * far);
            let [v_1, v_2] = opposite((c[1] / beta - product) / far, product);
            let v = [v_1, v_2, far];
            Roots::new(self, v, v.map(|v| self.y - v), far - v_2)
        } else {
            let y_1 = self.y - far;
            let product = -self.d().squared() / (beta * y_1);
            // From the linear term, 2a(b − a) − 2(T − β y₀).
            let linear = two * (self.a * self.d() - self.T + beta * self.y);
            let [y_3, y_2] = opposite((linear / beta - product) / y_1, product);
            let y = [y_1, y_2, y_3];
            Roots::new(self, y.map(|y| self.y - y), y, y_2 - y_3)
        }
    }
}

impl Roots {
    fn new(start: &Start, v: [Dd; 3], y: [Dd; 3], gap_32: Dd) -> Roots {
        let (y, z) = ([y[0], y[1].max(Dd::ZERO), y[2].min(Dd::ZERO)], v.map(|v| (start.z + v).max(Dd::ZERO)));
        Roots { v, y, z, gap_21: v[1] - v[0], gap_32, gap_31: v[2] - v[0] }
    }
}

/// The root that is farther from the middle one than the other is, and whether it is the highest.
fn far_root(c: &[Dd; 4]) -> (Dd, bool) {
    /// Number of steps: from 2r to at least √3 r, quadratically, six reach 32 digits.
    const STEPS: usize = 9;
    let at = |v: Dd| ((c[3] * v + c[2]) * v + c[1]) * v + c[0];
    let slope = |v: Dd| (Dd::from(3.0) * c[3] * v + Dd::from(2.0) * c[2]) * v + c[1];
    let three = Dd::from(3.0) * c[3];
    let inflection = -c[2] / three;
    let reach = Dd::from(2.0) * (c[2].squared() - three * c[1]).sqrt() / three;
    let highest = at(inflection) <= Dd::ZERO;
    let mut v = if highest { inflection + reach } else { inflection - reach };
    for _ in 0..STEPS {
        let slope = slope(v);
        if slope == Dd::ZERO {
            break;
        }
        v = v - at(v) / slope;
    }
    (v, highest)
}

/// The roots of x² − sum x + product, product ≤ 0, in rising order.
fn opposite(sum: Dd, product: Dd) -> [Dd; 2] {
    let half = sum * Dd::from(0.5);
    let root = (half.squared() - product).sqrt();
    let larger = if half < Dd::ZERO { half - root } else { half + root };
    let other = if larger == Dd::ZERO { Dd::ZERO } else { product / larger };
    if larger < other { [larger, other] } else { [other, larger] }
}

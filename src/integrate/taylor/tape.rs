//! Taylor coefficients of a motion, order by order (A. Jorba, M. Zou, Exp. Math. 14 (2005) 99; as a list of operations:
//! F. Biscani, D. Izzo, MNRAS 504 (2021) 2614).
//!
//! A series is a vector or a quaternion (x, y, z, w) as a function of time by its coefficients, which lie one after the
//! other with four numbers each: sums over them are four products at a time. The tape lists operations on series, an
//! operand before its use; coefficient k of a product is Σ aⱼ bₖ₋ⱼ, and the integral of a rate has coefficient k + 1
//! from coefficient k.

use nalgebra::{Matrix3, Vector3, Vector4};

/// Number of the highest coefficient of a series, the first being 0.
pub const HIGHEST: usize = 31;
const STRIDE: usize = HIGHEST + 1;

/// Number of a series on its tape.
pub type Id = usize;

/// A vector and 0, or a quaternion.
type Four = [f64; 4];

#[derive(Clone, Debug)]
enum Node {
    Linear {
        matrix: Matrix3<f64>,
        a: Id,
    },
    Sum {
        terms: Vec<(f64, Id)>,
    },
    Cross {
        a: Id,
        b: Id,
    },
    /// w a, with the last part w of a quaternion.
    Scaled {
        q: Id,
        a: Id,
    },
    /// ((I₂ − I₃)/I₁ ω₂ω₃, …): Euler's equation without torque in principal axes.
    Spin {
        w: Id,
        ratios: Vector3<f64>,
    },
    /// ½ q ω.
    Turning {
        q: Id,
        w: Id,
    },
    /// A cos(ωt + φ).
    Cosine {
        amplitude: Vector3<f64>,
        rate: f64,
        phase: f64,
    },
}

/// A series that is the integral of another.
#[derive(Clone, Copy, Debug)]
struct Integral {
    of: Id,
    out: Id,
}

#[derive(Clone, Debug, Default)]
pub struct Tape {
    coefficients: Vec<Four>,
    nodes: Vec<(Node, Id)>,
    integrals: Vec<Integral>,
}

impl Tape {
    /// A series that is 0 until something is put into it.
    pub fn series(&mut self) -> Id {
        let id = self.coefficients.len() / STRIDE;
        self.coefficients.resize(self.coefficients.len() + STRIDE, [0.0; 4]);
        id
    }

    pub fn constant(&mut self, value: Vector3<f64>) -> Id {
        let id = self.series();
        self.set(id, 0, &value);
        id
    }

    fn node(&mut self, node: Node) -> Id {
        let out = self.series();
        self.nodes.push((node, out));
        out
    }

    pub fn linear(&mut self, matrix: Matrix3<f64>, a: Id) -> Id {
        self.node(Node::Linear { matrix, a })
    }

    pub fn sum(&mut self, terms: Vec<(f64, Id)>) -> Id {
        match terms[..] {
            [(1.0, only)] => only,
            _ => self.node(Node::Sum { terms }),
        }
    }

    pub fn cross(&mut self, a: Id, b: Id) -> Id {
        self.node(Node::Cross { a, b })
    }

    pub fn spin(&mut self, w: Id, ratios: Vector3<f64>) -> Id {
        self.node(Node::Spin { w, ratios })
    }

    pub fn turning(&mut self, q: Id, w: Id) -> Id {
        self.node(Node::Turning { q, w })
    }

    pub fn cosine(&mut self, amplitude: Vector3<f64>, rate: f64, phase: f64) -> Id {
        self.node(Node::Cosine { amplitude, rate, phase })
    }

    /// R(q) a = a + 2 w t + 2 v × t with t = v × a, for the unit quaternion q = (v, w).
    pub fn rotated(&mut self, q: Id, a: Id) -> Id {
        self.rotated_by(q, a, 2.0)
    }

    /// R(q)ᵀ a, which is R(q) a with −v.
    pub fn rotated_back(&mut self, q: Id, a: Id) -> Id {
        self.rotated_by(q, a, -2.0)
    }

    fn rotated_by(&mut self, q: Id, a: Id, twice: f64) -> Id {
        let t = self.cross(q, a);
        let (wt, vt) = (self.node(Node::Scaled { q, a: t }), self.cross(q, t));
        self.sum(vec![(1.0, a), (twice, wt), (2.0, vt)])
    }

    /// Makes `out` the integral of `of`; coefficient 0 is `set`.
    pub fn integrate(&mut self, of: Id, out: Id) {
        self.integrals.push(Integral { of, out });
    }

    /// Number of operations so far.
    pub fn operations(&self) -> usize {
        self.nodes.len()
    }

    /// Works out coefficient `k` of the results of these operations, at the time `t_s`.
    pub fn evaluate(&mut self, range: std::ops::Range<usize>, k: usize, t_s: f64) {
        for (node, out) in &self.nodes[range] {
            let of = |id: &Id| -> &[Four] { &self.coefficients[id * STRIDE..][..=k] };
            let value = match node {
                Node::Linear { matrix, a } => four(&(matrix * vector(&of(a)[k]))),
                Node::Sum { terms } => terms.iter().fold([0.0; 4], |sum, (factor, a)| {
                    let a = of(a)[k];
                    std::array::from_fn(|i| sum[i] + factor * a[i])
                }),
                Node::Cross { a, b } => convolved(of(a), of(b), |a, b| {
                    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0], 0.0]
                }),
                Node::Scaled { q, a } => convolved(of(q), of(a), |q, a| a.map(|a| q[3] * a)),
                Node::Spin { w, ratios } => {
                    let [x, y, z, _] = convolved(of(w), of(w), |a, b| [a[1] * b[2], a[2] * b[0], a[0] * b[1], 0.0]);
                    [ratios.x * x, ratios.y * y, ratios.z * z, 0.0]
                }
                Node::Turning { q, w } => turning(of(q), of(w)),
                Node::Cosine { amplitude, rate, phase } => {
                    // The k-th derivative of the cosine is one shifted by k quarters of a turn.
                    let angle = rate * t_s + phase;
                    let (sin, cos) = (libm::sin(angle), libm::cos(angle));
                    let shifted = [cos, -sin, -cos, sin][k % 4];
                    four(&(amplitude * ((1..=k).fold(shifted, |x, i| x * rate / i as f64))))
                }
            };
            self.coefficients[out * STRIDE + k] = value;
        }
    }

    /// Works out coefficients k + 1 of all integrals.
    pub fn advance(&mut self, k: usize) {
        let part = 1.0 / (k + 1) as f64;
        for Integral { of, out } in &self.integrals {
            self.coefficients[out * STRIDE + k + 1] = self.coefficients[of * STRIDE + k].map(|x| x * part);
        }
    }

    pub fn set(&mut self, id: Id, k: usize, value: &Vector3<f64>) {
        self.coefficients[id * STRIDE + k] = four(value);
    }

    pub fn set_four(&mut self, id: Id, k: usize, value: &Vector4<f64>) {
        self.coefficients[id * STRIDE + k] = (*value).into();
    }

    /// Coefficient of a vector.
    pub fn coefficient(&self, id: Id, k: usize) -> Vector3<f64> {
        vector(&self.coefficients[id * STRIDE + k])
    }

    /// The largest part of a coefficient.
    pub fn size(&self, id: Id, k: usize) -> f64 {
        self.coefficients[id * STRIDE + k].iter().fold(0.0, |max, x| max.max(x.abs()))
    }

    /// The sum of a series up to `order`, `h` after its start (Horner).
    pub fn sum_at(&self, id: Id, order: usize, h: f64) -> Vector4<f64> {
        let series = &self.coefficients[id * STRIDE..][..=order];
        Vector4::from(series.iter().rev().fold([0.0; 4], |sum, c| std::array::from_fn(|i| sum[i] * h + c[i])))
    }
}

fn four(v: &Vector3<f64>) -> Four {
    [v.x, v.y, v.z, 0.0]
}

fn vector([x, y, z, _]: &Four) -> Vector3<f64> {
    Vector3::new(*x, *y, *z)
}

/// Σ product(aⱼ, bₖ₋ⱼ), from coefficients 0 … k of both.
#[inline(always)]
fn convolved(a: &[Four], b: &[Four], product: impl Fn(&Four, &Four) -> Four) -> Four {
    let mut sum = [0.0; 4];
    for (a, b) in a.iter().zip(b.iter().rev()) {
        let product = product(a, b);
        for i in 0..4 {
            sum[i] += product[i];
        }
    }
    sum
}

/// ½ q ω: the sums Σ qⱼ ωₖ₋ⱼ of every component of ω first, for four products at a time.
fn turning(q: &[Four], w: &[Four]) -> Four {
    let [mut x, mut y, mut z] = [[0.0; 4]; 3];
    for (q, w) in q.iter().zip(w.iter().rev()) {
        for i in 0..4 {
            x[i] += q[i] * w[0];
            y[i] += q[i] * w[1];
            z[i] += q[i] * w[2];
        }
    }
    [0.5 * (x[3] + z[1] - y[2]), 0.5 * (y[3] + x[2] - z[0]), 0.5 * (z[3] + y[0] - x[1]), -0.5 * (x[0] + y[1] + z[2])]
}

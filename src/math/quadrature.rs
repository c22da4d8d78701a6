//! Gauss's quadrature: nodes and weights.

/// Nodes and weights on −1..1: roots of Legendre's polynomial, by Newton's method (Press et al., Numerical Recipes,
/// 4.6).
pub fn legendre<const N: usize>() -> [(f64, f64); N] {
    let n = N as f64;
    std::array::from_fn(|i| {
        let mut x = libm::cos(std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5));
        let mut slope = 0.0;
        for _ in 0..8 {
            let (mut p, mut before) = (1.0, 0.0);
            for j in 0..N {
                let j = j as f64;
                (p, before) = (((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0), p);
            }
            slope = n * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// Five nodes and weights on 0..1.
pub const FIVE: [(f64, f64); 5] = [
    (0.046910077030668, 0.11846344252809454),
    (0.230765344947158, 0.23931433524968324),
    (0.5, 0.28444444444444444),
    (0.769234655052842, 0.23931433524968324),
    (0.953089922969332, 0.11846344252809454),
];

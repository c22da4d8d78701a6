//! Six numbers of a body, in loops of a known length that compilers unroll.

use nalgebra::{Matrix6, Vector6};

/// Six numbers of a body.
pub type Six = [f64; 6];

/// a · b, pair by pair.
#[inline(always)]
pub fn dot(a: &Six, b: &Vector6<f64>) -> f64 {
    let b: &Six = b.as_ref();
    ((a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])) + (a[4] * b[4] + a[5] * b[5])
}

/// `to += factor · a`.
#[inline(always)]
pub fn add_scaled(to: &mut Six, a: &Six, factor: f64) {
    for i in 0..6 {
        to[i] += a[i] * factor;
    }
}

/// f₁ a₁ + f₂ a₂ + f₃ a₃.
#[inline(always)]
pub fn combined(a: &[Six; 3], factors: [f64; 3]) -> Six {
    let mut sum = [0.0; 6];
    for i in 0..6 {
        sum[i] = a[0][i] * factors[0] + a[1][i] * factors[1] + a[2][i] * factors[2];
    }
    sum
}

/// f₁ a₁ + f₂ a₂.
#[inline(always)]
pub fn combined_two(a: &Six, b: &Six, factors: [f64; 2]) -> Six {
    let mut sum = [0.0; 6];
    for i in 0..6 {
        sum[i] = a[i] * factors[0] + b[i] * factors[1];
    }
    sum
}

/// f a.
#[inline(always)]
pub fn scaled(a: &Six, factor: f64) -> Six {
    a.map(|a| a * factor)
}

/// `to += a₁ b₁ᵀ + a₂ b₂ᵀ + …`.
#[inline(always)]
pub fn add_products<const N: usize>(to: &mut Matrix6<f64>, a: &[Six; N], b: &[Six; N]) {
    let columns: &mut [Six; 6] = &mut to.data.0;
    for (j, column) in columns.iter_mut().enumerate() {
        for i in 0..6 {
            let mut sum = a[0][i] * b[0][j];
            for k in 1..N {
                sum += a[k][i] * b[k][j];
            }
            column[i] += sum;
        }
    }
}

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

/// `to += a₁ b₁ᵀ + a₂ b₂ᵀ + a₃ b₃ᵀ`.
#[inline(always)]
pub fn add_products(to: &mut Matrix6<f64>, a: &[Six; 3], b: &[Six; 3]) {
    let columns: &mut [Six; 6] = &mut to.data.0;
    for (j, column) in columns.iter_mut().enumerate() {
        for i in 0..6 {
            column[i] += a[0][i] * b[0][j] + a[1][i] * b[1][j] + a[2][i] * b[2][j];
        }
    }
}

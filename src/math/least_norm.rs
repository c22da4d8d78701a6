//! Linear systems that say the same thing twice.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Solution A⁺ x for a symmetric A: of all that come nearest to A y = x the smallest. Eigenvalues below `rank` times
/// the largest count as rounding (relative: an absolute bound would make mass matter).
///
/// By eigenvectors: nalgebra's SVD returns wrong factors when eigenvalues repeat.
pub fn least_norm(A: DMatrix<f64>, x: &DVector<f64>, rank: f64) -> DVector<f64> {
    let eigen = SymmetricEigen::new(A);
    let smallest = rank * eigen.eigenvalues.amax();
    let mut along = eigen.eigenvectors.tr_mul(x);
    for (a, value) in along.iter_mut().zip(eigen.eigenvalues.iter()) {
        *a = if *value > smallest { *a / value } else { 0.0 };
    }
    eigen.eigenvectors * along
}

//! Linear systems whose equations may say the same thing twice: elimination with full pivoting.

use crate::deadline::Deadline;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Choice of a solution where a system leaves some of it open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Selection {
    /// Any solution: what the others determine is 0.
    Any,
    /// The smallest solution.
    Least,
}

/// Part of the largest pivot below which one is rounding of a redundant contact.
const RANK: f64 = 1e-11;

/// Gaussian elimination with full pivoting: P K Q = L U, of which the first `rank` rows mean something.
pub struct Eliminated {
    LU: DMatrix<f64>,
    rows: Vec<usize>,
    columns: Vec<usize>,
    rank: usize,
    deadline: Deadline,
}

impl Eliminated {
    /// None: out of time.
    pub fn new(mut LU: DMatrix<f64>, deadline: Deadline) -> Option<Self> {
        let n = LU.nrows();
        let (mut rows, mut columns): (Vec<usize>, Vec<usize>) = ((0..n).collect(), (0..n).collect());
        let largest = LU.amax();
        let mut rank = 0;
        while rank < n {
            if deadline.is_over() {
                return None;
            }
            let (r, c) = LU.view((rank, rank), (n - rank, n - rank)).icamax_full();
            let pivot = LU[(rank + r, rank + c)].abs();
            if pivot.is_nan() || pivot <= RANK * largest {
                break;
            }
            LU.swap_rows(rank, rank + r);
            rows.swap(rank, rank + r);
            LU.swap_columns(rank, rank + c);
            columns.swap(rank, rank + c);
            for i in rank + 1..n {
                LU[(i, rank)] /= LU[(rank, rank)];
            }
            for j in rank + 1..n {
                let above = LU[(rank, j)];
                for i in rank + 1..n {
                    let factor = LU[(i, rank)];
                    LU[(i, j)] -= factor * above;
                }
            }
            rank += 1;
        }
        Some(Eliminated { LU, rows, columns, rank, deadline })
    }

    /// Solution for a right-hand side: unknowns that the others determine are 0, or all are as small as they can be: x
    /// = Uᵀ (U Uᵀ)⁻¹ y. None where it is not finite, or time is up.
    pub fn solve(&self, rhs: &DVector<f64>, choice: Selection) -> Option<DVector<f64>> {
        let (LU, rank, n) = (&self.LU, self.rank, self.rows.len());
        let mut y = DVector::from_fn(rank, |i, _| rhs[self.rows[i]]);
        for i in 0..rank {
            y[i] -= (0..i).map(|j| LU[(i, j)] * y[j]).sum::<f64>();
        }
        let mut own = DVector::zeros(n);
        if choice == Selection::Any || rank == n {
            for i in (0..rank).rev() {
                let known: f64 = (i + 1..rank).map(|j| LU[(i, j)] * own[j]).sum();
                own[i] = (y[i] - known) / LU[(i, i)];
            }
        } else {
            let U = DMatrix::from_fn(rank, n, |i, j| if j >= i { LU[(i, j)] } else { 0.0 });
            own = U.tr_mul(&cholesky(gram(&U, self.deadline)?, self.deadline)?.solve(&y));
        }
        let mut x = DVector::zeros(n);
        own.iter().zip(&self.columns).for_each(|(own, column)| x[*column] = *own);
        x.iter().all(|x: &f64| x.is_finite()).then_some(x)
    }
}

/// Columns between two looks at the clock: of fewer, a product or factors take no time that counts.
const AT_ONCE: usize = 256;

/// U Uᵀ. None: out of time.
fn gram(U: &DMatrix<f64>, deadline: Deadline) -> Option<DMatrix<f64>> {
    let (rank, n) = U.shape();
    let transposed = U.transpose();
    if rank <= AT_ONCE {
        return Some(U * transposed);
    }
    let mut product = DMatrix::zeros(rank, rank);
    for first in (0..rank).step_by(AT_ONCE) {
        if deadline.is_over() {
            return None;
        }
        let columns = AT_ONCE.min(rank - first);
        product.columns_mut(first, columns).gemm(1.0, U, &transposed.view((0, first), (n, columns)), 0.0);
    }
    Some(product)
}

/// As nalgebra has it, column by column. None: it is not positive definite, or out of time.
fn cholesky(mut matrix: DMatrix<f64>, deadline: Deadline) -> Option<Cholesky<f64, Dyn>> {
    let n = matrix.nrows();
    if n <= AT_ONCE {
        return matrix.cholesky();
    }
    for j in 0..n {
        if deadline.is_over() {
            return None;
        }
        for k in 0..j {
            let factor = -matrix[(j, k)];
            let (mut column, before) = matrix.columns_range_pair_mut(j, k);
            column.rows_range_mut(j..).axpy(factor, &before.rows_range(j..), 1.0);
        }
        let root = Some(matrix[(j, j)]).filter(|pivot| *pivot > 0.0)?.sqrt();
        matrix[(j, j)] = root;
        let mut below = matrix.view_range_mut(j + 1.., j);
        below /= root;
    }
    Some(Cholesky::pack_dirty(matrix))
}

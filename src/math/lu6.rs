//! LU factors of one 6×6 block, rows exchanged by the largest element of every column (G. Golub, C. Van Loan, Matrix
//! Computations, 4th ed., 3.4): unrolled, as small systems are solved by the million.

use nalgebra::{Matrix6, Vector6};

/// P A = L U, L's diagonal being 1.
#[derive(Clone, Copy, Debug)]
pub struct Lu6 {
    /// L and U in one, by columns.
    columns: [[f64; 6]; 6],
    /// 1/U's diagonal.
    inverse: [f64; 6],
    /// Row that every row was exchanged with in its turn.
    exchanged: [usize; 6],
}

impl Lu6 {
    /// Factors of a matrix; None where it is singular.
    pub fn new(matrix: &Matrix6<f64>) -> Option<Self> {
        let mut columns: [[f64; 6]; 6] = (*matrix).into();
        let (mut inverse, mut exchanged) = ([0.0; 6], [0; 6]);
        for k in 0..6 {
            let mut pivot = k;
            for i in k + 1..6 {
                if columns[k][i].abs() > columns[k][pivot].abs() {
                    pivot = i;
                }
            }
            exchanged[k] = pivot;
            if pivot != k {
                columns.iter_mut().for_each(|column| column.swap(k, pivot));
            }
            inverse[k] = 1.0 / columns[k][k];
            if columns[k][k] == 0.0 {
                return None;
            }
            for i in k + 1..6 {
                columns[k][i] *= inverse[k];
            }
            let left = columns[k];
            for column in &mut columns[k + 1..] {
                let above = column[k];
                for i in k + 1..6 {
                    column[i] -= left[i] * above;
                }
            }
        }
        Some(Lu6 { columns, inverse, exchanged })
    }

    /// Solution of A x = `x`.
    pub fn solve(&self, x: &Vector6<f64>) -> Vector6<f64> {
        let mut x: [f64; 6] = (*x).into();
        for (k, other) in self.exchanged.iter().enumerate() {
            x.swap(k, *other);
        }
        for k in 0..6 {
            for i in k + 1..6 {
                x[i] -= self.columns[k][i] * x[k];
            }
        }
        for k in (0..6).rev() {
            x[k] *= self.inverse[k];
            for i in 0..k {
                x[i] -= self.columns[k][i] * x[k];
            }
        }
        x.into()
    }

    /// The same for every column of a matrix.
    pub fn solve_all(&self, matrix: &mut Matrix6<f64>) {
        for mut column in matrix.column_iter_mut() {
            let solved = self.solve(&column.clone_owned());
            column.copy_from(&solved);
        }
    }
}

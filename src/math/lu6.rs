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
        let mut lu = Lu6 { columns: (*matrix).into(), inverse: [0.0; 6], exchanged: [0; 6] };
        let is_regular = lu.eliminate::<0>()
            && lu.eliminate::<1>()
            && lu.eliminate::<2>()
            && lu.eliminate::<3>()
            && lu.eliminate::<4>()
            && lu.eliminate::<5>();
        is_regular.then_some(lu)
    }

    /// Column K's turn. Whether it has a pivot.
    #[inline(always)]
    fn eliminate<const K: usize>(&mut self) -> bool {
        let mut pivot = K;
        for i in K + 1..6 {
            if self.columns[K][i].abs() > self.columns[K][pivot].abs() {
                pivot = i;
            }
        }
        self.exchanged[K] = pivot;
        if pivot != K {
            self.columns.iter_mut().for_each(|column| column.swap(K, pivot));
        }
        if self.columns[K][K] == 0.0 {
            return false;
        }
        let inverse = 1.0 / self.columns[K][K];
        self.inverse[K] = inverse;
        for i in K + 1..6 {
            self.columns[K][i] *= inverse;
        }
        let left = self.columns[K];
        for j in K + 1..6 {
            let column = &mut self.columns[j];
            let above = column[K];
            for i in K + 1..6 {
                column[i] -= left[i] * above;
            }
        }
        true
    }

    /// Solution of A x = `x`.
    pub fn solve(&self, x: &Vector6<f64>) -> Vector6<f64> {
        let mut x: [f64; 6] = (*x).into();
        for (k, other) in self.exchanged.iter().enumerate() {
            x.swap(k, *other);
        }
        self.forward::<0>(&mut x);
        self.forward::<1>(&mut x);
        self.forward::<2>(&mut x);
        self.forward::<3>(&mut x);
        self.forward::<4>(&mut x);
        self.back::<5>(&mut x);
        self.back::<4>(&mut x);
        self.back::<3>(&mut x);
        self.back::<2>(&mut x);
        self.back::<1>(&mut x);
        self.back::<0>(&mut x);
        x.into()
    }

    /// L's column K.
    #[inline(always)]
    fn forward<const K: usize>(&self, x: &mut [f64; 6]) {
        let own = x[K];
        for (x, left) in x[K + 1..].iter_mut().zip(&self.columns[K][K + 1..]) {
            *x -= left * own;
        }
    }

    /// U's column K.
    #[inline(always)]
    fn back<const K: usize>(&self, x: &mut [f64; 6]) {
        x[K] *= self.inverse[K];
        let own = x[K];
        for (x, above) in x[..K].iter_mut().zip(&self.columns[K][..K]) {
            *x -= above * own;
        }
    }

    /// The same for every column of a matrix.
    pub fn solve_all(&self, matrix: &mut Matrix6<f64>) {
        for mut column in matrix.column_iter_mut() {
            let solved = self.solve(&column.clone_owned());
            column.copy_from(&solved);
        }
    }
}

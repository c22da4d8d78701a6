//! The linear complementarity problem z ≥ 0, w = M z + q ≥ 0, z · w = 0 by complementary pivoting (C. E. Lemke,
//! Management Science 11 (1965) 681; R. W. Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem, 1992,
//! 4.4).

/// Of the largest element of M: a pivot that is none.
const NO_PIVOT: f64 = 1e-12;
/// Pivots a variable after which it is given up.
const MOST: usize = 10;

/// z, from M by rows; None where the way ends in a ray, or takes too long.
pub fn solve(M: &[f64], q: &[f64]) -> Option<Vec<f64>> {
    let n = q.len();
    let least = (0..n).min_by(|a, b| q[*a].total_cmp(&q[*b])).filter(|i| q[*i] < 0.0);
    let Some(mut row) = least else { return Some(vec![0.0; n]) };
    let no_pivot = NO_PIVOT * M.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let mut tableau = Tableau::new(M, q);
    let mut entering = tableau.cover();
    for _ in 0..MOST * n {
        let leaving = tableau.pivot(row, entering);
        if leaving == tableau.cover() {
            return Some(tableau.z());
        }
        entering = if leaving < n { leaving + n } else { leaving - n };
        row = tableau.blocking(entering, no_pivot)?;
    }
    None
}

/// Rows of w − M z − d z₀ = q, d = (1, …, 1): columns w, z, z₀, q.
struct Tableau {
    /// By rows.
    elements: Vec<f64>,
    /// The row that is solved for.
    own: Vec<f64>,
    /// The variable that every row is solved for.
    basis: Vec<usize>,
}

impl Tableau {
    fn new(M: &[f64], q: &[f64]) -> Self {
        let n = q.len();
        let mut elements = Vec::with_capacity(n * (2 * n + 2));
        for (i, q) in q.iter().enumerate() {
            elements.extend((0..n).map(|j| f64::from(i == j)));
            elements.extend(M[i * n..][..n].iter().map(|x| -x));
            elements.extend([-1.0, *q]);
        }
        Tableau { elements, own: Vec::with_capacity(2 * n + 2), basis: (0..n).collect() }
    }

    /// z₀, which covers what is negative of q.
    fn cover(&self) -> usize {
        2 * self.basis.len()
    }

    fn row(&self, row: usize) -> &[f64] {
        let width = self.cover() + 2;
        &self.elements[row * width..][..width]
    }

    /// Solves a row for a variable. The one that it was solved for.
    fn pivot(&mut self, row: usize, entering: usize) -> usize {
        let inverse = 1.0 / self.row(row)[entering];
        let width = self.cover() + 2;
        self.own.clear();
        self.own.extend(self.elements[row * width..][..width].iter().map(|x| x * inverse));
        for (i, other) in self.elements.chunks_exact_mut(width).enumerate() {
            let factor = other[entering];
            if i == row {
                other.copy_from_slice(&self.own);
            } else if factor != 0.0 {
                other.iter_mut().zip(&self.own).for_each(|(x, own)| *x -= factor * own);
            }
        }
        std::mem::replace(&mut self.basis[row], entering)
    }

    /// The row whose variable is the first to become 0 as another one grows; z₀'s where several are.
    fn blocking(&self, entering: usize, no_pivot: f64) -> Option<usize> {
        let ratio = |i: usize| self.value(i).max(0.0) / self.row(i)[entering];
        let is_cover = |i: usize| self.basis[i] == self.cover();
        let may_block = |i: &usize| self.row(*i)[entering] > no_pivot;
        (0..self.basis.len()).filter(may_block).min_by(|a, b| {
            let by_ratio = ratio(*a).total_cmp(&ratio(*b));
            by_ratio.then_with(|| is_cover(*b).cmp(&is_cover(*a)))
        })
    }

    /// Of the variable that a row is solved for.
    fn value(&self, row: usize) -> f64 {
        self.row(row)[self.cover() + 1]
    }

    fn z(&self) -> Vec<f64> {
        let n = self.basis.len();
        let mut z = vec![0.0; n];
        for (row, basic) in self.basis.iter().enumerate().filter(|(_, basic)| (n..2 * n).contains(*basic)) {
            z[basic - n] = self.value(row).max(0.0);
        }
        z
    }
}

//! Linear systems whose equations may say the same thing twice: elimination with full pivoting.

use crate::deadline::Deadline;
use smallvec::SmallVec;
use std::ops::{Index, IndexMut};

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

/// Part of a solution of K x = 0 that is rounding.
const TOLD: f64 = 1e-9;

/// Unknowns of a system that needs no allocator: as many as a body has ways to move. (Matrices are copied whole.)
pub const FEW: usize = 6;

/// The numbers of a small vector, in place.
pub type Numbers = SmallVec<[f64; FEW]>;

/// A square matrix, column by column; a small one in place.
#[derive(Clone, Debug)]
pub struct Square {
    n: usize,
    elements: SmallVec<[f64; FEW * FEW]>,
}

impl Square {
    pub fn zeros(n: usize) -> Self {
        Square { n, elements: SmallVec::from_elem(0.0, n * n) }
    }

    /// The largest absolute value.
    pub fn amax(&self) -> f64 {
        amax(&self.elements)
    }

    /// Matrix times vector.
    pub fn times(&self, x: &[f64]) -> Numbers {
        let mut product = Numbers::from_elem(0.0, self.n);
        for (column, x) in self.elements.chunks_exact(self.n.max(1)).zip(x) {
            product.iter_mut().zip(column).for_each(|(sum, of)| *sum += of * x);
        }
        product
    }

    /// Makes a column zero.
    pub fn clear(&mut self, column: usize) {
        self.elements[column * self.n..(column + 1) * self.n].fill(0.0);
    }

    /// Transposed matrix times vector.
    pub fn transposed_times(&self, x: &[f64]) -> Numbers {
        let columns = self.elements.chunks_exact(self.n.max(1));
        columns.map(|column| column.iter().zip(x).map(|(of, x)| of * x).sum()).collect()
    }

    fn column(&self, j: usize) -> &[f64] {
        &self.elements[j * self.n..(j + 1) * self.n]
    }

    /// A column to be changed, and one before it.
    fn column_after(&mut self, j: usize, before: usize) -> (&mut [f64], &[f64]) {
        let (left, right) = self.elements.split_at_mut(j * self.n);
        (&mut right[..self.n], &left[before * self.n..(before + 1) * self.n])
    }
}

impl Index<(usize, usize)> for Square {
    type Output = f64;

    fn index(&self, (i, j): (usize, usize)) -> &f64 {
        &self.elements[j * self.n + i]
    }
}

impl IndexMut<(usize, usize)> for Square {
    fn index_mut(&mut self, (i, j): (usize, usize)) -> &mut f64 {
        &mut self.elements[j * self.n + i]
    }
}

/// Gaussian elimination with full pivoting: P K Q = L U, of which the first `rank` rows mean something.
pub struct Eliminated {
    LU: Square,
    rows: SmallVec<[usize; FEW]>,
    columns: SmallVec<[usize; FEW]>,
    rank: usize,
    deadline: Deadline,
}

impl Eliminated {
    /// None: out of time.
    pub fn new(mut LU: Square, deadline: Deadline) -> Option<Self> {
        let n = LU.n;
        let mut rows: SmallVec<[usize; FEW]> = (0..n).collect();
        let mut columns = rows.clone();
        let largest = LU.amax();
        let mut rank = 0;
        let all = &mut LU.elements[..];
        while rank < n {
            if deadline.is_over() {
                return None;
            }
            let (r, c) = place_of_pivot(all, n, rank);
            let pivot = all[c * n + r];
            if pivot.is_nan() || pivot.abs() <= RANK * largest {
                break;
            }
            if r != rank {
                all.chunks_exact_mut(n).for_each(|column| column.swap(rank, r));
                rows.swap(rank, r);
            }
            let (before, left) = all.split_at_mut((rank + 1) * n);
            let column = &mut before[rank * n..];
            if c != rank {
                column.swap_with_slice(&mut left[(c - rank - 1) * n..(c - rank) * n]);
                columns.swap(rank, c);
            }
            let factors = &mut column[rank + 1..];
            factors.iter_mut().for_each(|x| *x /= pivot);
            for column in left.chunks_exact_mut(n) {
                let above = column[rank];
                column[rank + 1..].iter_mut().zip(&*factors).for_each(|(x, factor)| *x -= factor * above);
            }
            rank += 1;
        }
        Some(Eliminated { LU, rows, columns, rank, deadline })
    }

    /// Solution for a right-hand side: unknowns that the others determine are 0, or all are as small as they can be: x
    /// = Uᵀ (U Uᵀ)⁻¹ y. None where it is not finite, or time is up.
    pub fn solve(&self, rhs: &[f64], choice: Selection) -> Option<Numbers> {
        let (LU, rank, n) = (&self.LU, self.rank, self.rows.len());
        let mut y: Numbers = self.rows[..rank].iter().map(|row| rhs[*row]).collect();
        for j in 0..rank {
            let known = y[j];
            y[j + 1..].iter_mut().zip(&LU.column(j)[j + 1..]).for_each(|(y, factor)| *y -= factor * known);
        }
        let mut own = Numbers::from_elem(0.0, n);
        if choice == Selection::Any || rank == n {
            for j in (0..rank).rev() {
                let x = y[j] / LU[(j, j)];
                own[j] = x;
                y[..j].iter_mut().zip(LU.column(j)).for_each(|(y, factor)| *y -= factor * x);
            }
        } else {
            let mut z = y;
            self.divide_by_gram(&mut z)?;
            for (j, own) in own.iter_mut().enumerate() {
                *own = LU.column(j)[..rank.min(j + 1)].iter().zip(&z).map(|(u, z)| u * z).sum();
            }
        }
        let mut x = Numbers::from_elem(0.0, n);
        own.iter().zip(&self.columns).for_each(|(own, column)| x[*column] = *own);
        x.iter().all(|x| x.is_finite()).then_some(x)
    }

    /// Whether there is one solution, whatever the right-hand side.
    pub fn is_regular(&self) -> bool {
        self.rank == self.rows.len()
    }

    /// Which unknowns the system does not tell: those that some solution of K x = 0 changes.
    pub fn leaves_open(&self) -> SmallVec<[bool; FEW]> {
        let (LU, rank, n) = (&self.LU, self.rank, self.rows.len());
        let mut is_open = SmallVec::from_elem(false, n);
        for k in rank..n {
            let mut own = Numbers::from_elem(0.0, n);
            own[k] = 1.0;
            let mut left: Numbers = LU.column(k)[..rank].iter().map(|u| -u).collect();
            for j in (0..rank).rev() {
                own[j] = left[j] / LU[(j, j)];
                let x = own[j];
                left[..j].iter_mut().zip(LU.column(j)).for_each(|(left, u)| *left -= u * x);
            }
            let least = TOLD * own.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
            own.iter().zip(&self.columns).filter(|(x, _)| x.abs() > least).for_each(|(_, i)| is_open[*i] = true);
        }
        is_open
    }

    /// y becomes (U Uᵀ)⁻¹ y, by Cholesky's factors. None: it is not positive definite, or out of time.
    fn divide_by_gram(&self, y: &mut [f64]) -> Option<()> {
        let (LU, rank, n) = (&self.LU, self.rank, self.rows.len());
        // The lower half of U Uᵀ.
        let mut L = Square::zeros(rank);
        for k in 0..n {
            if self.deadline.is_over() {
                return None;
            }
            let column = &LU.column(k)[..rank.min(k + 1)];
            for (j, factor) in column.iter().enumerate() {
                let sums = &mut L.elements[j * rank + j..(j + 1) * rank];
                sums.iter_mut().zip(&column[j..]).for_each(|(sum, u)| *sum += u * factor);
            }
        }
        for j in 0..rank {
            if self.deadline.is_over() {
                return None;
            }
            for k in 0..j {
                let (column, before) = L.column_after(j, k);
                let factor = before[j];
                column[j..].iter_mut().zip(&before[j..]).for_each(|(x, of)| *x -= factor * of);
            }
            let root = Some(L[(j, j)]).filter(|pivot| *pivot > 0.0)?.sqrt();
            L.elements[j * rank + j + 1..(j + 1) * rank].iter_mut().for_each(|x| *x /= root);
            L[(j, j)] = root;
        }
        for j in 0..rank {
            y[j] /= L[(j, j)];
            let known = y[j];
            y[j + 1..].iter_mut().zip(&L.column(j)[j + 1..]).for_each(|(y, factor)| *y -= factor * known);
        }
        for j in (0..rank).rev() {
            let known: f64 = L.column(j)[j + 1..].iter().zip(&y[j + 1..]).map(|(factor, y)| factor * y).sum();
            y[j] = (y[j] - known) / L[(j, j)];
        }
        Some(())
    }
}

/// Lanes of a search.
const LANES: usize = 8;

/// Place of the largest element of what is not eliminated yet; of equal ones the first, column by column.
fn place_of_pivot(all: &[f64], n: usize, rank: usize) -> (usize, usize) {
    let (mut largest, mut place) = (all[rank * n + rank].abs(), rank);
    for (j, column) in all.chunks_exact(n).enumerate().skip(rank) {
        let most = amax(&column[rank..]);
        if most > largest {
            (largest, place) = (most, j);
        }
    }
    let column = &all[place * n + rank..(place + 1) * n];
    (rank + column.iter().position(|x| x.abs() == largest).unwrap_or(0), place)
}

/// The largest absolute value, in lanes that do not wait for each other.
pub fn amax(of: &[f64]) -> f64 {
    let mut most = [0.0_f64; LANES];
    let chunks = of.chunks_exact(LANES);
    let rest = chunks.remainder().iter().fold(0.0_f64, |most, x| if x.abs() > most { x.abs() } else { most });
    for chunk in chunks {
        for (most, x) in most.iter_mut().zip(chunk) {
            *most = if x.abs() > *most { x.abs() } else { *most };
        }
    }
    most.iter().fold(rest, |a, b| if *b > a { *b } else { a })
}

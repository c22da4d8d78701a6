//! Which unknowns are zero in the smallest solution of a linear system some of whose unknowns may not be negative.
//!
//! The smallest x with K x = y and xᵢ ≥ 0 for some i is x = P(Kᵀ w), P leaving out what is negative of these, and w is
//! where the convex, piecewise quadratic ½|P(Kᵀ w)|² − y·w is least: Newton's method, which knows that it is there when
//! no more of them change, and a search along each of its directions over all the kinks (O. L. Mangasarian, J. Optim.
//! Theory Appl. 121 (2004) 1).

use super::full_pivot::{Numbers, Square, amax};
use crate::deadline::Deadline;
use nalgebra::{DMatrix, DVector};
use smallvec::SmallVec;

/// Added on the diagonal, of the largest element: redundant equations leave it singular.
const REGULAR: f64 = 1e-10;

/// Of the terms of the equations: what is left of them.
const SOLVED: f64 = 1e-12;

/// Steps in which none of them has changed.
const ALIKE: usize = 4;

/// Steps at most (measured: 7 to 15 of six bodies in a pile).
const STEPS: usize = 40;

/// For every unknown, whether it is not zero, if there is a solution. `free`: those that may be negative. None: there
/// is none, or it is not found.
pub fn not_zero(K: &Square, y: &[f64], free: &[bool], deadline: Deadline) -> Option<SmallVec<[bool; 8]>> {
    let n = y.len();
    let pushing =
        |z: &[f64]| -> Numbers { z.iter().zip(free).map(|(z, free)| if *free { *z } else { z.max(0.0) }).collect() };
    let (mut z, mut active) = (Numbers::from_elem(0.0, n), SmallVec::<[bool; 8]>::from_elem(true, n));
    let mut alike = 0;
    for _ in 0..STEPS {
        if deadline.is_over() {
            return None;
        }
        let x = pushing(&z);
        let missing: Numbers = K.times(&x).iter().zip(y).map(|(is, y)| y - is).collect();
        let terms = amax(y) + K.amax() * amax(&x);
        if amax(&missing) <= SOLVED * terms || alike == ALIKE {
            return Some(active);
        }
        let taken = DMatrix::from_fn(n, n, |i, j| if active[j] { K[(i, j)] } else { 0.0 });
        let mut H = &taken * taken.transpose();
        let largest = H.amax();
        (0..n).for_each(|i| H[(i, i)] += REGULAR * largest);
        let direction = H.cholesky()?.solve(&DVector::from_column_slice(&missing));
        let change = K.transposed_times(direction.as_slice());
        let falls: f64 = missing.iter().zip(&direction).map(|(missing, d)| missing * d).sum();
        let part = least_along(&z, &change, free, falls)?;
        z.iter_mut().zip(&change).for_each(|(z, change)| *z += part * change);
        let now: SmallVec<[bool; 8]> = z.iter().zip(free).map(|(z, free)| *free || *z > 0.0).collect();
        alike = if now == active { alike + 1 } else { 0 };
        active = now;
    }
    None
}

/// How far along a direction the function is least that falls so fast at its beginning; none: it falls for ever.
fn least_along(z: &[f64], change: &[f64], free: &[bool], mut falls: f64) -> Option<f64> {
    let is_in = |i: usize| free[i] || z[i] > 0.0 || (z[i] == 0.0 && change[i] > 0.0);
    let mut slope: f64 = (0..z.len()).filter(|i| is_in(*i)).map(|i| change[i] * change[i]).sum();
    let kink = |i: usize| (!free[i] && z[i] * change[i] < 0.0).then(|| (-z[i] / change[i], i));
    let mut kinks: SmallVec<[(f64, usize); 8]> = (0..z.len()).filter_map(kink).collect();
    kinks.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut at = 0.0;
    for (next, i) in kinks {
        if falls - slope * (next - at) <= 0.0 {
            break;
        }
        falls -= slope * (next - at);
        let square = change[i] * change[i];
        slope += if change[i] > 0.0 { square } else { -square };
        at = next;
    }
    let part = at + falls / slope;
    (slope > 0.0 && part.is_finite()).then_some(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(rows: &[&[f64]]) -> Square {
        let mut K = Square::zeros(rows.len());
        for (i, row) in rows.iter().enumerate() {
            row.iter().enumerate().for_each(|(j, x)| K[(i, j)] = *x);
        }
        K
    }

    /// Four legs of a table in a row, each equation of rank two: the smallest of all shares has one that pulls, and of
    /// those that push two are left out.
    #[test]
    fn of_four_in_a_row_two_carry_what_lies_beyond_the_last_but_one() {
        let places: [f64; 4] = [0.0, 1.0, 2.0, 3.0];
        let K = |i: usize, j: usize| 1.0 + places[i] * places[j];
        let rows: Vec<Vec<f64>> = (0..4).map(|i| (0..4).map(|j| K(i, j)).collect()).collect();
        let K = square(&rows.iter().map(|row| &row[..]).collect::<Vec<_>>());
        // A load of one at 2.5.
        let y: Vec<f64> = places.iter().map(|place| 1.0 + 2.5 * place).collect();
        let found = not_zero(&K, &y, &[false; 4], Deadline::default()).unwrap();
        assert_eq!(&found[..], [false, true, true, true], "the shares are 0, 1/12, 1/3, 7/12");
        // At the last one, and beyond it.
        let y: Vec<f64> = places.iter().map(|place| 1.0 + 3.0 * place).collect();
        assert_eq!(&not_zero(&K, &y, &[false; 4], Deadline::default()).unwrap()[3..], [true]);
        let y: Vec<f64> = places.iter().map(|place| 1.0 + 3.5 * place).collect();
        assert!(not_zero(&K, &y, &[false; 4], Deadline::default()).is_none());
        assert!(not_zero(&K, &y, &[true; 4], Deadline::default()).is_some());
    }
}

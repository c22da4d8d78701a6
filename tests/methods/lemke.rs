//! Linear complementarity problems: what is found is complementary, whatever the rank.

use gotai::math::lemke;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// M = B Bᵀ + a skew part + 1e-11 on the diagonal, B of any rank.
fn problem(draw: &mut ChaCha8Rng, n: usize, rank: usize, skew: f64) -> (Vec<f64>, Vec<f64>) {
    let B: Vec<f64> = (0..n * rank).map(|_| draw.random_range(-1.0..1.0)).collect();
    let mut M = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..n {
            M[i * n + j] = (0..rank).map(|k| B[i * rank + k] * B[j * rank + k]).sum();
        }
        M[i * n + i] += 1e-11;
    }
    for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
        let part = skew * draw.random_range(-1.0..1.0);
        M[i * n + j] += part;
        M[j * n + i] -= part;
    }
    (M, (0..n).map(|_| draw.random_range(-1.0..1.0)).collect())
}

#[test]
fn random_problems_are_solved() {
    let mut draw = ChaCha8Rng::seed_from_u64(1);
    let mut worst = 0.0_f64;
    for number in 0..3_000 {
        let n = 1 + number % 12;
        let (rank, skew) = if number % 2 == 0 { (n, 0.0) } else { (1 + number % n, 0.3) };
        let (M, q) = problem(&mut draw, n, rank, skew);
        let z = lemke::solve(&M, &q).unwrap_or_else(|| panic!("{number} ends in a ray"));
        let largest = z.iter().fold(1.0_f64, |a, b| a.max(*b));
        for i in 0..n {
            let w = q[i] + (0..n).map(|j| M[i * n + j] * z[j]).sum::<f64>();
            assert!(z[i] >= 0.0, "{number}: {z:?}");
            worst = worst.max((-w).max(w.min(z[i])) / largest);
        }
    }
    // measured: 7.1e-15
    assert!(worst <= 1e-13, "{worst}");
}

#[test]
fn what_asks_for_nothing_is_left_alone() {
    assert_eq!(lemke::solve(&[1.0, 2.0, 3.0, 4.0], &[0.0, 1.0]), Some(vec![0.0, 0.0]));
    assert_eq!(lemke::solve(&[], &[]), Some(vec![]));
}

/// −z − 1 ≥ 0 has no z ≥ 0.
#[test]
fn a_problem_without_solution_ends_in_a_ray() {
    assert_eq!(lemke::solve(&[-1.0], &[-1.0]), None);
}
